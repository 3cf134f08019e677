# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Points on walls: their weights reproduce them from their own face, at any number of walks."""

import numpy as np
import pytest

import newton_cagecut as cagecut
from cage_shapes import star_prism
from newton_cagecut.geometry import triangulate
from solver_scenes import make_solver
from surface_shapes import bumpy_sphere

CUT = cagecut.Blade([0.31, 0.28, 3.0], [0.2, 1.0, 0.0], [0.1, 0.05, -1.0])


def points_in(cage: cagecut.Cage, face: int, count: int) -> np.ndarray:
    """Points on a face, which may be slit or concave."""
    corners, wall = cage.vertices[list(cage.faces[face])], cage.walls[cage.face_wall[face]]
    flat = (corners - wall.origin) @ wall.axes.T
    corners = corners[triangulate(flat if cage.face_side[face] == 0 else flat[:, ::-1])]
    shares = np.random.default_rng(face).dirichlet(np.ones(3), size=(len(corners), count))
    return np.einsum("tnk,tkd->tnd", shares, corners).reshape(-1, 3)


@pytest.mark.parametrize("correction", ["harmonic", "affine"])
@pytest.mark.parametrize("walks", [1, 2, 7, 64])
def test_faces_reproduce_their_points(walks, correction):
    """Unit sum, positions and no weight off the face, on concave, slit and split faces, updated as recomputed."""
    before = star_prism()
    middle = before.vertices.mean(axis=0) + [0.07, 0.03, 2.0]
    cut = cagecut.Cut(before, cagecut.Blade(middle, [0.2, 1.0, 0.0], [0.1, 0.05, -1.0]))
    first = cut.advance(to=0.35 * cut.length)
    cage = first.cage
    points = [points_in(cage, face, 3) for face in range(cage.face_count)]
    face = np.repeat(np.arange(cage.face_count), [len(p) for p in points])
    points, keys = np.concatenate(points), cage.face_key[face]
    coords = cagecut.HarmonicCoordinates(
        cage, points, walks, point_keys=keys, correction=correction, quads="harmonic", device="cpu"
    )
    own = np.zeros((len(points), cage.vertex_count), dtype=bool)
    for row, number in enumerate(face):
        own[row, list(cage.faces[number])] = True
    for _ in range(2):
        weights = coords.weights.astype(np.float64)[:, : coords.cage.vertex_count]
        np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=5e-7)
        np.testing.assert_allclose(weights @ coords.cage.vertices, points, atol=1e-6)
        assert weights.min() > -1.5
        if coords.cage is cage:
            assert not weights[~own].any()
            coords.update(cut.advance(to=0.7 * cut.length))
    updated = coords.weights.copy()
    coords.recompute()
    np.testing.assert_array_equal(coords.weights, updated)


@pytest.mark.parametrize("walks", [1, 16])
@pytest.mark.parametrize("dimension", [2, 3])
def test_cuts_leave_the_rest_shape(dimension, walks):
    """After two cuts that cross, on as few as one walk, every point of the surface is where it was."""
    surface = bumpy_sphere(2) if dimension == 3 else None
    _, solver, *states = make_solver(dimension=dimension, surface=surface, walks=walks, quadrature=0, seed=3)
    blades = [CUT, cagecut.Blade([0.3, 0.55, 2.0], [1.0, 0.1, 0.0], [0.0, 0.2, -1.0])]
    if dimension == 2:
        blades = [cagecut.Blade([0.45, 2.0], [0.1, -1.0]), cagecut.Blade([-1.0, 0.55], [1.0, 0.1])]
    for blade in blades:
        cut = solver.begin_cut(0, blade)
        for share in (0.3, 0.8):
            solver.advance_cut(cut, to=share * cut.length, states=states)
    body = solver.bodies[0]
    assert (body.surface.point_key >= 0).sum() > 10
    np.testing.assert_allclose(
        solver.surface(states[0])[0], body.to_world(body.surface.points), atol=1.5e-6 * body.cage.diameter
    )
    weights = body.surface_weights
    body.coordinates.recompute()
    np.testing.assert_array_equal(body.surface_weights, weights)
