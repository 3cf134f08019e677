# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The walk cache: what it takes, what updates say of it, and what they refuse without having changed anything."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from cage_shapes import box
from harmonic_shapes import MAKERS, UNITS, assert_identical, interior_points, middle_cut, snapshot
from newton_cagecut.cage import Cage
from newton_cagecut.harmonic import Domain, HarmonicCoordinates
from newton_cagecut.harmonic.walks.query_points import point_arrays
from plane_shapes import outline, rectangle

WALKS = 64


@pytest.fixture(params=UNITS)
def cage(request) -> Cage:
    """The unit square and the unit box."""
    return MAKERS[request.param]()


@pytest.fixture
def points(cage) -> np.ndarray:
    """Thirty points inside."""
    return interior_points(cage, 30, np.random.default_rng(1))


def bake(cage: Cage | Domain, points: np.ndarray, **options) -> HarmonicCoordinates:
    """Coordinates with gradients."""
    return HarmonicCoordinates(cage, points, WALKS, **{"gradients": True, **options})


def test_bytes_of_a_walk(cage, points):
    """Landings and bounds take 64 bytes a walk together, 32 in the plane, as reported and as allocated."""
    coordinates = bake(cage, points, point_capacity=40)
    memory, expected = coordinates.memory(), {2: 32, 3: 64}[cage.dimension]
    assert memory["landings"] + memory["bounds"] == expected * 40 * WALKS
    rows = sum(values.nbytes for values in (*coordinates.landings.values(), coordinates.bounds))
    assert rows == expected * 30 * WALKS
    assert memory["weights"] == 4 * 40 * cage.vertex_count
    assert memory["gradients"] == 12 * 30 * cage.vertex_count


def test_nothing_is_kept_without_cuttable(cage, points, monkeypatch):
    """Without cuttable all walks are forgotten, in batches too, and the weights are the same."""
    kept, free = bake(cage, points), bake(cage, points, cuttable=False)
    np.testing.assert_array_equal(free.weights, kept.weights)
    np.testing.assert_array_equal(free.gradients, kept.gradients)
    memory = free.memory()
    assert memory["landings"] == memory["bounds"] == 0
    assert free._cache.records is None
    arrays = [value for part in (free._cache, free._cache.weights) for value in vars(part).values()]
    arrays += point_arrays(free._cache.points).values()
    assert max(array.size for array in arrays if isinstance(array, wp.array)) < len(points) * WALKS
    monkeypatch.setattr("newton_cagecut.harmonic.cache.stages._BATCH_WALKS", 7 * WALKS)
    free.recompute()
    np.testing.assert_array_equal(free.weights, kept.weights)


def test_no_update_without_cuttable(cage, points):
    """What needs the cache says so."""
    free = bake(cage, points, cuttable=False)
    weights = free.weights
    edit = middle_cut(cage).advance(to=0.5)
    for call in (
        lambda: free.update(edit),
        lambda: free.set_points([0], points[:1]),
        lambda: free.landings,
        lambda: free.bounds,
    ):
        with pytest.raises(ValueError, match="cuttable=False"):
            call()
    np.testing.assert_array_equal(free.weights, weights)


def test_gradients_of_a_mask(cage, points):
    """A mask gives gradients to some points: the same that all would have, and no memory for the others."""
    mask = np.arange(len(points)) % 3 == 0
    every, some = bake(cage, points), bake(cage, points, gradients=mask)
    np.testing.assert_array_equal(some.gradients, every.gradients[mask])
    assert some.memory()["gradients"] * 3 == every.memory()["gradients"]
    assert some.gradients.shape == (10, cage.vertex_count, cage.dimension)


def test_stats_count_what_happened(cage, points):
    """Every walk is walked again, evaluated again or reused; those of the last kind have the landings of before."""
    cut = middle_cut(cage)
    coordinates = bake(cage, points)
    for depth in (0.3, 0.6, 1.1):
        before = coordinates.landings
        stats = coordinates.update(cut.advance(to=depth))
        assert stats.walk_count == stats.checked == len(points) * WALKS
        assert stats.walk_count == stats.rewalked + stats.on_face + stats.reused
        assert min(stats.rewalked, stats.on_face, stats.reused) > 0
        assert stats.resolved_points <= len(points)
        moved = (before["point"] != coordinates.landings["point"]).any(axis=1)
        assert 0 < np.count_nonzero(moved) <= stats.rewalked
        assert stats.total_seconds == pytest.approx(sum(stats.seconds.values()))
        assert {"walls", "check", "rewalk", "on_face", "resolve"} <= stats.seconds.keys()
    stats = coordinates.recompute()
    assert (stats.rewalked, stats.on_face, stats.reused) == (stats.walk_count, 0, 0)


@pytest.mark.parametrize("cage", [outline(rectangle((0, 0), (8, 1))), box((8.0, 1.0, 1.0))], ids=["plane", "space"])
def test_update_touches_few_points(cage):
    """A short cut leaves the walks of points far away alone."""
    points = np.array([[x, 0.5, 0.5][: cage.dimension] for x in np.linspace(0.4, 7.6, 19)])
    coordinates, cut = bake(cage, points), middle_cut(cage)
    before = coordinates.landings
    stats = coordinates.update(cut.advance(to=0.1))
    assert 0 < stats.rewalked < 0.15 * stats.walk_count
    same = (before["point"] == coordinates.landings["point"]).all(axis=1).reshape(19, WALKS)
    assert same[:5].all()


