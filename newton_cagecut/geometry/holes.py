# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Holes of polygons joined to their outer loops by bridges.

Faces with holes (section 5.1 of the paper names them among the n-gons) become discs: a bridge is an edge that the same
loop walks both ways, so that vertices minus edges plus faces stays the Euler characteristic.
"""

from __future__ import annotations

import numpy as np

_FLAT = 1e-12


def signed_area(points: np.ndarray) -> float:
    """Area of a polygon, positive if counterclockwise [m^2].

    Args:
        points: Corners, shape (corner_count, 2) [m].
    """
    p = points - points[0]
    q = np.roll(p, -1, axis=0)
    return 0.5 * float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum())


def contains_point(points: np.ndarray, point: np.ndarray) -> bool:
    """Whether a polygon contains a point, by counting crossings.

    Args:
        points: Corners, shape (corner_count, 2) [m].
        point: The point, shape (2,) [m].
    """
    p = points - point
    q = np.roll(p, -1, axis=0)
    crosses = (p[:, 1] > 0.0) != (q[:, 1] > 0.0)
    p, q = p[crosses], q[crosses]
    right = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
    return bool(np.count_nonzero((right > 0.0) == (q[:, 1] > p[:, 1])) % 2)


def bridge_holes(outer: list[int], holes: list[list[int]], points: np.ndarray) -> list[int]:
    """Join holes to the loop around them by the shortest bridges that cross nothing.

    Args:
        outer: Counterclockwise loop of labels.
        holes: Clockwise loops of labels.
        points: Coordinates of the labels, shape (label_count, 2) [m].

    Returns:
        One loop of labels that walks each bridge both ways.
    """
    waiting = sorted(holes, key=lambda hole: tuple(points[hole].min(axis=0)))
    while waiting:
        loops = [outer, *waiting]
        edges = np.concatenate([np.stack([points[loop], np.roll(points[loop], -1, axis=0)], axis=1) for loop in loops])
        number, i, j = _find_bridge(outer, waiting, points, edges)
        hole = waiting.pop(number)
        outer = [*outer[: i + 1], *hole[j:], *hole[: j + 1], *outer[i:]]
    return outer


def _find_bridge(
    outer: list[int], holes: list[list[int]], points: np.ndarray, edges: np.ndarray
) -> tuple[int, int, int]:
    """The first of the holes that can be seen, with the corners of the loop and the hole to join."""
    fallback = None
    for number, hole in enumerate(holes):
        a, b = points[outer], points[hole]
        squared = ((a[:, None] - b) ** 2).sum(axis=2)
        for flat in np.argsort(squared, axis=None, kind="stable").tolist():
            i, j = divmod(flat, len(hole))
            if not (_opens_towards(a, i, b[j]) and _opens_towards(b, j, a[i])):
                continue
            fallback = fallback or (number, i, j)
            if _is_clear(a[i], b[j], edges):
                return number, i, j
    return fallback or (0, 0, 0)


def _side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Sign of the turn p, q, r, zero if nearly straight."""
    u, v = q - p, r - p
    value = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    limit = _FLAT * np.hypot(u[..., 0], u[..., 1]) * np.hypot(v[..., 0], v[..., 1])
    return np.where(np.abs(value) <= limit, 0.0, np.sign(value))


def _opens_towards(loop: np.ndarray, i: int, target: np.ndarray) -> bool:
    """Whether the inside at a loop's corner, to the left of its edges, opens towards a point."""
    before, here, after = loop[i - 1], loop[i], loop[(i + 1) % len(loop)]
    leaves, arrives = _side(here, after, target), _side(before, here, target)
    turn = _side(before, here, after)
    if turn > 0 or (turn == 0 and (here - before) @ (after - here) > 0.0):
        return bool(leaves > 0 and arrives > 0)
    return bool(leaves > 0 or arrives > 0)


def _is_clear(p: np.ndarray, q: np.ndarray, edges: np.ndarray) -> bool:
    """Whether the segment p-q meets no edge except at edges' ends that coincide with its own."""
    a, b = edges[:, 0], edges[:, 1]
    meets = (_side(p, q, a) * _side(p, q, b) <= 0) & (_side(a, b, p) * _side(a, b, q) <= 0)
    meets &= ((np.minimum(a, b) <= np.maximum(p, q)) & (np.minimum(p, q) <= np.maximum(a, b))).all(axis=1)
    for mine, other in ((p, q), (q, p)):
        for end, far in ((a, b), (b, a)):
            touches = (end == mine).all(axis=1)
            along = (_side(mine, other, far) == 0) & ((far - mine) @ (other - mine) > 0.0)
            meets = np.where(touches, along, meets)
    return not bool(meets.any())
