# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Whether segments, triangles and points meet, pair by pair, and which pairs are near enough to ask."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .vectors import triangle_normals, units

_CHUNK = 1 << 20


def near_pairs(one: np.ndarray, other: np.ndarray, tolerance: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Pairs of which the bounding boxes come within a tolerance of each other.

    Args:
        one: Corners of the first things, shape (one_count, corner_count, dimension) [m].
        other: Corners of the second things, shape (other_count, corner_count, dimension) [m].
        tolerance: Gap between boxes up to which they count as meeting [m].

    Yields:
        Indices of the first and of the second thing of each pair, block by block of the first, shapes (pair_count,).
    """
    one_low, one_high = one.min(axis=1) - tolerance, one.max(axis=1) + tolerance
    low, high = other.min(axis=1), other.max(axis=1)
    step = max(1, _CHUNK // max(1, len(other)))
    for begin in range(0, len(one), step):
        block = slice(begin, begin + step)
        near = np.ones((len(one[block]), len(other)), dtype=bool)
        for axis in range(one.shape[2]):
            near &= one_low[block, axis, None] <= high[:, axis]
            near &= one_high[block, axis, None] >= low[:, axis]
        row, column = np.nonzero(near)
        yield begin + row, column


def segments_meet(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether closed segments a-b and c-d of a plane come within a tolerance by crossing, shape (...,).

    Args:
        a: Starts of the first segments, shape (..., 2) [m].
        b: Ends of the first segments, shape (..., 2) [m].
        c: Starts of the second segments, shape (..., 2) [m].
        d: Ends of the second segments, shape (..., 2) [m].
        tolerance: Length below which two things coincide [m].
    """
    crossing = _side(a, b, c, tolerance) * _side(a, b, d, tolerance) <= 0
    crossing &= _side(c, d, a, tolerance) * _side(c, d, b, tolerance) <= 0
    overlap = (np.minimum(a, b) <= np.maximum(c, d) + tolerance) & (np.minimum(c, d) <= np.maximum(a, b) + tolerance)
    return crossing & overlap.all(axis=-1)


def _side(p: np.ndarray, q: np.ndarray, r: np.ndarray, tolerance: float) -> np.ndarray:
    """Sign of the turn p, q, r, zero if r lies within the tolerance of the line."""
    u, v = q - p, r - p
    value = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return np.where(np.abs(value) <= tolerance * np.hypot(u[..., 0], u[..., 1]), 0.0, np.sign(value))


def edge_pierces(p: np.ndarray, q: np.ndarray, corners: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether segments p-q pass from one side of their triangles to the other within them, shape (pair_count,).

    Args:
        p: Starts of the segments, shape (pair_count, 3) [m].
        q: Ends of the segments, shape (pair_count, 3) [m].
        corners: Triangles, shape (pair_count, 3, 3) [m].
        tolerance: Length below which two things coincide [m].
    """
    normal = units(triangle_normals(corners))
    from_p, from_q = (np.einsum("ij,ij->i", x - corners[:, 0], normal) for x in (p, q))
    opposite = (np.minimum(from_p, from_q) < -tolerance) & (np.maximum(from_p, from_q) > tolerance)
    difference = np.where(opposite, from_p - from_q, 1.0)
    return opposite & _lies_over(p + (from_p / difference)[:, None] * (q - p), corners, normal, tolerance)


def point_touches(points: np.ndarray, corners: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether points lie within a tolerance above or below their triangles, shape (pair_count,).

    Args:
        points: Points, shape (pair_count, 3) [m].
        corners: Triangles, shape (pair_count, 3, 3) [m].
        tolerance: Length below which two things coincide [m].
    """
    normal = units(triangle_normals(corners))
    height = np.einsum("ij,ij->i", points - corners[:, 0], normal)
    return (np.abs(height) <= tolerance) & _lies_over(points, corners, normal, tolerance)


def _lies_over(points: np.ndarray, corners: np.ndarray, normal: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether points lie over their triangles, looking along the unit normals, shape (pair_count,)."""
    inside = normal.any(axis=1)
    for k in range(3):
        u, along = corners[:, k], corners[:, (k + 1) % 3] - corners[:, k]
        height = np.einsum("ij,ij->i", np.cross(normal, along), points - u)
        inside &= height >= -tolerance * np.linalg.norm(along, axis=1)
    return inside
