# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangulates a smooth implicit surface with a given number of vertices, evenly spaced.

The vertices repel each other on the surface (Witkin and Heckbert, "Using particles to sample and control
implicit surfaces", 1994). The triangles are the restricted Delaunay triangulation (Edelsbrunner and Shah,
"Triangulating topological spaces", 1994): the facets between a tetrahedron whose circumcentre is inside and one
whose circumcentre is outside.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import Delaunay, cKDTree

Field = Callable[[np.ndarray], np.ndarray]


def field_gradient(field: Field, points: np.ndarray, step: float) -> np.ndarray:
    """Return the central differences of ``field`` at ``points``, shape ``(n, dimension)``."""
    axes = np.eye(points.shape[1]) * step
    return np.stack([(field(points + axis) - field(points - axis)) / (2 * step) for axis in axes], axis=1)


def project(field: Field, points: np.ndarray, *, step: float, iterations: int = 4) -> np.ndarray:
    """Return ``points`` moved along the gradient onto ``field == 0``."""
    for _ in range(iterations):
        gradient = field_gradient(field, points, step)
        points = points - (field(points) / (gradient**2).sum(axis=1))[:, None] * gradient
    return points


def even(points: np.ndarray) -> np.ndarray:
    """Return the same relative spacing for all points."""
    return np.ones(len(points))


def scatter(
    field: Field, lower: np.ndarray, upper: np.ndarray, count: int, *, step: float, seed: int, spacing: Field = even
) -> np.ndarray:
    """Return ``count`` random points on the surface, from those of a box that are close to it.

    Args:
        field: Negative inside.
        lower: Least corner of the box, shape ``(3,)``.
        upper: Greatest corner of the box, shape ``(3,)``.
        count: Number of points.
        step: Of the differences that stand for the field's gradient.
        seed: Of the random points.
        spacing: Relative spacing of the points, at least 1.
    """
    random, shells, found = np.random.default_rng(seed), [], 0
    while found < count:
        points = lower + (upper - lower) * random.random((60 * count, 3))
        shell = points[np.abs(field(points)) < 0.01 * np.linalg.norm(upper - lower)]
        shell = shell[random.random(len(shell)) * spacing(shell) ** 2 < 1.0]
        shell = project(field, shell, step=step)
        shell = shell[np.abs(field(shell)) < 10.0 * step]
        if not len(shell):
            raise ValueError(f"none of {60 * count} points of the box is near the surface: the box is too large for it")
        shells.append(shell)
        found += len(shell)
    return np.concatenate(shells)[:count]


def repel(field: Field, points: np.ndarray, *, step: float, iterations: int, spacing: Field = even) -> np.ndarray:
    """Return ``points`` after ``iterations`` steps of mutual repulsion on the surface, in units of ``spacing``."""
    for _ in range(iterations):
        distance, neighbour = cKDTree(points).query(points, k=16)
        distance = np.maximum(distance[:, 1:], 1e-9) / spacing(points)[:, None]
        reach = 1.15 * distance[:, 9].mean()
        push = np.clip(1.0 - distance / reach, 0.0, None) ** 2 * reach / distance
        away = points[:, None] - points[neighbour[:, 1:]]
        points = project(field, points + 0.35 * (push[..., None] * away).sum(axis=1), step=step, iterations=2)
    return points


def circumcentres(points: np.ndarray, tetrahedra: np.ndarray) -> np.ndarray:
    """Return the circumcentre of each tetrahedron, shape ``(t, 3)``."""
    corners = points[tetrahedra]
    edges = corners[:, 1:] - corners[:, :1]
    volume = np.einsum("ti,ti->t", edges[:, 0], np.cross(edges[:, 1], edges[:, 2]))
    square = (edges**2).sum(axis=2)
    numerator = sum(square[:, i, None] * np.cross(edges[:, (i + 1) % 3], edges[:, (i + 2) % 3]) for i in range(3))
    flat = np.abs(volume) < 1e-30
    return corners[:, 0] + numerator / (2 * np.where(flat, 1e-30, volume))[:, None]


def restricted_delaunay(field: Field, points: np.ndarray) -> np.ndarray:
    """Return the triangles of ``points`` on the surface ``field == 0``, outward, shape ``(m, 3)``.

    Raises:
        ValueError: The points are too sparse: their triangles are no closed surface that uses them all.
    """
    delaunay = Delaunay(points)
    inside = np.append(field(circumcentres(points, delaunay.simplices)) < 0, False)
    tetrahedron, corner = np.nonzero(inside[:-1, None] & ~inside[delaunay.neighbors])
    others = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    triangles = np.take_along_axis(delaunay.simplices[tetrahedron], others[corner], axis=1)
    opposite = points[delaunay.simplices[tetrahedron, corner]]
    a, b, c = (points[triangles[:, i]] for i in range(3))
    inward = np.einsum("ti,ti->t", np.cross(b - a, c - a), opposite - a) > 0
    triangles[inward] = triangles[inward][:, ::-1]
    _, uses = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True)
    if (uses != 2).any() or len(np.unique(triangles)) != len(points):
        raise ValueError(f"{len(points)} points are too few for this surface: {(uses != 2).sum()} edges are not closed")
    return triangles.astype(np.int32)


def mesh_field(
    field: Field,
    lower: np.ndarray,
    upper: np.ndarray,
    count: int,
    *,
    seed: int,
    step: float = 1e-4,
    iterations: int = 60,
    spacing: Field = even,
) -> tuple[np.ndarray, np.ndarray]:
    """Return ``count`` points on the surface ``field == 0`` and its outward triangles ``(m, 3)``.

    Args:
        field: Negative inside, roughly the distance near the surface [m].
        lower: Least corner of a box around the surface [m], shape ``(3,)``.
        upper: Greatest corner of that box [m], shape ``(3,)``.
        count: Number of points.
        seed: Of their first places.
        step: Of the differences that stand for the field's gradient [m].
        iterations: Steps in which the points spread.
        spacing: Relative spacing of the points, at least 1.

    Raises:
        ValueError: The box is too large for so few points, or the points are too sparse for the surface.
    """
    points = scatter(field, np.asarray(lower), np.asarray(upper), count, step=step, seed=seed, spacing=spacing)
    points = repel(field, points, step=step, iterations=iterations, spacing=spacing)
    points = project(field, points, step=step)
    return order_along(points, restricted_delaunay(field, points))


def order_along(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles in an order that keeps neighbours close and does not depend on the tessellation."""
    cells = np.floor((points - points.min(axis=0)) / np.ptp(points, axis=0).max() * 32).astype(np.int64)
    order = np.lexsort((points[:, 0], cells[:, 1], cells[:, 0], cells[:, 2]))
    rank = np.empty(len(points), dtype=np.int32)
    rank[order] = np.arange(len(points), dtype=np.int32)
    triangles = rank[triangles]
    first = triangles.argmin(axis=1)[:, None]
    triangles = np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1)
    return points[order], triangles[np.lexsort(triangles.T[::-1])]
