# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangles of the polygons of a mesh in space, each cut in the plane that fits it best.

Convex quads are cut all at once, along the diagonal that ear clipping takes; other polygons one by one.
"""

from __future__ import annotations

import numpy as np

from .triangulate import convex_quad_triangles, triangulate


def polygon_triangles(points: np.ndarray, counts: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """Cut polygons into triangles, each in its place.

    Args:
        points: Points, shape (point_count, 3).
        counts: Corners of each polygon, at least 3, shape (face_count,).
        indices: Point ids of all corners, polygon after polygon, shape (corner_count,).

    Returns:
        Point ids, shape (triangle_count, 3), int32.
    """
    counts, indices = np.asarray(counts, dtype=np.int64), np.asarray(indices, dtype=np.int64)
    corner_start = np.cumsum(counts) - counts
    triangle_start = np.cumsum(counts - 2) - (counts - 2)
    triangles = np.empty((int((counts - 2).sum()), 3), dtype=np.int32)
    left = counts != 3
    whole = np.flatnonzero(~left)
    triangles[triangle_start[whole]] = indices[corner_start[whole, None] + np.arange(3)]
    quads = np.flatnonzero(counts == 4)
    if len(quads):
        ids = indices[corner_start[quads, None] + np.arange(4)]
        corners, convex = convex_quad_triangles(_flattened(points[ids]))
        done = quads[convex]
        cut = np.take_along_axis(ids[convex], corners.reshape(-1, 6), axis=1).reshape(-1, 2, 3)
        triangles[triangle_start[done, None] + np.arange(2)] = cut
        left[done] = False
    for face in np.flatnonzero(left).tolist():
        ids = indices[corner_start[face] : corner_start[face] + counts[face]]
        cut = ids[triangulate(_flattened(points[ids][None])[0])]
        triangles[triangle_start[face] : triangle_start[face] + len(cut)] = cut
    return triangles


def _flattened(corners: np.ndarray) -> np.ndarray:
    """Polygons of as many corners each in the coordinate planes that fit them best, counterclockwise.

    Args:
        corners: Shape (face_count, corner_count, 3).

    Returns:
        Shape (face_count, corner_count, 2).
    """
    normal = np.cross(corners, np.roll(corners, -1, axis=1)).sum(axis=1)  # Newell's normal
    drop = np.abs(normal).argmax(axis=1)
    kept = np.array([[1, 2], [0, 2], [0, 1]])[drop]
    flat = np.take_along_axis(corners, kept[:, None], axis=2)
    flat[drop == 1, :, 1] *= -1.0
    flat[np.take_along_axis(normal, drop[:, None], axis=1)[:, 0] < 0.0, :, 0] *= -1.0
    return flat
