# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Checks of query points, those that users pass and those that edits meet; each names the culprit."""

from __future__ import annotations

import numpy as np

from ..cage import Cage, CageEdit, boundary_distances, check_inside
from ..geometry import as_flag, as_index, as_indices, as_integers, as_points, check_finite, shown
from .point_change import PointChange
from .walks.query_points import INSIDE

MOST_WALKS = 1 << 30
"""Walks that a set of coordinates can have: offsets into their arrays are 32-bit integers."""
MOST_VERTICES = 1 << 20
"""Cage vertices that there can be room for."""


def checked_change(change: PointChange, cage: Cage, *, count: int, capacity: int) -> tuple[PointChange, np.ndarray]:
    """Points to set in a cage, with keys, and which of them lie outside of it, within its tolerance.

    Args:
        change: The points as passed.
        cage: The cage.
        count: Number of points that there are.
        capacity: Points that there is room for.

    Raises:
        TypeError: The indices are not whole numbers.
        ValueError: A point lies outside the cage, an index is twice there or leaves a gap, a key is of no wall, or
            there are more points than there is room for.
    """
    points = checked_points(change.points, cage.dimension)
    indices = checked_indices(change.indices, len(points))
    added = np.sort(indices[indices >= count])
    if not np.array_equal(added, count + np.arange(len(added))):
        raise ValueError(f"indices: there are {count} points; new ones must follow without gaps")
    keys = checked_keys(change.keys, len(points), len(cage.walls))
    needed = int(indices.max(initial=-1)) + 1
    if needed > capacity:
        raise ValueError(f"{needed} points, but room was reserved for {capacity}: raise point_capacity")
    outside = check_inside(cage, points, which=np.flatnonzero(keys < 0))
    return PointChange(indices, points, keys), outside


def checked_points(points: np.ndarray, dimension: int) -> np.ndarray:
    """Points as float64, shape (n, dimension).

    Raises:
        TypeError: They are not numbers.
        ValueError: They have another shape or are not finite.
    """
    points = as_points(points, "points", rows="n", widths=(dimension,))
    check_finite(points, "points", row="point")
    return points


def checked_keys(keys: np.ndarray | None, count: int, wall_count: int, *, lowest: int = INSIDE) -> np.ndarray:
    """Keys 2 * wall + side, or INSIDE, one a point; INSIDE for all by default.

    Args:
        keys: Keys as passed, shape (count,).
        count: Number of points.
        wall_count: Number of walls of the cage.
        lowest: INSIDE, or 0 where all points must lie on walls.

    Raises:
        TypeError: They are not whole numbers.
        ValueError: There are fewer or more of them than points, or one is of no wall.
    """
    if keys is None and lowest == INSIDE:
        return np.full(count, INSIDE, np.int32)
    keys = as_integers(keys, "point_keys", shape=(count,)) if count or np.size(keys) else np.zeros(0, np.int32)
    highest = 2 * wall_count - 1
    bad = np.flatnonzero((keys < lowest) | (keys > highest))
    if len(bad):
        raise ValueError(
            f"point {bad[0]} has the key {keys[bad[0]]}; the keys of the cage's walls are 0 to {highest}"
            + (", -1 is for points inside" if lowest < 0 else "")
        )
    return keys.astype(np.int32)


def checked_indices(indices: np.ndarray, count: int | None = None) -> np.ndarray:
    """Numbers of points, none twice, as int64.

    Args:
        indices: Numbers as passed, shape (n,).
        count: How many there must be, if that matters.

    Raises:
        TypeError: They are not whole numbers.
        ValueError: They have another shape, one is negative, or one is there twice.
    """
    indices = as_indices(indices, "indices", of="point")
    if count is not None and len(indices) != count:
        raise ValueError(f"indices must have shape ({count},), one index a point, got {indices.shape}")
    unique, counts = np.unique(indices, return_counts=True)
    if (counts > 1).any():
        raise ValueError(f"indices: point {unique[counts > 1][0]} is given twice")
    return indices


