# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Winding numbers of points about closed boundaries: meshes of triangles, or in the plane loops of segments.

The walks of section 3 of the paper need points inside the cage; the winding number tells, with coincident
sides of a cut cancelling each other. Solid angles after Van Oosterom and Strackee (1983).
"""

from __future__ import annotations

import numpy as np

_CHUNK = 1 << 16


def solid_angles(points: np.ndarray, vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Signed solid angle of each triangle seen from each point, shape (point_count, triangle_count) [sr].

    Args:
        points: Points, shape (point_count, 3) [m].
        vertices: Positions, shape (vertex_count, 3) [m].
        triangles: Vertex ids, shape (triangle_count, 3).
    """
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    numerator = np.einsum("ij,ij->i", a, normal) - points @ normal.T
    square = sum((points[:, k, None] - vertices[:, k]) ** 2 for k in range(3))
    length = np.sqrt(square)
    corner_square = [square[:, triangles[:, k]] for k in range(3)]
    corner_length = [length[:, triangles[:, k]] for k in range(3)]
    denominator = corner_length[0] * corner_length[1]
    denominator *= corner_length[2]
    for i, j, k, edge in ((0, 1, 2, a - b), (1, 2, 0, b - c), (2, 0, 1, c - a)):
        dot = corner_square[i] + corner_square[j]
        dot -= np.einsum("ij,ij->i", edge, edge)
        dot *= corner_length[k]
        dot *= 0.5
        denominator += dot
    return 2.0 * np.arctan2(numerator, denominator)


def segment_angles(points: np.ndarray, vertices: np.ndarray, segments: np.ndarray) -> np.ndarray:
    """Signed angle of each segment seen from each point, shape (point_count, segment_count) [rad].

    Args:
        points: Points, shape (point_count, 2) [m].
        vertices: Positions, shape (vertex_count, 2) [m].
        segments: Vertex ids, shape (segment_count, 2).
    """
    a, b = (vertices[segments[:, k]] - points[:, None] for k in range(2))
    return np.arctan2(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0], (a * b).sum(axis=2))


def winding_numbers(
    points: np.ndarray, vertices: np.ndarray, simplices: np.ndarray, group: np.ndarray, group_count: int
) -> np.ndarray:
    """Winding number of each point about each group of simplices, shape (point_count, group_count).

    Args:
        points: Points, shape (point_count, dimension) [m].
        vertices: Positions, shape (vertex_count, dimension) [m].
        simplices: Vertex ids of triangles or segments, shape (simplex_count, dimension).
        group: Group of each simplex, shape (simplex_count,).
        group_count: Number of groups.
    """
    result = np.zeros((len(points), group_count))
    if not len(simplices):
        return result
    angles, whole = (segment_angles, 2.0 * np.pi) if simplices.shape[1] == 2 else (solid_angles, 4.0 * np.pi)
    order = np.argsort(group, kind="stable")
    present, start = np.unique(group[order], return_index=True)
    center = vertices.mean(axis=0)
    points, vertices, simplices = points - center, vertices - center, simplices[order]
    step = max(1, _CHUNK // len(simplices))
    for begin in range(0, len(points), step):
        angle = angles(points[begin : begin + step], vertices, simplices)
        result[begin : begin + step, present] = np.add.reduceat(angle, start, axis=1) / whole
    return result
