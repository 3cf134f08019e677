# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Query points: which are refused and how that is said, and how points are added and moved."""

from __future__ import annotations

import numpy as np
import pytest

from harmonic_shapes import (
    MAKERS,
    UNITS,
    assert_identical,
    assert_reproduces,
    interior_points,
    middle_cut,
    small_obstacle,
    snapshot,
)
from newton_cagecut.cage import Cage
from newton_cagecut.harmonic import HarmonicCoordinates

WALKS = 64


@pytest.fixture(params=UNITS)
def cage(request) -> Cage:
    """The unit square and the unit box."""
    return MAKERS[request.param]()


@pytest.fixture
def inside(cage) -> np.ndarray:
    """Two points inside."""
    return np.array([[0.3, 0.4, 0.5], [0.6, 0.2, 0.7]])[:, : cage.dimension]


def bake(cage: Cage, points: np.ndarray, **options) -> HarmonicCoordinates:
    """Coordinates with gradients."""
    return HarmonicCoordinates(cage, points, WALKS, **{"gradients": True, **options})


def per_point(coordinates: HarmonicCoordinates, count: int) -> dict[str, np.ndarray]:
    """All that a snapshot holds, a row a point."""
    return {name: values.reshape(count, -1) for name, values in snapshot(coordinates).items()}


def test_bad_points(cage, inside):
    """A point that is not finite, or has not as many numbers as the space has dimensions, is named."""
    inside[1, 1] = np.nan
    with pytest.raises(ValueError, match="point 1 is not finite"):
        bake(cage, inside)
    d = cage.dimension
    for shape in ((2, 5 - d), (d,), (2, d, 1)):
        with pytest.raises(ValueError, match=rf"shape \(n, {d}\), got \({', '.join(map(str, shape))}"):
            bake(cage, np.zeros(shape))


def test_no_points(cage):
    """No points are no error: the weights are empty, and updates have nothing to do."""
    coordinates = bake(cage, np.zeros((0, cage.dimension)))
    assert coordinates.weights.shape == (0, cage.vertex_count)
    edit = middle_cut(cage).advance(to=0.5)
    assert coordinates.update(edit).walk_count == 0
    assert coordinates.weights.shape == (0, edit.cage.vertex_count)


@pytest.mark.parametrize(
    ("option", "value", "text"),
    [
        ("walks", 0, "from 1 to 16777216"),
        ("walks", 1.5, "from 1 to 16777216"),
        ("walks", float("inf"), "from 1 to 16777216"),
        ("walks", "many", "from 1 to 16777216"),
        ("seed", -1, "from 0 to 4294967295"),
        ("max_steps", 0, "from 1 to 65536"),
        ("degree", 4, "from 1 to 3"),
        ("epsilon", 0.0, "between 1e-6 and 0.1"),
        ("epsilon", float("nan"), "between 1e-6 and 0.1"),
        ("correction", "best", "harmonic, affine, none"),
        ("bounds", "box", "dop18, dop26, aabb, sphere"),
        ("distance", "near", "grid, all"),
        ("quads", "bilinear", "mean_value, harmonic"),
    ],
)
def test_bad_options_are_named(cage, inside, option, value, text):
    """An option out of its range is refused with its name and its range."""
    with pytest.raises(ValueError, match=f"{option} must .*{text}"):
        HarmonicCoordinates(cage, inside, **{option: value})


@pytest.mark.parametrize("depth", [None, 0.6, 1.1])
def test_set_points_touches_no_other(cage, depth):
    """Added and moved points equal those of a fresh bake with the same edits; all others keep their bits."""
    old = interior_points(cage, 20, np.random.default_rng(1))
    fresh = np.concatenate([old, interior_points(cage, 5, np.random.default_rng(2))])
    fresh[[3, 11]] = interior_points(cage, 2, np.random.default_rng(3))
    moving = bake(cage, old, point_capacity=25)
    baked = bake(cage, fresh)
    if depth is not None:
        edit = middle_cut(cage).advance(to=depth)
        moving.update(edit)
        baked.update(edit)
    before = per_point(moving, 20)
    changed = np.array([3, 11, *range(20, 25)])
    stats = moving.set_points(changed, fresh[changed])
    assert moving.point_count == 25
    assert stats.walk_count == 25 * WALKS
    assert stats.resolved_points == 7
    assert stats.rewalked == 7 * WALKS
    after = {name: values.reshape(25, -1) for name, values in snapshot(moving).items() if name != "gradients"}
    kept = np.setdiff1d(np.arange(20), changed)
    assert_identical({name: before[name][kept] for name in after}, {name: after[name][kept] for name in after})
    np.testing.assert_array_equal(moving.gradients, baked.gradients[:20])
    assert_identical(after, {name: per_point(baked, 25)[name] for name in after})


