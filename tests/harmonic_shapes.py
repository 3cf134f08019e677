# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Points, blades and exact coordinates for the tests of harmonic coordinates, and what must hold of all of them."""

from __future__ import annotations

import numpy as np
import warp as wp

from cage_shapes import SHAPES
from newton_cagecut.cage import Cage, CageEdit, Cut, boundary_distances
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from plane_shapes import PLANES

wp.config.quiet = True

DEVICES = [str(device) for device in wp.get_devices()]

MAKERS = SHAPES | PLANES
"""Cages of both dimensions."""
UNITS = ("square", "box")
"""The unit cube of each dimension."""


def interior_points(cage: Cage, count: int, rng: np.random.Generator) -> np.ndarray:
    """Uniform points inside a cage, shape (count, dimension)."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    points = np.zeros((0, cage.dimension))
    while len(points) < count:
        drawn = rng.uniform(low, high, (4 * count, cage.dimension))
        points = np.concatenate([points, drawn[cage.contains(drawn)]])
    return points[:count]


def points_inside(cage: Cage, count: int, seed: int) -> np.ndarray:
    """Points inside a cage at some distance from its boundary, shape (count, dimension)."""
    points = interior_points(cage, 20 * count, np.random.default_rng(seed))
    return points[boundary_distances(cage, points) > 0.07 * cage.diameter][:count]


def points_near_faces(cage: Cage, distance: float, rng: np.random.Generator) -> np.ndarray:
    """A point in front of every simplex of a cage, at a distance [m] inside, shape (simplex_count, dimension)."""
    corners = cage.vertices[cage.simplices]
    normals = np.array([wall.normal for wall in cage.walls])[cage.face_wall[cage.simplex_face]]
    share = rng.dirichlet(np.full(cage.dimension, 3.0), len(corners))
    return np.einsum("ti,tij->tj", share, corners) - distance * normals


def small_obstacle(unit: Cage, middle: np.ndarray, size: float = 0.1) -> Cage:
    """A unit square or box made smaller, about a point."""
    return Cage(size * (unit.vertices - 0.5) + middle, unit.faces)


def random_blade(rng: np.random.Generator, cage: Cage) -> Blade:
    """A blade of any direction whose plane passes near the middle of a cage."""
    origin = cage.vertices.mean(axis=0) + 0.1 * cage.diameter * rng.uniform(-1.0, 1.0, cage.dimension)
    return Blade(origin, *rng.normal(size=(cage.dimension - 1, cage.dimension)))


def crossing_blade(rng: np.random.Generator, edits: list[CageEdit]) -> Blade:
    """A blade whose plane passes through what earlier edits swept."""
    swept = np.concatenate([edit.swept_simplices for edit in edits])
    middle = swept[len(swept) // 2].mean(axis=0)
    return Blade(middle, *rng.normal(size=(len(middle) - 1, len(middle))))


def middle_cut(cage: Cage) -> Cut:
    """A cut across x, from above, next to the middle of a cage."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    middle = low + (high - low) * [0.47, 0.5, 0.5][: cage.dimension]
    edge = [[0.0, 1.0, 0.0]] if cage.dimension == 3 else []
    return Cut(cage, Blade(middle, *edge, -np.eye(cage.dimension)[-1]))


def snapshot(coordinates: HarmonicCoordinates) -> dict[str, np.ndarray]:
    """All that an update brings up to date."""
    return {
        "weights": coordinates.weights,
        "gradients": coordinates.gradients,
        "degrees": coordinates.degrees,
        "bounds": coordinates.bounds,
        **coordinates.landings,
    }


def assert_identical(first: dict[str, np.ndarray], second: dict[str, np.ndarray]) -> None:
    """Assert equality bit for bit."""
    assert first.keys() == second.keys()
    for name, values in first.items():
        assert np.array_equal(values, second[name]), f"{name} differs"


