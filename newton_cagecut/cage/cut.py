# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progressive cuts of cages.

Section 5.2 of the paper. A cut is a pure function: (cage before the cut, blade, depth) -> cage. The section is
computed once; every advance opens it anew up to the blade.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .blade import Blade, BladePlane
from .cage import Cage
from .edit import CageEdit
from .numbering import Numbering
from .opening import Opening
from .polygon_mesh import PolygonMesh
from .region import Region
from .section import Section
from .triangulate import triangulate


@dataclass(frozen=True, eq=False)
class CutSnapshot:
    """Where a cut was; made by :meth:`Cut.snapshot`."""

    section: Section
    depth: float
    front: float
    cage: Cage
    half_edge_face: np.ndarray


class Cut:
    """A blade on its way through a cage."""

    def __init__(self, cage: Cage, blade: Blade):
        """Begin a cut; nothing changes before :meth:`advance`.

        Args:
            cage: The cage to cut, which may have been cut before.
            blade: The blade, in the cage's rest frame.

        Raises:
            TypeError: If the arguments are not a cage and a blade.
        """
        if not isinstance(cage, Cage):
            raise TypeError(f"cage must be a Cage, got {type(cage).__name__}")
        if not isinstance(blade, Blade):
            raise TypeError(f"blade must be a Blade, got {type(blade).__name__}")
        self.base = cage
        """The cage before the cut."""
        self.cage = cage
        """The cage as it is now."""
        self.plane = clear_plane(BladePlane.of(blade), cage.vertices, cage.length_tolerance)
        """The plane of the cut, moved off the cage's vertices."""
        self.wall = len(cage.walls)
        """Number of the cut's wall in the walls of the cage, once it has begun to open."""
        self.depth = 0.0
        """Depth to which the cut was advanced [m]."""
        self.section = Section(cage.mesh, self.plane)
        self._numbering = Numbering(self.section)
        self._reached_at = np.sort(self.section.node_coordinates[:, 1])
        self.front = self._front_at(0.0)
        """Coordinate s of the blade in the plane [m]."""
        self._half_edge_face = cage.mesh.face

    @property
    def length(self) -> float:
        """Depth at which the cut is complete, 0 if the blade misses the cage [m]."""
        return float(self._reached_at[-1] - self._reached_at[0]) if len(self._reached_at) else 0.0

    @property
    def complete(self) -> bool:
        """Whether nothing is left to cut."""
        return len(self._reached_at) == 0 or self.front > float(self._reached_at[-1])

    def advance(self, to: float) -> CageEdit:
        """Move the blade on.

        Args:
            to: Depth along the blade's direction, from where it first touches the cage [m].

        Returns:
            The step from the cage as it was.

        Raises:
            TypeError: If the depth is not a number.
            ValueError: If the depth is not a number's value, or less than the depth now.
        """
        depth = _as_depth(to)
        if depth < self.depth:
            raise ValueError(f"a cut never goes back: it has reached depth {self.depth:g}, asked for {depth:g}")
        before, front_before = self.cage, self.front
        front = self._front_at(depth)
        self.depth, self.front = depth, front
        if front == front_before or len(self._reached_at) == 0:
            return self._empty_edit()
        opening = Opening(self.section, self._numbering, front)
        region = Region(self.section, front, front_before)
        if len(opening.tip_chords) == 0 and not region.reached.any():
            return self._empty_edit()
        polygons = region.polygons()
        self.cage = open_cage(self.base, opening, self.plane)
        created, moved, source = self._changed_vertices(before, opening, region)
        self._half_edge_face = opening.half_edge_face
        triangles = [np.array(loop)[triangulate(region.coordinates[loop])] for loop in polygons]
        return CageEdit(
            before=before,
            cage=self.cage,
            wall=self.wall,
            plane=self.plane,
            front=front,
            depth=depth,
            complete=self.complete,
            swept=tuple(region.position[loop] for loop in polygons),
            swept_triangles=region.position[np.concatenate(triangles)] if triangles else np.zeros((0, 3, 3)),
            created=created,
            moved=moved,
            source_faces=source,
        )

    def snapshot(self) -> CutSnapshot:
        """Remember where the cut is, for :meth:`rewind`; nothing is copied."""
        return CutSnapshot(self.section, self.depth, self.front, self.cage, self._half_edge_face)

    def rewind(self, to: float | CutSnapshot = 0.0) -> Cage:
        """Take the blade back and the cut with it: a cut is a function of its depth, so nothing of it stays.

        Args:
            to: A snapshot of this cut, whose very cage comes back, or a depth, of which an equal cage is made [m].

        Returns:
            The cage, the same to the last bit as when the cut had been there on its way.

        Raises:
            TypeError: If the depth is not a number.
            ValueError: If the depth is not a number's value, negative or beyond the depth now, or the snapshot is of
                another cut. Nothing has changed then.
        """
        if isinstance(to, CutSnapshot):
            if to.section is not self.section:
                raise ValueError("the snapshot is of another cut; rewind that one, or take a snapshot of this one")
            self.depth, self.front, self.cage = to.depth, to.front, to.cage
            self._half_edge_face = to.half_edge_face
            return self.cage
        depth = _as_depth(to)
        if not 0.0 <= depth <= self.depth:
            raise ValueError(f"a cut is rewound to a depth between 0 and {self.depth:g}, where it is, not to {depth:g}")
        self.depth, self.front = 0.0, self._front_at(0.0)
        self.cage, self._half_edge_face = self.base, self.base.mesh.face
        if depth > 0.0:
            self.advance(to=depth)
        return self.cage

    def _empty_edit(self) -> CageEdit:
        none = np.zeros(0, dtype=np.int64)
        return CageEdit(
            before=self.cage,
            cage=self.cage,
            wall=self.wall,
            plane=self.plane,
            front=self.front,
            depth=self.depth,
            complete=self.complete,
            swept=(),
            swept_triangles=np.zeros((0, 3, 3)),
            created=none,
            moved=none,
            source_faces=none,
        )

    def _front_at(self, depth: float) -> float:
        """Coordinate of the front, moved on by the tolerance where it would pass too close to a node."""
        nodes, tolerance = self._reached_at, self.base.length_tolerance
        if len(nodes) == 0:
            return 0.0
        if depth <= 0.0:
            return float(nodes[0]) - tolerance
        front = min(float(nodes[0]) + depth, float(nodes[-1]) + tolerance)
        while True:
            last = int(np.searchsorted(nodes, front + tolerance)) - 1
            if last < 0 or nodes[last] <= front - tolerance or nodes[last] + tolerance <= front:
                return front
            front = float(nodes[last]) + tolerance

    def _changed_vertices(
        self, before: Cage, opening: Opening, region: Region
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Created and moved vertices, and faces of the cage before on which they are now."""
        section, numbering = self.section, self._numbering
        half_edge = np.full(self.cage.vertex_count, -1)
        fresh = region.reached
        half_edge[numbering.plus[fresh]] = half_edge[numbering.minus[fresh]] = section.node_half_edge[fresh]
        chords = opening.tip_chords
        ahead = np.where(opening.region.swept[section.chord_node[chords, 0]], 1, 0)
        half_edge[numbering.tip[chords]] = section.half_edge[section.chord_slot[chords, ahead]]
        created = np.arange(before.vertex_count, self.cage.vertex_count)
        moved = np.flatnonzero((before.vertices != self.cage.vertices[: before.vertex_count]).any(axis=1))
        return created, moved, self._half_edge_face[half_edge[np.concatenate([created, moved])]]


def _as_depth(to: float) -> float:
    try:
        depth = float(to)
    except (TypeError, ValueError):
        raise TypeError(f"the depth of a cut must be a number, got {to!r}") from None
    if np.isnan(depth):
        raise ValueError("the depth of a cut must be a number, got nan")
    return depth


def clear_plane(plane: BladePlane, points: np.ndarray, tolerance: float) -> BladePlane:
    """The plane moved, by as little as can be, so that no point is within the tolerance of it.

    Args:
        plane: The plane.
        points: Points to keep off, shape (point_count, 3) [m].
        tolerance: Distance to keep [m].
    """
    distance = np.sort(plane.distance(points))
    if len(distance) == 0 or np.abs(distance).min() > tolerance:
        return plane
    margin = 1.5 * tolerance
    lowest = np.concatenate([[-np.inf], distance + margin])
    highest = np.concatenate([distance - margin, [np.inf]])
    nearest = np.clip(0.0, lowest, highest)[lowest <= highest]
    return plane.shifted(float(nearest[np.argmin(np.abs(nearest))]))


def open_cage(base: Cage, opening: Opening, plane: BladePlane) -> Cage:
    """The cage that a section opened up to a front leaves.

    Args:
        base: The cage before the cut.
        opening: The section opened.
        plane: The plane of the cut.
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
    face_vertex[half - mesh.face_start[owner] + face_start[owner]] = mesh.face_vertex[half]
    for face, loop in zip(opening.faces.tolist(), opening.first_loops, strict=True):
        face_vertex[face_start[face] : face_start[face + 1]] = loop
    if appended:
        face_vertex[face_start[mesh.face_count] :] = np.concatenate(appended)
    wall, extra = len(base.walls), opening.extra_face
    return Cage._assembled(
        base,
        PolygonMesh(np.concatenate([mesh.vertices, opening.created_positions()]), face_start, face_vertex),
        (*base.walls, plane.wall()),
        np.concatenate([base.face_wall, base.face_wall[extra], np.full(len(sides), wall)]).astype(np.int64),
        np.concatenate([base.face_side, base.face_side[extra], np.tile([0, 1], len(sides) // 2)]).astype(np.int64),
    )