def test_set_points_then_update(cage):
    """Points that were set follow later cuts like any other."""
    points = interior_points(cage, 20, np.random.default_rng(4))
    coordinates = bake(cage, points[:12], point_capacity=20, gradients=False)
    cut = middle_cut(cage)
    coordinates.update(cut.advance(to=0.4))
    coordinates.set_points(np.arange(12, 20), points[12:])
    for depth in (0.8, 1.1):
        coordinates.update(cut.advance(to=depth))
        updated = snapshot(coordinates)
        coordinates.recompute()
        assert_identical(updated, snapshot(coordinates))
    assert_reproduces(coordinates, points, gradients=False)


def test_points_on_a_side_of_the_cut(cage, inside):
    """Points set on the two sides of a cut have the weights of their side, and keep them exact as the cut goes on."""
    coordinates = bake(cage, inside, point_capacity=4)
    cut = middle_cut(cage)
    coordinates.update(cut.advance(to=0.5))
    place = np.repeat([[0.47, *[0.4, 0.9][-cage.dimension + 1 :]]], 2, axis=0)
    coordinates.set_points([2, 3], place, [2 * cut.wall, 2 * cut.wall + 1])
    for depth in (0.5, 0.8, 1.1):
        coordinates.update(cut.advance(to=depth))
        updated = snapshot(coordinates)
        coordinates.recompute()
        assert_identical(updated, snapshot(coordinates))
        np.testing.assert_allclose(coordinates.weights[2:] @ coordinates.cage.vertices, place, atol=1e-5)
    component = coordinates.cage.vertex_component
    used = [set(component[np.flatnonzero(row)].tolist()) for row in coordinates.weights[2:]]
    assert len(used[0]) == len(used[1]) == 1
    assert used[0] != used[1]


def test_set_points_refuses(cage, inside):
    """Points outside, beyond the capacity, with gaps, twice or of the wrong count are refused; nothing has changed."""
    coordinates = bake(cage, inside, point_capacity=4)
    before = snapshot(coordinates)
    good = np.full((1, cage.dimension), 0.5)
    for indices, points, text in (
        ([0], good + 2.0, "outside"),
        ([0], good * np.nan, "not finite"),
        ([4], good, "gaps"),
        ([3], good, "gaps"),
        ([-1], good, "no point"),
        ([0, 0], np.repeat(good, 2, axis=0), "twice"),
        ([0, 1], good, "shape"),
        ([0], good[:, :-1], "shape"),
        ([2, 3, 4], np.repeat(good, 3, axis=0), "point_capacity"),
    ):
        with pytest.raises(ValueError, match=text):
            coordinates.set_points(np.array(indices), points)
    assert coordinates.point_count == 2
    assert_identical(before, snapshot(coordinates))
    keys = 2 * cage.face_count
    with pytest.raises(ValueError, match=f"keys of the cage's walls are 0 to {keys - 1}"):
        coordinates.set_points([0], good, [keys])


def test_bake_in_a_cut_cage(cage):
    """Coordinates made in a cage with a cut that is still open follow it from there."""
    rng = np.random.default_rng(5)
    cut = middle_cut(cage)
    cut.advance(to=0.5)
    points = interior_points(cage, 30, rng)
    coordinates = bake(cut.cage, points)
    assert_reproduces(coordinates, points)
    for depth in (0.8, 1.1):
        coordinates.update(cut.advance(to=depth))
        assert_reproduces(coordinates, points)
    assert coordinates.cage.component_count == 2


