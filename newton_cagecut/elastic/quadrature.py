# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Quadrature points: a Poisson-disk sample of a cage's inside, each with its share of the volume.

The paper (section 6.1) takes Poisson-disk samples after Bridson 2007 and keeps gradients off the boundary. Here, random
dart throwing over a dense, evenly distributed sample of the inside gives the same property in cages that fill
little of their bounding box (arms, shells), with the wanted count met to a few per cent; the dense sample then also
measures each point's volume, as that of the part of the cage nearest to it.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

_DENSITY = 48
_BISECTIONS = 14
_CHUNK = 1 << 18


class QuadratureCage(Protocol):
    """What the sampling needs of a cage."""

    vertices: np.ndarray
    triangles: np.ndarray
    volume: float

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points lie inside."""


def sample_quadrature(
    cage: QuadratureCage, count: int, *, seed: int = 0, margin: float = 0.25
) -> tuple[np.ndarray, np.ndarray]:
    """Spread quadrature points over the inside of a cage.

    Args:
        cage: The cage.
        count: Wanted number of points; the sample has about as many.
        seed: Seed of the sample.
        margin: Least distance of a point from the cage's faces, in units of the mean spacing
            (volume / count)^(1/3).

    Returns:
        Points, shape (point_count, 3) [m], and their volumes, shape (point_count,) [m^3], which sum to the cage's.

    Raises:
        ValueError: If the count is less than 1, the margin is not in [0, 1), or no point keeps the margin.
    """
    if count < 1:
        raise ValueError(f"The quadrature point count is {count}; it must be at least 1.")
    if not 0.0 <= margin < 1.0:
        raise ValueError(f"The quadrature margin is {margin}; it must lie in [0, 1).")
    rng = np.random.default_rng(seed)
    inside = _dense_inside(cage, count * _DENSITY, rng)
    spacing = (cage.volume / count) ** (1.0 / 3.0)
    near = surface_distances(inside, cage.vertices[cage.triangles]) < margin * spacing
    candidates = rng.permutation(inside[~near])
    if not len(candidates):
        raise ValueError(
            f"No point of the cage is {margin * spacing:.6g} m away from its faces: it is too thin for {count} "
            f"quadrature points at margin {margin}. Raise the count or lower the margin."
        )
    points = candidates[_dart_throw(candidates, count, spacing)]
    share = np.bincount(cKDTree(points).query(inside)[1], minlength=len(points))
    return points, share * (cage.volume / len(inside))


def surface_distances(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distance of each point to the nearest triangle, shape (point_count,) [m].

    Args:
        points: Points, shape (point_count, 3) [m].
        corners: Triangles, shape (triangle_count, 3, 3) [m].
    """
    result = np.empty(len(points))
    step = max(1, _CHUNK // len(corners))
    for begin in range(0, len(points), step):
        result[begin : begin + step] = _triangle_distances(points[begin : begin + step], corners).min(axis=1)
    return result


def _triangle_distances(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distance of each point to each triangle: to its plane over the triangle, else to its nearest edge."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    above = np.broadcast_to(lengths > 0.0, (len(points), len(corners))).copy()
    edge_distance = np.full(above.shape, np.inf)
    for k in range(3):
        start, edge = corners[:, k], corners[:, (k + 1) % 3] - corners[:, k]
        offset = points[:, None] - start
        parameter = np.einsum("ptc,tc->pt", offset, edge)
        parameter = np.clip(parameter / np.maximum(np.einsum("tc,tc->t", edge, edge), 1e-300), 0.0, 1.0)
        gap = offset - parameter[..., None] * edge
        edge_distance = np.minimum(edge_distance, np.einsum("ptc,ptc->pt", gap, gap))
        above &= np.einsum("ptc,tc->pt", offset, np.cross(normals, edge)) >= 0.0
    plane_distance = np.abs(np.einsum("ptc,tc->pt", points[:, None] - corners[:, 0], normals))
    return np.where(above, plane_distance, np.sqrt(edge_distance))


def _dense_inside(cage: QuadratureCage, count: int, rng: np.random.Generator) -> np.ndarray:
    """About ``count`` points spread evenly over the cage's inside (an additive recurrence with plastic steps)."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    dimension = len(low)
    root = 2.0
    for _ in range(64):
        root = (1.0 + root) ** (1.0 / (dimension + 1))
    box_count = int(np.ceil(count * np.prod(high - low) / cage.volume))
    steps = root ** -np.arange(1.0, dimension + 1.0)
    unit = (rng.random(dimension) + np.arange(box_count)[:, None] * steps) % 1.0
    points = low + unit * (high - low)
    return points[cage.contains(points)]


def _dart_throw(candidates: np.ndarray, count: int, spacing: float) -> np.ndarray:
    """Indices of a maximal Poisson-disk subset of about ``count`` candidates: the disk's radius is bisected."""
    tree = cKDTree(candidates)
    low, high = 0.0, 2.0 * spacing
    best = np.arange(len(candidates))
    for _ in range(_BISECTIONS):
        radius = 0.5 * (low + high)
        chosen = _throw_once(tree, radius)
        if abs(len(chosen) - count) < abs(len(best) - count):
            best = chosen
        if len(chosen) == count:
            break
        low, high = (radius, high) if len(chosen) > count else (low, radius)
    return best


def _throw_once(tree: cKDTree, radius: float) -> np.ndarray:
    """Take the candidates in order, each unless one taken before is nearer than the radius."""
    blocked = np.zeros(tree.n, dtype=bool)
    chosen = []
    for index in range(tree.n):
        if not blocked[index]:
            chosen.append(index)
            blocked[tree.query_ball_point(tree.data[index], radius)] = True
    return np.array(chosen)
