# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The front of an earlier cut, from which a further cut goes on in another plane.

Section 5.2 of the paper cuts along one plane. A scalpel follows a curve: each further strip begins at the front line of
the strip before it, where the two sides of that strip meet, and takes them apart there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .blade import BladePlane
from .polygon_mesh import PolygonMesh

_STRAIGHT = 1e-9


@dataclass(frozen=True, eq=False)
class Hinge:
    """Edges and vertices of a mesh on the line ``s = 0`` of the plane that goes on from there."""

    edges: np.ndarray
    """Half-edges along the front in faces of the earlier cut's negative side, shape (edge_count,)."""
    vertices: np.ndarray
    """Vertices on the front, ascending, shape (vertex_count,)."""

    @classmethod
    def of(cls, mesh: PolygonMesh, face_key: np.ndarray, wall: int, on_front: np.ndarray) -> Hinge:
        """Find the front of a cut.

        Args:
            mesh: The polygons as they are now.
            face_key: ``2 * wall + side`` of each face, shape (face_count,).
            wall: Wall of the earlier cut.
            on_front: Whether each vertex lies on the front line and is one that the cut made, shape (vertex_count,).
        """
        key = face_key[mesh.face]
        along = (mesh.twin >= 0) & on_front[mesh.face_vertex] & on_front[mesh.destination]
        edges = np.flatnonzero(along & (key == 2 * wall) & (key[mesh.twin] == 2 * wall + 1))
        return cls(edges, np.flatnonzero(on_front))


def corner_ahead(mesh: PolygonMesh, corners: list[int], plane: BladePlane) -> int:
    """The corner, of several at one vertex, into which the plane goes on.

    Bridges and slits that end at the vertex divide its face's angle there.

    Args:
        mesh: The polygons.
        corners: Half-edges that start at the vertex.
        plane: The plane, with the vertex at ``s = 0``.
    """
    best, least = corners[0], np.inf
    for corner in corners:
        here = mesh.vertices[mesh.face_vertex[corner]]
        normal = mesh.face_area_vector[mesh.face[corner]]
        normal = normal / np.linalg.norm(normal)
        ahead = np.cross(plane.normal, normal)
        ahead *= np.sign(ahead @ np.cross(plane.normal, plane.edge))
        out = mesh.vertices[mesh.destination[corner]] - here
        back = mesh.vertices[mesh.face_vertex[_previous(mesh, corner)]] - here
        turn, whole = _angle(out, ahead, normal), _angle(out, back, normal)
        whole = whole if whole > _STRAIGHT else 2.0 * np.pi
        excess = max(0.0, turn - whole)
        if min(excess, 2.0 * np.pi - turn) < least:
            best, least = corner, min(excess, 2.0 * np.pi - turn)
    return best


def _angle(one: np.ndarray, other: np.ndarray, normal: np.ndarray) -> float:
    """Angle from one direction to another, counterclockwise about a normal, from 0 to 2 pi."""
    return float(np.arctan2(np.cross(one, other) @ normal, one @ other) % (2.0 * np.pi))


def corners_to_part(mesh: PolygonMesh, edges: np.ndarray, corner: int, down: bool) -> list[int]:
    """Corners around a hinge's vertex that go with the negative side.

    Args:
        mesh: The polygons.
        edges: Half-edges of the hinge and their twins, shape (edge_count,).
        corner: The half-edge from the vertex in the face into which the cut goes on; that corner is not listed.
        down: Whether that face is walked from the positive to the negative side there.

    Returns:
        Half-edges that start at the vertex.
    """
    stop, found = set(edges.tolist()), []
    while True:
        crossed = corner if down else _previous(mesh, corner)
        other = int(mesh.twin[crossed])
        if crossed in stop or other < 0:
            return found
        corner = int(mesh.next[other]) if down else other
        found.append(corner)


def _previous(mesh: PolygonMesh, half_edge: int) -> int:
    begin, end = mesh.face_start[mesh.face[half_edge]], mesh.face_start[mesh.face[half_edge] + 1]
    return int(half_edge - 1 if half_edge > begin else end - 1)
