# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The paper's weight correction: the least change after which weights reproduce positions (equation 5)."""

from functools import cache

import warp as wp

from ..faces.face_tables import FaceTables

wp.set_module_options({"enable_backward": False})

_ZERO = wp.constant(wp.float64(0.0))
_ONE = wp.constant(wp.float64(1.0))


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
