# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of refined cages: more vertices in the same planes."""

import numpy as np
import pytest

import newton_cagecut as cagecut
from cage_shapes import box, merged_cube, square_torus, star_prism, tetrahedron, u_shape
from plane_shapes import PLANES

SHAPES = {"box": box, "tetrahedron": tetrahedron, "star": star_prism, "u": u_shape, "torus": square_torus}
SHAPES |= {"merged": merged_cube, **{f"plane_{name}": make for name, make in PLANES.items()}}


@pytest.mark.parametrize("name", SHAPES)
def test_refined_cage_is_the_same_body(name):
    """Volume, pieces, walls and Euler characteristic stay; every face lies on its wall; old vertices keep their ids."""
    cage = SHAPES[name]()
    fine = cage.refine().refine()
    assert fine.volume == pytest.approx(cage.volume, rel=1e-12)
    np.testing.assert_allclose(fine.piece_volumes, cage.piece_volumes, rtol=1e-12)
    assert fine.euler_characteristic == cage.euler_characteristic
    assert fine.walls is cage.walls
    assert np.array_equal(fine.vertices[: cage.vertex_count], cage.vertices)
    assert fine.face_count >= (4 if cage.dimension == 2 else 16) * cage.face_count
    fine.validate()
    for face, loop in enumerate(fine.faces):
        wall = fine.walls[fine.face_wall[face]]
        heights = (fine.vertices[list(loop)] - wall.origin) @ wall.normal
        assert np.abs(heights).max() < fine.length_tolerance


@pytest.mark.parametrize("name", ["box", "plane_square"])
def test_refined_cage_is_cut_and_updated_like_any_other(name):
    """Weights sum to one and are linear, and an update after a cut of the refined cage equals a recompute."""
    cage = SHAPES[name]().refine()
    rng = np.random.default_rng(0)
    points = cage.vertices.mean(axis=0) + 0.3 * (rng.random((40, cage.dimension)) - 0.5)
    coordinates = cagecut.HarmonicCoordinates(cage, points, walks=64, device="cpu")
    np.testing.assert_allclose(coordinates.weights @ cage.vertices, points, atol=1e-5)
    np.testing.assert_allclose(coordinates.weights.sum(axis=1), 1.0, atol=1e-5)
    if cage.dimension == 3:
        blade = cagecut.Blade([0.46, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0])
    else:
        blade = cagecut.Blade([0.46, 0.5], [0.2, -1.0])
    cut = cagecut.Cut(cage, blade)
    for share in (0.45, 1.0):
        coordinates.update(cut.advance(to=share * cut.length))
        updated = coordinates.weights.copy()
        coordinates.recompute()
        assert np.array_equal(coordinates.weights, updated)
    cut.cage.validate()
    assert cut.cage.piece_count == 2
    with pytest.raises(ValueError, match="has been cut"):
        cut.cage.refine()


@pytest.mark.parametrize("name", ["tetrahedron", "plane_square"])
def test_refined_weights_hold_the_coarse_ones(name):
    """Coarse weights are the refined ones gathered by how the coarse boundary values interpolate the new vertices."""
    cage = SHAPES[name]()
    fine = cage.refine()
    points = cage.vertices.mean(axis=0)[None] + np.linspace(-0.05, 0.05, 9)[:, None]
    coarse, refined = (cagecut.HarmonicCoordinates(c, points, walks=512, device="cpu").weights for c in (cage, fine))
    gathered = np.zeros((fine.vertex_count, cage.vertex_count))
    gathered[: cage.vertex_count] = np.eye(cage.vertex_count)
    for a, b in cage.mesh.edges if cage.dimension == 3 else cage.faces:
        middle = 0.5 * (cage.vertices[a] + cage.vertices[b])
        new = int(np.linalg.norm(fine.vertices - middle, axis=1).argmin())
        gathered[new, [a, b]] = 0.5
    np.testing.assert_allclose(refined @ gathered, coarse, atol=0.02)
