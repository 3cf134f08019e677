# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Planar strips of a cut, straight ones in 2D.

Sections 4 and 5.2 of the paper. A strip is a pure function: (cage before it, plane, front) -> cage. Its section is
computed once; every step opens it anew up to the front.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry import PolygonMesh, triangulate
from ...section import (
    BladePlane,
    ClippedSection,
    Hinge,
    LineOpening,
    LineSection,
    Numbering,
    Opening,
    Region,
    Section,
    clear_front,
)
from ..cage import Cage
from ..wall import Wall, cut_wall
from .edit import CageEdit


@dataclass(frozen=True, eq=False)
class StripState:
    """What a strip has opened."""

    cage: Cage
    """The cage."""
    front: float
    """Coordinate s of the front [m]."""
    half_edge_face: np.ndarray
    """Face of the cage that walks each half-edge of the cage before the strip, shape (half_edge_count,)."""


class Strip:
    """One plane's part of a cut."""

    def __init__(
        self,
        base: Cage,
        plane: BladePlane,
        *,
        first: float | None = None,
        hinge: Hinge | None = None,
        hinge_wall: int | None = None,
        window: tuple[float, float, float] | None = None,
    ):
        """Section a cage.

        Args:
            base: The cage before the strip.
            plane: The plane.
            first: Coordinate s of depth zero; by default where the blade first touches [m].
            hinge: Front of the strip before, at ``s = 0``.
            hinge_wall: Wall of the strip before, where that has begun to open.
            window: Heel, tip and start of the blade, which bound coordinates a, a and s [m].

        Raises:
            ValueError: If the section does not close at the hinge.
        """
        self.base = base
        self.plane = plane
        self.wall = len(base.walls)
        """Number of the strip's wall in the walls of the cage, once it has begun to open."""
        self.hinged = hinge is not None
        """Whether the strip begins at ``s = 0``."""
        self.hinge_wall = hinge_wall
        """Wall of which the front is the strip's hinge."""
        self._opened_wall = cut_wall(plane)
        self.section = _section(base, plane, hinge, window)
        self._numbering = Numbering(self.section)
        self._reached_at = np.sort(self.section.node_coordinates[:, 1])
        touches = len(self._reached_at) > 0
        self.first = first if first is not None else (float(self._reached_at[0]) if touches else 0.0)
        """Coordinate s of depth zero [m]."""
        self.length = max(0.0, float(self._reached_at[-1]) - self.first) if touches else 0.0
        """Depth at which the strip is complete [m]."""
        self.start = StripState(base, self.front_at(0.0), base.mesh.face)
        """The strip before it opens."""

    def is_complete(self, front: float) -> bool:
        """Whether nothing is left to cut beyond a front.

        Args:
            front: Coordinate s of the front [m].
        """
        return len(self._reached_at) == 0 or front > float(self._reached_at[-1])

    def front_at(self, depth: float) -> float:
        """Coordinate of the front, moved on by the tolerance where it would pass too close to a node.

        Args:
            depth: Depth in the strip [m].
        """
        nodes, tolerance = self._reached_at, self.base.length_tolerance
        if len(nodes) == 0:
            return 0.0
        if depth <= 0.0:
            return self.first - tolerance
        return clear_front(nodes, min(self.first + depth, float(nodes[-1]) + tolerance), tolerance)

    def advance(self, state: StripState, to: float, depth: float) -> tuple[StripState, CageEdit]:
        """Open the strip further.

        Args:
            state: What is open.
            to: Depth in the strip [m].
            depth: Depth in the whole cut, for the record [m].

        Returns:
            What is open then, and the step.
        """
        front = self.front_at(to)
        if front == state.front or len(self._reached_at) == 0:
            return self._stay(state, front, depth)
        opening = (LineOpening if self.base.dimension == 2 else Opening)(self.section, self._numbering, front)
        region = Region(self.section, front, state.front)
        if len(opening.tip_chords) == 0 and not region.reached.any():
            return self._stay(state, front, depth)
        polygons = region.polygons()
        cage = open_cage(self.base, opening, self._opened_wall)
        created, moved, source = self._changed_vertices(state, cage, opening, region)
        simplices = self._simplices(region, polygons)
        edit = CageEdit(
            before=state.cage,
            cage=cage,
            wall=self.wall,
            plane=self.plane,
            front=front,
            depth=depth,
            complete=self.is_complete(front),
            swept=tuple(region.position[loop] for loop in polygons),
            swept_wall=np.full(len(polygons), self.wall),
            swept_simplices=region.position[simplices],
            swept_simplex_wall=np.full(len(simplices), self.wall),
            created=created,
            moved=moved,
            source_faces=source,
        )
        return StripState(cage, front, opening.half_edge_face), edit

    def _simplices(self, region: Region, polygons: list[list[int]]) -> np.ndarray:
        """Labels of the triangles of polygons, or in 2D of the segments that they are, shape (count, dimension)."""
        if self.base.dimension == 2:
            return np.array(polygons, dtype=np.int64).reshape(-1, 2)
        parts = [np.array(loop)[triangulate(region.coordinates[loop])] for loop in polygons]
        return np.concatenate([np.zeros((0, 3), dtype=np.int64), *parts])

    def _stay(self, state: StripState, front: float, depth: float) -> tuple[StripState, CageEdit]:
        none = np.zeros(0, dtype=np.int64)
        edit = CageEdit(
            before=state.cage,
            cage=state.cage,
            wall=self.wall,
            plane=self.plane,
            front=front,
            depth=depth,
            complete=self.is_complete(front),
            swept=(),
            swept_wall=none,
            swept_simplices=np.zeros((0, self.base.dimension, self.base.dimension)),
            swept_simplex_wall=none,
            created=none,
            moved=none,
            source_faces=none,
        )
        return StripState(state.cage, front, state.half_edge_face), edit

    def _changed_vertices(
        self, state: StripState, cage: Cage, opening: Opening, region: Region
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Created and moved vertices, and faces of the cage before on which they are now."""
        section, numbering, before = self.section, self._numbering, state.cage
        half_edge = np.full(cage.vertex_count, -1)
        fresh = region.reached
        half_edge[numbering.plus[fresh]] = half_edge[numbering.minus[fresh]] = section.node_half_edge[fresh]
        chords = opening.tip_chords
        ahead = np.where(opening.region.swept[section.chord_node[chords, 0]], 1, 0)
        slots = section.chord_slot[chords, ahead]
        half_edge[numbering.tip[chords]] = np.where(slots >= 0, section.arrive[slots], -1)
        middles = opening.region.middles
        slots = section.chord_slot[middles, 0]
        for ids in (numbering.middle_plus[middles], numbering.middle_minus[middles]):
            half_edge[ids] = np.where(slots >= 0, section.arrive[slots], -1)
        created = np.arange(before.vertex_count, cage.vertex_count)
        moved = np.flatnonzero((before.vertices != cage.vertices[: before.vertex_count]).any(axis=1))
        half_edge = half_edge[np.concatenate([created, moved])]
        return created, moved, np.where(half_edge >= 0, state.half_edge_face[half_edge], -1)


def _section(base: Cage, plane: BladePlane, hinge: Hinge | None, window: tuple[float, float, float] | None) -> Section:
    """The section of a cage with a plane or a line, less what lies beyond the blade's window."""
    if base.dimension == 2:
        start = {} if window is None else {"start": window[2], "tolerance": base.length_tolerance}
        return LineSection(base.mesh, plane, vertex_piece=base.vertex_piece, hinge=hinge, **start)
    section = Section(base.mesh, plane, hinge=hinge)
    return section if window is None else ClippedSection(section, *window, base.length_tolerance)


def open_cage(base: Cage, opening: Opening, wall: Wall) -> Cage:
    """The cage that a section opened up to a front leaves.

    Args:
        base: The cage before the cut.
        opening: The section opened.
        wall: The wall that the cut appends.
    """
    mesh = base.mesh
    minus, plus = opening.side_vertices()
    sides: list[list[int]] = []
    for loop in opening.region.polygons():
        sides += [minus[loop].tolist(), plus[loop[::-1]].tolist()]
    appended = opening.extra_loops + sides
    size = np.concatenate([mesh.face_size, [len(loop) for loop in appended]]).astype(np.int64)
    size[opening.faces] = [len(loop) for loop in opening.first_loops]
    face_start = np.concatenate([[0], np.cumsum(size)])
    face_vertex = np.empty(face_start[-1], dtype=np.int64)
    kept = np.ones(mesh.face_count, dtype=bool)
    kept[opening.faces] = False
    half = np.flatnonzero(kept[mesh.face])
    owner = mesh.face[half]
    face_vertex[half - mesh.face_start[owner] + face_start[owner]] = opening.face_vertex[half]
    for face, loop in zip(opening.faces.tolist(), opening.first_loops, strict=True):
        face_vertex[face_start[face] : face_start[face + 1]] = loop
    if appended:
        face_vertex[face_start[mesh.face_count] :] = np.concatenate(appended)
    number, extra = len(base.walls), opening.extra_face
    return Cage._assembled(
        base,
        PolygonMesh(np.concatenate([mesh.vertices, opening.created_positions()]), face_start, face_vertex),
        (*base.walls, wall),
        np.concatenate([base.face_wall, base.face_wall[extra], np.full(len(sides), number)]).astype(np.int64),
        np.concatenate([base.face_side, base.face_side[extra], np.tile([0, 1], len(sides) // 2)]).astype(np.int64),
    )
