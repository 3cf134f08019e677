# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Nearest points of segments and triangles, pair by pair.

After Ericson, "Real-time collision detection", 2005, chapter 5.
"""

from __future__ import annotations

import numpy as np

_PARALLEL = 1e-14
_CORNER_PAIRS = ((0, 1), (1, 2), (2, 0))


def nearest_on_edges(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where two segments come closest, as fractions of their lengths, shapes (pair_count,).

    Args:
        one: Ends of the first segments, none without length, shape (pair_count, 2, dimension) [m].
        other: Ends of the second segments, none without length, shape (pair_count, 2, dimension) [m].
    """
    u, v, w = one[:, 1] - one[:, 0], other[:, 1] - other[:, 0], other[:, 0] - one[:, 0]
    uu, vv, uv, uw, vw = (np.einsum("ij,ij->i", *pair) for pair in ((u, u), (v, v), (u, v), (u, w), (v, w)))
    determinant = uu * vv - uv * uv
    skew = determinant > _PARALLEL * uu * vv
    s = np.clip(np.where(skew, uw * vv - vw * uv, 0.0) / np.where(skew, determinant, 1.0), 0.0, 1.0)
    t = np.clip((s * uv - vw) / vv, 0.0, 1.0)
    return np.clip((t * uv + uw) / uu, 0.0, 1.0), t


def edge_distances(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Distance between segments, pair by pair, shape (pair_count,) [m].

    Args:
        one: Ends of the first segments, none without length, shape (pair_count, 2, dimension) [m].
        other: Ends of the second segments, none without length, shape (pair_count, 2, dimension) [m].
    """
    s, t = nearest_on_edges(one, other)
    from_one = one[:, 0] + s[:, None] * (one[:, 1] - one[:, 0])
    return np.linalg.norm(other[:, 0] + t[:, None] * (other[:, 1] - other[:, 0]) - from_one, axis=1)


def nearest_on_triangles(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Barycentric coordinates of the point of each triangle that is nearest to a point, shape (pair_count, 3).

    Args:
        points: Points, shape (pair_count, 3) [m].
        corners: Triangles, shape (pair_count, 3, 3) [m].
    """
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    square = np.einsum("ij,ij->i", normal, normal)
    over = np.empty((len(points), 3))
    for i, j in _CORNER_PAIRS:
        across = np.cross(normal, corners[:, j] - corners[:, i])
        over[:, 3 - i - j] = np.einsum("ij,ij->i", across, points - corners[:, i]) / np.where(square > 0.0, square, 1.0)
    nearest, least = np.zeros((len(points), 3)), np.full(len(points), np.inf)
    for i, j in _CORNER_PAIRS:
        edge, offset = corners[:, j] - corners[:, i], points - corners[:, i]
        length = np.einsum("ij,ij->i", edge, edge)
        t = np.clip(np.einsum("ij,ij->i", offset, edge) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
        distance = np.linalg.norm(offset - t[:, None] * edge, axis=1)
        closer = distance < least
        least = np.where(closer, distance, least)
        on_edge = np.zeros((len(points), 3))
        on_edge[:, i], on_edge[:, j] = 1.0 - t, t
        nearest[closer] = on_edge[closer]
    return np.where(((over >= 0.0).all(axis=1) & (square > 0.0))[:, None], over, nearest)
