# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Clusters of quadrature points, each through the whole thickness of the cage.

The vertices that move a point lie at some distance from it, the root of the mean square by their weights. The clusters'
centres keep apart by twice the greatest such distance: so each spans the cage's thickness, however many vertices there
are, since none lies inside. Fewer and larger clusters change little, smaller ones lock. Distances are along paths
between neighbours that the same vertices move, so that no cluster spans two pieces, nor the two sides of a cut but
around its tip.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

_NEIGHBOR_COUNT = 12
_OVERLAP = 0.25
"""Least sum of the smaller weights of two neighbours."""

_PASSES = 4


def cluster_points(
    vertices: np.ndarray, points: np.ndarray, weights: np.ndarray, volumes: np.ndarray, piece: np.ndarray, capacity: int
) -> np.ndarray:
    """Clusters of points, by number from 0; a fixed function of its arguments.

    Args:
        vertices: Rest positions of the cage's vertices, shape (n, dimension) [m].
        points: Quadrature points, shape (q, dimension) [m].
        weights: Weights there, shape (q, n).
        volumes: Volumes, positive, shape (q,) [m^3].
        piece: The piece of each point, shape (q,).
        capacity: Greatest number of clusters; as many as there are pieces, or more.

    Returns:
        The cluster of each point, shape (q,).
    """
    graph = _neighbors(points, weights, piece)
    squares = np.einsum("qj,qj->q", weights, ((vertices[None] - points[:, None]) ** 2).sum(axis=2))
    apart = 2.0 * np.sqrt(max(squares.max(), 0.0))
    part = connected_components(graph, directed=False)[1]
    order = np.argsort(np.bincount(part, weights=volumes), kind="stable")[::-1]
    if len(order) > capacity:
        part, order = piece, np.unique(piece)
    result, used = np.zeros(len(points), dtype=np.int64), 0
    for rank, number in enumerate(order):
        own = np.flatnonzero(part == number)
        room = capacity - used - (len(order) - rank - 1)
        labels = _divide(graph[own][:, own], points[own], volumes[own], apart, room)
        result[own] = used + labels
        used += labels.max() + 1
    return result


def _neighbors(points: np.ndarray, weights: np.ndarray, piece: np.ndarray) -> coo_array:
    """Distances of neighbours that the same vertices move."""
    distance, near = cKDTree(points).query(points, k=min(_NEIGHBOR_COUNT, len(points)))
    near, distance = near.reshape(len(points), -1), distance.reshape(len(points), -1)
    first, second = np.repeat(np.arange(len(points)), near.shape[1]), near.ravel()
    overlap = np.concatenate(
        [np.minimum(weights[rows, None], weights[near[rows]]).sum(axis=2) for rows in _blocks(len(points))]
    ).ravel()
    kept = (first != second) & (overlap >= _OVERLAP) & (piece[first] == piece[second])
    length = np.maximum(distance.ravel()[kept], np.finfo(float).tiny)
    graph = coo_array((length, (first[kept], second[kept])), shape=(len(points),) * 2).tocsr()
    return graph.maximum(graph.T).tocsr()


def _blocks(count: int) -> list[slice]:
    return [slice(begin, begin + 256) for begin in range(0, count, 256)]


def _divide(graph: coo_array, points: np.ndarray, volumes: np.ndarray, apart: float, room: int) -> np.ndarray:
    """Clusters of connected points: farthest points as centres, then each centre moved to the middle of its own."""
    middle = np.average(points, axis=0, weights=volumes)
    centers = [int(((points - middle) ** 2).sum(axis=1).argmax())]
    distance = dijkstra(graph, indices=centers)
    while len(centers) < room:
        nearest = np.where(np.isfinite(distance), distance, 0.0).min(axis=0)
        farthest = int(nearest.argmax())
        if nearest[farthest] <= apart:
            break
        centers.append(farthest)
        distance = np.vstack([distance, dijkstra(graph, indices=[farthest])])
    for _ in range(_PASSES):
        labels = distance.argmin(axis=0)
        moved = [_middle(points, volumes, np.flatnonzero(labels == k), center) for k, center in enumerate(centers)]
        if moved == centers:
            break
        centers, distance = moved, dijkstra(graph, indices=moved)
    return np.unique(distance.argmin(axis=0), return_inverse=True)[1]


def _middle(points: np.ndarray, volumes: np.ndarray, own: np.ndarray, center: int) -> int:
    """The point of a cluster that is nearest to its centre of mass."""
    if not len(own):
        return center
    middle = np.average(points[own], axis=0, weights=volumes[own])
    return int(own[((points[own] - middle) ** 2).sum(axis=1).argmin()])
