# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The candidate grid finds the walls that a search of all of them finds, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import merged_cube, star_prism, u_shape
from harmonic_shapes import assert_identical, crossing_blade, interior_points, random_blade, snapshot
from newton_cagecut.cage import Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from plane_shapes import PLANES


@pytest.mark.parametrize("make", [merged_cube, star_prism, u_shape, PLANES["comb"], PLANES["annulus"]])
def test_grid_equals_all_walls(make):
    """Landings, bounds, weights and gradients are the same by grid and by all walls, after merged cuts too."""
    rng = np.random.default_rng(1)
    cage = make()
    points = interior_points(cage, 60, rng)
    by_grid, by_all = (
        HarmonicCoordinates(cage, points, 128, gradients=True, distance=distance) for distance in ("grid", "all")
    )
    assert_identical(snapshot(by_grid), snapshot(by_all))
    first = Cut(cage, random_blade(rng, cage))
    edits = [first.advance(to=depth * first.length) for depth in (0.2, 0.5, 0.9)]
    second = Cut(first.cage, crossing_blade(rng, edits))
    for edit in [*edits, second.advance(to=0.5 * second.length), second.advance(to=1.1 * second.length)]:
        by_grid.update(edit)
        by_all.update(edit)
        assert_identical(snapshot(by_grid), snapshot(by_all))


def test_first_landings_are_nearest():
    """The first radius of every point is its distance to the nearest wall, measured in float64."""
    cage = star_prism()
    points = interior_points(cage, 100, np.random.default_rng(2))
    coordinates = HarmonicCoordinates(cage, points, 16, gradients=True)
    cut = Cut(cage, random_blade(np.random.default_rng(3), cage))
    edit = cut.advance(to=0.6 * cut.length)
    coordinates.update(edit)
    corners = np.concatenate([cage.vertices[cage.triangles], edit.swept_simplices])
    exact = np.array([min(_distance(point, triangle) for triangle in corners) for point in points])
    np.testing.assert_allclose(coordinates.domain.distance_to_walls(points), exact, atol=1e-6)
    landed = coordinates.domain.frame.center + coordinates.domain.frame.half_side * coordinates.landings["point"]
    off = [min(_distance(point, triangle) for triangle in corners) for point in landed[:200].astype(np.float64)]
    assert max(off) < 1e-6


def _distance(point: np.ndarray, triangle: np.ndarray) -> float:
    """Distance of a point from a triangle: from its plane inside, from its edges outside."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    ends = ((a, b), (b, c), (c, a))
    if all(np.cross(q - p, point - p) @ normal >= 0.0 for p, q in ends):
        return abs(float((point - a) @ normal)) / float(np.linalg.norm(normal))
    shares = [(p, q - p, np.clip((point - p) @ (q - p) / ((q - p) @ (q - p)), 0.0, 1.0)) for p, q in ends]
    return min(float(np.linalg.norm(point - p - t * along)) for p, along, t in shares)
