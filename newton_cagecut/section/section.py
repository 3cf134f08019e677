# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The section of a mesh with the plane, or in 2D the line, of a blade.

Sections 4 and 5.2 of the paper. Nodes are crossed edges, chords run from node to node through faces, with the inside of
the mesh to the left seen against the plane's normal; in 2D they are the intervals of the line inside the body. What
fills a section in stands beside this file: polygons, segments, and the clipping to a knife's window.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry import PolygonMesh
from .blade import BladePlane
from .nodes import Nodes


@dataclass(frozen=True, eq=False, kw_only=True)
class Section:
    """Nodes and chords of a section; vertices at distance zero count as being on the positive side.

    With a hinge, only what lies at ``s > 0`` counts, and the section begins at the hinge's vertices.
    """

    mesh: PolygonMesh
    """The polygons, or segments."""
    plane: BladePlane
    """The plane, or line."""
    nodes: Nodes
    """Where chords end."""
    arrive: np.ndarray
    """Crossed half-edges, ascending, and then those that arrive at the hinge, shape (crossing_count,)."""
    leave: np.ndarray
    """Half-edge with which the loop goes on after each crossing, shape (crossing_count,)."""
    chord_slot: np.ndarray
    """Crossings from and to which each chord runs, -1 where it runs through no face, shape (chord_count, 2)."""
    chord_face: np.ndarray
    """Face through which each chord runs, -1 for none, shape (chord_count,)."""
    chord_node: np.ndarray
    """Nodes from and to which each chord runs, shape (chord_count, 2)."""
    chord_next: np.ndarray
    """Chord that continues each chord through the next face, -1 at an open edge, shape (chord_count,)."""
    chord_group: np.ndarray
    """Number of the solid whose surface each chord runs through, shape (chord_count,)."""
    parted: np.ndarray
    """Corners of which the vertex goes to the negative side where a hinge opens, shape (parted_count,)."""
    parted_node: np.ndarray
    """Node of each of them, shape (parted_count,)."""
    hinge_corner: np.ndarray
    """Corners at the hinge's vertices in the faces into which the section goes on, shape (corner_count,)."""
    window: tuple[float, float, float] | None = None
    """Heel, tip and start of a knife where they are, off the nodes; None for a blade without [m]."""

    @property
    def hinge_arrive(self) -> np.ndarray:
        """Half-edges that arrive at the hinge's corners, shape (corner_count,)."""
        return self.arrive[len(self.arrive) - len(self.hinge_corner) :]

    @property
    def node_count(self) -> int:
        """Number of nodes."""
        return self.nodes.count

    @property
    def node_coordinates(self) -> np.ndarray:
        """Coordinates (a, s) of the nodes, shape (node_count, 2) [m]."""
        return self.nodes.coordinates

    @property
    def chord_count(self) -> int:
        """Number of chords."""
        return len(self.chord_face)

    @cached_property
    def chord_ends(self) -> np.ndarray:
        """Nodes of each chord in the order in which the front reaches them, shape (chord_count, 2)."""
        swap = self.nodes.rank[self.chord_node[:, 0]] > self.nodes.rank[self.chord_node[:, 1]]
        return np.where(swap[:, None], self.chord_node[:, ::-1], self.chord_node)

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

    @property
    def chord_tipped(self) -> np.ndarray:
        """Whether a chord has a vertex where the front crosses it, which those along a hinge have not."""
        return (self.chord_face >= 0) | (self.nodes.vertex[self.chord_node] < 0).any(axis=1)

    @cached_property
    def chord_hubs(self) -> np.ndarray:
        """Whether a chord's vertices on each side stand off it, in the opened faces, shape (chord_count,).

        Those are the ones that run along a window's border from border to border, through no face.
        """
        on_face = np.zeros(self.node_count, dtype=bool)
        on_face[self.chord_node[self.chord_face >= 0]] = True
        return (self.nodes.pinned & ~on_face)[self.chord_node].all(axis=1)

    @cached_property
    def chord_swells(self) -> np.ndarray:
        """Whether the slit along a chord, from a pinned node on, gets a vertex on each side to open at.

        Shape (chord_count,).
        """
        return (self.chord_face >= 0) & self.nodes.pinned[self.chord_ends[:, 0]]

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
        bulges[pairs] = ~self.nodes.pinned[self.chord_node[pairs]].any(axis=1) & (self.chord_face[pairs] >= 0)
        return bulges

    def chord_points(self, front: float, chords: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points at which chords cross the front.

        Args:
            front: Coordinate s of the front [m].
            chords: Chords of which one end is reached and one is not, shape (count,).

        Returns:
            Positions, shape (count, dimension) [m], and coordinates (a, s), shape (count, 2) [m].
        """
        coordinates = self.values_on_chords(self.nodes.coordinates, front, chords)
        coordinates[:, 1] = front
        return self.values_on_chords(self.nodes.position, front, chords), coordinates

    def values_on_chords(self, at_nodes: np.ndarray, front: float, chords: np.ndarray) -> np.ndarray:
        """Values where chords cross the front, linear along them, shape (count, ...).

        Args:
            at_nodes: Values at the nodes, shape (node_count, ...).
            front: Coordinate s of the front [m].
            chords: Chords of which one end is reached and one is not, shape (count,).
        """
        low, high = self.chord_ends[chords].T
        s = self.nodes.coordinates[:, 1]
        t = ((front - s[low]) / (s[high] - s[low]))[:, None]
        return at_nodes[low] + t * (at_nodes[high] - at_nodes[low])
