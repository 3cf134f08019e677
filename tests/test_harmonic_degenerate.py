# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Query points where they are least welcome: on the boundary and a hair beside it, outside, in cavities, on cuts."""

from __future__ import annotations

import numpy as np
import pytest

from harmonic_shapes import (
    MAKERS,
    UNITS,
    assert_identical,
    assert_reproduces,
    interior_points,
    points_near_faces,
    small_obstacle,
    snapshot,
)
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade

NAMES = pytest.mark.parametrize("name", ["square", "star", "holed_square", "box", "merged_cube", "star_prism"])
CAVITIES = {"square": "holed_square", "box": "square_torus"}


def bake(cage: Cage, points: np.ndarray, walks: int = 64, **options) -> HarmonicCoordinates:
    """Coordinates with gradients."""
    return HarmonicCoordinates(cage, points, walks, gradients=True, **options)


def assert_sound(coordinates: HarmonicCoordinates, points: np.ndarray) -> None:
    """Assert that weights reproduce the points, and that they and their gradients are bounded."""
    assert_reproduces(coordinates, points, gradients=False)
    assert np.abs(coordinates.weights).max() < 1.0 + 1e-5
    assert np.abs(coordinates.gradients).max() * coordinates.cage.diameter < 100.0


@NAMES
def test_vertices_and_edges(name):
    """On a vertex its weight is 1; between two vertices of an edge only theirs are not 0, and linear."""
    cage = MAKERS[name]()
    coordinates = bake(cage, cage.vertices)
    assert_sound(coordinates, cage.vertices)
    np.testing.assert_allclose(coordinates.weights, np.eye(cage.vertex_count), atol=1e-5)
    edges = cage.mesh.edges
    points = 0.3 * cage.vertices[edges[:, 0]] + 0.7 * cage.vertices[edges[:, 1]]
    coordinates = bake(cage, points)
    assert_sound(coordinates, points)
    expected = np.zeros_like(coordinates.weights)
    np.put_along_axis(expected, edges, [[0.3, 0.7]], axis=1)
    np.testing.assert_allclose(coordinates.weights, expected, atol=1e-4)


@NAMES
@pytest.mark.parametrize("distance", [0.0, 1e-7, 0.9e-6, -1e-7, -0.9e-6])
def test_on_faces_and_a_hair_beside(name, distance):
    """Points on faces, and up to the tolerance inside and outside of them, have the boundary's weights, extended."""
    cage = MAKERS[name]()
    points = points_near_faces(cage, distance * cage.diameter, np.random.default_rng(1))
    coordinates = bake(cage, points, 512)
    assert_sound(coordinates, points)
    assert coordinates.recompute().capped == 0
    assert coordinates.weights.min() > -1e-4
    keys = cage.face_key[cage.simplex_face]
    on_boundary = coordinates.boundary_weights(points, keys, walks=512)
    few = np.diff(cage.mesh.face_start)[cage.simplex_face] <= 4  # on others nested walks differ by their noise
    np.testing.assert_allclose(coordinates.weights[few], on_boundary[few], atol=1e-4)
    np.testing.assert_allclose(coordinates.weights, on_boundary, atol=0.15)


@NAMES
def test_farther_outside_is_refused(name):
    """Beyond the tolerance points are refused with their number and distance, from a bake and when set later."""
    cage = MAKERS[name]()
    points = interior_points(cage, 5, np.random.default_rng(2))
    coordinates = bake(cage, points)
    points[3] = points_near_faces(cage, -1.2 * cage.length_tolerance, np.random.default_rng(3))[0]
    text = rf"1 of \d points lie outside the cage, the farthest \(point {{}}\) by {1.2 * cage.length_tolerance:.4g} m"
    with pytest.raises(ValueError, match=text.format(3)):
        bake(cage, points)
    with pytest.raises(ValueError, match=text.format(0)):
        coordinates.set_points([1], points[3:4])


@pytest.mark.parametrize("name", UNITS)
def test_cavities_and_obstacles_are_outside(name):
    """Points in a hole, a cavity or an obstacle are refused; those on its boundary and within the tolerance are not."""
    base = MAKERS[name]()
    obstacle = small_obstacle(base, np.full(base.dimension, 0.5))
    cage = base.insert(obstacle).cage
    beside = points_near_faces(obstacle, 0.5 * cage.length_tolerance, np.random.default_rng(4))
    points = np.concatenate([obstacle.vertices, beside])
    assert_sound(bake(cage, points), points)
    for covered, distance in ((np.full((1, base.dimension), 0.5), "0.05"), (beside[:1] * 0.9 + 0.05, r"0.00\d+")):
        with pytest.raises(ValueError, match=rf"1 of 1 points lie outside the cage, .* by {distance} m"):
            bake(cage, covered)
    with pytest.raises(ValueError, match="1 of 1 points lie outside the cage"):
        bake(MAKERS[CAVITIES[name]](), np.array([[1.5, 1.5, 0.3][: base.dimension]]))


