# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The section of a plane cage with the line that a blade sweeps.

Section 4 of the paper cuts cages of line segments. Nodes are crossed segments; chords are the intervals of the line
inside the body, from the node where the line enters to the one where it leaves. They run through no face, so that the
tip of a cut lies inside the body, and only the segments at their ends are split.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..geometry import PolygonMesh
from .blade import BladePlane
from .hinge import Hinge
from .pairing import alternate
from .section import Section


class LineSection(Section):
    """Nodes and chords of a line's section; vertices at distance zero count as being on the positive side.

    With a hinge, only what lies at ``s > 0`` counts, and the section begins at the hinge's vertex.
    """

    def __init__(
        self,
        mesh: PolygonMesh,
        plane: BladePlane,
        *,
        vertex_piece: np.ndarray,
        hinge: Hinge | None = None,
        start: float = -np.inf,
        tolerance: float = 0.0,
    ):
        """Cut a plane cage's segments with a line.

        Args:
            mesh: The segments, in closed loops.
            plane: The line.
            vertex_piece: Solid piece of each vertex, shape (vertex_count,).
            hinge: Tip of an earlier cut from which this one goes on, at ``s = 0``.
            start: Coordinate s behind which nothing is cut [m].
            tolerance: Distance that the start keeps from nodes [m].

        Raises:
            ValueError: If the start lies inside the body, or the section does not close at the hinge.
        """
        self.mesh = mesh
        self.plane = plane
        distance = plane.distance(mesh.vertices)
        on_hinge = np.zeros(mesh.vertex_count, dtype=bool)
        if hinge is not None:
            on_hinge[hinge.vertices] = True
        origin, end = mesh.face_vertex[0::2], mesh.face_vertex[1::2]
        crosses = ((distance[origin] >= 0.0) != (distance[end] >= 0.0)) & ~(on_hinge[origin] | on_hinge[end])
        self.arrive = 2 * np.flatnonzero(crosses)
        """Crossed segments, as half-edges, ascending, shape (crossing_count,)."""
        self._number_nodes(distance)
        self.enters = distance[mesh.face_vertex[self.node_half_edge]] >= 0.0
        """Whether the line enters the body at each node, where its segment goes down, shape (node_count,)."""
        if hinge is not None:
            self._keep_nodes(self.node_coordinates[:, 1] > 0.0)
        self.parted = np.zeros(0, dtype=np.int64)
        """Corners of which the vertex goes to the negative side where a hinge opens."""
        self.parted_node = np.zeros(0, dtype=np.int64)
        """Node of each of them."""
        if hinge is not None:
            self._add_hinge(hinge)
        self._join_chords(vertex_piece[mesh.face_vertex[self.node_half_edge]])
        if np.isfinite(start):
            self._drop_behind(start, tolerance)
            self.window = (-np.inf, np.inf, start)

    def _add_hinge(self, hinge: Hinge) -> None:
        """Add a node at the hinge's vertex, where the line enters the body; the segment that leaves it is parted."""
        mesh = self.mesh
        self.parted = 2 * np.flatnonzero(np.isin(mesh.face_vertex[0::2], hinge.vertices))
        self.parted_node = self.node_count + np.arange(len(self.parted))
        vertex = mesh.face_vertex[self.parted]
        position = mesh.vertices[vertex]
        self.node_half_edge = np.concatenate([self.node_half_edge, self.parted])
        self.node_above, self.node_below = (np.concatenate([ids, vertex]) for ids in (self.node_above, self.node_below))
        self.node_fraction = np.concatenate([self.node_fraction, np.zeros(len(vertex))])
        self.node_position = np.concatenate([self.node_position, position])
        self.node_coordinates = np.concatenate([self.node_coordinates, np.zeros((len(vertex), 2))])
        self.node_vertex = np.concatenate([self.node_vertex, vertex])
        self.enters = np.concatenate([self.enters, np.ones(len(vertex), dtype=bool)])

    def _join_chords(self, piece: np.ndarray) -> None:
        """Pair entries and exits, piece by piece, in the order of the line."""
        along, pairs = self.node_coordinates[:, 1], [np.zeros((0, 2), dtype=np.int64)]
        for number in np.unique(piece).tolist():
            mine = np.flatnonzero(piece == number)
            enters = self.enters[mine]
            if 2 * np.count_nonzero(enters) != len(mine):
                raise ValueError(
                    "the section does not close at the tip of the cut before it: the line leaves the piece of vertex "
                    f"{self.mesh.face_vertex[self.node_half_edge[mine[0]]]} {np.count_nonzero(~enters)} times and "
                    f"enters it {np.count_nonzero(enters)} times; move the blade a little, or begin a new cut where "
                    "the cage has grown across the tip"
                )
            pairs.append(mine[np.array(alternate(along[mine], enters))])
        chords = np.concatenate(pairs)
        self._set_chords(chords[np.argsort(along[chords[:, 0]], kind="stable")])

    def _set_chords(self, chords: np.ndarray) -> None:
        none = np.full_like(chords, -1)
        self.chord_node = chords
        """Nodes from and to which each chord runs, in the order of the line, shape (chord_count, 2)."""
        self.chord_slot, self.chord_face = none, none[:, 0]

    def _drop_behind(self, start: float, tolerance: float) -> None:
        """Forget the chords that end before the blade's start, which must not lie inside one."""
        first, last = self.node_coordinates[self.chord_node, 1].T
        ahead = first > start - tolerance
        inside = ~ahead & (last > start + tolerance)
        if inside.any():
            low, high = first[inside][0], last[inside][0]
            raise ValueError(
                f"the blade starts inside the body, at {start:g} between {low:g} and {high:g} along its line: the cut "
                "would touch no face; move the start to where the line is outside"
            )
        self._set_chords(self.chord_node[ahead])
        used = np.zeros(self.node_count, dtype=bool)
        used[self.chord_node] = True
        self.chord_node = (np.cumsum(used) - 1)[self.chord_node]
        self._keep_nodes(used)

    def _keep_nodes(self, kept: np.ndarray) -> None:
        self.node_half_edge, self.node_vertex = self.node_half_edge[kept], self.node_vertex[kept]
        self.node_above, self.node_below = self.node_above[kept], self.node_below[kept]
        self.node_fraction, self.enters = self.node_fraction[kept], self.enters[kept]
        self.node_position, self.node_coordinates = self.node_position[kept], self.node_coordinates[kept]

    @property
    def tipped(self) -> np.ndarray:
        """Whether a chord has a vertex where the front crosses it: all have, shape (chord_count,)."""
        return np.ones(self.chord_count, dtype=bool)

    @cached_property
    def chord_bulges(self) -> np.ndarray:
        """Whether a chord gets a vertex on each side once it is open, which none needs, shape (chord_count,)."""
        return np.zeros(self.chord_count, dtype=bool)
