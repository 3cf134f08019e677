# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Seams: points that were split for the sake of attributes, found again by where they stand.

The paper's embedded mesh (section 6.3) is one of positions. Files split its points where texture coordinates or normals
differ, which leaves open edges that lie on each other. Only along such edges are points joined: what is closed as it is
given, such as the two sides of a cut or two bodies that touch, stays apart.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...geometry import PolygonMesh

WELD = 1e-6
"""Default distance up to which points of open edges are joined, in longest sides of the box around the mesh."""


def weld_seams(mesh: PolygonMesh, tolerance: float, *, apart: np.ndarray) -> np.ndarray:
    """The first of the points at the place of each, shape (point_count,).

    Points are joined where two open edges that run in opposite directions lie on each other, end on end, and where an
    open edge has no length; also where just two edges lie on each other that run alike, since one triangle is turned
    over then, unless they are of the same triangle, given twice.

    Args:
        mesh: The triangles with their points.
        tolerance: Distance up to which ends lie on each other [m].
        apart: Points that are never joined, as a mask, shape (point_count,).
    """
    count = mesh.vertex_count
    if (mesh.twin >= 0).all():
        return np.arange(count)
    border = open_half_edges(mesh)
    start, end = mesh.face_vertex[border], mesh.destination[border]
    free = ~(apart[start] | apart[end])
    start, end = start[free], end[free]
    place = _places(mesh.vertices, np.unique(np.concatenate([start, end])), tolerance)
    if place is None:
        return np.arange(count)
    one, other = _opposite_pairs(place[start], place[end], count)
    third = mesh.face_vertex[mesh.next[mesh.next[border[free]]]]
    turned, back = _alike_pairs(place[start], place[end], mesh.vertices[third], tolerance)
    short = np.flatnonzero(place[start] == place[end])
    pairs = np.concatenate(
        [
            np.stack([start[one], end[other]], axis=1),
            np.stack([end[one], start[other]], axis=1),
            np.stack([start[turned], start[back]], axis=1),
            np.stack([end[turned], end[back]], axis=1),
            np.stack([start[short], end[short]], axis=1),
        ]
    )
    return _first_of_groups(pairs, count)


def open_half_edges(mesh: PolygonMesh) -> np.ndarray:
    """Half-edges along which no other runs, ascending."""
    _, number, size = np.unique(mesh.edge_key, return_inverse=True, return_counts=True)
    return np.flatnonzero(size[number.reshape(-1)] == 1)


def _places(points: np.ndarray, which: np.ndarray, tolerance: float) -> np.ndarray | None:
    """The first of the points at the place of each, among some; None where no two share one."""
    if len(which) < 2:
        return None
    pairs = cKDTree(points[which]).query_pairs(tolerance, output_type="ndarray")
    return _first_of_groups(which[pairs], len(points)) if len(pairs) else None


def _opposite_pairs(start: np.ndarray, end: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """All pairs of edges of which the second runs from the end of the first to its start."""
    forth, back = start * count + end, end * count + start
    order = np.argsort(back, kind="stable")
    first = np.searchsorted(back[order], forth, side="left")
    size = np.searchsorted(back[order], forth, side="right") - first
    one = np.repeat(np.arange(len(start)), size)
    within = np.arange(len(one)) - np.repeat(np.cumsum(size) - size, size)
    return one, order[np.repeat(first, size) + within]


def _alike_pairs(
    start: np.ndarray, end: np.ndarray, third: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of edges between two places, where there are just these, that run alike in triangles that differ.

    Args:
        start: Place at which each edge starts, shape (count,).
        end: Place at which each ends, shape (count,).
        third: Position of the triangle's point across each edge, shape (count, 3) [m].
        tolerance: Distance up to which those are the same [m].
    """
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((high, low))
    low, high = low[order], high[order]
    begins = np.flatnonzero((np.diff(low, prepend=-1) != 0) | (np.diff(high, prepend=-1) != 0))
    size = np.diff(np.append(begins, len(order)))
    one, other = order[begins[size == 2]], order[begins[size == 2] + 1]
    differ = np.linalg.norm(third[one] - third[other], axis=1) > tolerance
    chosen = differ & (start[one] == start[other]) & (start[one] != end[one])
    return one[chosen], other[chosen]


def _first_of_groups(pairs: np.ndarray, count: int) -> np.ndarray:
    """The lowest of the numbers that pairs connect with each, shape (count,)."""
    graph = coo_array((np.ones(len(pairs), dtype=bool), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    first = np.unique(label, return_index=True)[1]
    return first[label]
