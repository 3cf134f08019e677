# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The front of an earlier cut, from which a further cut goes on in another plane.

Section 5.2 of the paper cuts along one plane. A scalpel follows a curve: each further strip begins at the front line of
the strip before it, where the two sides of that strip meet, and takes them apart there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import PolygonMesh
from .blade import BladePlane

_STRAIGHT = 1e-9
_ROUNDING = 1e-12


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
        ahead = _ahead_in(plane, normal)
        out = mesh.vertices[mesh.destination[corner]] - here
        back = mesh.vertices[mesh.face_vertex[_previous(mesh, corner)]] - here
        turn, whole = _angle(out, ahead, normal), _angle(out, back, normal)
        whole = whole if whole > _STRAIGHT else 2.0 * np.pi
        excess = max(0.0, turn - whole)
        if min(excess, 2.0 * np.pi - turn) < least:
            best, least = corner, min(excess, 2.0 * np.pi - turn)
    return best


def crosses_ahead(
    mesh: PolygonMesh, plane: BladePlane, on_hinge: np.ndarray, half_edge: np.ndarray, s: np.ndarray
) -> np.ndarray:
    """Whether half-edges cross the plane ahead of the hinge, the same for twins, shape (count,).

    Where a crossing is as near to the hinge's line as rounding, as edges of a regular mesh on which the front lies are,
    its face tells: the plane leaves the face of a hinge's vertex ahead if it goes outward, and passes another face as a
    whole ahead or behind.

    Args:
        mesh: The polygons.
        plane: The plane, with the hinge at ``s = 0``.
        on_hinge: Whether each vertex is the hinge's, shape (vertex_count,).
        half_edge: Half-edges that cross the plane, without ends on the hinge, shape (count,).
        s: Coordinate s of where they do, shape (count,) [m].
    """
    ahead = s > 0.0
    close = np.flatnonzero(np.abs(s) <= _ROUNDING * np.ptp(mesh.vertices, axis=0).max())
    if not len(close):
        return ahead
    has_hinge = np.logical_or.reduceat(on_hinge[mesh.face_vertex], mesh.face_start[:-1])
    place, open_ones = {h: i for i, h in enumerate(half_edge.tolist())}, set(half_edge[close].tolist())
    of_face: dict[int, list[int]] = {}
    for h in half_edge[np.isin(mesh.face[half_edge], mesh.face[half_edge[close]])].tolist():
        of_face.setdefault(int(mesh.face[h]), []).append(h)
    while open_ones:
        told = {}
        for h in sorted(open_ones):
            face = int(mesh.face[h])
            others = [other for other in of_face[face] if other != h]
            if has_hinge[face]:
                told[h] = _leaves_through(mesh, plane, h)
            elif len(others) == 1 and others[0] not in open_ones:
                told[h] = ahead[place[others[0]]]
        if not told:
            break
        for h, value in told.items():
            for one in (h, int(mesh.twin[h])):
                if one in open_ones:
                    ahead[place[one]] = value
                    open_ones.discard(one)
    return ahead


def _leaves_through(mesh: PolygonMesh, plane: BladePlane, half_edge: int) -> bool:
    """Whether the plane, as it goes ahead, leaves the half-edge's face through it."""
    sides = [half_edge] if mesh.twin[half_edge] < 0 else [half_edge, int(mesh.twin[half_edge])]
    normal = max(mesh.face_area_vector[mesh.face[sides]], key=np.linalg.norm)
    along = mesh.vertices[mesh.destination[half_edge]] - mesh.vertices[mesh.face_vertex[half_edge]]
    return bool(np.cross(along, normal) @ _ahead_in(plane, normal) > 0.0)


def _ahead_in(plane: BladePlane, normal: np.ndarray) -> np.ndarray:
    """Direction in which the plane goes ahead within a face of some normal."""
    ahead = np.cross(plane.normal, normal)
    return ahead * np.sign(ahead @ plane.across)


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
