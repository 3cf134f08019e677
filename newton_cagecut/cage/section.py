# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The section of a polygon mesh with the plane of a blade.

Section 5.2 of the paper. Nodes are crossed edges, chords run from node to node through faces, with the inside of the
mesh to the left seen against the plane's normal. Which crossings a chord joins is decided by entering and leaving,
never by comparing positions of features that coincide; so earlier cuts, whose two sides coincide, need no care.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .blade import BladePlane
from .pairing import alternate
from .polygon_mesh import PolygonMesh


class Section:
    """Nodes and chords of a plane's section; vertices at distance zero count as being on the positive side."""

    def __init__(self, mesh: PolygonMesh, plane: BladePlane, *, face_group: np.ndarray | None = None):
        """Cut a mesh's edges with a plane.

        Args:
            mesh: The polygons, closed or open.
            plane: The plane.
            face_group: Number of the solid that each face bounds, where solids may overlap, shape (face_count,).
        """
        self.mesh = mesh
        self.plane = plane
        self._face_group = face_group
        distance = plane.distance(mesh.vertices)
        positive = distance >= 0.0
        starts_positive = positive[mesh.face_vertex]
        self.half_edge = np.flatnonzero(starts_positive != starts_positive[mesh.next])
        """Crossed half-edges, ascending, shape (crossing_count,)."""
        self._goes_down = starts_positive[self.half_edge]
        self._number_nodes(distance)
        self._join_chords()

    def _number_nodes(self, distance: np.ndarray) -> None:
        mesh, half_edge = self.mesh, self.half_edge
        twin = mesh.twin[half_edge]
        representative = np.where(twin >= 0, np.minimum(twin, half_edge), half_edge)
        self.node_half_edge, self.node_of = np.unique(representative, return_inverse=True)
        start, end = mesh.face_vertex[self.node_half_edge], mesh.destination[self.node_half_edge]
        down = distance[start] >= 0.0
        self.node_above = np.where(down, start, end)
        """Vertex on the positive side of each node's edge, shape (node_count,)."""
        self.node_below = np.where(down, end, start)
        """Vertex on the negative side of each node's edge, shape (node_count,)."""
        above, below = mesh.vertices[self.node_above], mesh.vertices[self.node_below]
        top, bottom = distance[self.node_above], distance[self.node_below]
        self.node_fraction = top / (top - bottom)
        """Place of each node between its edge's ends, 0 at the positive one, shape (node_count,)."""
        self.node_position = above + self.node_fraction[:, None] * (below - above)
        """Positions, shape (node_count, 3) [m]."""
        self.node_coordinates = self.plane.coordinates(self.node_position)
        """Coordinates (a, s) in the plane, shape (node_count, 2) [m]."""

    def _join_chords(self) -> None:
        """Pair the crossings of each face."""
        face = self.mesh.face[self.half_edge]
        slot = np.arange(len(face))
        down, up = slot[self._goes_down], slot[~self._goes_down]
        count = np.bincount(face, minlength=self.mesh.face_count) // 2
        crowded = count > 1
        plain_down, plain_up = down[~crowded[face[down]]], up[~crowded[face[up]]]
        pairs = [np.stack([plain_down, plain_up], axis=1)]
        for f in np.flatnonzero(crowded).tolist():
            pairs.append(self._pair_along_face(f, slot[face == f]))
        joined = np.concatenate(pairs)
        joined = joined[np.argsort(joined[:, 0], kind="stable")]
        self.chord_slot = joined
        """Crossings (positions in :attr:`half_edge`) from and to which each chord runs, shape (chord_count, 2)."""
        self.chord_face = face[joined[:, 0]]
        """Face through which each chord runs, shape (chord_count,)."""
        self.chord_node = self.node_of[joined]
        """Nodes from and to which each chord runs, shape (chord_count, 2)."""

    def _pair_along_face(self, face: int, slots: np.ndarray) -> np.ndarray:
        line = np.cross(self.plane.normal, self.mesh.face_area_vector[face])
        position = (
            self.node_position[self.node_of[slots]]
            - self.mesh.vertices[self.mesh.face_vertex[self.mesh.face_start[face]]]
        )
        along = position[:, 0] * line[0] + position[:, 1] * line[1] + position[:, 2] * line[2]
        return slots[np.array(alternate(along, self._goes_down[slots]))]

    @property
    def node_count(self) -> int:
        """Number of crossed edges."""
        return len(self.node_half_edge)

    @property
    def chord_count(self) -> int:
        """Number of chords."""
        return len(self.chord_face)

    @cached_property
    def chord_next(self) -> np.ndarray:
        """Chord that continues each chord through the next face, -1 at an open edge, shape (chord_count,)."""
        chord_at = np.full(len(self.half_edge), -1)
        chord_at[self.chord_slot[:, 0]] = np.arange(self.chord_count)
        twin = self.mesh.twin[self.half_edge[self.chord_slot[:, 1]]]
        slot = np.searchsorted(self.half_edge, twin)
        return np.where(twin >= 0, chord_at[np.minimum(slot, len(chord_at) - 1)], -1)

    @cached_property
    def chord_loop(self) -> np.ndarray:
        """Number of the closed loop that each chord belongs to, -1 in open chains, shape (chord_count,)."""
        loop = np.full(self.chord_count, -2)
        following = self.chord_next.tolist()
        entered = np.zeros(self.chord_count, dtype=bool)
        entered[self.chord_next[self.chord_next >= 0]] = True
        for start in np.flatnonzero(~entered).tolist():
            chord = start
            while chord >= 0:
                loop[chord] = -1
                chord = following[chord]
        count = 0
        for start in range(self.chord_count):
            chord = start
            if loop[chord] != -2:
                continue
            while loop[chord] == -2:
                loop[chord] = count
                chord = following[chord]
            count += 1
        return loop

    @cached_property
    def chord_group(self) -> np.ndarray:
        """Number of the solid whose surface each chord runs through, shape (chord_count,)."""
        if self._face_group is None:
            return np.zeros(self.chord_count, dtype=np.int64)
        return self._face_group[self.chord_face]

    @cached_property
    def node_rank(self) -> np.ndarray:
        """Place of each node in the order in which the front reaches them, shape (node_count,)."""
        rank = np.empty(self.node_count, dtype=np.int64)
        rank[np.argsort(self.node_coordinates[:, 1], kind="stable")] = np.arange(self.node_count)
        return rank

    @cached_property
    def chord_ends(self) -> np.ndarray:
        """Nodes of each chord in the order in which the front reaches them, shape (chord_count, 2)."""
        swap = self.node_rank[self.chord_node[:, 0]] > self.node_rank[self.chord_node[:, 1]]
        return np.where(swap[:, None], self.chord_node[:, ::-1], self.chord_node)

    def chord_points(self, front: float, chords: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points at which chords cross the front.

        Args:
            front: Coordinate s of the front [m].
            chords: Chords of which one end is reached and one is not, shape (count,).

        Returns:
            Positions, shape (count, 3) [m], and coordinates (a, s), shape (count, 2) [m].
        """
        low, high = self.chord_ends[chords].T
        s_low, s_high = self.node_coordinates[low, 1], self.node_coordinates[high, 1]
        t = ((front - s_low) / (s_high - s_low))[:, None]
        position = self.node_position[low] + t * (self.node_position[high] - self.node_position[low])
        coordinates = self.node_coordinates[low] + t * (self.node_coordinates[high] - self.node_coordinates[low])
        coordinates[:, 1] = front
        return position, coordinates
