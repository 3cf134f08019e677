# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages: closed polygon meshes around the volume, or loops of segments around the area, that is cut.

Section 3 of the paper calls this the cage; section 5.1 lets its faces be n-gons, planar in the rest state. Positions
are in the rest frame. In 2D a volume is an area.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from ..geometry import (
    PolygonMesh,
    as_flag,
    as_length,
    as_loops,
    as_number,
    as_points,
    check_finite,
    triangulate_faces,
    units,
    winding_numbers,
)
from .checks import topology
from .edits import extrusion, refinement
from .edits.edit import CageEdit
from .edits.obstacle import insert_obstacle
from .inflation import moved_out
from .pieces import component_piece
from .repair import repaired
from .wall import Wall, face_walls


class Cage:
    """A closed, consistently oriented manifold of planar polygons, or of segments in the plane; immutable."""

    def __init__(
        self, vertices: np.ndarray, faces: Sequence[Sequence[int]], *, tolerance: float = 1e-6, repair: bool = False
    ):
        """Validate and build a cage.

        Args:
            vertices: Rest positions, shape (vertex_count, 3), or (vertex_count, 2) in the plane [m].
            faces: Loops of vertex ids, counterclockwise seen from outside. In the plane segments (a, b) with the inside
                to their left: outer loops counterclockwise, those around holes clockwise.
            tolerance: Length below which things coincide, relative to the diagonal of the bounding box.
            repair: Whether faces that are not planar are cut into triangles, outwards where that goes, and a cage that
                is inside out is turned. Vertices stay what they are.

        Raises:
            TypeError: If the vertices are not numbers or the faces not sequences of integers.
            ValueError: If the cage is not what the class promises; the text names the culprit.
        """
        positions = as_points(vertices, "vertices", rows="vertex_count", widths=(3, 2))
        face_start, face_vertex = as_loops(faces, "the cage")
        tolerance = as_number(tolerance, "tolerance", limits=(0.0, 0.1))
        if not 0.0 < tolerance < 0.1:
            raise ValueError(f"tolerance must lie between 0 and 0.1, got {tolerance}")
        topology.check_loops(positions, face_start, face_vertex, simple=True)
        self.tolerance = tolerance
        self.diameter = float(np.linalg.norm(positions.max(axis=0) - positions.min(axis=0)))
        if as_flag(repair, "repair"):
            face_start, face_vertex = as_loops(
                repaired(
                    positions,
                    face_start,
                    face_vertex,
                    tolerance=self.length_tolerance,
                    build=lambda loops: Cage(positions, loops, tolerance=tolerance),
                ),
                "the cage",
            )
        self.mesh = PolygonMesh(positions, face_start, face_vertex)
        topology.check_boundary(self.mesh, self.length_tolerance)
        normals = units(self.mesh.face_area_vector)
        topology.check_planarity(self.mesh, normals, self.length_tolerance)
        self.walls: tuple[Wall, ...] = face_walls(positions, face_start, face_vertex, normals)
        self.face_wall = np.arange(self.face_count)
        self.face_side = np.zeros(self.face_count, dtype=np.int64)
        topology.check_crossings(self)
        self._freeze()

    @classmethod
    def _assembled(
        cls, base: Cage, mesh: PolygonMesh, walls: tuple[Wall, ...], face_wall: np.ndarray, face_side: np.ndarray
    ) -> Cage:
        """A cage that an edit made of ``base``, taken as it is."""
        cage = cls.__new__(cls)
        cage.tolerance = base.tolerance
        cage.diameter = base.diameter
        cage.mesh = mesh
        cage.walls = walls
        cage.face_wall = face_wall
        cage.face_side = face_side
        cage._freeze()
        return cage

    def _freeze(self) -> None:
        mesh = self.mesh
        for array in (mesh.vertices, mesh.face_start, mesh.face_vertex, self.face_wall, self.face_side):
            array.setflags(write=False)

    def __repr__(self) -> str:
        counts = (self.vertex_count, self.face_count, self.component_count)
        return "Cage(vertex_count={}, face_count={}, component_count={})".format(*counts)

    @property
    def dimension(self) -> int:
        """Dimension of the space, 2 or 3."""
        return self.mesh.dimension

    @property
    def vertices(self) -> np.ndarray:
        """Rest positions, shape (vertex_count, dimension) [m]."""
        return self.mesh.vertices

    @cached_property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """Loops of vertex ids, counterclockwise seen from outside; a slit's loop walks to its tip and back.

        In 2D pairs of vertex ids, with the inside to the left.
        """
        return self.mesh.loops()

    @property
    def vertex_count(self) -> int:
        """Number of vertices."""
        return self.mesh.vertex_count

    @property
    def face_count(self) -> int:
        """Number of faces."""
        return self.mesh.face_count

    @property
    def length_tolerance(self) -> float:
        """Length below which things coincide [m]."""
        return self.tolerance * self.diameter

    @property
    def face_key(self) -> np.ndarray:
        """``2 * wall + side`` of each face, shape (face_count,)."""
        return 2 * self.face_wall + self.face_side

    @property
    def face_component(self) -> np.ndarray:
        """Connected component of each face, shape (face_count,)."""
        return self.mesh.face_component

    @property
    def vertex_component(self) -> np.ndarray:
        """Connected component of each vertex, numbered by their lowest vertices, shape (vertex_count,)."""
        return self.mesh.vertex_component

    @property
    def component_count(self) -> int:
        """Number of connected components."""
        return self.mesh.component_count

    @cached_property
    def component_piece(self) -> np.ndarray:
        """Solid piece to which each component belongs; cavities and inner cuts to that around them.

        Shape (component_count,).
        """
        return component_piece(self)

    @property
    def face_piece(self) -> np.ndarray:
        """Solid piece that each face bounds, shape (face_count,)."""
        return self.component_piece[self.face_component]

    @property
    def vertex_piece(self) -> np.ndarray:
        """Solid piece of each vertex, numbered by their lowest vertices, shape (vertex_count,)."""
        return self.component_piece[self.vertex_component]

    @property
    def piece_volumes(self) -> np.ndarray:
        """Volume, in 2D area, of each solid piece, cavities taken off, shape (piece_count,) [m^d]."""
        return np.bincount(self.component_piece, weights=self.component_volumes)

    @property
    def piece_count(self) -> int:
        """Number of solid pieces."""
        return int(self.component_piece.max()) + 1

    @property
    def component_volumes(self) -> np.ndarray:
        """Enclosed volume, in 2D area, of each component, negative for a cavity, nothing for a cut wholly inside.

        Shape (component_count,) [m^d].
        """
        return self.mesh.component_volumes

    @property
    def volume(self) -> float:
        """Enclosed volume, in 2D area [m^d]."""
        return float(self.mesh.face_volume.sum())

    @property
    def euler_characteristic(self) -> int:
        """Vertices minus edges plus faces, in 2D vertices minus segments."""
        if self.dimension == 2:
            return self.vertex_count - self.face_count
        return self.vertex_count - self.mesh.edge_count + self.face_count

    @cached_property
    def corner_coordinates(self) -> np.ndarray:
        """In-plane coordinates of every half-edge's origin on its face's wall, shape (half_edge_count, 2) [m].

        The second axis is reversed on faces of side 1, so that all faces are counterclockwise.
        """
        owner = self.face_wall[self.mesh.face]
        axes = np.array([wall.axes for wall in self.walls])[owner]
        offset = self.vertices[self.mesh.face_vertex] - np.array([wall.origin for wall in self.walls])[owner]
        coordinates = np.einsum("hij,hj->hi", axes, offset)
        coordinates[:, 1] *= 1 - 2 * self.face_side[self.mesh.face]
        return coordinates

    @cached_property
    def _triangulation(self) -> tuple[np.ndarray, np.ndarray]:
        if self.dimension == 2:
            raise ValueError("the faces of a plane cage are segments, not triangles; use simplices and simplex_face")
        return triangulate_faces(self.mesh, self.corner_coordinates)

    @property
    def triangles(self) -> np.ndarray:
        """Triangles of the faces as vertex ids, shape (triangle_count, 3)."""
        return self._triangulation[0]

    @property
    def simplices(self) -> np.ndarray:
        """What the boundary is made of, triangles of the faces or segments, shape (simplex_count, dimension)."""
        return self.mesh.face_vertex.reshape(-1, 2) if self.dimension == 2 else self.triangles

    @property
    def simplex_face(self) -> np.ndarray:
        """Face of each simplex, sorted, shape (simplex_count,)."""
        return np.arange(self.face_count) if self.dimension == 2 else self.triangle_face

    @property
    def triangle_face(self) -> np.ndarray:
        """Face of each triangle, sorted, shape (triangle_count,)."""
        return self._triangulation[1]

    def validate(self) -> None:
        """Check the cage again, slits and coincident sides of cuts being allowed.

        Raises:
            ValueError: If the cage is not a closed, oriented manifold of planar polygons, in 2D of segments, around a
                positive volume.
        """
        topology.check_loops(self.vertices, self.mesh.face_start, self.mesh.face_vertex, simple=False)
        topology.check_topology(self.mesh)
        normals = np.array([wall.normal for wall in self.walls])[self.face_wall]
        topology.check_planarity(self.mesh, normals, self.length_tolerance)
        topology.check_volume(self.mesh)

    def winding_numbers(self, points: np.ndarray) -> np.ndarray:
        """Winding number of each point about each component.

        Args:
            points: Points, shape (point_count, dimension) [m].

        Returns:
            Winding numbers, shape (point_count, component_count).

        Raises:
            TypeError: If the points are not numbers.
            ValueError: If they have another shape or are not finite.
        """
        points = as_points(points, "points", rows="point_count", widths=(self.dimension,))
        check_finite(points, "points")
        group = self.face_component[self.simplex_face]
        return winding_numbers(points, self.vertices, self.simplices, group, self.component_count)

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points lie inside the cage.

        Args:
            points: Points, shape (point_count, dimension) [m].

        Returns:
            True for the points inside, shape (point_count,).

        Raises:
            TypeError: If the points are not numbers.
            ValueError: If they have another shape or are not finite.
        """
        return self.winding_numbers(points).sum(axis=1) > 0.5

    def piece_of(self, points: np.ndarray) -> np.ndarray:
        """Solid piece in which points lie.

        Args:
            points: Points, shape (point_count, dimension) [m].

        Returns:
            Piece of each point, -1 outside the cage, shape (point_count,).

        Raises:
            TypeError: If the points are not numbers.
            ValueError: If they have another shape or are not finite.
        """
        number = self.winding_numbers(points)
        volume = np.where((number > 0.5) & self.mesh.component_outward, self.component_volumes, np.inf)
        return np.where(number.sum(axis=1) > 0.5, self.component_piece[volume.argmin(axis=1)], -1)

    def extrude(self, face: int, distance: float) -> CageEdit:
        """Move a face outward along its normal and close the gap around it with new faces; the cage stays as it is.

        Args:
            face: A face that no cut has slit or split.
            distance: How far it moves [m].

        Returns:
            The step to the extended cage.

        Raises:
            TypeError: If the face is not an integer or the distance not a number.
            ValueError: If the face cannot be extruded or something is in its way; the text names the culprit.
        """
        return extrusion.extrude(self, face, distance)

    def move_face(self, face: int, distance: float) -> CageEdit:
        """Move a face outward along its normal, its neighbours growing with it; the cage stays as it is.

        Args:
            face: A face that no cut has slit or split, at right angles to all its neighbours.
            distance: How far it moves [m].

        Returns:
            The step to the extended cage.

        Raises:
            TypeError: If the face is not an integer or the distance not a number.
            ValueError: If a neighbour would not stay planar, or something is in its way; the text names the culprit.
        """
        return extrusion.move_face(self, face, distance)

    def refine(self) -> Cage:
        """The cage with a vertex in the middle of each edge, and its faces split; the cage stays as it is.

        Faces stay in their planes and the walls are the same, so walks land where they did. Triangles become four
        triangles and convex quads four quads; other faces are cut into triangles first. Extrude and move faces before:
        parts of a wall do not move alone.

        Returns:
            A cage with about four times, in 2D twice, the faces.

        Raises:
            ValueError: If the cage has been cut.
        """
        mesh, parent = refinement.refined(self)
        cage = Cage._assembled(self, mesh, self.walls, self.face_wall[parent], self.face_side[parent])
        cage.validate()
        return cage

    def triangulated(self) -> Cage:
        """The cage with all its faces cut into triangles, in their planes; the cage stays as it is.

        Faces that are not planar are cut where a cage is made of them: ``Cage(vertices, faces, repair=True)``.

        Raises:
            ValueError: If the cage has been cut, or is a plane one.
        """
        refinement.refuse_cuts(self, "cut it into triangles")
        return Cage(self.vertices, self.triangles, tolerance=self.tolerance)

    def inflated(self, distance: float) -> Cage:
        """The cage with its faces moved outward by a distance at least; the cage stays as it is.

        Around corners of more than three planes, in the plane never, faces may bend; those are cut into triangles.

        Args:
            distance: The distance [m].

        Raises:
            TypeError: If the distance is not a number.
            ValueError: If it is not positive, the cage has been cut, or faces would cross each other.
        """
        length = as_length(distance, "the distance")
        refinement.refuse_cuts(self, "inflate it")
        return Cage(moved_out(self, length), self.faces, tolerance=self.tolerance, repair=True)

    def insert(self, obstacle: Cage) -> CageEdit:
        """Take the room of an obstacle from the body; the cage stays as it is.

        Args:
            obstacle: A cage without cuts, strictly inside the body.

        Returns:
            The step to the cage with a cavity.

        Raises:
            TypeError: If the obstacle is not a cage.
            ValueError: If the obstacle is not strictly inside the body; the text names the culprit.
        """
        return insert_obstacle(self, obstacle)
