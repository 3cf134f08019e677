# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangulation of weakly simple polygons by ear clipping.

The faces that cutting leaves (section 5.1 of the paper) have slits, bridges to holes and collinear corners.
Orientation tests break ties as if every corner stood an infinitesimal step inside the polygon (simulation of
simplicity, Edelsbrunner and Muecke 1990): so the two sides of a slit are apart and the polygon is simple. Whatever ears
are clipped, the signed triangles sum to the polygon, so that no point of it is left uncovered.
"""

from __future__ import annotations

import numpy as np

_FLAT = 1e-13
_FLAT_STEP = 1e-9
_UTURN = 1e-7
_POOR = 1e-3


def triangulate(points: np.ndarray, *, apart: np.ndarray | None = None) -> np.ndarray:
    """Triangulate a polygon given by its corners in counterclockwise order.

    The polygon may touch itself as slits and bridges do: edges that coincide, corners that coincide, collinear corners.

    Args:
        points: Corners, shape (corner_count, 2).
        apart: Corners of which no diagonal may join two, as a mask, shape (corner_count,). That can be had if they lie
            on the border of a convex region around the polygon, edges between them on that border too, and some other
            corner is there.

    Returns:
        Triangles of corner indices, shape (corner_count - 2, 3), counterclockwise.

    Raises:
        ValueError: If there are fewer than three corners.
    """
    points = np.asarray(points, dtype=np.float64)
    count = len(points)
    if count < 3:
        raise ValueError(f"a polygon needs at least 3 corners, got {count}")
    if count == 3:
        return np.array([[0, 1, 2]])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = float((high - low).max())
    scaled = (points - low) / (scale if scale > 0.0 else 1.0)
    corner = np.concatenate([scaled, inward_directions(scaled)], axis=1)
    apart = np.zeros(count, dtype=bool) if apart is None else apart
    remaining = np.arange(count)
    triangles = []
    while len(remaining) > 3:
        clipped = _choose_ears(corner, remaining, apart)
        size = len(remaining)
        triangles.append(
            np.stack([remaining[clipped - 1], remaining[clipped], remaining[(clipped + 1) % size]], axis=1)
        )
        remaining = np.delete(remaining, clipped)
    if len(remaining) == 3:
        triangles.append(remaining[None])
    return np.concatenate(triangles)


def inward_directions(points: np.ndarray) -> np.ndarray:
    """Unit directions from the corners into the polygon, ahead at a slit's tip, shape (corner_count, 2)."""
    out = _unit_edges(points)
    into = np.roll(out, 1, axis=0)
    total = np.stack([-(into[:, 1] + out[:, 1]), into[:, 0] + out[:, 0]], axis=1)
    length = np.hypot(total[:, 0], total[:, 1])
    uturn = length < _UTURN
    return np.where(uturn[:, None], into, total / np.where(uturn, 1.0, length)[:, None])


def _unit_edges(points: np.ndarray) -> np.ndarray:
    """Unit vectors of the edges that leave the corners; an edge without length takes over from the one before it."""
    edge = np.roll(points, -1, axis=0) - points
    length = np.hypot(edge[:, 0], edge[:, 1])
    good = np.flatnonzero(length > 0.0)
    if len(good) == 0:
        return np.tile([1.0, 0.0], (len(points), 1))
    if len(good) < len(points):
        source = good[np.searchsorted(good, np.arange(len(points)), side="right") - 1]
        edge, length = edge[source], length[source]
    return edge / length[:, None]


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _orientation(corner: np.ndarray, i: np.ndarray, j: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Sign of the turn i, j, k with ties broken by the corners' inward steps (columns 2 and 3 of ``corner``)."""
    i, j, k = np.broadcast_arrays(i, j, k)
    u = corner[j] - corner[i]
    v = corner[k] - corner[i]
    value = _cross(u, v)
    reach = np.abs(u[..., :2]).sum(axis=-1) + np.abs(v[..., :2]).sum(axis=-1)
    sign = np.sign(value)
    flat = np.abs(value) <= _FLAT * reach
    if flat.any():
        u, v, reach = u[flat], v[flat], reach[flat]
        first = _cross(u[:, 2:], v) + _cross(u, v[:, 2:])
        second = _cross(u[:, 2:], v[:, 2:])
        tied = np.abs(first) <= _FLAT_STEP * reach
        sign[flat] = np.where(tied, np.where(np.abs(second) <= _FLAT_STEP, 0.0, np.sign(second)), np.sign(first))
    return sign


def _choose_ears(corner: np.ndarray, remaining: np.ndarray, apart: np.ndarray) -> np.ndarray:
    """Positions in ``remaining`` of ears that can be clipped together, at least one."""
    before, after = np.roll(remaining, 1), np.roll(remaining, -1)
    turn = _orientation(corner, before, remaining, after)
    allowed = ~(apart[before] & apart[after])
    candidate = np.flatnonzero((turn > 0) & allowed)
    if len(candidate) == 0:
        quality = _shape_quality(corner, before, remaining, after)
        return np.array([int(np.argmax(np.where(allowed | ~allowed.any(), quality, -np.inf)))])
    a, b, c = before[candidate], remaining[candidate], after[candidate]
    quality = _shape_quality(corner, a, b, c)
    blocked = _blocked(corner, a, b, c, remaining[turn <= 0])
    if blocked.all():
        return candidate[[int(np.argmax(quality))]]
    candidate, quality = candidate[~blocked], quality[~blocked]
    order = np.argsort(-quality, kind="stable")
    ranked = quality[order]
    good = ranked >= min(0.25 * ranked[0], ranked[0])
    good[: len(order) // 2] |= ranked[: len(order) // 2] >= _POOR * ranked[0]
    keep = order[good]
    return _apart(candidate[keep], len(remaining))


def _apart(position: np.ndarray, size: int) -> np.ndarray:
    """The leading positions of which no two are neighbours on a ring of ``size``."""
    taken = bytearray(size)
    chosen = []
    for p in position.tolist():
        if not taken[p]:
            chosen.append(p)
            taken[p - 1] = taken[p] = taken[(p + 1) % size] = 1
    return np.array(chosen)


def _shape_quality(corner: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Area over squared edge lengths: greatest for equilateral triangles, zero for flat ones, negative for inverted."""
    p, q, r = corner[a, :2], corner[b, :2], corner[c, :2]
    squares = ((q - p) ** 2 + (r - q) ** 2 + (p - r) ** 2).sum(axis=-1)
    return _cross(q - p, r - p) / np.where(squares > 0.0, squares, 1.0)


def _blocked(corner: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Whether some corner of ``other`` lies in the closed triangle a, b, c, shape (triangle_count,)."""
    if len(other) == 0:
        return np.zeros(len(a), dtype=bool)
    triangle = corner[np.stack([a, b, c]), :2]
    low, high = triangle.min(axis=0) - _FLAT, triangle.max(axis=0) + _FLAT
    spot = corner[other, :2]
    near = ((spot >= low[:, None]) & (spot <= high[:, None])).all(axis=2)
    near &= (other != a[:, None]) & (other != c[:, None])
    row, column = np.nonzero(near)
    for start, end in ((c, a), (a, b), (b, c)):
        inside = _orientation(corner, start[row], end[row], other[column]) >= 0
        row, column = row[inside], column[inside]
    blocked = np.zeros(len(a), dtype=bool)
    blocked[row] = True
    return blocked
