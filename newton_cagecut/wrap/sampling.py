# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Points spread evenly over triangles."""

from __future__ import annotations

from functools import cache

import numpy as np


def triangle_grid(corners: np.ndarray, spacing: float, *, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """Grids of points on triangles, corners included.

    Args:
        corners: Triangles, shape (triangle_count, 3, 3) [m].
        spacing: Largest distance between neighbours along an edge [m].
        limit: Most pieces that an edge is split into, whatever the spacing.

    Returns:
        Triangle of each point, shape (n,), and its barycentric coordinates there, shape (n, 3).
    """
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    pieces = np.clip(np.ceil(longest / spacing), 1, limit).astype(int)
    owners, coordinates = [], []
    for count in np.unique(pieces).tolist():
        which, grid = np.flatnonzero(pieces == count), _barycentric_grid(count)
        owners.append(np.repeat(which, len(grid)))
        coordinates.append(np.tile(grid, (len(which), 1)))
    return np.concatenate(owners), np.concatenate(coordinates)


def spread_points(points: np.ndarray, triangles: np.ndarray, spacing: float) -> np.ndarray:
    """Points on a mesh, so dense that each of its points is nearer than ``spacing`` to one, shape (n, 3) [m].

    Args:
        points: Points of the mesh, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
        spacing: Distance between neighbours, about [m].
    """
    corners = points[triangles]
    owner, weights = triangle_grid(corners, spacing, limit=1 << 12)
    places = np.einsum("nk,nki->ni", weights, corners[owner])
    cell = np.floor((places - places.min(axis=0)) / (0.5 * spacing)).astype(np.int64)
    size = cell.max(axis=0) + 1
    key = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    return places[np.unique(key, return_index=True)[1]]


@cache
def _barycentric_grid(pieces: int) -> np.ndarray:
    """Barycentric coordinates of the points of a triangle with its edges in so many pieces."""
    rows = [(i, j, pieces - i - j) for i in range(pieces + 1) for j in range(pieces + 1 - i)]
    grid = np.array(rows) / pieces
    grid.setflags(write=False)
    return grid
