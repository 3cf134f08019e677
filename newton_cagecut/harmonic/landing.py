# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Boundary values of landings: the few cage vertices that a landing speaks for, and their weights.

Triangles are barycentric, convex quads mean value (paper, equation 4), everything else is a nested walk on the face
that ends on an edge (paper, section 5.1). The nested walk is replayable too: it has counters of its own.
"""

from __future__ import annotations

from functools import cache

import warp as wp

from .faces import QUAD, TRIANGLE, FaceTables, face_of_landing
from .points import QueryPoints
from .random import NESTED_STREAM, direction_on_circle

wp.set_module_options({"enable_backward": False})

CAPPED = wp.constant(wp.int32(1 << 30))
"""Set in a landing's key when its walk was stopped by the cap on steps."""

KEY_MASK = wp.constant(wp.int32((1 << 30) - 1))

NOWHERE = wp.constant(wp.int32(-1))
"""Edge of a landing that needs no nested walk."""

_WRONG_SIDE = wp.constant(4.0e-6)


@wp.struct
class Landings:
    """Where walks ended, shape (walk_count,) each: 28 bytes a walk.

    ``key`` is 2 * wall + side, ``point`` is in the unit frame; ``face``, ``edge`` (row of the face's loop) and
    ``param`` (along that edge) follow from them and the faces as they are.
    """

    key: wp.array[wp.int32]
    point: wp.array[wp.vec3]
    face: wp.array[wp.int32]
    edge: wp.array[wp.int32]
    param: wp.array[float]


LANDING_DTYPES = {"key": wp.int32, "point": wp.vec3, "face": wp.int32, "edge": wp.int32, "param": float}


@wp.struct
class BoundaryValue:
    """Up to four cage vertices and their weights, which sum to 1."""

    vertex: wp.vec4i
    weight: wp.vec4d
    count: int


@wp.struct
class EdgeHit:
    """The edge of a face nearest to a point of its plane."""

    distance: float
    row: int
    param: float


@wp.func
def cross2(u: wp.vec2, v: wp.vec2) -> float:
    """Third component of the cross product of two plane vectors."""
    return u[0] * v[1] - u[1] * v[0]


@wp.func
def plane_point(tables: FaceTables, wall: int, x: wp.vec3) -> wp.vec2:
    """Coordinates of a point in a wall's plane."""
    offset = x - tables.wall_origin[wall]
    return wp.vec2(wp.dot(tables.wall_axis_0[wall], offset), wp.dot(tables.wall_axis_1[wall], offset))


@wp.func
def nearest_edge(tables: FaceTables, face: int, x: wp.vec2) -> EdgeHit:
    """Nearest edge of a face's loop. Of the two coincident edges of a slit it is the one whose inner side x is on."""
    first = tables.loop_start[face]
    last = tables.loop_start[face + 1]
    orientation = tables.orientation[face]
    hit = EdgeHit()
    nearest = float(1.0e30)
    for row in range(first, last):
        a = tables.loop_point[row]
        b = tables.loop_point[wp.where(row + 1 == last, first, row + 1)]
        ab = b - a
        ax = x - a
        t = wp.clamp(wp.dot(ab, ax) / wp.max(wp.dot(ab, ab), 1.0e-30), 0.0, 1.0)
        distance = wp.length(ax - ab * t)
        ranked = distance
        if cross2(ab, ax) * orientation < 0.0:
            ranked = distance + _WRONG_SIDE
        if ranked < nearest:
            nearest = ranked
            hit.distance = distance
            hit.row = row - first
            hit.param = t
    return hit


@wp.func
def walk_on_face(
    tables: FaceTables,
    face: int,
    start: wp.vec2,
    seed: wp.uint32,
    point: wp.uint32,
    walk: wp.uint32,
    epsilon: float,
    max_steps: int,
) -> EdgeHit:
    """Walk on circles in a face's plane until an edge is within ``epsilon``."""
    x = start
    hit = nearest_edge(tables, face, x)
    step = int(0)
    while hit.distance >= epsilon and step < max_steps:
        x += hit.distance * direction_on_circle(seed + NESTED_STREAM, point, walk, wp.uint32(step))
        hit = nearest_edge(tables, face, x)
        step += 1
    return hit


