# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Quadrature points: a Poisson-disk sample of a cage's inside, each with its share of the volume, in 2D the area.

The paper (section 6.1) takes Poisson-disk samples after Bridson 2007 and keeps gradients off the boundary. SciPy has
Bridson's algorithm for boxes. Here its draws are moved to the nearest of many candidates inside the cage, so that arms
and shells which fill little of their box cost no more than their own points and are covered to their ends. The dense
sample that the candidates come from also measures each point's volume, as that of the part of the cage nearest to it.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.ndimage import label
from scipy.spatial import cKDTree
from scipy.stats import qmc

from ..geometry import simplex_distances

_CELL_POINTS = 3  # of the dense sample in each of its cells
_CELLS = 16  # of the dense sample for each quadrature point
_PACKING = {2: 0.7, 3: 0.8}  # points in a square or cube whose side is their least distance
_DRAWS = 16  # around each point
_COUNT_TOLERANCE = 0.03
_TRIES = 12


class QuadratureCage(Protocol):
    """What the sampling needs of a cage."""

    vertices: np.ndarray
    simplices: np.ndarray
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
            (volume / count)^(1/dimension).

    Returns:
        Points, shape (point_count, dimension) [m], and their volumes, shape (point_count,), which sum to the cage's
        [m^3, in 2D m^2].

    Raises:
        ValueError: If the count is less than 1, the margin is not in [0, 1), or no point keeps the margin.
    """
    if count < 1:
        raise ValueError(f"The quadrature point count is {count}; it must be at least 1.")
    if not 0.0 <= margin < 1.0:
        raise ValueError(f"The quadrature margin is {margin}; it must lie in [0, 1).")
    rng = np.random.default_rng(seed)
    inside = _dense_inside(cage, count * _CELLS, rng)
    spacing = (cage.volume / count) ** (1.0 / inside.shape[1])
    candidates = inside[~_near_surface(inside, cage.vertices[cage.simplices], margin * spacing)]
    if not len(candidates):
        raise ValueError(
            f"No point of the cage is {margin * spacing:.6g} m away from its faces: it is too thin for {count} "
            f"quadrature points at margin {margin}. Raise the count or lower the margin."
        )
    scaled = (candidates - candidates[0]) / spacing
    points = candidates[_choose(scaled, count, len(candidates) / len(inside), rng)]
    share = np.bincount(cKDTree(points).query(inside)[1], minlength=len(points))
    return points, share * (cage.volume / len(inside))


def _near_surface(points: np.ndarray, corners: np.ndarray, distance: float) -> np.ndarray:
    """Whether each point is nearer to some segment or triangle than a distance."""
    tree, near = cKDTree(points), np.zeros(len(points), dtype=bool)
    centers = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1) + distance
    for simplex, found in enumerate(tree.query_ball_point(centers, reach)):
        near[found] |= simplex_distances(points[found], corners[[simplex]])[:, 0] < distance
    return near


def _dense_inside(cage: QuadratureCage, cell_count: int, rng: np.random.Generator) -> np.ndarray:
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


def _choose(candidates: np.ndarray, count: int, volume_share: float, rng: np.random.Generator) -> np.ndarray:
    """Indices of a Poisson-disk sample of about ``count`` candidates, in units of the mean spacing."""
    dimension = candidates.shape[1]
    radius = (_PACKING[dimension] * volume_share) ** (1.0 / dimension)
    low, high = 0.0, np.inf
    best = np.arange(len(candidates))
    for _ in range(_TRIES):
        chosen = _disks(candidates, radius, rng)
        if abs(len(chosen) - count) < abs(len(best) - count):
            best = chosen
        if abs(len(chosen) - count) <= _COUNT_TOLERANCE * count:
            break
        low, high = (radius, high) if len(chosen) > count else (low, radius)
        radius *= (len(chosen) / count) ** (1.2 / dimension)
        if not low < radius < high:
            radius = 0.5 * (low + high)
    return best


def _disks(candidates: np.ndarray, radius: float, rng: np.random.Generator) -> np.ndarray:
    """Indices of candidates no two of which are nearer than the radius, and to one of which each other one is."""
    tree = cKDTree(candidates)
    box = {"l_bounds": candidates.min(axis=0) - radius, "u_bounds": candidates.max(axis=0) + radius}
    engine = qmc.PoissonDisk(
        candidates.shape[1], radius=radius, hypersphere="volume", ncandidates=_DRAWS, rng=rng, **box
    )
    draw = engine.hypersphere_method

    def draw_candidates(center: np.ndarray, reach: float, count: int) -> np.ndarray:
        return np.concatenate([center[None], candidates[tree.query(draw(center, reach, count))[1]]])

    engine.hypersphere_method = draw_candidates
    chosen = np.zeros((0, candidates.shape[1]))
    uncovered = candidates
    while len(uncovered):
        # SciPy grows the sample from its pool, here candidates without a point near them, far from one another
        _, first = np.unique(np.floor(uncovered / (3.0 * radius)), axis=0, return_index=True)
        engine.sample_pool = list(uncovered[first])
        chosen = np.concatenate([chosen, engine.fill_space()])
        uncovered = uncovered[cKDTree(chosen).query(uncovered)[0] > (1.0 + 1e-4) * radius]
    return tree.query(chosen)[1]