def assert_reproduces(coordinates: HarmonicCoordinates, points: np.ndarray, *, gradients: bool = True) -> None:
    """Assert that weights sum to 1, give the rest position and have gradients that leave rigid motions free.

    To 1e-5 of the size and 1e-4, where float32 resolves that: next to a cut gradients can be so large that it does not.
    """
    cage, weights = coordinates.cage, coordinates.weights
    np.testing.assert_allclose(weights.sum(axis=1, dtype=np.float64), 1.0, atol=1e-5)
    np.testing.assert_allclose(weights @ cage.vertices, points, atol=1e-5 * cage.diameter)
    if gradients:
        slopes = coordinates.gradients.astype(np.float64)
        allowed = np.maximum(1e-4, 2.0**-21 * cage.diameter * np.abs(slopes).max(axis=(1, 2)))
        assert (np.abs(slopes.sum(axis=1)).max(axis=1) * cage.diameter <= allowed).all()
        identity = np.einsum("vi,pvj->pij", cage.vertices - points.mean(axis=0), slopes)
        assert (np.abs(identity - np.eye(cage.dimension)).max(axis=(1, 2)) <= allowed).all()


def mean_value(corners: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Floater's mean value coordinates of a convex polygon from angles, shape (corner_count,)."""
    offset = corners - point
    length = np.linalg.norm(offset, axis=1)
    if length.min() < 1e-12 * length.max():
        return np.eye(len(corners))[length.argmin()]
    after = np.roll(offset, -1, axis=0)
    cosine = np.einsum("ij,ij->i", offset, after) / (length * np.roll(length, -1))
    tangent = np.tan(np.arccos(np.clip(cosine, -1.0, 1.0)) / 2.0)
    weight = (np.roll(tangent, 1) + tangent) / length
    return weight / weight.sum()


def multilinear(cage: Cage, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Exact harmonic coordinates of a box or a rectangle and their gradients [1/m], shapes (n, v) and (n, v, d)."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    sign = np.where(cage.vertices > 0.5 * (low + high), 1.0, -1.0)
    factor = 0.5 + sign * ((points - 0.5 * (low + high)) / (high - low))[:, None]
    slope = sign / (high - low)
    axes = range(cage.dimension)
    gradient = np.stack([slope[:, k] * np.delete(factor, k, axis=2).prod(axis=2) for k in axes], axis=2)
    return factor.prod(axis=2), gradient


def copies(cage: Cage, points: np.ndarray, walks: int, count: int, **options) -> tuple[np.ndarray, ...]:
    """Independent weights, and gradients if asked for, copies x points x vertices: each point is there many times."""
    coordinates = HarmonicCoordinates(cage, np.repeat(points, count, axis=0), walks, cuttable=False, **options)
    return tuple(by_copy(values, count) for values in (coordinates.weights, coordinates.gradients) if len(values))


def by_copy(values: np.ndarray, count: int) -> np.ndarray:
    """Values of points that are each there so many times in a row, in float64, copies x points x the rest."""
    return values.astype(np.float64).reshape(-1, count, *values.shape[1:]).swapaxes(0, 1)


def assert_within_errors(estimates: np.ndarray, exact: np.ndarray, *, own_error: np.ndarray | float = 0.0) -> None:
    """Assert that single estimates lie within three standard errors of the exact values, but for one in a hundred.

    Args:
        estimates: Independent estimates, whose spread is the standard error of each, shape (run_count, ...).
        exact: What they are of, shape (...).
        own_error: What may be wrong with the exact values, shape (...).
    """
    allowed = 3.0 * estimates.std(axis=0, ddof=1) + own_error + 1e-6
    assert np.mean(np.abs(estimates - exact) > allowed) < 0.01


def assert_unbiased(estimates: np.ndarray, exact: np.ndarray, *, own_error: np.ndarray | float = 0.0) -> None:
    """Assert that independent estimates scatter about the exact values by their standard error and no more.

    Args:
        estimates: Estimates, shape (run_count, ...).
        exact: What they are of, shape (...).
        own_error: What may be wrong with the exact values, shape (...).
    """
    count = len(estimates)
    spread = estimates.std(axis=0, ddof=1)
    resolved = spread > 1e-6
    assert resolved.mean() > 0.9
    off = np.maximum(np.abs(estimates.mean(axis=0) - exact) - own_error, 0.0)[resolved]
    score = off / (spread[resolved] / np.sqrt(count))
    expected = np.sqrt((count - 1) / (count - 3))  # Student's t
    assert 0.6 * expected < np.sqrt(np.mean(score**2)) < 1.35 * expected
    assert np.mean(score > 3.0 * expected) < 0.02


def side_vertices(cage: Cage, wall: int, side: int) -> np.ndarray:
    """Vertices of the faces on one side of a wall, ascending."""
    faces = np.flatnonzero(cage.face_key == 2 * wall + side)
    return np.unique(np.concatenate([cage.faces[face] for face in faces]))
