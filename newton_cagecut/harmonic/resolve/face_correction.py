# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The least change after which the weights of a point on a wall reproduce it, over the corners that it sees.

Equation 5 of the paper in the plane of a face. A corner behind a slit is not seen, so nothing is given to it; those
that are seen always span the plane, since a point of a polygon sees the corners of a triangle of any triangulation.
"""

from functools import cache

import warp as wp

from ..faces.face_tables import SEGMENT, FaceTables, cross2, plane_point

wp.set_module_options({"enable_backward": False})

_ZERO = wp.constant(wp.float64(0.0))
_ONE = wp.constant(wp.float64(1.0))
_ROUNDS = wp.constant(2)
"""Corrections, the second for what the first has rounded off."""
_ROUNDING = wp.constant(wp.float64(1.0e-6))
"""What may be missing, in the unit frame: some roundings of float32."""
_TOLERANCE = wp.constant(1.0e-6)
"""How far off a line a point counts as on it, in the unit frame."""


@wp.func
def side_of(a: wp.vec2, b: wp.vec2, x: wp.vec2) -> float:
    """Distance of x from the line a-b, positive to the left; 0 where it is next to nothing."""
    ab = b - a
    distance = cross2(ab, x - a) / wp.max(wp.length(ab), 1.0e-20)
    return wp.where(wp.abs(distance) <= _TOLERANCE, 0.0, distance)


@wp.func
def is_before_corner(a: wp.vec2, c: wp.vec2, b: wp.vec2, x: wp.vec2, orientation: float) -> bool:
    """Whether x is in the angle that the face has at its corner c, between those before and after it."""
    arriving = c - a
    leaving = b - c
    left_of_first = side_of(a, c, x) * orientation >= 0.0
    left_of_second = side_of(c, b, x) * orientation >= 0.0
    turn = cross2(arriving, leaving) * orientation
    if turn > _TOLERANCE * wp.length(arriving) * wp.length(leaving):
        return left_of_first and left_of_second
    return left_of_first or left_of_second  # a reflex corner, or the end of a slit


@wp.func
def sees_corner(tables: FaceTables, face: int, row: int, x: wp.vec2) -> bool:
    """Whether no edge of a face is between a point of it and one of its corners, sides of slits included."""
    if tables.kind[face] == SEGMENT:
        return True
    first = tables.loop_start[face]
    last = tables.loop_start[face + 1]
    before = wp.where(row == first, last, row) - 1
    after = wp.where(row + 1 == last, first, row + 1)
    corner = tables.loop_point[row]
    a = tables.loop_point[before]
    if not is_before_corner(a, corner, tables.loop_point[after], x, tables.orientation[face]):
        return False
    a = tables.loop_point[last - 1]
    for other in range(first, last):
        b = tables.loop_point[other]
        if side_of(a, b, x) * side_of(a, b, corner) < 0.0 and side_of(x, corner, a) * side_of(x, corner, b) < 0.0:
            return False
        a = b
    return True


@cache
def make_face_correction(dimension: int, Moments: object) -> wp.Function:
    """Make the function that corrects the weights of a point on a wall.

    Args:
        dimension: 2 or 3.
        Moments: Struct type of the sums; see ``regression.py``.
    """

    @wp.func
    def in_plane(tables: FaceTables, wall: int, vertex: int, origin: wp.vec3d, size: wp.float64) -> wp.vec3d:
        """One, and the vertex's offset from the point along the axes of the wall, in sizes of the face."""
        offset = (tables.rest[vertex] - origin) / size
        return wp.vec3d(
            _ONE,
            wp.dot(wp.vec3d(tables.wall_axis_0[wall]), offset),
            wp.dot(wp.vec3d(tables.wall_axis_1[wall]), offset),
        )

    @wp.func
    def missing_on_face(
        moments: Moments,
        tables: FaceTables,
        slot: int,
        wall: int,
        vertex_count: int,
        origin: wp.vec3d,
        size: wp.float64,
    ) -> wp.vec3d:
        """What the weights lack of a sum of one and of the point's position, in sizes of the face; 0 for rounding."""
        missing = wp.vec3d(_ONE, _ZERO, _ZERO)
        for j in range(vertex_count):
            weight = moments.value[slot, j][0]
            if weight != _ZERO:
                missing -= in_plane(tables, wall, j, origin, size) * weight
        if wp.abs(missing[0]) <= _ROUNDING and size * wp.max(wp.abs(missing[1]), wp.abs(missing[2])) <= _ROUNDING:
            return wp.vec3d()
        return missing

    @wp.func
    def correct_on_face(
        moments: Moments, tables: FaceTables, slot: int, face: int, wall: int, vertex_count: int, origin: wp.vec3d
    ):
        """Spread what is missing over the corners in sight; a vertex that is several of them takes several shares."""
        first = tables.loop_start[face]
        last = tables.loop_start[face + 1]
        size = _ZERO
        for row in range(first, last):
            size = wp.max(size, wp.length(tables.rest[tables.loop_vertex[row]] - origin))
        missing = missing_on_face(moments, tables, slot, wall, vertex_count, origin, size)
        if wp.length_sq(missing) == _ZERO:
            return
        x = plane_point(tables, wall, wp.vec3(origin))
        normal = wp.mat33d()
        if wp.static(dimension == 2):
            normal[2, 2] = _ONE  # the second axis is zero
        for row in range(first, last):
            if sees_corner(tables, face, row, x):
                a = in_plane(tables, wall, tables.loop_vertex[row], origin, size)
                normal += wp.outer(a, a)
        inverse = wp.inverse(normal)
        for _round in range(_ROUNDS):
            share = inverse * missing
            for row in range(first, last):
                if sees_corner(tables, face, row, x):
                    j = tables.loop_vertex[row]
                    value = moments.value[slot, j]
                    value[0] = value[0] + wp.dot(in_plane(tables, wall, j, origin, size), share)
                    moments.value[slot, j] = value
            missing = missing_on_face(moments, tables, slot, wall, vertex_count, origin, size)

    return correct_on_face
