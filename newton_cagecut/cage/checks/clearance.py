# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""How far a whole triangle mesh stays from the faces of a cage.

Section 3 of the paper embeds the mesh in the cage. Its vertices may all lie inside and a triangle still leave, past a
concave edge of the cage; so the distance is that of triangles from triangles.
"""

from __future__ import annotations

import numpy as np

from ...geometry import edge_distances, nearest_on_triangles
from ..cage import Cage
from .crossings import edge_pierces, near_pairs
from .inside import boundary_distances

_SAMPLE = 4096  # points that bound the distance from above, before triangles are compared
_CORNERS = ((0, 1), (1, 2), (2, 0))


def mesh_clearance(cage: Cage, points: np.ndarray, triangles: np.ndarray) -> float:
    """Least distance between a triangle mesh and the faces of a cage, zero where they cross [m].

    With all points inside the cage, a positive distance says that the whole mesh is.

    Args:
        cage: The cage, in space.
        points: Points of the mesh, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
    """
    corners = np.asarray(points, dtype=np.float64)[triangles]
    sample = corners[:: max(1, len(corners) // _SAMPLE), 0]
    least = float(boundary_distances(cage, sample).min())
    faces = cage.vertices[cage.triangles]
    for row, column in near_pairs(corners, faces, least):
        near = _plane_gaps(corners[row], faces[column]) <= least
        if near.any():
            least = min(least, float(_pair_distances(corners[row[near]], faces[column[near]]).min()))
    return least


def _plane_gaps(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Distance of triangles from the planes of others, zero where they cross, shape (pair_count,) [m]."""
    normal = np.cross(other[:, 1] - other[:, 0], other[:, 2] - other[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = np.einsum("pci,pi->pc", one - other[:, :1], normal)
    return np.maximum(np.maximum(height.min(axis=1), -height.max(axis=1)), 0.0)


def _pair_distances(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Distance between triangles, pair by pair, shape (pair_count,) [m].

    Triangles that do not cross are closest at a corner of one or at an edge of both.
    """
    least = np.full(len(one), np.inf)
    for first, second in ((one, other), (other, one)):
        for k in range(3):
            nearest = np.einsum("pk,pki->pi", nearest_on_triangles(first[:, k], second), second)
            least = np.minimum(least, np.linalg.norm(first[:, k] - nearest, axis=1))
        for i, j in _CORNERS:
            least[edge_pierces(first[:, i], first[:, j], second, 0.0)] = 0.0
    for pair in _CORNERS:
        edge = one[:, pair]
        long = (edge[:, 0] != edge[:, 1]).any(axis=1)
        for other_pair in _CORNERS:
            distance = edge_distances(edge[long], other[long][:, other_pair])
            least[long] = np.minimum(least[long], distance)
    return least