@wp.func
def mean_value_weights(c0: wp.vec2, c1: wp.vec2, c2: wp.vec2, c3: wp.vec2, x: wp.vec2) -> wp.vec4:
    """Mean value coordinates of a convex quad, not normalised (paper, equation 4); linear on its edges.

    tan(angle / 2) = |u x v| / (|u| |v| + u . v) for the angle between two corners as seen from x.
    """
    arms = wp.matrix_from_rows(c0 - x, c1 - x, c2 - x, c3 - x)
    lengths = wp.vec4(wp.length(arms[0]), wp.length(arms[1]), wp.length(arms[2]), wp.length(arms[3]))
    tangents = wp.vec4()
    for i in range(4):
        j = (i + 1) % 4
        u = arms[i]
        v = arms[j]
        edge = v - u
        opening = lengths[i] * lengths[j] + wp.dot(u, v)
        if opening <= 1.0e-6 * wp.dot(edge, edge):
            t = wp.clamp(-wp.dot(u, edge) / wp.dot(edge, edge), 0.0, 1.0)
            on_edge = wp.vec4()
            on_edge[i] = 1.0 - t
            on_edge[j] = t
            return on_edge
        tangents[i] = wp.abs(cross2(u, v)) / opening
    weights = wp.vec4()
    for i in range(4):
        weights[i] = (tangents[(i + 3) % 4] + tangents[i]) / wp.max(lengths[i], 1.0e-20)
    return weights


@wp.func
def boundary_value(tables: FaceTables, face: int, edge: int, param: float, local: wp.vec2) -> BoundaryValue:
    """The cage vertices of a landing and their weights."""
    first = tables.loop_start[face]
    value = BoundaryValue()
    if edge >= 0:
        length = tables.loop_start[face + 1] - first
        t = wp.float64(param)
        value.count = 2
        value.vertex[0] = tables.loop_vertex[first + edge]
        value.vertex[1] = tables.loop_vertex[first + (edge + 1) % length]
        value.weight = wp.vec4d(wp.float64(1.0) - t, t, wp.float64(0.0), wp.float64(0.0))
        return value
    c0 = tables.loop_point[first]
    c1 = tables.loop_point[first + 1]
    c2 = tables.loop_point[first + 2]
    raw = wp.vec4()
    if tables.kind[face] == TRIANGLE:
        value.count = 3
        raw[0] = wp.max(0.0, cross2(c1 - local, c2 - local) * tables.orientation[face])
        raw[1] = wp.max(0.0, cross2(c2 - local, c0 - local) * tables.orientation[face])
        raw[2] = wp.max(0.0, cross2(c0 - local, c1 - local) * tables.orientation[face])
    else:
        value.count = 4
        raw = mean_value_weights(c0, c1, c2, tables.loop_point[first + 3], local)
    total = wp.float64(0.0)
    for i in range(value.count):
        value.vertex[i] = tables.loop_vertex[first + i]
        value.weight[i] = wp.float64(raw[i])
        total += value.weight[i]
    value.weight = value.weight / total
    return value


@wp.func
def landed_face(tables: FaceTables, key: int, local: wp.vec2, piece: int) -> int:
    """The face of a landing: on its own side; on the other where rounding put the walk's end across a cut."""
    face = face_of_landing(tables, key, local, piece)
    if face < 0:
        face = face_of_landing(tables, key ^ 1, local, piece)
    if face < 0:
        face = face_of_landing(tables, key, local, -1)
    if face < 0:
        face = face_of_landing(tables, key ^ 1, local, -1)
    return face


@cache
def make_land_kernel(*, nested: bool) -> wp.Kernel:
    """Make the kernel that looks up the faces of landings and, where needed, walks on them.

    Args:
        nested: Whether any face needs a nested walk; without, its code is left out.
    """

    @wp.kernel(enable_backward=False, module="unique")
    def land(
        offset: int,
        work: wp.array[wp.int32],
        walks: int,
        first_walk: int,
        seed: wp.uint32,
        points: QueryPoints,
        tables: FaceTables,
        landings: Landings,
        epsilon: float,
        max_steps: int,
    ):
        slot = offset + wp.tid()
        walk = slot
        if work.shape[0] > 0:
            walk = work[slot]
        point = (first_walk + walk) // walks
        key = landings.key[walk] & KEY_MASK
        local = plane_point(tables, key // 2, landings.point[walk])
        face = landed_face(tables, key, local, points.piece[point])
        landings.face[walk] = face
        edge = NOWHERE
        param = float(0.0)
        if wp.static(nested):
            if tables.kind[face] != TRIANGLE and tables.kind[face] != QUAD:
                number = wp.uint32((first_walk + walk) % walks)
                hit = walk_on_face(tables, face, local, seed, wp.uint32(point), number, epsilon, max_steps)
                edge = hit.row
                param = hit.param
        landings.edge[walk] = edge
        landings.param[walk] = param

    return land
