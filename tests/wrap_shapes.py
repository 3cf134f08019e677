# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes to make cages around, and what another library says of a mesh and its cage."""

from __future__ import annotations

import manifold3d
import numpy as np

from newton_cagecut.cage import Cage
from surface_shapes import icosphere

CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
CUBE_TRIANGLES = np.array(
    [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4]]
    + [[1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]]
)


def open_bowl() -> tuple[np.ndarray, np.ndarray]:
    """The lower half of a sphere, open above."""
    points, triangles = icosphere(2)
    triangles = triangles[points[triangles][:, :, 2].mean(axis=1) < 0.0]
    used, corner = np.unique(triangles, return_inverse=True)
    return points[used], corner.reshape(-1, 3)


def sheet() -> tuple[np.ndarray, np.ndarray]:
    """A flat disc of eight triangles."""
    angle = np.arange(8) * np.pi / 4.0
    points = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    return np.concatenate([points, np.zeros((1, 3))]), np.array([[8, i, (i + 1) % 8] for i in range(8)])


def two_balls(distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Two unit spheres, their centres this far apart."""
    points, triangles = icosphere(2)
    both = np.concatenate([points, points + [distance, 0.0, 0.0]])
    return both, np.concatenate([triangles, triangles + len(points)])


def solid(points: np.ndarray, triangles: np.ndarray) -> manifold3d.Manifold:
    """A closed mesh as the other library's solid, in float64."""
    made = manifold3d.Manifold(manifold3d.Mesh64(np.ascontiguousarray(points), triangles.astype(np.uint64)))
    assert made.status() == manifold3d.Error.NoError
    return made


def independent_gap(cage: Cage, points: np.ndarray, triangles: np.ndarray) -> float:
    """Distance of a closed mesh, or an open one taken twice, from what is outside the cage."""
    middle, size = cage.vertices.mean(axis=0), cage.diameter
    around = manifold3d.Manifold.cube([4.0] * 3, True) - solid((cage.vertices - middle) / size, cage.triangles)
    return size * around.min_gap(solid(*closed_twice((points - middle) / size, triangles)), 4.0)


def closed_twice(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mesh itself if it is closed; otherwise both its sides, joined along its rim."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    rim = np.zeros(len(points), dtype=bool)
    rim[unique[count == 1]] = True
    if not rim.any():
        return points, triangles
    back = np.where(rim, np.arange(len(points)), len(points) + np.cumsum(~rim) - 1)
    return np.concatenate([points, points[~rim]]), np.concatenate([triangles, back[triangles[:, ::-1]]])