@pytest.mark.parametrize("depth", [None, 0.6])
def test_removed_points_leave_the_others_alone(cage, depth):
    """Removed points weigh nothing; all others keep their bits, through a cut and a recompute too."""
    points = interior_points(cage, 20, np.random.default_rng(6))
    full, fewer = bake(cage, points), bake(cage, points)
    cut = middle_cut(cage)
    if depth is not None:
        edit = cut.advance(to=depth)
        full.update(edit)
        fewer.update(edit)
    gone = np.array([0, 7, 19])
    fewer.remove_points(gone)
    kept = np.setdiff1d(np.arange(20), gone)
    np.testing.assert_array_equal(fewer.removed_points, gone)
    assert fewer.point_count == 20
    for later in (0.8, 1.1):
        before, after = per_point(full, 20), per_point(fewer, 20)
        assert_identical({name: before[name][kept] for name in before}, {name: after[name][kept] for name in before})
        assert not any(after[name][gone].any() for name in ("weights", "gradients", "degrees", "key"))
        edit = cut.advance(to=later)
        full.update(edit)
        stats = fewer.update(edit)
        assert stats.walk_count == stats.checked == 17 * WALKS
        assert stats.reused >= 0
        updated = snapshot(fewer)
        assert fewer.recompute().rewalked == 17 * WALKS
        assert_identical(updated, snapshot(fewer))


def test_removed_numbers_are_used_again(cage):
    """A point put where another was removed is what it had been from the start; it follows cuts again."""
    points = interior_points(cage, 12, np.random.default_rng(7))
    expected = bake(cage, points)
    other = points.copy()
    other[[2, 5]] = other[[5, 2]]
    coordinates = bake(cage, other, point_capacity=13)
    cut = middle_cut(cage)
    edit = cut.advance(to=0.4)
    coordinates.remove_points([5, 2])
    for one in (expected, coordinates):
        one.update(edit)
    coordinates.set_points([5, 2], points[[5, 2]])
    assert len(coordinates.removed_points) == 0
    assert_identical(snapshot(coordinates), snapshot(expected))
    edit = cut.advance(to=1.1)
    for one in (expected, coordinates):
        one.update(edit)
    assert_identical(snapshot(coordinates), snapshot(expected))


def test_all_points_removed(cage, inside):
    """With every point removed there is nothing left to walk, and edits are taken all the same."""
    coordinates = bake(cage, inside)
    coordinates.remove_points([0, 1])
    stats = coordinates.update(middle_cut(cage).advance(to=0.5))
    assert stats.walk_count == stats.rewalked == coordinates.recompute().rewalked == 0
    assert not coordinates.weights.any()


def test_removal_is_undone_by_a_snapshot(cage, inside):
    """Restoring a snapshot brings removed points back, and removes those again that were removed then."""
    coordinates = bake(cage, interior_points(cage, 10, np.random.default_rng(8)))
    coordinates.remove_points([3])
    known, kept = snapshot(coordinates), coordinates.snapshot()
    coordinates.remove_points([0, 9])
    coordinates.set_points([3], inside[:1])
    coordinates.restore(kept)
    np.testing.assert_array_equal(coordinates.removed_points, [3])
    assert_identical(known, snapshot(coordinates))


def test_obstacle_where_a_point_was_removed(cage, inside):
    """An obstacle may cover a point once it is removed."""
    coordinates = bake(cage, inside)
    edit = cage.insert(small_obstacle(cage, inside[0]))
    with pytest.raises(ValueError, match="remove the points first"):
        coordinates.update(edit)
    coordinates.remove_points([0])
    coordinates.update(edit)
    updated = snapshot(coordinates)
    coordinates.recompute()
    assert_identical(updated, snapshot(coordinates))


def test_remove_points_refuses(cage, inside):
    """What is no point, was removed, is there twice or is no number is refused; nothing has changed then."""
    coordinates = bake(cage, inside)
    coordinates.remove_points([1])
    before = snapshot(coordinates)
    for indices, error, text in (
        ([0, 2], ValueError, "no point 2"),
        ([0, 1], ValueError, "no point 1"),
        ([0, 0], ValueError, "point 0 is given twice"),
        ([-1], ValueError, "-1 is no point"),
        ([[0]], ValueError, r"shape \(n,\)"),
        ([0.0], TypeError, "must be integers"),
    ):
        with pytest.raises(error, match=text):
            coordinates.remove_points(np.array(indices))
    np.testing.assert_array_equal(coordinates.removed_points, [1])
    assert_identical(before, snapshot(coordinates))
    with pytest.raises(ValueError, match="cuttable=False"):
        bake(cage, inside, cuttable=False).remove_points([0])
