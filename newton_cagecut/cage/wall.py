# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Walls: the planar sheets, in 2D the lines, that stop walks.

Section 4.1 of the paper measures distances to the boundary; original faces and swept cuts are both walls here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import units
from ..section import BladePlane


@dataclass(frozen=True, eq=False)
class Wall:
    """A planar sheet, in 2D a straight line; original face ``i`` of a cage is wall ``i``, every cut appends one."""

    origin: np.ndarray
    """A point of the wall, shape (dimension,) [m]."""
    axes: np.ndarray
    """Orthonormal axes in the wall, shape (dimension - 1, dimension)."""
    normal: np.ndarray
    """Unit normal, shape (dimension,).

    In 3D it is ``axes[0] x axes[1]``, outward for an original face. In 2D an original face has it outward, to the right
    of the axis, and a cut to the left of the axis, which is the blade's direction.
    """
    two_sided: bool
    """Whether the sheet has a front and a back, as cuts do."""


def face_walls(vertices: np.ndarray, face_start: np.ndarray, face_vertex: np.ndarray, normals: np.ndarray) -> tuple:
    """The one-sided walls of a cage's original faces.

    Args:
        vertices: Positions, shape (vertex_count, dimension) [m].
        face_start: First half-edge of each face and the end of the last, shape (face_count + 1,).
        face_vertex: Vertex at which each half-edge starts, shape (half_edge_count,).
        normals: Unit outward normals, shape (face_count, dimension).

    Returns:
        One wall for each face, its first axis along the face's first edge.
    """
    size = np.diff(face_start)
    corner = vertices[face_vertex]
    origin = np.add.reduceat(corner, face_start[:-1], axis=0) / size[:, None]
    first = corner[face_start[:-1] + 1] - corner[face_start[:-1]]
    first = units(first - np.einsum("ij,ij->i", first, normals)[:, None] * normals)
    axes = first[:, None] if vertices.shape[1] == 2 else np.stack([first, np.cross(normals, first)], axis=1)
    return tuple(Wall(origin[i], axes[i], normals[i], two_sided=False) for i in range(len(size)))


def cut_wall(plane: BladePlane) -> Wall:
    """The two-sided wall that a cut along a plane leaves.

    Args:
        plane: The plane that the blade sweeps.
    """
    axes = plane.direction[None] if plane.dimension == 2 else np.stack([plane.edge, plane.across])
    return Wall(plane.origin, axes, plane.normal, two_sided=True)
