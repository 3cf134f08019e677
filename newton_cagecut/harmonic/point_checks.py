# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Checks of query points, those that users pass and those that edits meet; each names the culprit."""

from __future__ import annotations

import numpy as np

from ..cage import Cage, CageEdit, boundary_distances, check_inside
from .point_change import PointChange
from .walks.query_points import INSIDE


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
        ValueError: They have another shape or are not finite.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != dimension:
        raise ValueError(f"points must have the shape (n, {dimension}), not {points.shape}")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise ValueError(f"point {bad[0]} is not finite: {points[bad[0]]}")
    return points


def checked_keys(keys: np.ndarray | None, count: int, wall_count: int, *, lowest: int = INSIDE) -> np.ndarray:
    """Keys 2 * wall + side, or INSIDE, one a point; INSIDE for all by default.

    Args:
        keys: Keys as passed, shape (count,).
        count: Number of points.
        wall_count: Number of walls of the cage.
        lowest: INSIDE, or 0 where all points must lie on walls.

    Raises:
        ValueError: There are fewer or more of them than points, or one is of no wall.
    """
    if keys is None:
        return np.full(count, INSIDE, np.int32)
    keys = np.asarray(keys)
    if keys.shape != (count,):
        raise ValueError(f"point_keys must have the shape ({count},), one key a point, not {keys.shape}")
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
    indices = np.asarray(indices)
    if indices.size and indices.dtype.kind not in "iu":
        raise TypeError(f"indices must be whole numbers, not {indices.dtype}")
    if indices.ndim != 1 or (count is not None and len(indices) != count):
        shape = "n" if count is None else count
        raise ValueError(f"indices must have the shape ({shape},), one index a point, not {indices.shape}")
    unique, counts = np.unique(indices, return_counts=True)
    if (counts > 1).any():
        raise ValueError(f"indices: point {unique[counts > 1][0]} is given twice")
    if len(unique) and unique[0] < 0:
        raise ValueError(f"indices: {unique[0]} is no point; they count from 0")
    return indices.astype(np.int64)


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
