# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Faces slit and split with the front of a cut at one place.

Section 5.2 and figure 8 of the paper list the cases; here they are two rules. A loop that arrives at a crossing behind
the front goes to the chord's other end if that is behind the front too, which splits the face, and to the chord's tip
and back on the other side if not, which slits it.
"""

from __future__ import annotations

import numpy as np

from ..geometry import bridge_holes, contains_point
from .created_vertices import CreatedVertices
from .opening import OpenedFaces

_SHUT, _OPEN, _PINNED = 0, 1, 2

Hops = dict[int, tuple[tuple[int, ...], int]]
"""For each half-edge with an open crossing: vertices to insert and the half-edge with which to go on."""
Slits = list[tuple[int, list[int]]]


def walk_faces(created: CreatedVertices) -> OpenedFaces:
    """Walk the loops of the touched faces, the first of each keeping the face's place.

    Args:
        created: The vertices of an opened section of polygons.
    """
    section, mesh = created.section, created.section.mesh
    face_vertex = _parted(created)
    open_ends = created.region.swept[section.chord_node]
    touched = np.unique(section.chord_face[open_ends.any(axis=1) & (section.chord_face >= 0)])
    hops, slits = _hops(created, open_ends)
    hinge = set(section.hinge_corner.tolist()) if hops else set()
    place: dict[int, tuple[int, int]] = {}
    loops = {}
    bounds = (touched.tolist(), mesh.face_start[touched].tolist(), mesh.face_start[touched + 1].tolist())
    for face, begin, end in zip(*bounds, strict=True):
        vertex, after = face_vertex[begin:end].tolist(), mesh.next[begin:end].tolist()
        loops[face] = _walk_face(face, begin, vertex, after, hops, hinge, place)
    for h, corner in zip(section.hinge_arrive.tolist(), section.hinge_corner.tolist(), strict=True):
        if h in place:
            place[corner] = place[h]
    for chord, slit in slits:
        face = int(section.chord_face[chord])
        _join_slit(created, face, loops[face], slit)
    extra_loops, extra_face, number = _order_extra(created, open_ends, loops)
    half_edge_face = mesh.face.copy()
    for h, where in place.items():
        if where[1]:
            half_edge_face[h] = number[where]
    return OpenedFaces(
        touched=touched,
        first_loops=[loops[face][0] for face in touched.tolist()],
        extra_loops=extra_loops,
        extra_face=extra_face,
        face_vertex=face_vertex,
        half_edge_face=half_edge_face,
        slits=slits,
    )


def _parted(created: CreatedVertices) -> np.ndarray:
    """Vertex at which each half-edge starts, after the two sides of the cut before have parted."""
    section, mesh = created.section, created.section.mesh
    parted = created.region.swept[section.parted_node]
    if not parted.any():
        return mesh.face_vertex
    face_vertex = mesh.face_vertex.copy()
    face_vertex[section.parted[parted]] = created.numbering.minus[section.parted_node[parted]]
    return face_vertex


def _hops(created: CreatedVertices, open_ends: np.ndarray) -> tuple[Hops, Slits]:
    """Where the loops of the touched faces leave their half-edges, and the slits that meet none."""
    section, numbering = created.section, created.numbering
    touched = np.flatnonzero(open_ends.any(axis=1))
    touched = touched[section.chord_face[touched] >= 0]
    slots = section.chord_slot[touched]
    node = section.chord_node[touched]
    pinned = section.nodes.pinned[node]
    plus, minus = numbering.plus[node].tolist(), numbering.minus[node].tolist()
    columns = (section.arrive[slots].tolist(), section.leave[slots].tolist(), plus, minus)
    tips = numbering.tip[touched].tolist()
    state = np.where(open_ends[touched], np.where(pinned, _PINNED, _OPEN), _SHUT).tolist()
    middles = set(created.region.middles.tolist())
    hops: Hops = {}
    slits: Slits = []
    for chord, h, after, p, m, tip, ends in zip(touched.tolist(), *columns, tips, state, strict=True):
        above, below = (), ()
        if chord in middles:
            above, below = (int(numbering.middle_plus[chord]),), (int(numbering.middle_minus[chord]),)
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
            slits.append((chord, [last[0], *above, last[1], *below]))
    return hops, slits


def _walk_face(
    face: int,
    begin: int,
    vertex: list[int],
    after: list[int],
    hops: Hops,
    hinge: set[int],
    place: dict[int, tuple[int, int]],
) -> list[list[int]]:
    """The loops that a face falls into.

    Args:
        face: The face.
        begin: Its first half-edge.
        vertex: Vertices at which its half-edges start.
        after: The half-edge after each of them.
        hops: Where loops leave the half-edges.
        hinge: Half-edges at which no loop begins.
        place: Takes the face and the loop that walks each half-edge.
    """
    loops: list[list[int]] = []
    for start in range(begin, begin + len(vertex)):
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
    return loops


def _order_extra(
    created: CreatedVertices, open_ends: np.ndarray, loops: dict[int, list[list[int]]]
) -> tuple[list[list[int]], list[int], dict[tuple[int, int], int]]:
    """Order the further loops by when the chord that split them off was completed, so that their places last.

    Returns:
        The loops, the face that each was split off from, and the number as a face of each loop of a face.
    """
    section, first = created.section, created.section.mesh.face_count
    complete = np.flatnonzero(open_ends.all(axis=1) & (section.chord_face >= 0))
    done = section.nodes.rank[section.chord_ends[complete, 1]]
    complete = complete[np.argsort(done, kind="stable")]
    taken = dict.fromkeys(loops, 1)
    extra_loops: list[list[int]] = []
    extra_face: list[int] = []
    number: dict[tuple[int, int], int] = {}
    for face in section.chord_face[complete].tolist():
        k = taken[face]
        if k < len(loops[face]):
            number[face, k] = first + len(extra_loops)
            extra_loops.append(loops[face][k])
            extra_face.append(face)
            taken[face] = k + 1
    return extra_loops, extra_face, number


def _join_slit(created: CreatedVertices, face: int, loops: list[list[int]], slit: list[int]) -> None:
    """Bridge a slit that meets no edge of its face to the one of its loops that is around it."""
    flat = [_face_coordinates(created, face, loop) for loop in loops]
    hole = _face_coordinates(created, face, slit)
    inside = [k for k, points in enumerate(flat) if contains_point(points, hole[1])]
    k = inside[0] if inside else 0
    size = len(loops[k])
    labels = loops[k] + slit
    joined = bridge_holes(list(range(size)), [list(range(size, len(labels)))], np.concatenate([flat[k], hole]))
    loops[k] = [labels[i] for i in joined]


def _face_coordinates(created: CreatedVertices, face: int, vertices: list[int]) -> np.ndarray:
    """Coordinates of vertices in the plane of a face, in which it is counterclockwise, shape (count, 2) [m]."""
    mesh = created.section.mesh
    normal = mesh.face_area_vector[face]
    axis = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    axis /= np.linalg.norm(axis)
    axes = np.stack([axis, np.cross(normal / np.linalg.norm(normal), axis)])
    return (created.positions_of(vertices) - mesh.vertices[mesh.face_vertex[mesh.face_start[face]]]) @ axes.T
