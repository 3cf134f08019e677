# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks that points lie in a cage, and their distance from its faces.

Section 3 of the paper defines the coordinates for points inside the cage only.
"""

from __future__ import annotations

import numpy as np

from ..cage import Cage

_CHUNK = 1 << 18


def check_inside(cage: Cage, points: np.ndarray, *, which: np.ndarray | None = None) -> np.ndarray:
    """Check that points lie inside a cage or, within its tolerance, on it.

    Args:
        cage: The cage.
        points: Points, shape (point_count, dimension) [m].
        which: Points to check, by index; all by default.

    Returns:
        Those of them that lie outside, but no farther than the tolerance, by index, ascending where ``which`` is.

    Raises:
        ValueError: If some points are outside; the text has their count, the worst one and its distance.
    """
    points = np.asarray(points, dtype=np.float64)
    which = np.arange(len(points)) if which is None else which
    outside = which[~cage.contains(points[which])]
    if len(outside) == 0:
        return outside
    distance = boundary_distances(cage, points[outside])
    far = np.count_nonzero(distance > cage.length_tolerance)
    if far:
        worst = int(np.argmax(distance))
        raise ValueError(
            f"{far} of {len(points)} points lie outside the cage, the farthest (point {outside[worst]}) by "
            f"{distance[worst]:.4g} m; make the cage larger or move the points into it"
        )
    return outside


def boundary_distances(cage: Cage, points: np.ndarray) -> np.ndarray:
    """Distance of points to the faces of a cage, shape (point_count,) [m].

    Args:
        cage: The cage.
        points: Points, shape (point_count, dimension) [m].
    """
    corners = cage.vertices[cage.simplices]
    step = max(1, _CHUNK // len(corners))
    parts = [simplex_distances(points[i : i + step], corners).min(axis=1) for i in range(0, len(points), step)]
    return np.concatenate(parts) if parts else np.zeros(0)


def simplex_distances(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distance of each point to each segment in the plane, or each triangle in space, shape (point_count, count) [m].

    Args:
        points: Points, shape (point_count, dimension) [m].
        corners: Segments, shape (count, 2, 2), or triangles, shape (count, 3, 3) [m].
    """
    if corners.shape[1] == 2:
        return _segment_distances(points, corners[:, 0], corners[:, 1])
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / np.where(length > 0.0, length, 1.0)
    above = np.ones((len(points), len(corners)), dtype=bool)
    nearest = np.full((len(points), len(corners)), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        nearest = np.minimum(nearest, _segment_distances(points, p, q))
        above &= np.einsum("pij,ij->pi", points[:, None] - p, np.cross(normal, q - p)) >= 0.0
    height = np.abs(np.einsum("pij,ij->pi", points[:, None] - a, normal))
    return np.where(above & (length[:, 0] > 0.0), height, nearest)


def _segment_distances(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distance of each point to each segment."""
    edge = end - start
    offset = points[:, None] - start
    square = np.einsum("ij,ij->i", edge, edge)
    t = np.clip(np.einsum("pij,ij->pi", offset, edge) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return np.linalg.norm(offset - t[..., None] * edge, axis=2)
