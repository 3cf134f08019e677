# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Fills a shape in the plane with even triangles.

Bars between neighbouring points push them apart until they fill the shape, and points that leave it are put back on its
border (Persson and Strang, "A simple mesh generator in MATLAB", 2004).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from assets.implicit import Field, project

_STEP = 1e-4  # of the differences that stand for a field's gradient, in spacings
_INNER = 1e-3  # how far inside the middle of a triangle lies, in spacings
_NEEDLE = 0.3  # quality below which a triangle on the border is left out; 1 for an even one


def fill(
    field: Field,
    lower: Sequence[float],
    upper: Sequence[float],
    spacing: float,
    *,
    fixed: np.ndarray,
    iterations: int = 40,
) -> tuple[np.ndarray, np.ndarray]:
    """Return points ``(n, 2)`` and counterclockwise triangles ``(m, 3)`` that fill ``field < 0``.

    Args:
        field: Negative inside, roughly the distance near the border [m].
        lower: Least corner of a box around the shape [m].
        upper: Greatest corner of that box [m].
        spacing: Length of the edges [m].
        fixed: Points that the mesh has, shape ``(k, 2)``; edges run along lines of them that are as dense.
        iterations: Steps in which the points spread.
    """
    points = np.concatenate([fixed, _grid(field, lower, upper, spacing, fixed)])
    free = np.arange(len(points)) >= len(fixed)
    for _ in range(iterations):
        bars = _bars(_triangles(field, points, spacing))
        along = points[bars[:, 0]] - points[bars[:, 1]]
        length = np.linalg.norm(along, axis=1, keepdims=True)
        wanted = 1.2 * np.sqrt((length**2).mean())
        push = np.maximum(wanted - length, 0.0) / length * along
        force = np.stack([np.bincount(bars.T.ravel(), np.r_[p, -p], len(points)) for p in push.T], axis=1)
        points = points + 0.2 * force * free[:, None]
        outside = np.flatnonzero((field(points) > 0.0) & free)
        points[outside] = project(field, points[outside], step=_STEP * spacing, iterations=2)
    triangles = _triangles(field, points, spacing)
    triangles = triangles[(_quality(points, triangles) > _NEEDLE) | ~_on_border(triangles)]
    used, places = np.unique(triangles, return_inverse=True)
    return points[used], places.reshape(-1, 3).astype(np.int32)


def _grid(
    field: Field, lower: Sequence[float], upper: Sequence[float], spacing: float, fixed: np.ndarray
) -> np.ndarray:
    """Return a grid of even triangles inside the shape, less what is close to a fixed point."""
    x, y = (np.arange(a, b, s) for a, b, s in zip(lower, upper, (spacing, np.sqrt(0.75) * spacing)))
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    grid[1::2, :, 0] += 0.5 * spacing
    points = grid.reshape(-1, 2)
    return points[(field(points) < 0.0) & (cKDTree(fixed).query(points)[0] > 0.7 * spacing)]


def _triangles(field: Field, points: np.ndarray, spacing: float) -> np.ndarray:
    """Return the Delaunay triangles inside the shape, counterclockwise."""
    triangles = Delaunay(points).simplices
    inside = field(points[triangles].mean(axis=1)) < -_INNER * spacing
    (ax, ay), (bx, by) = np.moveaxis(points[triangles[:, 1:]] - points[triangles[:, :1]], 0, -1)
    return np.where((ax * by - ay * bx < 0.0)[:, None], triangles[:, ::-1], triangles)[inside]


def _bars(triangles: np.ndarray) -> np.ndarray:
    """Return the edges of triangles, each once, shape ``(e, 2)``."""
    return np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)


def _quality(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the area of triangles over that of even ones with edges as long, shape ``(m,)``."""
    sides = np.roll(points[triangles], -1, axis=1) - points[triangles]
    area = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
    return 2.0 * np.sqrt(3.0) * area / (sides**2).sum(axis=(1, 2))


def _on_border(triangles: np.ndarray) -> np.ndarray:
    """Return whether some edge of each triangle is no other one's, shape ``(m,)``."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, number, uses = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    return (uses[number.reshape(-1, 3)] == 1).any(axis=1)
