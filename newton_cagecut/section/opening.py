# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Faces slit and split, and sides opened, with the front of a cut at one place.

Section 5.2 and figure 8 of the paper list the cases; here they are two rules. A loop that arrives at a crossing behind
the front goes to the chord's other end if that is behind the front too, which splits the face, and to the chord's tip
and back on the other side if not, which slits it.
"""

from __future__ import annotations

import numpy as np

from ..geometry import bridge_holes, contains_point
from .numbering import Numbering
from .section import Section
from .swept_region import Region

_SHUT, _OPEN, _PINNED = 0, 1, 2


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
        self.region = Region(section, front, middles=np.flatnonzero(numbering.middle_plus >= 0))
        swept = self.region.swept
        self.created_count = int(numbering.created[np.count_nonzero(swept)])
        """Number of vertices beyond the mesh's own."""
        self.tip_chords = self.region.upper_chords
        """Chords that end in a tip, shape (tip_count,)."""
        self._open_ends = swept[section.chord_node]
        self._positions: np.ndarray | None = None
        self._walk_faces()

    def created_values(self, at_nodes: np.ndarray, at_tips: np.ndarray) -> np.ndarray:
        """Values of the created vertices from those at nodes and at tips, halfway between them in the middle of chords.

        Args:
            at_nodes: Values at all nodes, shape (node_count, ...).
            at_tips: Values at the tips, shape (tip_count, ...).

        Returns:
            Values in the order of their ids, shape (created_count, ...).
        """
        section, numbering = self.section, self.numbering
        first, swept = section.mesh.vertex_count, self.region.swept
        values = np.zeros((self.created_count, *at_nodes.shape[1:]), dtype=at_nodes.dtype)
        opened = swept & (section.node_vertex < 0)
        values[numbering.plus[opened] - first] = at_nodes[opened]
        values[numbering.minus[swept] - first] = at_nodes[swept]
        values[numbering.tip[self.tip_chords] - first] = at_tips
        middles = self.region.middles
        if len(middles):
            low, high = section.chord_ends[middles].T
            end = np.where(swept[high], numbering.plus[high], numbering.tip[middles]) - first
            halfway = (0.5 * (values[numbering.plus[low] - first] + values[end])).astype(values.dtype)
            values[numbering.middle_plus[middles] - first] = halfway
            values[numbering.middle_minus[middles] - first] = halfway
        return values

    def created_positions(self) -> np.ndarray:
        """Positions of the created vertices, shape (created_count, dimension) [m]."""
        section, numbering, region = self.section, self.numbering, self.region
        tips = region.position[section.node_count + self.tip_chords]
        positions = self.created_values(section.node_position, tips)
        for ids in (numbering.middle_plus[region.middles], numbering.middle_minus[region.middles]):
            positions[ids - section.mesh.vertex_count] = region.position[region.middle_labels]
        return positions

    def side_vertices(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of the region's labels on the negative and on the positive side, shapes (label_count,)."""
        numbering = self.numbering
        return (
            np.concatenate([numbering.minus, numbering.tip, numbering.tip, numbering.middle_minus]),
            np.concatenate([numbering.plus, numbering.tip, numbering.tip, numbering.middle_plus]),
        )

    def _hops(self) -> dict[int, tuple[tuple[int, ...], int]]:
        """For each half-edge with an open crossing: vertices to insert and the half-edge with which to go on."""
        section = self.section
        touched = np.flatnonzero(self._open_ends.any(axis=1))
        touched = touched[section.chord_face[touched] >= 0]
        slots = section.chord_slot[touched]
        node = section.chord_node[touched]
        pinned = section.node_pinned[node]
        plus, minus = self.numbering.plus[node].tolist(), self.numbering.minus[node].tolist()
        columns = (section.arrive[slots].tolist(), section.leave[slots].tolist(), plus, minus)
        tips = self.numbering.tip[touched].tolist()
        state = np.where(self._open_ends[touched], np.where(pinned, _PINNED, _OPEN), _SHUT).tolist()
        middles = set(self.region.middles.tolist())
        hops: dict[int, tuple[tuple[int, ...], int]] = {}
        self.slits: list[tuple[int, list[int]]] = []
        """Chords along which slits meet no edge of their face, and the vertices of each: at the chord's start, on the
        positive side, at its end, on the negative side."""
        for chord, h, after, p, m, tip, ends in zip(touched.tolist(), *columns, tips, state, strict=True):
            above, below = (), ()
            if chord in middles:
                above, below = (int(self.numbering.middle_plus[chord]),), (int(self.numbering.middle_minus[chord]),)
            if ends[0] == ends[1] == _OPEN:
                hops[h[0]] = ((p[0], *above, p[1]), after[1])
                hops[h[1]] = ((m[1], *below, m[0]), after[0])
                continue
            last = [p[k] if ends[k] == _PINNED else tip for k in (0, 1)]
            if ends[0] == _OPEN:
                hops[h[0]] = ((p[0], *above, last[1], *below, m[0]), after[0])
            elif ends[1] == _OPEN:
                hops[h[1]] = ((m[1], *below, last[0], *above, p[1]), after[1])
            else:
                self.slits.append((chord, [last[0], *above, last[1], *below]))
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
        for chord, slit in self.slits:
            self._join_slit(int(section.chord_face[chord]), slit)

    def _join_slit(self, face: int, slit: list[int]) -> None:
        """Bridge a slit that meets no edge of its face to the loop around it."""
        row = int(np.searchsorted(self.faces, face))
        extra = [i for i, owner in enumerate(self.extra_face) if owner == face]
        loops = [self.first_loops[row], *(self.extra_loops[i] for i in extra)]
        flat = [self._face_coordinates(face, loop) for loop in loops]
        hole = self._face_coordinates(face, slit)
        inside = [k for k, points in enumerate(flat) if contains_point(points, hole[1])]
        k = inside[0] if inside else 0
        size = len(loops[k])
        labels = loops[k] + slit
        joined = bridge_holes(list(range(size)), [list(range(size, len(labels)))], np.concatenate([flat[k], hole]))
        loop = [labels[i] for i in joined]
        if k == 0:
            self.first_loops[row] = loop
        else:
            self.extra_loops[extra[k - 1]] = loop

    def _face_coordinates(self, face: int, vertices: list[int]) -> np.ndarray:
        """Coordinates of vertices in the plane of a face, in which it is counterclockwise, shape (count, 2) [m]."""
        mesh = self.section.mesh
        normal = mesh.face_area_vector[face]
        axis = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
        axis /= np.linalg.norm(axis)
        axes = np.stack([axis, np.cross(normal / np.linalg.norm(normal), axis)])
        return (self.positions(vertices) - mesh.vertices[mesh.face_vertex[mesh.face_start[face]]]) @ axes.T

    def positions(self, vertices: np.ndarray | list[int]) -> np.ndarray:
        """Positions of vertices, old or created [m].

        Args:
            vertices: Vertices, of any shape.

        Returns:
            Positions, shape (..., 3).
        """
        old = self.section.mesh.vertices
        ids = np.asarray(vertices)
        if self._positions is None:
            self._positions = self.created_positions()
        positions = np.empty((*ids.shape, 3))
        below = ids < len(old)
        positions[below] = old[ids[below]]
        positions[~below] = self._positions[ids[~below] - len(old)]
        return positions

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
