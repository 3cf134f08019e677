# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Edits of coordinates are all or nothing, wherever they fail."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

import numpy as np
import pytest
import warp as wp

from failure_injection import FailingCalls, InjectedFailure
from harmonic_shapes import MAKERS, UNITS, assert_identical, interior_points, middle_cut, snapshot
from newton_cagecut.cage import CageEdit
from newton_cagecut.harmonic import Domain, HarmonicCoordinates, Journal, PointChange

WALKS, POINTS = 6, 8

Action = Callable[[HarmonicCoordinates, Journal | None], None]


def everything(coordinates: HarmonicCoordinates) -> dict[str, object]:
    """All arrays with their unused rows, and what is referred to, by name."""
    cache, domain, state = coordinates._cache, coordinates.domain, coordinates._state
    found = {name: array.numpy().copy() for name, array in cache.arrays.items()}
    found |= {f"pointer of {name}": array.ptr for name, array in cache.weights.arrays.items()}
    found |= {f"wall {name}": rows.copy() for name, rows in state.walls.rows.items()}
    found |= {f"cell {name}": getattr(state.grid.cells, name).numpy().copy() for name in ("first", "last", "items")}
    found |= {f"face {name}": getattr(state.faces, name).numpy().copy() for name in ("loop_vertex", "kind", "key_face")}
    found |= {"triangles": state.walls.data.rows.numpy().copy(), "nearest": state.grid._nearest.numpy().copy()}
    found |= {"state": id(state), "present": id(domain.now), "cage": id(coordinates.cage), "rest": cache.rest.copy()}
    return found | {"point count": coordinates.point_count, "removed": coordinates.removed_points}


def assert_unchanged(before: dict[str, object], after: dict[str, object]) -> None:
    """Assert equality of all bytes, those of rows that nobody has written yet as well."""
    assert before.keys() == after.keys()
    for name, value in before.items():
        other = after[name]
        same = value.tobytes() == other.tobytes() if isinstance(value, np.ndarray) else value == other
        assert same, f"{name} has changed"


def bake(dimension: int, *, walks: int = WALKS, **options) -> HarmonicCoordinates:
    """Coordinates in a coarse grid, with room for more points."""
    cage = MAKERS[UNITS[dimension - 2]]()
    points = interior_points(cage, POINTS, np.random.default_rng(3))
    points[0, 0], keys = 1.0, np.full(POINTS, -1)  # on a wall, of which the side is told
    keys[0] = 2 * face_at(cage, points[0])
    domain = Domain(cage, device=wp.get_device("cpu"), grid_resolution=2)
    mask = np.arange(POINTS) % 2 == 0
    return HarmonicCoordinates(
        domain, points, walks, seed=5, gradients=mask, point_keys=keys, point_capacity=POINTS + 4, **options
    )


def face_at(cage, point: np.ndarray) -> int:
    """The wall that a point lies on."""
    return int(np.argmin([abs((point - wall.origin) @ wall.normal) for wall in cage.walls]))


def some_points(coordinates: HarmonicCoordinates, indices: list[int]) -> PointChange:
    """Points to set."""
    dimension = coordinates.cage.dimension
    places = np.random.default_rng(9).uniform(0.05, 0.4, (len(indices), dimension))
    return PointChange(np.array(indices), places)


def edit_of(coordinates: HarmonicCoordinates, kind: str) -> CageEdit:
    """A cut that ends inside, one that goes through, or a face that moves outward."""
    cage = coordinates.cage
    if kind == "extrusion":
        return cage.extrude(face_at(cage, cage.vertices.max(axis=0) - 0.3 * np.eye(cage.dimension)[1]), 0.4)
    return middle_cut(cage).advance(to=0.4 if kind == "cut" else 1.2)


def updating(kind: str) -> Callable[[HarmonicCoordinates], Action]:
    """An update with points that move and points that are new."""

    def prepared(coordinates: HarmonicCoordinates) -> Action:
        edit, points = edit_of(coordinates, kind), some_points(coordinates, [2, POINTS, POINTS + 1])
        return lambda other, journal: other.update(edit, points=points, journal=journal)

    return prepared


def setting(coordinates: HarmonicCoordinates) -> Action:
    """Points that move, one in the place of a removed one, and a new one."""
    coordinates.remove_points([3])
    change = some_points(coordinates, [1, 3, POINTS])
    return lambda other, journal: other.set_points(change.indices, change.points, journal=journal)


def removing(coordinates: HarmonicCoordinates) -> Action:
    """Points that go."""
    return lambda other, journal: other.remove_points([0, 1, 5], journal=journal)


def restoring(coordinates: HarmonicCoordinates) -> Action:
    """Back to before a cut, which has made the weights grow, and before points have moved."""
    kept = coordinates.snapshot()
    coordinates.update(edit_of(coordinates, "through"), points=some_points(coordinates, [1, POINTS]))
    return lambda other, journal: other.restore(kept, journal=journal)


