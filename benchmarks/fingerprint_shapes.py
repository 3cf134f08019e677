# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Small cages, surfaces and blades of both dimensions, for fingerprints."""

from __future__ import annotations

import numpy as np

from newton_cagecut import Blade, Cage, Surface

U_OUTLINE = np.array([[0, 0.1], [3, 0], [3.1, 3], [2.1, 2.9], [1.95, 1.1], [1.07, 0.97], [0.93, 3.03], [-0.1, 2.8]])
"""An irregular U, whose legs point along the second axis: its triangles do not depend on rounding."""
SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)


def star(count: int = 5, inner: float = 0.45) -> np.ndarray:
    """Return an irregular star, or with an inner radius near 1 a polygon of twice as many corners, shape (2 count, 2).

    Args:
        count: Number of its spikes.
        inner: Radius between them [m]; they end at about 1 m.
    """
    angle = np.pi / count * np.arange(2 * count) + 0.1
    radius = np.where(np.arange(2 * count) % 2 == 0, 1.0, inner)
    radius = radius * (1.0 + 0.04 * np.sin(7.0 * np.arange(2 * count) ** 2))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def cage_on(outline: np.ndarray, dimension: int, height: float = 1.0) -> Cage:
    """Return the cage of a polygon: its segments, or in space a prism of quads and two polygons.

    Args:
        outline: Its corners, counterclockwise, shape (n, 2) [m].
        dimension: Dimension of the cage.
        height: Height of the prism [m].
    """
    n = len(outline)
    if dimension == 2:
        return Cage(outline, [(i, (i + 1) % n) for i in range(n)])
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    corners = np.concatenate([np.c_[outline, np.full(n, z)] for z in (0.0, height)])
    return Cage(corners, [tuple(range(n))[::-1], tuple(range(n, 2 * n)), *sides])


def points_in(cage: Cage, count: int = 50) -> np.ndarray:
    """Return random points inside a cage, shape (count, dimension) [m].

    Args:
        cage: The cage.
        count: How many.
    """
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    drawn = np.random.default_rng(5).uniform(low, high, (20 * count, cage.dimension))
    return drawn[cage.contains(drawn)][:count]


def ball(dimension: int, scale: float = 0.42, center: float = 0.5) -> Surface:
    """Return a ball of circles of latitude with texture coordinates and normals, or a disk of rings without normals.

    Args:
        dimension: Dimension of the surface.
        scale: Its radius [m].
        center: Each coordinate of its middle [m].
    """
    rings, around = 6, 12
    angle = 2.0 * np.pi * np.arange(around) / around
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    triangles = _rings(rings, around)
    if dimension == 2:
        points = np.append((np.linspace(0.2, 1.0, rings)[:, None, None] * circle).reshape(-1, 2), np.zeros((1, 2)), 0)
        return Surface(scale * points + center, triangles, uvs=points @ [[0.3, 0.1], [-0.2, 0.7]])
    polar = np.repeat(np.pi * np.arange(1, rings + 1) / (rings + 1), around)
    points = np.c_[np.sin(polar)[:, None] * np.tile(circle, (rings, 1)), np.cos(polar)]
    points = np.concatenate([points, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    last = _fan(around, (rings - 1) * around, rings * around + 1)[:, [1, 0, 2]]
    return Surface(scale * points + center, np.concatenate([triangles, last]), uvs=points[:, :2], normals=points)


def _fan(around: int, first: int, middle: int) -> np.ndarray:
    """Return the triangles of a circle of points about a middle one."""
    k = np.arange(around)
    return np.stack([first + k, first + (k + 1) % around, np.full(around, middle)], axis=1)


def _rings(rings: int, around: int) -> np.ndarray:
    """Return the triangles of rings of points, one after the other, with the next point in the middle of the first."""
    first = np.arange(rings - 1)[:, None] * around
    a, b = (first + np.arange(around)).reshape(-1), (first + (np.arange(around) + 1) % around).reshape(-1)
    halves = [np.stack([a, a + around, b], axis=1), np.stack([b, a + around, b + around], axis=1)]
    return np.concatenate([_fan(around, 0, rings * around), *halves])


def down(dimension: int, x: float = 0.45) -> Blade:
    """Return a blade that comes down through the unit box or square at an angle.

    Args:
        dimension: Dimension of the blade.
        x: Where it meets the middle [m].
    """
    if dimension == 2:
        return Blade([x, 0.5], [0.2, -1.0])
    return Blade([x, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0])


def across(dimension: int) -> Blade:
    """Return a blade that comes along the first axis and crosses the other.

    Args:
        dimension: Dimension of the blade.
    """
    if dimension == 2:
        return Blade([0.5, 0.53], [1.0, 0.15])
    return Blade([0.5, 0.5, 0.53], [0.05, 1.0, -0.1], [1.0, 0.1, 0.15])
