# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Edits that extend a cage: a face moves outward.

Section 8 of the paper names extrusions as edits after which walks resume from their former landing points. What the
face sweeps, the prism between its old and its new place, becomes part of the body; the wall of its old place retires.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...geometry import PolygonMesh, as_index, as_number, units, winding_numbers
from ..wall import face_walls
from .edit import CageEdit, swept_faces
from .face_contact import find_contact

if TYPE_CHECKING:
    from ..cage import Cage

_NONE = np.zeros(0, dtype=np.int64)


def extrude(cage: Cage, face: int, distance: float) -> CageEdit:
    """Move a face outward along its normal and join its old border to the new one by further faces.

    Vertices, faces and walls keep their numbers. The vertices of the moved face are new, in the order of its loop; the
    further faces follow the order of its edges. The moved face and each of those have a wall of their own.

    Args:
        cage: The cage, which may have been cut.
        face: The face, which no cut has slit or split.
        distance: How far it moves [m].

    Raises:
        TypeError: If the face is not an integer or the distance not a number.
        ValueError: If the face cannot be extruded or something is in its way; the text names the culprit.
    """
    face, distance = _checked(cage, face, distance)
    grown = _extruded(cage, face, distance)
    _check_way(cage, grown, face, distance)
    grown.validate()
    faces = np.concatenate([[face], np.arange(cage.face_count, grown.face_count)])
    created = np.arange(cage.vertex_count, grown.vertex_count)
    return CageEdit(
        before=cage,
        cage=grown,
        **swept_faces(grown, faces, grown.face_wall[faces]),
        created=created,
        moved=_NONE,
        source_faces=np.full(len(created), -1),
        retired_walls=cage.face_wall[[face]],
    )


def move_face(cage: Cage, face: int, distance: float) -> CageEdit:
    """Move a face outward along its normal, its neighbours growing with it.

    No vertex and no face is added. The moved face has a new wall; its neighbours' walls gain a strip each.

    Args:
        cage: The cage, which may have been cut.
        face: The face, which no cut has slit or split, between neighbours that are parallel to its normal.
        distance: How far it moves [m].

    Raises:
        TypeError: If the face is not an integer or the distance not a number.
        ValueError: If the face cannot be moved, a neighbour would not just grow, or something is in its way; the text
            names the culprit.
    """
    face, distance = _checked(cage, face, distance)
    _check_neighbours(cage, face, distance)
    grown = _extruded(cage, face, distance)
    _check_way(cage, grown, face, distance)
    mesh, wall = cage.mesh, len(cage.walls)
    loop, top = _loop(mesh, face), _loop(grown.mesh, face)
    vertices, face_wall = mesh.vertices.copy(), cage.face_wall.copy()
    vertices[loop] = grown.vertices[top]
    face_wall[face] = wall
    moved_mesh = PolygonMesh(vertices, mesh.face_start, mesh.face_vertex)
    walls = (*cage.walls, grown.walls[wall])
    result = cage._assembled(cage, moved_mesh, walls, face_wall, cage.face_side)
    result.validate()
    sides = np.arange(cage.face_count, grown.face_count)
    strip_walls = cage.face_wall[_neighbours(mesh, face)]
    return CageEdit(
        before=cage,
        cage=result,
        **swept_faces(grown, np.append(sides, face), np.append(strip_walls, wall)),
        created=_NONE,
        moved=np.sort(loop),
        source_faces=np.full(len(loop), -1),
        retired_walls=cage.face_wall[[face]],
    )


def _checked(cage: Cage, face: int, distance: float) -> tuple[int, float]:
    """The arguments, if the face can leave its place and the distance is one."""
    face = as_index(face, "the face")
    if not 0 <= face < cage.face_count:
        raise ValueError(f"the cage has faces 0 to {cage.face_count - 1}, there is no face {face}")
    distance = as_number(distance, "the distance that a face moves")
    farthest = cage.length_tolerance / np.finfo(float).eps  # beyond it rounding is coarser than the tolerance
    if not cage.length_tolerance < distance <= farthest:
        raise ValueError(
            f"a face moves outward by a finite distance beyond the cage's tolerance of {cage.length_tolerance:.3g} m, "
            f"at most {farthest:.3g} m, got {distance:g} m; put an obstacle in or cut to take from the body"
        )
    _check_uncut(cage, face)
    return face, distance


def _check_uncut(cage: Cage, face: int) -> None:
    """Check that a face is alone on its wall, without slits, so that the wall can retire."""
    wall = cage.face_wall[face]
    if cage.walls[wall].two_sided:
        raise ValueError(f"face {face} of the cage is a side of a cut, of which the wall stays; choose another face")
    others = np.setdiff1d(np.flatnonzero(cage.face_wall == wall), face)
    if len(others):
        split = "a cut or refine() has split" if any(wall.two_sided for wall in cage.walls) else "refine() has split"
        raise ValueError(
            f"{split} face {face} of the cage from face {others[0]}, and their wall cannot retire in part; move or "
            "extrude faces before that, or choose another face"
        )
    if any(cage.walls[cage.face_wall[neighbour]].two_sided for neighbour in _neighbours(cage.mesh, face)):
        raise ValueError(f"a cut has slit face {face} of the cage; move it before it is cut, or choose another face")


def _loop(mesh: PolygonMesh, face: int) -> np.ndarray:
    return mesh.face_vertex[mesh.face_start[face] : mesh.face_start[face + 1]]