def recomputing(coordinates: HarmonicCoordinates) -> Action:
    """After an edit that other coordinates in the domain have brought here."""
    other = HarmonicCoordinates(coordinates.domain, [[0.5] * coordinates.cage.dimension], WALKS)
    other.update(edit_of(coordinates, "cut"))
    return lambda one, journal: one.recompute(journal=journal)


def recomputing_with_gaps(coordinates: HarmonicCoordinates) -> Action:
    """The same after points were removed."""
    coordinates.remove_points([2])
    return recomputing(coordinates)


ACTIONS = {
    "cut": updating("cut"),
    "cut through": updating("through"),
    "extrusion": updating("extrusion"),
    "set": setting,
    "remove": removing,
    "restore": restoring,
    "recompute": recomputing,
    "recompute with gaps": recomputing_with_gaps,
}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("name", ACTIONS)
def test_failed_edits_change_nothing(name, dimension):
    """Stopped at any Warp call, an edit leaves every byte as it was; then it does what it would have done."""
    check_failures(name, dimension, {"vertex_capacity": 24} if name in ("cut", "recompute") else {})


@pytest.mark.parametrize(("name", "walks"), [("cut through", 0), ("set", 0), ("cut through", WALKS), ("set", WALKS)])
def test_failed_edits_of_fitted_coordinates(name, walks):
    """Stopped while the fit is made, or at another Warp call, an edit leaves every byte as it was as well."""
    check_failures(name, 2, {"correction": "fitted", "walks": walks}, stride=7)


def check_failures(name: str, dimension: int, options: dict[str, object], *, stride: int = 1) -> None:
    """Check that an edit leaves every byte as it was wherever it is stopped, and then does what it would have done."""
    expected = bake(dimension, **options)
    ACTIONS[name](expected)(expected, None)
    coordinates = bake(dimension, **options)
    act, failures = ACTIONS[name](coordinates), 0
    before = everything(coordinates)
    while True:
        with FailingCalls(failures) as calls, contextlib.suppress(InjectedFailure):
            act(coordinates, None)
        if not calls.raised:
            break
        assert_unchanged(before, everything(coordinates))
        failures += stride
    assert failures == -(-calls.count // stride) * stride > 20
    assert_identical(snapshot(expected), snapshot(coordinates))
    assert coordinates.point_count == expected.point_count
    np.testing.assert_array_equal(coordinates.lowest_weights, expected.lowest_weights)


@pytest.mark.parametrize("dimension", [2, 3])
def test_points_of_an_update(dimension):
    """An update with points is an update and then points that are set, bit for bit."""
    together, apart = bake(dimension), bake(dimension)
    edit, change = edit_of(together, "cut"), some_points(together, [2, POINTS, POINTS + 1])
    apart_edit = edit_of(apart, "cut")
    stats = together.update(edit, points=change)
    own = apart.update(apart_edit)
    added = apart.set_points(change.indices, change.points)
    assert_identical(snapshot(together), snapshot(apart))
    counts = ("walk_count", "checked", "rewalked", "on_face", "resumed", "resolved_points", "capped", "lowest_weight")
    assert all(getattr(stats, name) == getattr(own, name) for name in counts)
    assert set(stats.seconds) == {*own.seconds, "new_points"}
    assert added.resolved_points == len(change.indices)


def test_bad_points_stop_an_update():
    """Points that the edited cage does not hold are refused before anything has changed."""
    coordinates = bake(3)
    edit, before = edit_of(coordinates, "cut"), everything(coordinates)
    inside = [[0.1, 0.1, 0.1]]
    bad = {
        "outside": PointChange([1], [[3.0, 0.0, 0.0]]),
        "without gaps": PointChange([POINTS + 1], inside),
        "point_capacity": PointChange(np.arange(POINTS, POINTS + 5), 5 * inside),
        "keys of the cage's walls": PointChange([1], inside, [99]),
        "one index a point": PointChange([], inside),
    }
    for text, change in bad.items():
        with pytest.raises(ValueError, match=text):
            coordinates.update(edit, points=change)
        assert_unchanged(before, everything(coordinates))
    coordinates.update(edit, points=PointChange([], np.zeros((0, 3))))
    assert coordinates.cage is edit.cage


@pytest.mark.parametrize("dimension", [2, 3])
def test_edits_within_a_larger_one(dimension):
    """When a larger edit fails at last, all edits that were a part of it are taken back, the latest first."""
    coordinates = bake(dimension)
    kept, before = coordinates.snapshot(), everything(coordinates)

    def interrupted() -> None:
        with Journal() as journal:
            edit, points = edit_of(coordinates, "cut"), some_points(coordinates, [POINTS])
            coordinates.update(edit, points=points, journal=journal)
            coordinates.remove_points([0, 2], journal=journal)
            coordinates.set_points([2], some_points(coordinates, [2]).points, journal=journal)
            coordinates.recompute(journal=journal)
            coordinates.restore(kept, journal=journal)
            coordinates.update(edit_of(coordinates, "through"), journal=journal)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert_unchanged(before, everything(coordinates))
