# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Thinning of many points to a wanted number of them that keep apart and leave no hole.

Farthest points in rounds: each takes, of the points that are nearly as far from those taken as any is, as many as keep
that far apart from each other. So two points taken are never much nearer than the farthest point not taken is, as in a
maximal Poisson-disk sample, and their number is exact.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

_NEARLY = 0.92
"""Share of the greatest distance that counts as nearly as far."""

_SINGLE_COUNT = 8
"""Points that are taken one by one before the rounds."""


def thin(points: np.ndarray, count: int) -> np.ndarray:
    """Indices of points that are spread evenly over all, in the order in which they were taken.

    Args:
        points: Points, shape (n, dimension); the first is taken first, and of equals the earlier ones.
        count: Number of points to take; all of them if there are fewer.

    Returns:
        Indices, shape (min(count, n),).
    """
    count = min(count, len(points))
    tree = cKDTree(points)
    taken = np.zeros(count, dtype=np.int64)
    distance = np.linalg.norm(points - points[0], axis=1)
    used = 1
    while used < count:
        far = _far_points(points, distance, single=used < _SINGLE_COUNT)[: count - used]
        taken[used : used + len(far)] = far
        used += len(far)
        pairs = cKDTree(points[far]).sparse_distance_matrix(tree, distance.max(), output_type="ndarray")
        np.minimum.at(distance, pairs["j"], pairs["v"])
        distance[far] = 0.0
    return taken


def _far_points(points: np.ndarray, distance: np.ndarray, *, single: bool) -> np.ndarray:
    """Points to take next: the farthest one, or all that are nearly as far and from each other too."""
    if single:
        return distance.argmax()[None]
    reach = _NEARLY * distance.max()
    if reach == 0.0:
        return np.flatnonzero(distance == 0.0)
    far = np.flatnonzero(distance >= reach)
    return far[_first_apart(points[far], reach)]


def _first_apart(points: np.ndarray, reach: float) -> np.ndarray:
    """Indices that a walk through points takes which skips those nearer than the reach to one taken."""
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    is_open, is_taken = np.ones(len(points), dtype=bool), np.zeros(len(points), dtype=bool)
    while is_open.any():
        pairs = pairs[is_open[pairs].all(axis=1)]
        free = is_open.copy()
        free[pairs[:, 1]] = False
        is_taken |= free
        is_open &= ~free
        is_open[pairs[free[pairs[:, 0]], 1]] = False
    return np.flatnonzero(is_taken)
