# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What an opened section makes of a cage, and what an edit tells of it.

Section 5.2 of the paper: faces are slit or split, the cut's sides become faces, and the newly swept polygon and the
vertices created or displaced are what the weights' update has to know.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import PolygonMesh, triangulate
from ...section import Opening, SweptRegion
from ..wall import Wall

if TYPE_CHECKING:
    from ..cage import Cage


def open_cage(base: Cage, opening: Opening, wall: Wall) -> Cage:
    """The cage that a section opened up to a front leaves.

    Args:
        base: The cage before the cut.
        opening: The section opened.
        wall: The wall that the cut appends.
    """
    mesh, faces = base.mesh, opening.faces
    minus, plus = opening.vertices.sides
    sides: list[list[int]] = []
    for loop in opening.region.polygons:
        sides += [minus[loop].tolist(), plus[loop[::-1]].tolist()]
    appended = faces.extra_loops + sides
    size = np.concatenate([mesh.face_size, [len(loop) for loop in appended]]).astype(np.int64)
    size[faces.touched] = [len(loop) for loop in faces.first_loops]
    face_start = np.concatenate([[0], np.cumsum(size)])
    face_vertex = np.empty(face_start[-1], dtype=np.int64)
    kept = np.ones(mesh.face_count, dtype=bool)
    kept[faces.touched] = False
    half = np.flatnonzero(kept[mesh.face])
    owner = mesh.face[half]
    face_vertex[half - mesh.face_start[owner] + face_start[owner]] = faces.face_vertex[half]
    for face, loop in zip(faces.touched.tolist(), faces.first_loops, strict=True):
        face_vertex[face_start[face] : face_start[face + 1]] = loop
    if appended:
        face_vertex[face_start[mesh.face_count] :] = np.concatenate(appended)
    number, extra = len(base.walls), faces.extra_face
    return base._assembled(
        base,
        PolygonMesh(np.concatenate([mesh.vertices, opening.vertices.positions]), face_start, face_vertex),
        (*base.walls, wall),
        np.concatenate([base.face_wall, base.face_wall[extra], np.full(len(sides), number)]).astype(np.int64),
        np.concatenate([base.face_side, base.face_side[extra], np.tile([0, 1], len(sides) // 2)]).astype(np.int64),
    )


def swept_polygons(swept: SweptRegion, wall: int) -> dict[str, tuple[np.ndarray, ...] | np.ndarray]:
    """The fields of an edit that tell of what was swept.

    Args:
        swept: What of the section was swept.
        wall: Number of the cut's wall.
    """
    polygons, dimension = swept.polygons, swept.position.shape[1]
    if dimension == 2:
        simplices = np.array(polygons, dtype=np.int64).reshape(-1, 2)
    else:
        parts = [np.array(loop)[triangulate(swept.coordinates[loop])] for loop in polygons]
        simplices = np.concatenate([np.zeros((0, 3), dtype=np.int64), *parts])
    return {
        "swept": tuple(swept.position[loop] for loop in polygons),
        "swept_wall": np.full(len(polygons), wall),
        "swept_simplices": swept.position[simplices],
        "swept_simplex_wall": np.full(len(simplices), wall),
    }


def changed_vertices(
    before: Cage, cage: Cage, opening: Opening, swept: SweptRegion, half_edge_face: np.ndarray
) -> dict[str, np.ndarray]:
    """The fields of an edit that tell of created and moved vertices, and of faces of the cage before that hold them.

    Args:
        before: The cage before the step.
        cage: The cage after the step.
        opening: The section opened, of the cage before the strip.
        swept: What of the section the step swept.
        half_edge_face: Face of ``before`` that walks each half-edge of the cage before the strip.
    """
    section, numbering = opening.section, opening.vertices.numbering
    half_edge = np.full(cage.vertex_count, -1)
    fresh = swept.reached
    half_edge[numbering.plus[fresh]] = half_edge[numbering.minus[fresh]] = section.nodes.half_edge[fresh]
    chords = opening.vertices.tip_chords
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
    return {
        "created": created,
        "moved": moved,
        "source_faces": np.where(half_edge >= 0, half_edge_face[half_edge], -1),
    }
