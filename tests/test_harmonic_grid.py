# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The candidate grid finds the walls that a search of all of them finds, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from benchmarks.topology import armed_ball
from harmonic_shapes import MAKERS, assert_identical, crossing_blade, interior_points, random_blade, snapshot
from newton_cagecut.cage import Cut
from newton_cagecut.geometry import simplex_distances
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.harmonic.cache.domain import Domain


@pytest.mark.parametrize("name", ["star", "holed_square", "comb", "merged_cube", "star_prism", "u_shape"])
def test_grid_equals_all_walls(name):
    """Landings, bounds, weights and gradients are the same by grid and by all walls, after merged cuts too."""
    rng = np.random.default_rng(1)
    cage = MAKERS[name]()
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


@pytest.mark.parametrize("name", ["star", "star_prism"])
def test_first_landings_are_nearest(name):
    """The first radius of every point is its distance to the nearest wall, measured in float64."""
    cage = MAKERS[name]()
    points = interior_points(cage, 100, np.random.default_rng(2))
    coordinates = HarmonicCoordinates(cage, points, 16, gradients=True)
    cut = Cut(cage, random_blade(np.random.default_rng(3), cage))
    edit = cut.advance(to=0.6 * cut.length)
    coordinates.update(edit)
    corners = np.concatenate([cage.vertices[cage.simplices], edit.swept_simplices])
    exact = simplex_distances(points, corners).min(axis=1)
    np.testing.assert_allclose(coordinates.domain.distance_to_walls(points), exact, atol=1e-6)
    landed = coordinates.domain.frame.center + coordinates.domain.frame.half_side * coordinates.landings["point"]
    assert simplex_distances(landed.astype(np.float64), corners).min(axis=1).max() < 1e-6


@pytest.mark.parametrize("name", ["star", "star_prism"])
@pytest.mark.parametrize("resolution", [3, 24, 128])
def test_landings_do_not_depend_on_the_resolution(name, resolution):
    """A grid of any fineness finds the same walls, the one that the number of walls suggests among them."""
    rng = np.random.default_rng(4)
    cage = MAKERS[name]()
    points = interior_points(cage, 40, rng)
    options = {"quads": "mean_value", "distance": "grid", "device": wp.get_device()}
    cut = Cut(cage, random_blade(rng, cage))
    edits = [cut.advance(to=depth * cut.length) for depth in (0.3, 0.7)]
    fitting, other = (
        HarmonicCoordinates(Domain(cage, **options, **more), points, 128, gradients=True)
        for more in ({}, {"grid_resolution": resolution})
    )
    for edit in [None, *edits]:
        if edit is not None:
            fitting.update(edit)
            other.update(edit)
        assert_identical(snapshot(fitting), snapshot(other))


def test_more_walls_get_a_finer_grid():
    """Cages of few walls get a coarse grid, and those of the plane a finer one than as many triangles."""

    def cells(cage):
        return max(Domain(cage, quads="mean_value", distance="grid", device=wp.get_device()).grid.cells.shape)

    assert cells(MAKERS["box"]()) < cells(MAKERS["star_prism"]()) < cells(armed_ball(300))
    assert cells(MAKERS["box"]()) < cells(MAKERS["square"]())
