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

from ..geometry import PolygonMesh
from .blade import BladePlane
from .hinge import Hinge, corner_ahead, corners_to_part, crosses_ahead
from .pairing import alternate


class Section:
    """Nodes and chords of a plane's section; vertices at distance zero count as being on the positive side.

    With a hinge, only what lies at ``s > 0`` counts, and the section begins at the hinge's vertices.
    """

    window: tuple[float, float, float] | None = None
    """Heel, tip and start of a knife where they are, off the nodes; None for a blade without [m]."""

    def __init__(
        self,
        mesh: PolygonMesh,
        plane: BladePlane,
        *,
        face_group: np.ndarray | None = None,
        hinge: Hinge | None = None,
        tolerance: float = 0.0,
    ):
        """Cut a mesh's edges with a plane.

        Args:
            mesh: The polygons, closed or open.
            plane: The plane.
            face_group: Number of the solid that each face bounds, where solids may overlap, shape (face_count,).
            hinge: Front of an earlier cut from which this one goes on, at ``s = 0``.
            tolerance: Distance up to which vertices count as on the plane [m].
        """
        self.mesh = mesh
        self.plane = plane
        self._face_group = face_group
        distance = plane.distance(mesh.vertices)
        distance[np.abs(distance) <= tolerance] = 0.0
        positive = distance >= 0.0
        starts_positive = positive[mesh.face_vertex]
        crosses = starts_positive != starts_positive[mesh.next]
        if hinge is not None:
            on_hinge = np.zeros(mesh.vertex_count, dtype=bool)
            on_hinge[hinge.vertices] = True
            crosses &= ~(on_hinge[mesh.face_vertex] | on_hinge[mesh.destination])
        half_edge = np.flatnonzero(crosses)
        if hinge is not None:
            points = _crossings(mesh, distance, half_edge)
            half_edge = half_edge[crosses_ahead(mesh, plane, on_hinge, half_edge, points)]
        self.arrive = half_edge
        """Crossed half-edges, ascending, and then those that arrive at the hinge, shape (crossing_count,)."""
        self.leave = mesh.next[half_edge]
        """Half-edge with which the loop goes on after each crossing, shape (crossing_count,)."""
        self._ordinary_count = len(half_edge)
        self._goes_down = starts_positive[half_edge]
        self._number_nodes(distance)
        self.parted = np.zeros(0, dtype=np.int64)
        """Corners of which the vertex goes to the negative side where a hinge opens."""
        self.parted_node = np.zeros(0, dtype=np.int64)
        """Node of each of them."""
        self.hinge_corner = np.zeros(0, dtype=np.int64)
        """Corners at the hinge's vertices in the faces into which the section goes on."""
        hinge_chords = np.zeros((0, 2), dtype=np.int64)
        if hinge is not None:
            hinge_chords = self._add_hinge(hinge)
        self._join_chords(hinge_chords)

    def _number_nodes(self, distance: np.ndarray) -> None:
        mesh, half_edge = self.mesh, self.arrive
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
        self.node_vertex = np.full(len(start), -1)
        """Vertex of the mesh that each node is, -1 for crossed edges, shape (node_count,)."""

    def _add_hinge(self, hinge: Hinge) -> np.ndarray:
        """Add nodes at the hinge's vertices, and crossings in the faces into which the section goes on from them.

        Those are the faces that the plane enters and does not leave, or the other way round.

        Returns:
            Nodes from and to which the section runs along the hinge, shape (edge_count, 2).
        """
        mesh, plain = self.mesh, self.node_count
        balance = np.bincount(
            mesh.face[self.arrive], weights=np.where(self._goes_down, 1.0, -1.0), minlength=mesh.face_count
        )
        at = np.full(mesh.vertex_count, -1)
        at[hinge.vertices] = np.arange(len(hinge.vertices))
        corner = np.flatnonzero((at[mesh.face_vertex] >= 0) & (balance[mesh.face] != 0.0))
        _, chosen, count = np.unique(mesh.face_vertex[corner], return_index=True, return_counts=True)
        several = mesh.face_vertex[corner[chosen[count > 1]]].tolist()
        of_several = {vertex: corner[mesh.face_vertex[corner] == vertex].tolist() for vertex in several}
        corner = corner[chosen]
        corner[count > 1] = [corner_ahead(mesh, of_several[vertex], self.plane) for vertex in several]
        self.hinge_corner = corner
        if len(corner) != np.abs(balance).sum():
            raise ValueError(
                "the section does not close at the front of the cut before it: faces "
                f"{np.flatnonzero(balance).tolist()[:4]} have no corner of their own there; move the blade a "
                "little, or begin a new cut where the cage has grown across the front"
            )
        vertex = mesh.face_vertex[corner]
        edges = np.concatenate([hinge.edges, mesh.twin[hinge.edges]])
        down = balance[mesh.face[corner]] < 0.0
        parted = [corners_to_part(mesh, edges, *item) for item in zip(corner.tolist(), down.tolist(), strict=True)]
        self.parted = np.array([c for part in parted for c in part], dtype=np.int64)
        nodes = plain + np.arange(len(corner))
        self.parted_node = np.repeat(nodes, [len(part) for part in parted])
        previous = np.empty_like(mesh.next)
        previous[mesh.next] = np.arange(len(previous))
        self.arrive = np.concatenate([self.arrive, previous[corner]])
        self.leave = np.concatenate([self.leave, mesh.next[corner]])
        self._goes_down = np.concatenate([self._goes_down, down])
        self.node_of = np.concatenate([self.node_of, nodes])
        position = mesh.vertices[vertex]
        coordinates = self.plane.coordinates(position)
        coordinates[:, 1] = 0.0
        self.node_half_edge = np.concatenate([self.node_half_edge, corner])
        self.node_above, self.node_below = (np.concatenate([ids, vertex]) for ids in (self.node_above, self.node_below))
        self.node_fraction = np.concatenate([self.node_fraction, np.zeros(len(corner))])
        self.node_position = np.concatenate([self.node_position, position])
        self.node_coordinates = np.concatenate([self.node_coordinates, coordinates])
        self.node_vertex = np.concatenate([self.node_vertex, vertex])
        node_at = np.full(mesh.vertex_count, -1)
        node_at[vertex] = nodes
        chords = np.stack([node_at[mesh.destination[hinge.edges]], node_at[mesh.face_vertex[hinge.edges]]], axis=1)
        if (chords < 0).any():
            raise ValueError("the plane does not go on from all of the front of the cut before it; turn it less")
        return chords

    def _join_chords(self, hinge_chords: np.ndarray) -> None:
        """Pair the crossings of each face; chords along the hinge, which are in no face, come last."""
        face = self.mesh.face[self.arrive]
        slot = np.arange(len(face))
        down, up = slot[self._goes_down], slot[~self._goes_down]
        count = np.bincount(face, minlength=self.mesh.face_count) // 2
        crowded = count > 1
        plain_down, plain_up = down[~crowded[face[down]]], up[~crowded[face[up]]]
        plain_down = plain_down[np.argsort(face[plain_down], kind="stable")]
        plain_up = plain_up[np.argsort(face[plain_up], kind="stable")]
        pairs = [np.stack([plain_down, plain_up], axis=1)]
        for f in np.flatnonzero(crowded).tolist():
            pairs.append(self._pair_along_face(f, slot[face == f]))
        joined = np.concatenate(pairs)
        joined = joined[np.argsort(joined[:, 0], kind="stable")]
        none = np.full_like(hinge_chords, -1)
        self.chord_slot = np.concatenate([joined, none])
        """Crossings from and to which each chord runs, -1 along the hinge, shape (chord_count, 2)."""
        self.chord_face = np.concatenate([face[joined[:, 0]], none[:, 0]])
        """Face through which each chord runs, -1 along the hinge, shape (chord_count,)."""
        self.chord_node = np.concatenate([self.node_of[joined], hinge_chords])
        """Nodes from and to which each chord runs, shape (chord_count, 2)."""

    def _pair_along_face(self, face: int, slots: np.ndarray) -> np.ndarray:
        line = np.cross(self.plane.normal, self.mesh.face_area_vector[face])
        position = (
            self.node_position[self.node_of[slots]]
            - self.mesh.vertices[self.mesh.face_vertex[self.mesh.face_start[face]]]
        )
        along = position[:, 0] * line[0] + position[:, 1] * line[1] + position[:, 2] * line[2]
        return slots[np.array(alternate(along, self._goes_down[slots]))]

    def node_values(self, values: np.ndarray) -> np.ndarray:
        """Values at the nodes from those at the vertices, linear along the edges.

        Args:
            values: Values of the mesh's vertices, shape (vertex_count, ...).

        Returns:
            Values, shape (node_count, ...).
        """
        above, below = values[self.node_above], values[self.node_below]
        return above + self.node_fraction[:, None] * (below - above)

    @cached_property
    def node_pinned(self) -> np.ndarray:
        """Whether both sides of the cut share the node, which no edge crosses, shape (node_count,)."""
        return np.zeros(self.node_count, dtype=bool)

    @property
    def tipped(self) -> np.ndarray:
        """Whether a chord has a vertex where the front crosses it, which those along a hinge have not."""
        return self.chord_face >= 0

    @cached_property
    def chord_swells(self) -> np.ndarray:
        """Whether the slit along a chord gets a vertex on each side to open at, shape (chord_count,)."""
        return np.zeros(self.chord_count, dtype=bool)

    @cached_property
    def chord_hubs(self) -> np.ndarray:
        """Whether a chord's vertices on each side stand off it, in the opened faces, shape (chord_count,)."""
        return np.zeros(self.chord_count, dtype=bool)

    @cached_property
    def chord_bulges(self) -> np.ndarray:
        """Whether a chord gets a vertex on each side once it is open.

        That is so beside a border that touches no face, and to tell a chord from its loop's only other chord: such
        loops go around cuts of finite width that the plane crosses.
        """
        bulges = self.chord_hubs.copy()
        closed = np.flatnonzero(self.chord_loop >= 0)
        loops, first, count = np.unique(self.chord_loop[closed], return_index=True, return_counts=True)
        pairs = closed[first[count == 2]]
        bulges[pairs] = ~self.node_pinned[self.chord_node[pairs]].any(axis=1) & (self.chord_face[pairs] >= 0)
        return bulges

    @property
    def hinge_arrive(self) -> np.ndarray:
        """Half-edges that arrive at the hinge's corners, shape (corner_count,)."""
        return self.arrive[self._ordinary_count :]

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
        mesh, slots, plain = self.mesh, self.chord_slot, self._ordinary_count
        chord_at = np.full(len(self.arrive) + 1, -1)
        in_face = np.flatnonzero(self.chord_face >= 0)
        chord_at[slots[in_face, 0]] = in_face
        end = slots[in_face, 1]
        twin = np.where(end < plain, mesh.twin[self.arrive[end]], -1)
        slot = np.searchsorted(self.arrive[:plain], twin)
        following = np.full(self.chord_count, -1)
        following[in_face] = np.where(twin >= 0, chord_at[np.minimum(slot, plain)], -1)
        along = np.flatnonzero(self.chord_face < 0)
        if len(along):
            node_chord = np.full(self.node_count, -1)
            node_chord[self.chord_node[along, 0]] = along
            ends_there = in_face[end >= plain]
            following[ends_there] = node_chord[self.chord_node[ends_there, 1]]
            starts_there = in_face[slots[in_face, 0] >= plain]
            node_chord[self.chord_node[starts_there, 0]] = starts_there
            following[along] = node_chord[self.chord_node[along, 1]]
        return following

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
        group = self._face_group[self.chord_face]
        along = np.flatnonzero(self.chord_face < 0)
        group[along] = group[self.chord_next[along]]
        return group

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


def _crossings(mesh: PolygonMesh, distance: np.ndarray, half_edge: np.ndarray) -> np.ndarray:
    """Where half-edges cross the plane, the same for twins, shape (count, 3) [m]."""
    start, end = mesh.face_vertex[half_edge], mesh.destination[half_edge]
    down = distance[start] >= 0.0
    above, below = np.where(down, start, end), np.where(down, end, start)
    t = distance[above] / (distance[above] - distance[below])
    return mesh.vertices[above] + t[:, None] * (mesh.vertices[below] - mesh.vertices[above])


def clear_front(nodes: np.ndarray, front: float, tolerance: float) -> float:
    """The front moved on, by as little as can be, so that no node is within the tolerance of it.

    Args:
        nodes: Coordinates s of the nodes, ascending [m].
        front: Coordinate s of the front [m].
        tolerance: Distance to keep [m].
    """
    while True:
        last = int(np.searchsorted(nodes, front + tolerance)) - 1
        if last < 0 or nodes[last] <= front - tolerance or nodes[last] + tolerance <= front:
            return front
        front = float(nodes[last]) + tolerance
