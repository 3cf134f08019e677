# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What holds of all weights: rest shapes are reproduced, rigid motions free, pieces know nothing of each other."""

from __future__ import annotations

import numpy as np
import pytest

from harmonic_shapes import (
    MAKERS,
    UNITS,
    assert_identical,
    assert_reproduces,
    crossing_blade,
    interior_points,
    middle_cut,
    points_near_faces,
    random_blade,
    snapshot,
)
from newton_cagecut.cage import Cage, Cut, boundary_distances
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from plane_shapes import PLANES

PAIR = pytest.mark.parametrize("name", ["star", "merged_cube"])
"""A cage of each dimension that is not simple."""


@pytest.mark.parametrize("name", [*PLANES, "tetrahedron", "box", "merged_cube", "star_prism"])
def test_rest_shape_is_reproduced(name):
    """Weights sum to 1 and give the rest position, gradients leave rigid motions free, before and after cuts."""
    rng = np.random.default_rng(1)
    cage = MAKERS[name]()
    points = interior_points(cage, 60, rng)
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    assert_reproduces(coordinates, points)
    first = Cut(cage, random_blade(rng, cage))
    edits = [first.advance(to=depth * first.length) for depth in (0.5, 0.8)]
    second = Cut(first.cage, crossing_blade(rng, edits))
    for edit in [*edits, second.advance(to=0.4 * second.length), second.advance(to=1.1 * second.length)]:
        coordinates.update(edit)
        assert_reproduces(coordinates, points)


@PAIR
def test_identities_are_tight_inside(name):
    """Away from walls the gradients' identities hold to 1e-4 with no allowance for their size, cut or not."""
    cage = MAKERS[name]()
    points = interior_points(cage, 200, np.random.default_rng(2))
    cut = middle_cut(cage)
    points = points[np.minimum(np.abs(cut.plane.distance(points)), boundary_distances(cage, points)) > 0.02][:60]
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    for depth in (None, 0.5, 1.1):
        if depth is not None:
            coordinates.update(cut.advance(to=depth))
        slopes = coordinates.gradients.astype(np.float64)
        np.testing.assert_allclose(slopes.sum(axis=1), 0.0, atol=1e-4)
        identity = np.einsum("vi,pvj->pij", coordinates.cage.vertices, slopes)
        np.testing.assert_allclose(identity, np.broadcast_to(np.eye(cage.dimension), identity.shape), atol=1e-4)


@pytest.mark.parametrize("distance", [1e-7, 1e-6, 1e-5, 1e-4])
@PAIR
def test_next_to_walls(name, distance):
    """Points within 1e-7 to 1e-4 of a face or of a cut reproduce their position and have bounded weights."""
    rng = np.random.default_rng(3)
    cage = MAKERS[name]()
    cut = middle_cut(cage)
    beside = interior_points(cage, 200, rng)
    beside -= cut.plane.distance(beside)[:, None] * cut.plane.normal
    beside = beside[cage.contains(beside) & (boundary_distances(cage, beside) > 0.05)][:20]
    assert len(beside) == 20
    beside += np.where(np.arange(20) % 2 == 0, distance, -distance)[:, None] * cut.plane.normal
    points = np.concatenate([points_near_faces(cage, distance, rng), beside])
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    assert_reproduces(coordinates, points)
    for depth in (0.5, 1.1):
        coordinates.update(cut.advance(to=depth))
        assert_reproduces(coordinates, points)
        assert np.abs(coordinates.weights).max() < 1.5


@pytest.mark.parametrize("walks", [16, 64])
@PAIR
def test_few_walks_do_not_extrapolate(name, walks):
    """Next to a wall, where few landings are off it, weights stay bounded and exact: no fit is extrapolated."""
    rng = np.random.default_rng(3)
    cage = MAKERS[name]()
    points = np.concatenate([points_near_faces(cage, distance, rng) for distance in [1e-2] * 10 + [1e-3] * 10])
    points = points[cage.contains(points)]
    coordinates = HarmonicCoordinates(cage, points, walks, gradients=True)
    cut = middle_cut(cage)
    for depth in (0.5, 1.1):
        coordinates.update(cut.advance(to=depth))
    assert np.abs(coordinates.weights).max() < 1.5
    assert_reproduces(coordinates, points)


@pytest.mark.parametrize("name", ["square", "star", "holed_square", "box", "star_prism"])
def test_other_pieces_have_no_weight(name):
    """After complete cuts the weights and gradients of other pieces' vertices are zero exactly."""
    rng = np.random.default_rng(4)
    cage = MAKERS[name]()
    points = interior_points(cage, 80, rng)
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    up = np.array([0.0, 0.1, 1.0])
    vectors = {2: [[[0.1, 1.0]], [[1.0, 0.1]]], 3: [[np.cross(n, up), up] for n in ([1.0, 0.1, 0.0], [0.1, 1.0, 0.2])]}
    for directions in vectors[cage.dimension]:
        cut = Cut(cage, Blade(cage.vertices.mean(axis=0) + 0.02, *directions))
        for depth in (0.6, 1.1):
            coordinates.update(cut.advance(to=depth * cut.length))
        cage = cut.cage
    assert cage.piece_count >= 3
    foreign = cage.vertex_piece[None] != cage.piece_of(points)[:, None]
    assert np.all(coordinates.weights[foreign] == 0.0)
    assert np.all(coordinates.gradients[foreign] == 0.0)
    assert_reproduces(coordinates, points)


def _moved(cage: Cage, scale: float, offset: float) -> Cage:
    return Cage(cage.vertices * scale + offset, cage.faces)


@pytest.mark.parametrize(("scale", "offset"), [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e4)])
@PAIR
def test_size_and_place_do_not_matter(name, scale, offset):
    """The same cage of 1 mm, of 1 km or 10 km away has the same weights, cut or not; gradients scale."""
    cage = MAKERS[name]()
    moved = _moved(cage, scale, offset)
    points = interior_points(cage, 40, np.random.default_rng(5))
    here = HarmonicCoordinates(cage, points, 64, gradients=True)
    there = HarmonicCoordinates(moved, points * scale + offset, 64, gradients=True)
    cuts = middle_cut(cage), middle_cut(moved)
    for depth in (None, 0.4, 0.8):
        if depth is not None:
            here.update(cuts[0].advance(to=depth))
            there.update(cuts[1].advance(to=depth * scale))
        np.testing.assert_allclose(there.weights, here.weights, atol=1e-6)
        np.testing.assert_allclose(there.gradients * scale, here.gradients, atol=1e-4)


@pytest.mark.parametrize("name", UNITS)
def test_seed(name):
    """The same seed gives the same bits, another seed other weights."""
    cage = MAKERS[name]()
    points = interior_points(cage, 10, np.random.default_rng(6))
    first, again, other = (HarmonicCoordinates(cage, points, 64, seed, gradients=True) for seed in (1, 1, 2))
    assert_identical(snapshot(first), snapshot(again))
    assert not np.array_equal(first.weights, other.weights)
