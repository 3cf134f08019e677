# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Normals of vertices, smooth over the skin and over each side of a cut, and the copies that keep them apart."""

from __future__ import annotations

from functools import cache

import numpy as np

from ..geometry import triangle_normals

_LEVELS = 256  # of each of the two coordinates of a direction: at most 1 degree off, 0.34 in the mean


def split_caps(
    rest_points: np.ndarray, triangles: np.ndarray, triangle_cap: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Give the caps vertices of their own, one copy for each side of a cut, so that their edges can be hard.

    The two sides of a cut share the tips at its front. At rest they lie in one plane and face opposite ways; a
    triangle without area may go to either.

    Args:
        rest_points: Vertices at rest, shape ``(n, 3)``.
        triangles: Vertex indices, shape ``(m, 3)``.
        triangle_cap: The wall of the cut whose cap a triangle belongs to, or -1 on the skin, shape ``(m,)``.

    Returns:
        The vertex that each vertex is a copy of, shape ``(n + copies,)``, the first ``n`` being the vertices
        themselves, and the triangles on the copies, shape ``(m, 3)``.
    """
    count = len(rest_points)
    cap = np.flatnonzero(triangle_cap >= 0)
    _, wall = np.unique(triangle_cap[cap], return_inverse=True)
    area = triangle_normals(rest_points[triangles[cap]].astype(np.float64))
    by_size = np.lexsort((-np.linalg.norm(area, axis=1), wall))
    largest = by_size[np.searchsorted(wall[by_size], wall)]
    side = np.einsum("ij,ij->i", area, area[largest]) < 0.0
    corner = (2 * wall + side)[:, None] * count + triangles[cap]
    copies, place = np.unique(corner, return_inverse=True)
    split = triangles.copy()
    split[cap] = count + place.reshape(-1, 3)
    return np.concatenate([np.arange(count), copies % count]), split


def vertex_normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the unit normal of each vertex, the mean over its triangles by area, shape ``(n, 3)``, float32.

    Args:
        points: Vertices, shape ``(n, 3)``.
        triangles: Vertex indices, shape ``(m, 3)``.
    """
    area = np.repeat(triangle_normals(points[triangles].astype(np.float64)), 3, axis=0)
    corner = triangles.reshape(-1)
    total = np.stack([np.bincount(corner, area[:, i], len(points)) for i in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    up = np.array([0.0, 0.0, 1.0])  # of a vertex without triangles that have an area
    return np.where(length > 0.0, total / np.where(length > 0.0, length, 1.0), up).astype(np.float32)


@cache
def direction_table() -> np.ndarray:
    """Directions all over the sphere, shape ``(65536, 3)``, float32: a grid on an octahedron that is folded open."""
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, _LEVELS), np.linspace(-1.0, 1.0, _LEVELS), indexing="ij")
    z = 1.0 - np.abs(x) - np.abs(y)
    x, y = np.where(z < 0.0, _folded(x, y), x), np.where(z < 0.0, _folded(y, x), y)
    table = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    table = (table / np.linalg.norm(table, axis=1, keepdims=True)).astype(np.float32)
    table.setflags(write=False)
    return table


def direction_numbers(normals: np.ndarray) -> np.ndarray:
    """Return rows of :func:`direction_table` that are nearly some unit vectors, shape ``(n,)``.

    Args:
        normals: Unit vectors, shape ``(n, 3)``.
    """
    x, y, z = (normals / np.abs(normals).sum(axis=1, keepdims=True)).T
    x, y = np.where(z < 0.0, _folded(x, y), x), np.where(z < 0.0, _folded(y, x), y)
    row, column = (np.rint((value + 1.0) * (0.5 * (_LEVELS - 1))).astype(np.int32) for value in (x, y))
    return row * _LEVELS + column


def _folded(value: np.ndarray, other: np.ndarray) -> np.ndarray:
    """A coordinate of the lower half of the octahedron, which is folded out over the upper one's edges."""
    return (1.0 - np.abs(other)) * np.where(value >= 0.0, 1.0, -1.0)
