# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Edits that obstruct: an obstacle is put into a cage.

Section 8 of the paper names obstructing edits as those after which walks are walked again. The room of the obstacle is
taken from the body: its boundary becomes the boundary of a cavity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import as_instance
from ..wall import face_walls
from .edit import CageEdit, swept_faces
from .face_contact import find_contact

if TYPE_CHECKING:
    from ..cage import Cage

_LARGEST_TOLERANCE = 0.1


def insert_obstacle(cage: Cage, obstacle: Cage) -> CageEdit:
    """Take the room of an obstacle from a cage.

    Vertices, faces and walls keep their numbers; those of the obstacle follow in its own order. Its loops are reversed,
    so that the body is outside of them. A hollow obstacle leaves a piece of the body inside it.

    Args:
        cage: The cage, which may have been cut.
        obstacle: What is put in, strictly inside the body; it has no cuts of its own.

    Raises:
        TypeError: If the obstacle is not a cage.
        ValueError: If the obstacle is not one for this cage or not strictly inside it; the text names the culprit.
    """
    solid = _as_solid(cage, obstacle)
    mesh, first = solid.mesh, cage.face_count
    backward = (mesh.face_start[:-1] + mesh.face_start[1:] - 1)[mesh.face] - np.arange(len(mesh.face_vertex))
    loops = mesh.face_vertex[backward]
    walls = face_walls(mesh.vertices, mesh.face_start, loops, -np.array([wall.normal for wall in solid.walls]))
    result = cage._assembled(
        cage,
        cage.mesh.extended(mesh.vertices, mesh.face_size, cage.vertex_count + loops),
        (*cage.walls, *walls),
        np.append(cage.face_wall, len(cage.walls) + np.arange(mesh.face_count)),
        np.append(cage.face_side, np.zeros(mesh.face_count, dtype=np.int64)),
    )
    _check_room(cage, solid, result)
    result.validate()
    faces, created = np.arange(first, result.face_count), np.arange(cage.vertex_count, result.vertex_count)
    return CageEdit(
        before=cage,
        cage=result,
        **swept_faces(result, faces, result.face_wall[faces]),
        created=created,
        moved=np.zeros(0, dtype=np.int64),
        source_faces=np.full(len(created), -1),
    )


def _as_solid(cage: Cage, obstacle: Cage) -> Cage:
    """The obstacle as a cage of the same tolerance, with a wall for each face."""
    as_instance(obstacle, type(cage), "the obstacle")
    if obstacle.dimension != cage.dimension:
        raise ValueError(f"an obstacle of dimension {obstacle.dimension} does not fit a cage of {cage.dimension}")
    for face, wall in enumerate(obstacle.face_wall.tolist()):
        if obstacle.walls[wall].two_sided:
            raise ValueError(f"face {face} of the obstacle is a side of a cut; put in a cage that has not been cut")
    tolerance = cage.length_tolerance / obstacle.diameter
    if tolerance >= _LARGEST_TOLERANCE:
        raise ValueError(
            f"the obstacle is {obstacle.diameter:.3g} m across, too small for a cage with a tolerance of "
            f"{cage.length_tolerance:.3g} m; make it larger or leave it out"
        )
    try:
        return type(cage)(obstacle.vertices, obstacle.faces, tolerance=tolerance)
    except ValueError as error:
        raise ValueError(
            f"the obstacle, checked as a cage with the tolerance of the one around it, {cage.length_tolerance:.3g} m: "
            f"{error}"
        ) from None


def _check_room(cage: Cage, solid: Cage, result: Cage) -> None:
    """Check that an obstacle lies strictly inside a body and nothing of the body in it."""
    contact = find_contact(result, np.arange(result.face_count) >= cage.face_count)
    if contact is not None:
        raise ValueError(
            f"face {contact[0] - cage.face_count} of the obstacle meets face {contact[1]} of the cage; an obstacle "
            "lies strictly inside the body, so move it or make it smaller"
        )
    outside = np.flatnonzero(~cage.contains(solid.vertices))
    if len(outside):
        raise ValueError(
            f"vertex {outside[0]} of the obstacle lies outside the cage, at {solid.vertices[outside[0]].tolist()}; an "
            "obstacle lies strictly inside the body, so move it in"
        )
    enclosed = np.flatnonzero(solid.contains(cage.vertices))
    if len(enclosed):
        raise ValueError(
            f"the obstacle encloses vertex {enclosed[0]} of the cage; cut around it or put obstacles beside it"
        )
