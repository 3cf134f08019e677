# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Sections and pieces against manifold3d, and the same cut at every scale and place."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import SHAPES, hexagonal_prism, random_blade
from cut_sequences import CAGES, EVERY
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from plane_shapes import loops_of

RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
_SCALES = [(1e-3, 0.0), (1.0, 0.0), (1e3, 0.0), (1.0, 1e4)]


def _solid(cage: Cage) -> manifold3d.Manifold:
    """The cage as the other library's solid, in float64; a plane cage as a prism of height one over it."""
    vertices, triangles = (cage.vertices.copy(), cage.triangles) if cage.dimension == 3 else _prism(cage)
    solid = manifold3d.Manifold(manifold3d.Mesh64(vertices, triangles.astype(np.uint64)))
    assert solid.status() == manifold3d.Error.NoError
    return solid


def _prism(cage: Cage) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a prism over a plane cage, triangulated by the other library."""
    loops, count = loops_of(cage), cage.vertex_count
    cap = np.concatenate(loops)[manifold3d.triangulate([cage.vertices[loop] for loop in loops])]
    a, b = cage.simplices.T
    sides = [np.stack([a, b, b + count], axis=1), np.stack([a, b + count, a + count], axis=1)]
    height = np.repeat([0.0, 1.0], count)
    return np.c_[np.tile(cage.vertices, (2, 1)), height], np.concatenate([cap[:, ::-1], cap + count, *sides])


def _cap_area(half: manifold3d.Manifold, origin: np.ndarray, normal: np.ndarray, tolerance: float) -> float:
    """Area of a half's triangles in a plane."""
    mesh = half.to_mesh64()
    corner = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)]
    on_plane = (np.abs((corner - origin) @ normal) < tolerance).all(axis=1)
    cross = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[on_plane]
    return 0.5 * float(np.linalg.norm(cross, axis=1).sum())


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=5, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_complete_cuts_against_manifold(name, seed):
    """The measure of the section and the volumes of the pieces are those of an independent library, to 1e-9."""
    cage = EVERY[name]()
    cut = Cut(cage, random_blade(np.random.default_rng(seed), cage))
    edit = cut.advance(to=np.inf)
    origin, normal = (np.append(vector, 0.0)[:3] for vector in (cut.plane.origin, cut.plane.normal))
    halves = _solid(cage).split_by_plane(normal, origin @ normal)
    volumes = sorted(part.volume() for half in halves for part in half.decompose())
    np.testing.assert_allclose(sorted(edit.cage.piece_volumes), volumes, rtol=1e-9, atol=1e-9 * cage.volume)
    area = np.linalg.norm(edit.cage.mesh.face_area_vector, axis=1)
    for side, half in ((1, halves[0]), (0, halves[1])):
        mine = area[edit.cage.face_key == 2 * cut.wall + side].sum()
        reference = _cap_area(half, origin, normal, 1e-3 * cage.length_tolerance)
        assert mine == pytest.approx(reference, rel=1e-9, abs=1e-9 * cage.diameter**2)


def _sequence(scale: float, shift: float) -> tuple[list[Cage], HarmonicCoordinates]:
    """Two crossing cuts, one of them bent, of a cage of some size at some place; cages and final weights."""
    plain = hexagonal_prism()
    offset = shift * np.array([1.0, -0.3, 0.7])
    cage = Cage(scale * plain.vertices + offset, plain.faces)
    points = np.random.default_rng(1).uniform(-0.5, 0.5, (8, 3)) + [0.0, 0.0, 0.5]
    coordinates = HarmonicCoordinates(cage, scale * points * [1, 1, 0.9] + offset, walks=64, seed=2, device="cpu")
    cages = []

    def carve(origin, edge, direction, depth: float, turned=None) -> None:
        cut = Cut(coordinates.cage, Blade(scale * np.array(origin) + offset, edge, direction))
        for part in (0.4, 1.0):
            if turned is not None and part == 1.0:
                cut.turn(turned)
            coordinates.update(cut.advance(to=part * depth * scale))
            cages.append(coordinates.cage)

    carve([0.1, 0.0, 0.5], [0.1, 1.0, 0.2], [0.2, 0.0, -1.0], 0.8, turned=[0.6, 0.1, -1.0])
    carve([0.0, 0.1, 0.4], [0.1, 1.0, 0.1], [1.0, 0.0, 0.1], 9.0)
    return cages, coordinates


@pytest.mark.parametrize(("scale", "shift"), _SCALES)
def test_every_scale_and_place(scale, shift):
    """A cage of 1 mm, 1 m or 1 km, or 10 km from the origin, has the same topology and the same weights."""
    cages, coordinates = _sequence(scale, shift)
    reference, expected = _sequence(1.0, 0.0)
    for one, two in zip(cages, reference, strict=True):
        assert one.faces == two.faces
    assert cages[-1].component_count > 1
    np.testing.assert_allclose(coordinates.weights, expected.weights, atol=1e-6)


def test_shapes_are_all_played():
    """The collection of cages has all those of the other tests and those of the assets."""
    assert set(SHAPES) | {"starfish_cage", "bunny_cage"} <= set(CAGES)
