# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Faces slit and split, and sides opened, with the front of a cut at one place.

Section 5.2 and figure 8 of the paper list the cases; here they are two rules. A loop that arrives at a crossing behind
the front goes to the chord's other end if that is behind the front too, which splits the face, and to the chord's tip
and back on the other side if not, which slits it.
"""

from __future__ import annotations

import numpy as np

from .numbering import Numbering
from .region import Region
from .section import Section


class Opening:
    """What a section becomes when it is opened up to a front."""

    def __init__(self, section: Section, numbering: Numbering, front: float):
        """Open a section.

        Args:
            section: The section.
            numbering: Its vertex ids.
            front: Coordinate s up to which it is open [m].
        """
        self.section = section
        self.numbering = numbering
        self.region = Region(section, front)
        swept = self.region.swept
        self.created_count = int(numbering.created[np.count_nonzero(swept)])
        """Number of vertices beyond the mesh's own."""
        self.tip_chords = self.region.upper_chords
        """Chords that end in a tip, shape (tip_count,)."""
        self._open_ends = swept[section.chord_node]
        self._walk_faces()

    def created_values(self, at_nodes: np.ndarray, at_tips: np.ndarray) -> np.ndarray:
        """Values of the created vertices from those at nodes and at tips.

        Args:
            at_nodes: Values at all nodes, shape (node_count, ...).
            at_tips: Values at the tips, shape (tip_count, ...).

        Returns:
            Values in the order of their ids, shape (created_count, ...).
        """
        first, swept = self.section.mesh.vertex_count, self.region.swept
        values = np.zeros((self.created_count, *at_nodes.shape[1:]), dtype=at_nodes.dtype)
        opened = swept & (self.section.node_vertex < 0)
        values[self.numbering.plus[opened] - first] = at_nodes[opened]
        values[self.numbering.minus[swept] - first] = at_nodes[swept]
        values[self.numbering.tip[self.tip_chords] - first] = at_tips
        return values

    def created_positions(self) -> np.ndarray:
        """Positions of the created vertices, shape (created_count, 3) [m]."""
        tips = self.region.position[self.section.node_count + self.tip_chords]
        return self.created_values(self.section.node_position, tips)

    def side_vertices(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of the region's labels on the negative and on the positive side, shapes (label_count,)."""
        tip = self.numbering.tip
        return np.concatenate([self.numbering.minus, tip]), np.concatenate([self.numbering.plus, tip])

    def _hops(self) -> dict[int, tuple[tuple[int, ...], int]]:
        """For each half-edge with an open crossing: vertices to insert and the half-edge with which to go on."""
        section = self.section
        touched = np.flatnonzero(self._open_ends.any(axis=1))
        touched = touched[section.chord_face[touched] >= 0]
        slots = section.chord_slot[touched]
        half, leave = section.arrive[slots], section.leave[slots]
        node = section.chord_node[touched]
        plus, minus = self.numbering.plus[node].tolist(), self.numbering.minus[node].tolist()
        columns = (half.tolist(), leave.tolist(), plus, minus)
        tips = self.numbering.tip[touched].tolist()
        hops: dict[int, tuple[tuple[int, ...], int]] = {}
        for h, after, p, m, tip, is_open in zip(*columns, tips, self._open_ends[touched].tolist(), strict=True):
            if is_open[0] and is_open[1]:
                hops[h[0]] = ((p[0], p[1]), after[1])
                hops[h[1]] = ((m[1], m[0]), after[0])
            elif is_open[0]:
                hops[h[0]] = ((p[0], tip, m[0]), after[0])
            else:
                hops[h[1]] = ((m[1], tip, p[1]), after[1])
        return hops

    def _walk_faces(self) -> None:
        """Walk the loops of the touched faces, the first of each keeping the face's place."""
        section, mesh = self.section, self.section.mesh
        self.face_vertex = mesh.face_vertex
        """Vertex at which each half-edge of the mesh starts, after the opening, shape (half_edge_count,)."""
        parted = self.region.swept[section.parted_node]
        if parted.any():
            self.face_vertex = mesh.face_vertex.copy()
            self.face_vertex[section.parted[parted]] = self.numbering.minus[section.parted_node[parted]]
        self.faces = np.unique(section.chord_face[self._open_ends.any(axis=1) & (section.chord_face >= 0)])
        """Faces of the mesh that are slit or split, ascending, shape (touched_count,)."""
        hops = self._hops()
        self.first_loops: list[list[int]] = []
        """What stays in the place of each touched face."""
        extra: dict[int, list[list[int]]] = {}
        place: dict[int, tuple[int, int]] = {}
        flat, following = self.face_vertex, mesh.next
        hinge = set(section.hinge_corner.tolist()) if hops else set()
        for face, begin, end in zip(
            self.faces.tolist(),
            mesh.face_start[self.faces].tolist(),
            mesh.face_start[self.faces + 1].tolist(),
            strict=True,
        ):
            vertex, after = flat[begin:end].tolist(), following[begin:end].tolist()
            loops: list[list[int]] = []
            for start in range(begin, end):
                if start in place or start in hinge:
                    continue
                loop, h = [], start
                while h not in place:
                    place[h] = (face, len(loops))
                    loop.append(vertex[h - begin])
                    hop = hops.get(h)
                    if hop is None:
                        h = after[h - begin]
                    else:
                        loop.extend(hop[0])
                        h = hop[1]
                loops.append(loop)
            self.first_loops.append(loops[0])
            extra[face] = loops[1:]
        for h, corner in zip(section.hinge_arrive.tolist(), section.hinge_corner.tolist(), strict=True):
            if h in place:
                place[corner] = place[h]
        self._place_extra(extra, place)

    def _place_extra(self, extra: dict[int, list[list[int]]], place: dict[int, tuple[int, int]]) -> None:
        """Order the further loops by when the chord that split them off was completed, so that their places last."""
        section, mesh = self.section, self.section.mesh
        complete = np.flatnonzero(self._open_ends.all(axis=1) & (section.chord_face >= 0))
        done = section.node_rank[section.chord_ends[complete, 1]]
        complete = complete[np.argsort(done, kind="stable")]
        taken = dict.fromkeys(extra, 0)
        self.extra_loops: list[list[int]] = []
        """Loops split off from touched faces."""
        self.extra_face: list[int] = []
        """Face that each of them was split off from."""
        number: dict[tuple[int, int], int] = {}
        for face in section.chord_face[complete].tolist():
            k = taken[face]
            if k < len(extra[face]):
                number[face, k + 1] = mesh.face_count + len(self.extra_loops)
                self.extra_loops.append(extra[face][k])
                self.extra_face.append(face)
                taken[face] = k + 1
        self.half_edge_face = mesh.face.copy()
        """Face, after the opening, that walks each half-edge of the mesh, shape (half_edge_count,)."""
        for h, where in place.items():
            if where[1]:
                self.half_edge_face[h] = number[where]
