# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The front of an earlier cut, from which a further cut goes on in another plane.

Section 5.2 of the paper cuts along one plane. A scalpel follows a curve: each further strip begins at the front line of
the strip before it, where the two sides of that strip meet, and takes them apart there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .polygon_mesh import PolygonMesh


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