def checked_room(
    point_capacity: int | None,
    vertex_capacity: int | None,
    gradients: bool | np.ndarray,
    cuttable: bool,
    cage: Cage,
    count: int,
    walks: int,
) -> dict[str, object]:
    """What a walk cache is made with, by name.

    Args:
        point_capacity: As passed to the coordinates.
        vertex_capacity: Likewise.
        gradients: Likewise.
        cuttable: Likewise.
        cage: The cage.
        count: Number of points.
        walks: Walks a point.
    """
    return {
        "point_capacity": checked_point_capacity(point_capacity, count, walks),
        "vertex_capacity": checked_vertex_capacity(vertex_capacity, cage),
        "gradient_mask": checked_gradients(gradients, count),
        "cuttable": as_flag(cuttable, "cuttable"),
    }


def checked_point_capacity(capacity: int | None, count: int, walks: int) -> int:
    """Points to reserve room for; as many as there are for None.

    Args:
        capacity: What was passed.
        count: Points that there are.
        walks: Walks of each.

    Raises:
        TypeError: It is not a whole number.
        ValueError: It is less than there are, or their walks are more than the arrays of walks can be long.
    """
    if capacity is not None:
        capacity = as_index(capacity, "point_capacity, the number of points to reserve room for,")
        if capacity < count:
            raise ValueError(f"point_capacity={capacity} is less than the {count} points that there are; raise it")
    capacity = count if capacity is None else capacity
    if capacity * max(walks, 1) > MOST_WALKS:
        raise ValueError(
            f"{capacity} points (point_capacity) of {walks} walks are more than {MOST_WALKS} walks; take fewer walks, "
            "or several sets of coordinates that share a domain"
        )
    return capacity


def checked_vertex_capacity(capacity: int | None, cage: Cage) -> int | None:
    """Cage vertices to reserve room for; None where it grows.

    Args:
        capacity: What was passed.
        cage: The cage.

    Raises:
        TypeError: It is not a whole number.
        ValueError: The cage does not fit, or there is too much of it.
    """
    if capacity is None:
        return None
    capacity = as_index(capacity, "vertex_capacity, the number of vertices to reserve room for,")
    require_vertex_room(cage.vertex_count, capacity)
    if capacity > MOST_VERTICES:
        raise ValueError(f"vertex_capacity={capacity} is more than {MOST_VERTICES}; a row of weights is as long as it")
    return capacity


def checked_gradients(gradients: bool | np.ndarray, count: int) -> np.ndarray:
    """Which points have gradients, shape (count,), bool.

    Args:
        gradients: What was passed: yes or no for all, or a mask.
        count: Number of points.

    Raises:
        TypeError: It is neither.
        ValueError: The mask has another length.
    """
    try:
        mask = np.asarray(gradients)
    except ValueError:
        mask = np.zeros(0)
    if mask.dtype != bool:
        raise TypeError(f"gradients must be True, False or a mask over all {count} points, got {shown(gradients)}")
    if mask.shape not in ((), (count,)):
        raise ValueError(f"the mask gradients must have shape ({count},), got {mask.shape}")
    return np.broadcast_to(mask, count)


def require_vertex_room(vertices: int, vertex_capacity: int | None) -> None:
    """Refuse a cage that does not fit the capacity.

    Args:
        vertices: Number of cage vertices.
        vertex_capacity: Cage vertices that there is room for; None where it grows.

    Raises:
        ValueError: There are more.
    """
    if vertex_capacity is not None and vertices > vertex_capacity:
        raise ValueError(
            f"the cage has {vertices} vertices, room was reserved for {vertex_capacity}: raise vertex_capacity"
        )


def require_uncovered(edit: CageEdit, keys: np.ndarray, rest: np.ndarray) -> None:
    """Refuse an obstacle that covers points.

    Args:
        edit: The edit.
        keys: Keys of the points, shape (point_count,).
        rest: Their rest positions [m], shape (point_count, dimension).

    Raises:
        ValueError: The obstacle covers some.
    """
    if edit.cage.volume >= edit.before.volume or edit.wall >= 0:
        return
    inner = np.flatnonzero(keys == INSIDE)
    covered = inner[~edit.cage.contains(rest[inner])]
    covered = covered[boundary_distances(edit.before, rest[covered]) > edit.before.length_tolerance]
    if len(covered):
        raise ValueError(
            f"the obstacle covers {len(covered)} of {len(keys)} points, such as point {covered[0]} at "
            f"{rest[covered[0]].tolist()}; move the obstacle, or remove the points first"
        )