@pytest.mark.parametrize("epsilon", [1e-4, 1e-6])
@pytest.mark.parametrize("name", ["comb", "u_shape"])
def test_walks_do_not_go_around_the_cage(name, epsilon):
    """Outside of a cage with a wide tolerance all walks end at the nearest place, never across a gap of the cage."""
    cage = MAKERS[name]()
    cage = Cage(cage.vertices, cage.faces, tolerance=1e-2)
    points = points_near_faces(cage, -0.9 * cage.length_tolerance, np.random.default_rng(5))
    coordinates = bake(cage, points, epsilon=epsilon)
    assert_reproduces(coordinates, points, gradients=False)
    assert coordinates.recompute().capped == 0
    landed = coordinates.landings["point"].reshape(len(points), -1, cage.dimension)
    landed = coordinates.domain.frame.center + coordinates.domain.frame.half_side * landed
    off = np.linalg.norm(landed - points[:, None], axis=2)
    np.testing.assert_allclose(off, 0.9 * cage.length_tolerance, rtol=1e-3)
    assert coordinates.weights.min() > -0.1


@pytest.mark.parametrize("name", UNITS)
def test_edits_of_cages_with_points_on_the_boundary(name):
    """Points on the boundary, or outside within the tolerance, follow extensions, obstacles and cuts bit for bit."""
    cage = MAKERS[name]()
    rng = np.random.default_rng(6)
    offsets = (0.0, -0.3 * cage.length_tolerance, -0.9 * cage.length_tolerance)
    points = np.concatenate([cage.vertices, *(points_near_faces(cage, offset, rng) for offset in offsets)])
    coordinates = bake(cage, points)
    edits = [cage.move_face(1, 0.3)]
    edits.append(edits[-1].cage.insert(small_obstacle(cage, np.full(cage.dimension, 0.5))))
    cut = Cut(edits[-1].cage, Blade(np.full(cage.dimension, 0.45), *np.eye(cage.dimension)[:0:-1]))
    edits += [cut.advance(to=part * cut.length) for part in (0.4, 1.1)]
    for edit in edits:
        coordinates.update(edit)
        updated = snapshot(coordinates)
        coordinates.recompute()
        assert_identical(updated, snapshot(coordinates))
        assert_reproduces(coordinates, points, gradients=False)
    assert coordinates.cage.piece_count == 2


@pytest.mark.parametrize("name", UNITS)
def test_points_on_crossing_cuts(name):
    """Points exactly on cuts, and where two cuts cross, belong to one of the pieces that meet there."""
    cage = MAKERS[name]()
    share = np.linspace(0.05, 0.95, 12)
    points = np.concatenate([np.c_[np.full(12, 0.47), share, share], np.c_[share, np.full(12, 0.52), 1.0 - share]])
    points = np.concatenate([points, [[0.47, 0.52, 0.3], [0.47, 0.52, 0.0], [0.47, 0.0, 0.3]]])[:, : cage.dimension]
    coordinates = bake(cage, points)
    edge = [] if cage.dimension == 2 else [[0.0, 0.0, 1.0]]
    middle = np.array([0.47, 0.52, 0.5][: cage.dimension])
    for direction in np.eye(cage.dimension)[:2]:
        cut = Cut(cage, Blade(middle, *edge, -direction))
        for part in (0.5, 1.1):
            coordinates.update(cut.advance(to=part * cut.length))
            updated = snapshot(coordinates)
            coordinates.recompute()
            assert_identical(updated, snapshot(coordinates))
        cage = cut.cage
    assert cage.piece_count == 4
    assert_sound(coordinates, points)
    for point, row in zip(points, coordinates.weights):
        (piece,) = np.unique(cage.vertex_piece[np.flatnonzero(row)])
        own = cage.vertices[cage.vertex_piece == piece]
        assert (own.min(axis=0) <= point + 1e-9).all()
        assert (own.max(axis=0) >= point - 1e-9).all()
