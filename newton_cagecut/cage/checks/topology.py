# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks that a cage is a closed, oriented manifold of planar polygons, in 2D of segments, around a positive volume.

Section 3 of the paper asks for such a boundary and leaves finding out to the user. Every refusal names the culprit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import PolygonMesh
from . import crossings, segment_checks

if TYPE_CHECKING:
    from ..cage import Cage

_WELD = "merge coincident vertices and fill holes so that every edge has exactly two faces"


def check_loops(vertices: np.ndarray, face_start: np.ndarray, face_vertex: np.ndarray, *, simple: bool) -> None:
    """Check indices and positions, before half-edges mean anything.

    Args:
        vertices: Positions, shape (vertex_count, dimension) [m].
        face_start: First half-edge of each face and the end of the last, shape (face_count + 1,).
        face_vertex: Vertex at which each half-edge starts, shape (half_edge_count,).
        simple: Whether a face may visit a vertex only once.

    Raises:
        ValueError: If something is not finite, out of range, too short, repeated or unused.
    """
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise ValueError(f"vertex {bad[0]} of the cage is not finite: {vertices[bad[0]].tolist()}")
    size = np.diff(face_start)
    if len(size) == 0:
        raise ValueError("the cage has no faces")
    is_plane = vertices.shape[1] == 2
    bad = np.flatnonzero(size != 2 if is_plane else size < 3)
    if len(bad):
        needs = "of a plane cage is a segment of 2" if is_plane else "needs at least 3"
        raise ValueError(f"face {bad[0]} of the cage has {size[bad[0]]} vertices; a face {needs}")
    face = np.repeat(np.arange(len(size)), size)
    bad = np.flatnonzero((face_vertex < 0) | (face_vertex >= len(vertices)))
    if len(bad):
        h = bad[0]
        raise ValueError(
            f"face {face[h]} of the cage uses vertex {face_vertex[h]}, but there are only {len(vertices)} vertices"
        )
    if simple:
        key = np.sort(face * len(vertices) + face_vertex)
        bad = np.flatnonzero(key[1:] == key[:-1])
        if len(bad):
            where, vertex = divmod(int(key[bad[0]]), len(vertices))
            advice = "give it two ends" if is_plane else "split it into simple polygons"
            raise ValueError(f"face {where} of the cage visits vertex {vertex} twice; {advice}")
    bad = np.flatnonzero(np.bincount(face_vertex, minlength=len(vertices)) == 0)
    if len(bad):
        raise ValueError(f"vertex {bad[0]} of the cage belongs to no face; remove the {len(bad)} unused vertices")


def check_boundary(mesh: PolygonMesh, tolerance: float) -> None:
    """Check that a cage's faces bound a positive volume, before it is known where their planes are.

    Args:
        mesh: The cage's faces.
        tolerance: Length below which two things coincide [m].

    Raises:
        ValueError: If they do not.
    """
    if tolerance == 0.0:
        raise ValueError("all vertices of the cage coincide")
    check_topology(mesh)
    check_areas(mesh, tolerance)
    if mesh.dimension == 2:
        segment_checks.check_crossings(mesh, tolerance)
    check_volume(mesh)


def check_crossings(cage: Cage) -> None:
    """Check that a cage's faces cross neither themselves nor each other, and that its components are nested right.

    Args:
        cage: The cage; in 2D its segments are known not to cross.

    Raises:
        ValueError: If they do, or are not.
    """
    if cage.dimension == 3:
        crossings.check_simple_faces(cage.mesh, cage.corner_coordinates, cage.length_tolerance)
        crossings.check_face_pairs(cage.mesh, cage.triangles, cage.triangle_face, cage.length_tolerance)
    crossings.check_nesting(cage.vertices, cage.vertex_component, cage.component_volumes, cage.winding_numbers)


