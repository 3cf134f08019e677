# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Distances between points, segments and triangles, and where these come closest.

After Ericson, "Real-time collision detection", 2005, chapter 5.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .overlaps import edge_pierces
from .vectors import triangle_normals, units

_PARALLEL = 1e-14
_EDGES = ((0, 1), (1, 2), (2, 0))


def simplex_distances(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distance of each point to each segment in the plane, or each triangle in space, shape (point_count, count) [m].

    Args:
        points: Points, shape (point_count, dimension) [m].
        corners: Segments, shape (count, 2, 2), or triangles, shape (count, 3, 3) [m].
    """
    points = points[:, None]
    if corners.shape[1] == 2:
        return _along_edges(points - corners[:, 0], corners[:, 1] - corners[:, 0])[1]
    normal = triangle_normals(corners)
    length = np.linalg.norm(normal, axis=1)
    normal, over, nearest = units(normal, length), length > 0.0, np.inf
    for _, inward, _, distance in _from_edges(points, corners, normal):
        over = over & (inward >= 0.0)
        nearest = np.minimum(nearest, distance)
    height = np.abs(np.einsum("...i,...i->...", points - corners[:, 0], normal))
    return np.where(over, height, nearest)


def nearest_on_triangles(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Barycentric coordinates of the point of each triangle that is nearest to a point, shape (pair_count, 3).

    Args:
        points: Points, shape (pair_count, 3) [m].
        corners: Triangles, shape (pair_count, 3, 3) [m].
    """
    normal = triangle_normals(corners)
    square = np.einsum("ij,ij->i", normal, normal)
    over, nearest = np.empty((len(points), 3)), np.zeros((len(points), 3))
    least = np.full(len(points), np.inf)
    for (i, j), inward, t, distance in _from_edges(points, corners, normal):
        over[:, 3 - i - j] = inward / np.where(square > 0.0, square, 1.0)
        closer = distance < least
        least = np.where(closer, distance, least)
        on_edge = np.zeros((len(points), 3))
        on_edge[:, i], on_edge[:, j] = 1.0 - t, t
        nearest[closer] = on_edge[closer]
    return np.where(((over >= 0.0).all(axis=1) & (square > 0.0))[:, None], over, nearest)


def _from_edges(
    points: np.ndarray, corners: np.ndarray, normal: np.ndarray
) -> Iterator[tuple[tuple[int, int], np.ndarray, np.ndarray, np.ndarray]]:
    """Where points stand to the edges of triangles, pair by pair or each to each.

    Yields:
        Corners of an edge; how far inside of it the points are, times its length and the normal's; where they are
        nearest to it, as a fraction of its length; and their distances from it.
    """
    for i, j in _EDGES:
        edge, offset = corners[:, j] - corners[:, i], points - corners[:, i]
        yield (i, j), np.einsum("...i,...i->...", np.cross(normal, edge), offset), *_along_edges(offset, edge)


def _along_edges(offset: np.ndarray, edge: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where points, given from the edges' starts, are nearest to edges, as fractions, and their distances."""
    square = np.einsum("ij,ij->i", edge, edge)
    t = np.clip(np.einsum("...i,...i->...", offset, edge) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return t, np.linalg.norm(offset - t[..., None] * edge, axis=-1)


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


def triangle_distances(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Distance between triangles, pair by pair, shape (pair_count,) [m].

    Triangles that do not cross are closest at a corner of one or at an edge of both.

    Args:
        one: First triangles, which may be lines or points, shape (pair_count, 3, 3) [m].
        other: Second triangles, with edges that have lengths, shape (pair_count, 3, 3) [m].
    """
    least = np.full(len(one), np.inf)
    for first, second in ((one, other), (other, one)):
        for k in range(3):
            nearest = np.einsum("pk,pki->pi", nearest_on_triangles(first[:, k], second), second)
            least = np.minimum(least, np.linalg.norm(first[:, k] - nearest, axis=1))
        for i, j in _EDGES:
            least[edge_pierces(first[:, i], first[:, j], second, 0.0)] = 0.0
    for pair in _EDGES:
        edge = one[:, pair]
        long = (edge[:, 0] != edge[:, 1]).any(axis=1)
        for other_pair in _EDGES:
            distance = edge_distances(edge[long], other[long][:, other_pair])
            least[long] = np.minimum(least[long], distance)
    return least


def plane_gaps(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Distance of triangles from the planes of others, zero where they cross, shape (pair_count,) [m].

    Args:
        one: Triangles, shape (pair_count, 3, 3) [m].
        other: Triangles with area, shape (pair_count, 3, 3) [m].
    """
    normal = units(triangle_normals(other))
    height = np.einsum("pci,pi->pc", one - other[:, :1], normal)
    return np.maximum(np.maximum(height.min(axis=1), -height.max(axis=1)), 0.0)
