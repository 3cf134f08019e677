# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Gives triangles without area one, since an alpha wrap overlooks them and PyMeshLab crashes on nothing else."""

from __future__ import annotations

import numpy as np

_LEAST_AREA = 1e-12
_WIDTH = 1e-4


def broaden(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Move corners of triangles that are lines or points a little aside.

    Args:
        points: Points in a box with a diagonal of 1, shape (point_count, 3).
        triangles: Point ids, shape (triangle_count, 3).

    Returns:
        Points, those that were moved at the end, and triangles.
    """
    corners = points[triangles]
    edges = np.roll(corners, -1, axis=1) - corners
    thin = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) < 2.0 * _LEAST_AREA
    corners, edges = corners[thin], edges[thin]
    along = np.take_along_axis(edges, np.linalg.norm(edges, axis=2).argmax(axis=1)[:, None, None], axis=1)[:, 0]
    along[~along.any(axis=1), 0] = 1.0
    across = np.cross(along, np.eye(3)[np.abs(along).argmin(axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    upright = np.cross(along, across)
    upright /= np.linalg.norm(upright, axis=1, keepdims=True)
    corners[:, 1] += _WIDTH * across
    corners[:, 2] += _WIDTH * upright
    added = len(points) + np.arange(3 * len(corners)).reshape(-1, 3)
    return np.concatenate([points, corners.reshape(-1, 3)]), np.concatenate([triangles[~thin], added])
