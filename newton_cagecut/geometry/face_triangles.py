# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangles of a mesh's planar faces.

Triangles and strictly convex faces are done together; what cutting made of a face (section 5.1 of the paper) is done
one by one.
"""

from __future__ import annotations

import numpy as np

from .polygon_mesh import PolygonMesh
from .triangulate import triangulate

_CONVEX = 1e-9


def triangulate_faces(mesh: PolygonMesh, corner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangulate every face.

    Args:
        mesh: The polygons.
        corner: In-plane coordinates of the half-edges' origins, faces counterclockwise, shape (half_edge_count, 2) [m].

    Returns:
        Triangles of vertex ids, shape (triangle_count, 3), and the face of each, shape (triangle_count,), sorted.
    """
    parts, owners = [], []
    convex = _strictly_convex(mesh, corner)
    for size in np.unique(mesh.face_size[convex]):
        faces = np.flatnonzero(convex & (mesh.face_size == size))
        step = np.arange(1, size - 1)
        local = np.stack([np.zeros_like(step), step, step + 1], axis=1)
        parts.append((mesh.face_start[faces][:, None, None] + local).reshape(-1, 3))
        owners.append(np.repeat(faces, size - 2))
    for face in np.flatnonzero(~convex).tolist():
        begin, end = mesh.face_start[face], mesh.face_start[face + 1]
        parts.append(begin + triangulate(corner[begin:end]))
        owners.append(np.full(end - begin - 2, face))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return mesh.face_vertex[np.concatenate(parts)[order]], owner[order]


def _strictly_convex(mesh: PolygonMesh, corner: np.ndarray) -> np.ndarray:
    """Faces that turn left at every corner, once around."""
    out = corner[mesh.next] - corner
    into = np.empty_like(out)
    into[mesh.next] = out
    turn = into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0]
    limit = _CONVEX * np.hypot(*into.T) * np.hypot(*out.T)
    left = np.logical_and.reduceat(turn > limit, mesh.face_start[:-1])
    angle = np.add.reduceat(np.arctan2(turn, np.einsum("ij,ij->i", into, out)), mesh.face_start[:-1])
    return (left & (angle < 3.0 * np.pi)) | (mesh.face_size == 3)
