# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Whether new faces of a cage keep off those that were there before.

Sections 3 and 8 of the paper: an edit that adds faces must leave a closed manifold that does not meet itself. Two
planar faces meet where an edge of one passes through or ends on the other, or where two edges cross; so it takes edges
against edges and, in space, vertices and edges against triangles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import PolygonMesh, edge_distances, edge_pierces, near_pairs, point_touches

if TYPE_CHECKING:
    from ..cage import Cage


def find_contact(cage: Cage, added: np.ndarray) -> tuple[int, int] | None:
    """Two faces of which one was added and one was not, and which come closer than the tolerance.

    Where faces share a vertex they may touch there, and only there.

    Args:
        cage: The cage with the new faces.
        added: Whether each face is new, shape (face_count,).

    Returns:
        The new face and the other one, None if all keep apart.
    """
    mesh = cage.mesh
    is_new = np.ones(mesh.vertex_count, dtype=bool)
    is_new[mesh.face_vertex[~added[mesh.face]]] = False
    edge_is_new = is_new[mesh.edges].any(axis=1)
    new_edges, old_edges = mesh.edges[edge_is_new], mesh.edges[~edge_is_new]
    hit = _edges_meet(mesh.vertices, new_edges, old_edges, cage.length_tolerance)
    if hit is not None:
        return _face_with(mesh, new_edges[hit[0]], added), _face_with(mesh, old_edges[hit[1]], ~added)
    if cage.dimension == 2:
        return None
    simplex_is_new = added[cage.simplex_face]
    new_triangles, old_triangles = cage.simplices[simplex_is_new], cage.simplices[~simplex_is_new]
    new_faces, old_faces = cage.simplex_face[simplex_is_new], cage.simplex_face[~simplex_is_new]
    hit = _edges_on_faces(cage, new_edges, np.flatnonzero(is_new), old_triangles, old_faces)
    if hit is not None:
        return _face_with(mesh, hit[0], added), hit[1]
    hit = _edges_on_faces(cage, old_edges, np.flatnonzero(~is_new), new_triangles, new_faces)
    return None if hit is None else (hit[1], _face_with(mesh, hit[0], ~added))


def _face_with(mesh: PolygonMesh, vertices: np.ndarray, among: np.ndarray) -> int:
    """The first of some faces that has all of some vertices."""
    count = np.bincount(mesh.face[np.isin(mesh.face_vertex, vertices)], minlength=mesh.face_count)
    return int(np.flatnonzero(among & (count >= len(vertices)))[0])


def _edges_meet(vertices: np.ndarray, one: np.ndarray, other: np.ndarray, tolerance: float) -> tuple[int, int] | None:
    """The first edge of each of two sets that come within the tolerance without a vertex in common."""
    a, b = vertices[one], vertices[other]
    for row, column in near_pairs(a, b, tolerance):
        apart = (one[row, :, None] != other[column, None, :]).all(axis=(1, 2))
        row, column = row[apart], column[apart]
        close = edge_distances(a[row], b[column]) <= tolerance
        if close.any():
            first = int(np.argmax(close))
            return int(row[first]), int(column[first])
    return None


def _edges_on_faces(
    cage: Cage, edges: np.ndarray, ends: np.ndarray, triangles: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, int] | None:
    """The first edge or vertex that meets a triangle of a face that has none of its vertices, and that face.

    Args:
        cage: The cage.
        edges: Edges, shape (edge_count, 2).
        ends: Vertices, shape (vertex_count,).
        triangles: Triangles as vertex ids, shape (triangle_count, 3).
        faces: Face of each triangle, shape (triangle_count,).
    """
    vertices, tolerance = cage.vertices, cage.length_tolerance
    corners = vertices[triangles]
    has = np.unique(cage.mesh.face * cage.vertex_count + cage.mesh.face_vertex)
    for row, column in near_pairs(vertices[ends[:, None]], corners, tolerance):
        foreign = ~np.isin(faces[column] * cage.vertex_count + ends[row], has)
        row, column = row[foreign], column[foreign]
        close = point_touches(vertices[ends[row]], corners[column], tolerance)
        if close.any():
            first = int(np.argmax(close))
            return ends[row[first : first + 1]], int(faces[column[first]])
    for row, column in near_pairs(vertices[edges], corners, tolerance):
        through = edge_pierces(*np.moveaxis(vertices[edges[row]], 1, 0), corners[column], tolerance)
        if through.any():
            first = int(np.argmax(through))
            return edges[row[first]], int(faces[column[first]])
    return None
