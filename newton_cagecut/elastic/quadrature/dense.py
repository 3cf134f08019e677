# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Many points spread evenly over a cage's inside, from which quadrature points and their volumes are made."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.ndimage import label

from ...geometry import simplex_distances

_CELL_POINTS = 3  # in each cell


class QuadratureCage(Protocol):
    """What the sampling needs of a cage."""

    vertices: np.ndarray
    simplices: np.ndarray
    volume: float

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points lie inside."""


def dense_inside(cage: QuadratureCage, cell_count: int, rng: np.random.Generator) -> np.ndarray:
    """Points spread evenly over the cage's inside, in about ``cell_count`` cubes or squares.

    Only the points of cells that the surface passes are tested one by one; cells that it keeps apart are inside or
    outside together.
    """
    side = (cage.volume / cell_count) ** (1.0 / cage.vertices.shape[1])
    low = cage.vertices.min(axis=0) - side
    shape = np.ceil((cage.vertices.max(axis=0) - low) / side).astype(int) + 1
    crossed = _crossed_cells((cage.vertices[cage.simplices] - low) / side, shape)
    regions = label(~crossed)[0]
    number, first = np.unique(regions, return_index=True)
    centers = low + side * (np.stack(np.unravel_index(first, shape), axis=1) + 0.5)
    whole = np.isin(regions, number[cage.contains(centers) & (number > 0)])
    points = low + side * _spread(np.argwhere(whole), rng)
    tested = low + side * _spread(np.argwhere(crossed), rng)
    return np.concatenate([points, tested[cage.contains(tested)]])


def near_surface(points: np.ndarray, corners: np.ndarray, distance: float) -> np.ndarray:
    """Whether each point is nearer to some segment or triangle than a distance.

    Args:
        points: Points, shape (n, dimension) [m].
        corners: Corners of the segments or triangles, shape (m, dimension, dimension) [m].
        distance: The distance [m].
    """
    near = np.zeros(len(points), dtype=bool)
    normals = _normals(corners)
    heights = distance * np.linalg.norm(normals, axis=1) + 1e-12 * np.abs(normals).max(initial=0.0)
    low, high = corners.min(axis=1) - distance, corners.max(axis=1) + distance
    for simplex, normal, height, least, greatest in zip(corners, normals, heights, low, high):
        slab = np.flatnonzero(np.abs(points @ normal - simplex[0] @ normal) <= height)
        slab = slab[~near[slab]]
        slab = slab[((points[slab] >= least) & (points[slab] <= greatest)).all(axis=1)]
        near[slab] = simplex_distances(points[slab], simplex[None])[:, 0] < distance
    return near


def _spread(cells: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Points in each unit cell, evenly over all (an additive recurrence with plastic steps)."""
    dimension = cells.shape[1]
    root = 2.0
    for _ in range(64):
        root = (1.0 + root) ** (1.0 / (dimension + 1))
    steps = root ** -np.arange(1.0, dimension + 1.0)
    within = (rng.random(dimension) + np.arange(len(cells) * _CELL_POINTS)[:, None] * steps) % 1.0
    return np.repeat(cells, _CELL_POINTS, axis=0) + within


def _crossed_cells(corners: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """Unit cells of a grid that simplices pass, or nearly: those in a simplex's box that its plane or line passes."""
    crossed = np.zeros(shape, dtype=bool)
    normals = _normals(corners)
    begin, end = np.floor(corners.min(axis=1) - 1e-6).astype(int), np.floor(corners.max(axis=1) + 1e-6).astype(int) + 1
    for simplex, normal, first, last in zip(corners, normals, begin, end):
        axes = [np.arange(a, b) + 0.5 for a, b in zip(first, last)]
        height = sum(np.ix_(*(n * (axis - x) for n, axis, x in zip(normal, axes, simplex[0]))))
        crossed[tuple(map(slice, first, last))] |= np.abs(height) <= (0.5 + 1e-6) * np.abs(normal).sum()
    return crossed


def _normals(corners: np.ndarray) -> np.ndarray:
    """Normals of segments or triangles, as long as these are large: the minors of their edges."""
    edges = corners[:, 1:] - corners[:, :1]
    axes = range(edges.shape[2])
    return np.stack([(-1.0) ** k * np.linalg.det(np.delete(edges, k, axis=2)) for k in axes], axis=1)
