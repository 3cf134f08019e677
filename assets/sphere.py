# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A sphere in a cube: ``python -m assets.sphere`` writes sphere.usdc and sphere_cage.usda.

As many vertices and faces as SPHERE in Table 1 of the paper: an icosahedron divided five times, 10242 vertices, in a
cube of 8 vertices and 12 triangles. Metres, +Z up, 1 m across.
"""

from __future__ import annotations

import numpy as np

from assets.prism import prism_faces, split_quads
from assets.write import write_asset

LEVEL = 5
RADIUS, HALF_SIDE = 0.48, 0.5  # [m]
_FACES = (
    "0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8 3 9 4 3 4 2 3 2 6 3 6 8 3 8 9 4 9 5 2 4 11 6 "
    "2 10 8 6 7 9 8 1"
)


def icosphere(level: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a unit sphere of ``20 * 4**level`` triangles."""
    g = 0.5 * (1.0 + np.sqrt(5.0))
    rows = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0]]
    points = np.array([np.roll(row, shift) for shift in range(3) for row in rows])
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    triangles = np.array(_FACES.split(), dtype=int).reshape(-1, 3)
    for _ in range(level):
        edges = np.sort(np.concatenate([np.roll(triangles, -k, axis=1)[:, :2] for k in range(3)]), axis=1)
        unique, inverse = np.unique(edges, axis=0, return_inverse=True)
        middle = points[unique].mean(axis=1)
        ab, bc, ca = len(points) + inverse.reshape(3, -1)
        points = np.concatenate([points, middle / np.linalg.norm(middle, axis=1, keepdims=True)])
        a, b, c = triangles.T
        corners = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = np.concatenate([np.stack(part, axis=1) for part in corners])
    return points, triangles


def sphere_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(10242, 3)`` [m] and the outward triangles ``(20480, 3)`` of the sphere."""
    points, triangles = icosphere(LEVEL)
    return RADIUS * points, triangles


def sphere_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices ``(8, 3)`` [m] and the 12 triangles of the cube."""
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    corners = [np.column_stack([square, np.full(4, z)]) for z in (1, -1)]
    return HALF_SIDE * np.concatenate(corners), split_quads(prism_faces([(0, 1, 2, 3)], 4))


if __name__ == "__main__":
    write_asset("sphere", sphere_mesh(), sphere_cage())
