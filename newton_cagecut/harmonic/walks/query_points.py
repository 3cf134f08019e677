# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Query points on a device."""

from __future__ import annotations

import numpy as np
import warp as wp

INSIDE = -1
"""Key of a point that lies on no wall."""

REMOVED = -2
"""Key of a point that was removed: its number is free."""


@wp.struct
class QueryPoints:
    """Points whose coordinates are wanted, shape (point_capacity,) each.

    ``position`` is in the unit frame. ``key`` is 2 * wall + side for a point on a wall, whose walks end where they
    start, else INSIDE or REMOVED. ``piece`` is that of the cage, -1 on a wall or outside; a point outside is one
    within the cage's tolerance, whose walks end at once, where they are nearest. ``gradient_row`` is the point's row
    among the gradients, -1 without. ``first_radius`` is the distance to the walls, measured by the first walk.
    """

    position: wp.array[wp.vec3]
    key: wp.array[wp.int32]
    piece: wp.array[wp.int32]
    gradient_row: wp.array[wp.int32]
    first_radius: wp.array[float]


def empty_points(capacity: int, gradient_mask: np.ndarray, device: wp.context.Device) -> QueryPoints:
    """Reserve points; those of the mask have gradients, in order."""
    rows = np.full(capacity, -1, np.int32)
    rows[np.flatnonzero(gradient_mask)] = np.arange(int(gradient_mask.sum()))
    points = QueryPoints()
    points.position = wp.zeros(capacity, dtype=wp.vec3, device=device)
    points.key = wp.full(capacity, INSIDE, dtype=wp.int32, device=device)
    points.piece = wp.zeros(capacity, dtype=wp.int32, device=device)
    points.gradient_row = wp.array(rows, dtype=wp.int32, device=device)
    points.first_radius = wp.zeros(capacity, dtype=float, device=device)
    return points


def point_arrays(points: QueryPoints) -> dict[str, wp.array]:
    """The arrays of points, by name."""
    return {name: getattr(points, name) for name in ("position", "key", "piece", "gradient_row", "first_radius")}


def byte_count(points: QueryPoints) -> int:
    """Bytes on the device."""
    return 28 * points.key.size


def place_points(
    points: QueryPoints, indices: np.ndarray, positions: np.ndarray, keys: np.ndarray, pieces: np.ndarray
) -> None:
    """Write points to their places.

    Args:
        points: Where to write them.
        indices: Their numbers, shape (n,).
        positions: Their positions in the unit frame, shape (n, 3).
        keys: Their keys, shape (n,).
        pieces: Their pieces, shape (n,).
    """
    for array, values in ((points.position, positions), (points.key, keys), (points.piece, pieces)):
        write_rows(array, indices, values)


def write_rows(array: wp.array, indices: np.ndarray, values: np.ndarray) -> None:
    """Write rows of a device array in place."""
    if len(indices):
        rows = array.numpy()
        rows[indices] = values
        array.assign(rows)