def _neighbours(mesh: PolygonMesh, face: int) -> np.ndarray:
    """The face next to each side face that an extrusion would add, shape (side_count,)."""
    begin, end = mesh.face_start[face : face + 2]
    if mesh.dimension == 3:
        return mesh.face[mesh.twin[begin:end]]
    segments, (first, last) = mesh.face_vertex.reshape(-1, 2), mesh.face_vertex[begin:end]
    return np.concatenate([np.flatnonzero(segments[:, 1] == first), np.flatnonzero(segments[:, 0] == last)])


def _extruded(cage: Cage, face: int, distance: float) -> Cage:
    """The cage with a face at its new place and faces around the prism that it swept; nothing is checked."""
    mesh, old_wall = cage.mesh, cage.walls[cage.face_wall[face]]
    loop, offset = _loop(mesh, face), distance * old_wall.normal
    top = mesh.vertex_count + np.arange(len(loop))
    if cage.dimension == 3:
        sides = np.stack([loop, np.roll(loop, -1), np.roll(top, -1), top], axis=1)
    else:
        sides = np.array([[loop[0], top[0]], [top[1], loop[1]]])
    side_count, size = sides.shape
    grown = mesh.extended(mesh.vertices[loop] + offset, np.full(side_count, size), sides.ravel())
    grown.face_vertex[mesh.face_start[face] : mesh.face_start[face + 1]] = top
    normals = units(grown.face_area_vector[mesh.face_count :])
    side_walls = face_walls(grown.vertices, size * np.arange(side_count + 1), sides.ravel(), normals)
    walls = (*cage.walls, replace(old_wall, origin=old_wall.origin + offset), *side_walls)
    face_wall = np.append(cage.face_wall, len(cage.walls) + 1 + np.arange(side_count))
    face_wall[face] = len(cage.walls)
    face_side = np.append(cage.face_side, np.zeros(side_count, dtype=np.int64))
    return cage._assembled(cage, grown, walls, face_wall, face_side)


def _check_neighbours(cage: Cage, face: int, distance: float) -> None:
    """Check that a face's neighbours stay planar and gain a strip each when it moves, and change in no other way."""
    mesh, normal = cage.mesh, cage.walls[cage.face_wall[face]].normal
    has_moved = np.zeros(mesh.vertex_count, dtype=bool)
    has_moved[_loop(mesh, face)] = True
    touching = np.setdiff1d(mesh.face[has_moved[mesh.face_vertex]], face)
    slope = np.abs(np.array([cage.walls[wall].normal for wall in cage.face_wall[touching]]) @ normal)
    if slope.max() * distance > cage.length_tolerance:
        raise ValueError(
            f"face {touching[slope.argmax()]} of the cage would not stay planar if face {face} moved: it is not at "
            f"a right angle to it; use extrude({face}, {distance:g}), which adds faces"
        )
    edges = mesh.edges[has_moved[mesh.edges].sum(axis=1) == 1]
    start = np.where(has_moved[edges[:, 0]], edges[:, 0], edges[:, 1])
    along = mesh.vertices[edges.sum(axis=1) - start] - mesh.vertices[start]
    back = -(along @ normal)
    aside = np.linalg.norm(along + back[:, None] * normal, axis=1)
    bad = np.flatnonzero((back <= 0.0) | (aside * distance > cage.length_tolerance * np.abs(back + distance)))
    if len(bad):
        a, b = edges[bad[0]].tolist()
        grows = "shrink" if back[bad[0]] <= 0.0 else "not just gain a strip"
        at_edge = np.flatnonzero(mesh.edge_key == min(a, b) * mesh.vertex_count + max(a, b))
        raise ValueError(
            f"face {mesh.face[at_edge[0]]} of the cage would {grows} if face {face} moved, because its edge ({a}, {b}) "
            f"does not run straight back; use extrude({face}, {distance:g}) if the way is free"
        )


def _check_way(cage: Cage, grown: Cage, face: int, distance: float) -> None:
    """Check that nothing of a cage is in the prism that a face sweeps, and nothing touches it but at its border."""
    added = np.arange(grown.face_count) >= cage.face_count
    added[face] = True
    contact = find_contact(grown, added)
    other = None if contact is None else contact[1]
    if other is None:
        vertex = _vertex_in_prism(cage, grown, face, added)
        other = None if vertex is None else int(cage.mesh.face[np.flatnonzero(cage.mesh.face_vertex == vertex)[0]])
    if other is not None:
        raise ValueError(
            f"face {face} of the cage would run into face {other} or fold onto it within {distance:g} m; move it less "
            "far, or choose another face"
        )


def _vertex_in_prism(cage: Cage, grown: Cage, face: int, added: np.ndarray) -> int | None:
    """A vertex of a cage inside the prism that a face sweeps, if there is one."""
    loop, top = _loop(cage.mesh, face), _loop(grown.mesh, face)
    corners = grown.vertices[np.concatenate([loop, top])]
    near = ((cage.vertices >= corners.min(axis=0)) & (cage.vertices <= corners.max(axis=0))).all(axis=1)
    near[loop] = False
    near = np.flatnonzero(near)
    bottom = cage.simplices[cage.simplex_face == face][:, ::-1]
    shell = np.concatenate([bottom, grown.simplices[added[grown.simplex_face]]])
    number = winding_numbers(cage.vertices[near], grown.vertices, shell, np.zeros(len(shell), dtype=np.int64), 1)
    inside = near[number[:, 0] > 0.5]
    return int(inside[0]) if len(inside) else None
