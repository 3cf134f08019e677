# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Blades and their planes."""

from __future__ import annotations

import numpy as np
import pytest

from newton_cagecut.cage.wall import cut_wall
from newton_cagecut.section import Blade, BladePlane


def test_coordinates_are_skew():
    """A point of the plane is the origin plus its coordinates along edge and direction."""
    blade = Blade([1.0, 2.0, 3.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.5])
    plane = BladePlane.of(blade)
    wanted = np.array([[0.3, -0.7], [2.0, 1.5]])
    points = plane.origin + wanted @ np.stack([plane.edge, plane.direction])
    np.testing.assert_allclose(plane.coordinates(points), wanted, atol=1e-14)
    np.testing.assert_allclose(plane.distance(points), 0.0, atol=1e-14)
    np.testing.assert_allclose(plane.normal @ np.stack([plane.edge, plane.direction]).T, 0.0, atol=1e-15)


def test_distance_is_along_edge_cross_direction():
    """The positive side is where edge x direction points, and shifting the plane lowers distances."""
    plane = BladePlane.of(Blade(np.zeros(3), [1, 0, 0], [0, 5, 0]))
    assert plane.distance(np.array([[0.0, 0.0, 2.0]]))[0] == 2.0
    assert plane.shifted(0.5).distance(np.array([[0.0, 0.0, 2.0]]))[0] == 1.5


def test_equal_points_have_equal_distances():
    """Distances do not depend on a point's place in the array, to the last bit."""
    rng = np.random.default_rng(0)
    plane = BladePlane.of(Blade(*rng.normal(size=(3, 3))))
    points = rng.normal(size=(101, 3))
    single = np.concatenate([plane.distance(p[None]) for p in points])
    np.testing.assert_array_equal(plane.distance(points), single)


def test_wall_of_a_plane():
    """A cut's wall is two-sided, with the plane's normal."""
    plane = BladePlane.of(Blade([1, 1, 1], [1, 0, 0], [0.5, 1, 0]))
    wall = cut_wall(plane)
    assert wall.two_sided
    np.testing.assert_allclose(np.cross(*wall.axes), plane.normal, atol=1e-15)


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        (([0, 0, 0], [0, 0, 0], [1, 0, 0]), "edge is zero"),
        (([0, 0, 0], [1, 0, 0], [0, 0, 0]), "direction is zero"),
        (([0, 0, 0], [1, 2, 3], [-2, -4, -6]), "parallel"),
        (([0, np.nan, 0], [1, 0, 0], [0, 1, 0]), "origin is not finite"),
        (([0, 0, 0], [np.inf, 0, 0], [0, 1, 0]), "edge is not finite"),
        (([0], [1, 0, 0], [0, 1, 0]), r"origin must have shape \(3,\), or \(2,\) in the plane"),
        (([0, 0, 0], [1, 0], [0, 1, 0]), r"edge must have shape \(3,\), as its origin has, got \(2,\)"),
        (([0, 0], [0, 1, 0]), r"direction must have shape \(2,\), as its origin has, got \(3,\)"),
        (([0, 0], [0, 0]), "direction is zero"),
        (([0, 0], [1, np.nan]), "direction is not finite"),
        (([0, 0], [1, 0], [0, 1]), r"has no edge; give Blade\(origin, direction\)"),
    ],
)
def test_bad_blades_are_refused(arguments, match):
    """Blades that span no plane are refused with the argument's name."""
    with pytest.raises(ValueError, match=match):
        Blade(*arguments)


def test_wrong_types_are_refused():
    """Text is no vector, and a direction must be given."""
    with pytest.raises(TypeError, match="direction must be three numbers"):
        Blade([0, 0, 0], [1, 0, 0], "up")
    with pytest.raises(TypeError, match="direction must be two numbers"):
        Blade([0, 0], "up")
    with pytest.raises(TypeError, match="in space needs an edge and a direction"):
        Blade([0, 0, 0], [1, 0, 0])
    with pytest.raises(TypeError, match="in the plane needs a direction"):
        Blade([0, 0])


def test_tiny_and_huge_directions():
    """The lengths of edge and direction do not matter."""
    blade = Blade(np.zeros(3), [1e-200, 0, 0], [0, 1e200, 0])
    np.testing.assert_array_equal(blade.normal, [0, 0, 1])