def test_edit_of_another_cage_is_refused(cage, points):
    """An edit that is skipped, repeated or of another cage is refused, and the right one is taken afterwards."""
    coordinates, cut = bake(cage, points), middle_cut(cage)
    edits = [cut.advance(to=depth) for depth in (0.3, 0.6)]
    before = snapshot(coordinates)
    for edit in (edits[1], middle_cut(Cage(cage.vertices, cage.faces)).advance(to=0.3)):
        with pytest.raises(ValueError, match="another cage"):
            coordinates.update(edit)
    assert_identical(before, snapshot(coordinates))
    assert coordinates.cage is cage
    coordinates.update(edits[0])
    with pytest.raises(ValueError, match="another cage"):
        coordinates.update(edits[0])
    coordinates.update(edits[1])
    other = bake(cage, points)
    for edit in edits:
        other.update(edit)
    assert_identical(snapshot(coordinates), snapshot(other))


def test_capacity_exceeded_changes_nothing(cage, points):
    """A cut that needs more vertices than were reserved is refused before anything has changed; a smaller one fits."""
    needed = 2 * cage.vertex_count
    capacity = {2: 7, 3: 14}[cage.dimension]
    coordinates = bake(cage, points, vertex_capacity=capacity)
    pointer = coordinates.weights_array.ptr
    before, walls = snapshot(coordinates), coordinates.domain.walls.triangle_count
    complete = middle_cut(cage)
    with pytest.raises(ValueError, match=rf"{needed} vertices.*{capacity}.*vertex_capacity"):
        coordinates.update(complete.advance(to=1.1))
    assert_identical(before, snapshot(coordinates))
    assert coordinates.domain.walls.triangle_count == walls
    assert coordinates.domain.cage is coordinates.cage is cage
    edit = middle_cut(cage).advance(to=0.5)
    coordinates.update(edit)
    free = bake(cage, points)
    free.update(edit)
    assert_identical(snapshot(coordinates), snapshot(free))
    assert coordinates.weights_array.ptr == pointer
    assert np.all(coordinates.weights_array.numpy()[:, edit.cage.vertex_count :] == 0.0)
    with pytest.raises(ValueError, match="vertex_capacity"):
        bake(cage, points, vertex_capacity=cage.vertex_count - 1)


def test_shared_domain(cage, points):
    """Coordinates that share a domain follow edits as if each had its own, and none can miss one."""
    domain = Domain(cage, quads="mean_value", distance="grid", device=wp.get_device("cpu"))
    first, second, own = bake(domain, points[:10]), bake(domain, points), bake(cage, points)
    cut = middle_cut(cage)
    edits = [cut.advance(to=depth) for depth in (0.3, 0.6)]
    for coordinates in (first, second, own):
        coordinates.update(edits[0])
    assert_identical(snapshot(second), snapshot(own))
    np.testing.assert_array_equal(first.weights, own.weights[:10])
    first.update(edits[1])
    last = cut.advance(to=0.9)
    first.update(last)
    with pytest.raises(ValueError, match="another cage"):
        second.update(last)
    second.recompute()
    for edit in (edits[1], last):
        own.update(edit)
    assert_identical(snapshot(second), snapshot(own))


def test_a_domain_has_its_options(cage, points):
    """What was not said is the domain's; another choice than the domain's is refused, and so is one of none."""
    domain = Domain(cage, quads="harmonic", distance="all", device="cpu")
    shared = bake(domain, points)
    assert_identical(snapshot(shared), snapshot(bake(cage, points, quads="harmonic", distance="all")))
    assert_identical(snapshot(shared), snapshot(bake(domain, points, quads="harmonic", distance="all", device="cpu")))
    for name, value in (("quads", "mean_value"), ("distance", "grid")):
        with pytest.raises(ValueError, match=f"{name}='{value}', but the domain has"):
            bake(domain, points, **{name: value})
        with pytest.raises(ValueError, match=f"{name} must be one of"):
            Domain(cage, device="cpu", **{name: "other"})


def test_coordinates_behind_their_domain(cage, points):
    """Coordinates that have missed an edit go on with the cage that their weights are for, until they recompute."""
    domain = Domain(cage, device="cpu")
    first, behind, own = bake(domain, points), bake(domain, points), bake(cage, points)
    edit = middle_cut(cage).advance(to=0.5)
    first.update(edit)
    assert first.cage is domain.cage is edit.cage
    assert behind.cage is cage
    for one in (behind, own):
        one.set_points([3], points[4:5])
    assert_identical(snapshot(behind), snapshot(own))
    np.testing.assert_array_equal(behind.weights_at(points[:4]), own.weights_at(points[:4]))
    for one in (behind, own):
        one.update(edit)
    assert_identical(snapshot(behind), snapshot(own))
