# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The paper's weight correction: the least change after which weights reproduce positions (equation 5).

Inside of a piece it is spread over the piece's vertices, on a wall over those of the point's own face, in its plane.
"""

from functools import cache

import warp as wp

from ..faces.face_tables import FaceTables

wp.set_module_options({"enable_backward": False})

_ZERO = wp.constant(wp.float64(0.0))
_ONE = wp.constant(wp.float64(1.0))
_ROUNDS = wp.constant(2)
"""Corrections on a face, the second for what the first has rounded off."""
_ROUNDING = wp.constant(wp.float64(1.0e-6))
"""What may be missing on a face, in the unit frame: some roundings of float32."""


@cache
def make_affine_correction(dimension: int, Moments: object) -> wp.Function:
    """Make the function that corrects a point's weights and, likewise, their gradients.

    Args:
        dimension: 2 or 3.
        Moments: Struct type of the sums; see ``regression.py``.
    """

    @wp.func
    def correct_affinely(
        moments: Moments, tables: FaceTables, slot: int, piece: int, vertex_count: int, origin: wp.vec3d
    ):
        """Spread the change over the vertices of the point's own piece."""
        normal = wp.mat44d()
        if wp.static(dimension == 2):
            normal[2, 2] = _ONE  # nothing else is there along the third axis
        missing = wp.vec4d(_ZERO, _ZERO, _ZERO, _ONE)
        slopes = wp.matrix(dtype=wp.float64, shape=(4, 3))
        for axis in range(wp.static(dimension)):
            slopes[axis, axis] = _ONE
        for j in range(vertex_count):
            if tables.vertex_piece[j] == piece:
                v = tables.rest[j] - origin
                a = wp.vec4d(v[0], v[1], v[2], _ONE)
                normal += wp.outer(a, a)
                missing -= a * moments.value[slot, j][0]
                slopes -= wp.outer(a, moments.slope[slot, j])
        inverse = wp.inverse(normal)
        missing = inverse * missing
        slopes = inverse * slopes
        for j in range(vertex_count):
            if tables.vertex_piece[j] == piece:
                v = tables.rest[j] - origin
                a = wp.vec4d(v[0], v[1], v[2], _ONE)
                value = moments.value[slot, j]
                value[0] = value[0] + wp.dot(a, missing)
                moments.value[slot, j] = value
                moments.slope[slot, j] = moments.slope[slot, j] + wp.transpose(slopes) * a

    return correct_affinely


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
    def correct_on_face(
        moments: Moments, tables: FaceTables, slot: int, face: int, wall: int, vertex_count: int, origin: wp.vec3d
    ):
        """Spread the change over the corners of a face; a vertex that is several of them takes several shares.

        Next to a slit nothing is done for less than rounding, so that its other side has no weight at all.
        """
        first = tables.loop_start[face]
        last = tables.loop_start[face + 1]
        size = _ZERO
        for row in range(first, last):
            size = wp.max(size, wp.length(tables.rest[tables.loop_vertex[row]] - origin))
        normal = wp.mat33d()
        if wp.static(dimension == 2):
            normal[2, 2] = _ONE  # the second axis is zero
        for row in range(first, last):
            a = in_plane(tables, wall, tables.loop_vertex[row], origin, size)
            normal += wp.outer(a, a)
        inverse = wp.inverse(normal)
        for _round in range(_ROUNDS):
            missing = wp.vec3d(_ONE, _ZERO, _ZERO)
            for j in range(vertex_count):
                weight = moments.value[slot, j][0]
                if weight != _ZERO:
                    missing -= in_plane(tables, wall, j, origin, size) * weight
            if wp.abs(missing[0]) > _ROUNDING or size * wp.max(wp.abs(missing[1]), wp.abs(missing[2])) > _ROUNDING:
                missing = inverse * missing
                for row in range(first, last):
                    j = tables.loop_vertex[row]
                    value = moments.value[slot, j]
                    value[0] = value[0] + wp.dot(in_plane(tables, wall, j, origin, size), missing)
                    moments.value[slot, j] = value

    return correct_on_face