def check_topology(mesh: PolygonMesh) -> None:
    """Check that every edge has two opposite half-edges and every vertex one fan of faces, or one way through in 2D.

    Args:
        mesh: The cage's faces.

    Raises:
        ValueError: If the mesh is open, not manifold or not consistently oriented.
    """
    if mesh.dimension == 2:
        segment_checks.check_closed(mesh)
        return
    lonely = np.flatnonzero(mesh.twin < 0)
    if len(lonely):
        _refuse_edge(mesh, int(lonely[0]))
    fan_starts = np.unique(mesh.fan)
    count = np.bincount(mesh.face_vertex[fan_starts], minlength=mesh.vertex_count)
    bad = np.flatnonzero(count > 1)
    if len(bad):
        faces = np.unique(mesh.face[np.flatnonzero(mesh.face_vertex == bad[0])]).tolist()
        raise ValueError(
            f"vertex {bad[0]} of the cage joins {count[bad[0]]} separate fans of faces (faces {faces}): "
            "the surface is not a manifold there; give each fan a vertex of its own"
        )


def _refuse_edge(mesh: PolygonMesh, half_edge: int) -> None:
    """Raise with what is wrong at a half-edge that has no single twin."""
    same = np.flatnonzero(mesh.edge_key == mesh.edge_key[half_edge])
    a, b = sorted((int(mesh.face_vertex[half_edge]), int(mesh.destination[half_edge])))
    faces = mesh.face[same].tolist()
    if len(same) == 1:
        raise ValueError(f"the cage is open: edge ({a}, {b}) belongs to face {faces[0]} only; {_WELD}")
    if len(same) > 2:
        raise ValueError(
            f"edge ({a}, {b}) of the cage belongs to {len(same)} faces {faces}: it is not manifold; {_WELD}"
        )
    raise ValueError(
        f"faces {faces[0]} and {faces[1]} of the cage run along edge ({a}, {b}) in the same direction: "
        "they are not consistently oriented; reverse one of them"
    )


def check_areas(mesh: PolygonMesh, tolerance: float) -> None:
    """Check that edges have length and faces area.

    Args:
        mesh: The cage's polygons.
        tolerance: Length below which two things coincide [m].

    Raises:
        ValueError: If an edge or a face is degenerate.
    """
    length = np.linalg.norm(mesh.vertices[mesh.destination] - mesh.vertices[mesh.face_vertex], axis=1)
    bad = np.flatnonzero(length <= tolerance)
    if len(bad):
        a, b = mesh.face_vertex[bad[0]], mesh.destination[bad[0]]
        raise ValueError(f"edge ({a}, {b}) of face {mesh.face[bad[0]]} of the cage has no length; merge its vertices")
    area = np.linalg.norm(mesh.face_area_vector, axis=1)
    bad = np.flatnonzero(area <= 0.5 * tolerance * np.maximum.reduceat(length, mesh.face_start[:-1]))
    if len(bad):
        raise ValueError(f"face {bad[0]} of the cage is degenerate: its area is {area[bad[0]]:.3g}; remove it")


def check_planarity(mesh: PolygonMesh, normals: np.ndarray, tolerance: float) -> None:
    """Check that the corners of each face lie in a plane.

    Args:
        mesh: The cage's polygons.
        normals: Unit normal of each face's plane, or of its line in 2D, shape (face_count, dimension).
        tolerance: Largest spread across the plane [m].

    Raises:
        ValueError: If a face is not planar.
    """
    height = np.einsum("ij,ij->i", mesh.corner_offset, normals[mesh.face])
    highest = np.maximum.reduceat(height, mesh.face_start[:-1])
    spread = highest - np.minimum.reduceat(height, mesh.face_start[:-1])
    bad = int(np.argmax(spread))
    if spread[bad] > tolerance:
        begin, end = mesh.face_start[bad], mesh.face_start[bad + 1]
        worst = mesh.face_vertex[begin + int(np.argmax(np.abs(height[begin:end] - height[begin:end].mean())))]
        raise ValueError(
            f"face {bad} of the cage is not planar: its vertices (worst: {worst}) spread over {spread[bad]:.3g} across "
            f"its plane, the tolerance is {tolerance:.3g}; triangulate it (repair=True does) or flatten it"
        )


def check_volume(mesh: PolygonMesh) -> None:
    """Check that the enclosed volume, in 2D the area, is positive.

    Args:
        mesh: The cage's polygons.

    Raises:
        ValueError: If the volume is zero or negative.
    """
    volume = float(mesh.face_volume.sum())
    if volume <= 0.0:
        what = "area" if mesh.dimension == 2 else "volume"
        raise ValueError(
            f"the cage is inside out: its {what} is {volume:.6g}; reverse all {mesh.face_count} faces, or repair=True"
        )
