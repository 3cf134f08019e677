# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Triangles bisected across their longest edges until they are as small as they are wanted, all at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

_MOST_ROUNDS = 60


def bisect(
    points: np.ndarray, triangles: np.ndarray, wanted: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bisect triangles, those with a common edge alike, so that meshes without hanging corners stay so.

    Args:
        points: Positions, shape (point_count, dimension).
        triangles: Corners, shape (triangle_count, 3).
        wanted: Centres of triangles -> greatest length of their edges.

    Returns:
        Positions, those given first; corners of the triangles, oriented as they were; and which of the given ones each
        is a part of, ascending.
    """
    owner = np.arange(len(triangles))
    fresh = np.ones(len(triangles), dtype=bool)
    for _ in range(_MOST_ROUNDS):
        corner = points[triangles]
        edge = np.roll(corner, -1, axis=1) - corner
        squared = (edge**2).sum(axis=2)
        marked = np.zeros(len(triangles), dtype=bool)
        center = (corner[fresh, 0] + corner[fresh, 1] + corner[fresh, 2]) / 3.0
        marked[fresh] = np.sqrt(squared[fresh].max(axis=1)) > wanted(center)
        if not marked.any():
            break
        key = _edge_keys(triangles, len(points))
        # Of edges that are as long but for rounding, the one that all its triangles agree on.
        longest = _first_longest(squared, key)
        order = (longest[:, None] + np.arange(3)) % 3
        turned = np.take_along_axis(triangles, order, axis=1)
        key = np.take_along_axis(key, order, axis=1)
        split = _closed(key, np.unique(key[marked, 0]))
        place = np.minimum(np.searchsorted(split, key), len(split) - 1)
        middle = np.where(split[place] == key, len(points) + place, -1)
        # Those that stay whole stay as they are: how often others are divided leaves no trace in them.
        triangles = np.where(middle[:, :1] >= 0, turned, triangles)
        triangles, source = _children(triangles, middle)
        owner, fresh = owner[source], middle[source, 0] >= 0
        points = np.concatenate([points, (points[split // len(points)] + points[split % len(points)]) / 2.0])
    return points, triangles, owner


def _edge_keys(triangles: np.ndarray, point_count: int) -> np.ndarray:
    after = np.roll(triangles, -1, axis=1)
    return np.minimum(triangles, after).astype(np.int64) * point_count + np.maximum(triangles, after)


def _first_longest(squared: np.ndarray, key: np.ndarray) -> np.ndarray:
    tied = squared >= squared.max(axis=1, keepdims=True) * (1.0 - 1e-9)
    return np.where(tied, key, np.iinfo(np.int64).max).argmin(axis=1)


def _closed(key: np.ndarray, split: np.ndarray) -> np.ndarray:
    """Edges to split, with the longest ones of all triangles that have one of them; ``key`` has those first."""
    while True:
        hit = np.isin(key, split).any(axis=1)
        more = np.union1d(split, key[hit, 0])
        if len(more) == len(split):
            return split
        split = more


def _children(triangles: np.ndarray, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parts of triangles (a, b, c), first across ab, then across the other edges that have a middle, else -1.

    Returns:
        Corners of the parts, and the triangles that they are of, ascending.
    """
    a, b, c = triangles.T
    m, p, q = middle.T
    whole = m < 0
    parts = [
        (whole, (a, b, c)),
        (~whole & (q < 0), (a, m, c)),
        (~whole & (q >= 0), (q, a, m)),
        (~whole & (q >= 0), (c, q, m)),
        (~whole & (p < 0), (m, b, c)),
        (~whole & (p >= 0), (m, b, p)),
        (~whole & (p >= 0), (p, c, m)),
    ]
    found = np.concatenate([np.stack(corners, axis=1)[mask] for mask, corners in parts])
    source = np.concatenate([np.flatnonzero(mask) for mask, _ in parts])
    order = np.argsort(source, kind="stable")
    return found[order], source[order]
