# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Walls: the planar sheets that stop walks.

Section 4.1 of the paper measures distances to the boundary; original faces and swept cuts are both walls here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Wall:
    """A planar sheet; original face ``i`` of a cage is wall ``i``, every cut appends one."""

    origin: np.ndarray
    """A point of the plane, shape (3,) [m]."""
    axes: np.ndarray
    """Orthonormal axes in the plane, shape (2, 3)."""
    normal: np.ndarray
    """Unit normal, ``axes[0] x axes[1]``; outward for an original face, shape (3,)."""
    two_sided: bool
    """Whether the sheet has a front and a back, as cuts do."""


def face_walls(vertices: np.ndarray, face_start: np.ndarray, face_vertex: np.ndarray, normals: np.ndarray) -> tuple:
    """The one-sided walls of a cage's original faces.

    Args:
        vertices: Positions, shape (vertex_count, 3) [m].
        face_start: First half-edge of each face and the end of the last, shape (face_count + 1,).
        face_vertex: Vertex at which each half-edge starts, shape (half_edge_count,).
        normals: Unit outward normals, shape (face_count, 3).

    Returns:
        One wall for each face, its first axis along the face's first edge.
    """
    size = np.diff(face_start)
    corner = vertices[face_vertex]
    origin = np.add.reduceat(corner, face_start[:-1], axis=0) / size[:, None]
    first = corner[face_start[:-1] + 1] - corner[face_start[:-1]]
    first -= np.einsum("ij,ij->i", first, normals)[:, None] * normals
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(normals, first)
    axes = np.stack([first, second], axis=1)
    return tuple(Wall(origin[i], axes[i], normals[i], two_sided=False) for i in range(len(size)))
