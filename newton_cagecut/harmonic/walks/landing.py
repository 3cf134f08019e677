# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Landings: where walks ended, cached so that only changed ones are evaluated again (paper, section 4.4).

A landing is (wall, side, point); face, edge and place on the edge follow from it and the faces as they are.
"""

from __future__ import annotations

from functools import cache

import warp as wp

CAPPED = wp.constant(wp.int32(1 << 30))
"""Set in a landing's key when its walk was stopped by the cap on steps."""

PASSED = wp.constant(wp.int32(1 << 29))
"""Set in a landing's key when its walk has come through a gate."""

KEY_MASK = wp.constant(wp.int32((1 << 29) - 1))

NOWHERE = wp.constant(wp.int32(-1))
"""Edge of a landing that needs no nested walk."""


@wp.struct
class SpaceLandings:
    """Landings in 3D, shape (walk_count,) each: 28 bytes a walk.

    ``key`` is 2 * wall + side, ``point`` is in the unit frame; ``edge`` is a row of the face's loop, ``param`` the
    place along that edge.
    """

    key: wp.array[wp.int32]
    point: wp.array[wp.vec3]
    face: wp.array[wp.int32]
    edge: wp.array[wp.int32]
    param: wp.array[float]


@wp.struct
class PlaneLandings:
    """Landings in 2D, shape (walk_count,) each: 16 bytes a walk. Faces are segments, which have no edges."""

    key: wp.array[wp.int32]
    point: wp.array[wp.vec2]
    face: wp.array[wp.int32]


LANDING_DTYPES = {
    2: {"key": wp.int32, "point": wp.vec2, "face": wp.int32},
    3: {"key": wp.int32, "point": wp.vec3, "face": wp.int32, "edge": wp.int32, "param": float},
}
"""Types of the arrays of landings, by dimension."""


def landing_type(dimension: int) -> object:
    """Struct type of the landings in a dimension."""
    return SpaceLandings if dimension == 3 else PlaneLandings


def empty_landings(dimension: int, count: int, device: wp.context.Device) -> object:
    """Reserve landings.

    Args:
        dimension: 2 or 3.
        count: Number of walks.
        device: Where to put them.
    """
    landings = landing_type(dimension)()
    for name, dtype in LANDING_DTYPES[dimension].items():
        setattr(landings, name, wp.empty(count, dtype=dtype, device=device))
    return landings


@cache
def point_functions(dimension: int) -> tuple[wp.Function, wp.Function]:
    """Functions from a stored point to space, where 2D is the plane z = 0, and back."""
    if dimension == 3:

        @wp.func
        def to_space(point: wp.vec3) -> wp.vec3:
            return point

        @wp.func
        def from_space(point: wp.vec3) -> wp.vec3:
            return point

    else:

        @wp.func
        def to_space(point: wp.vec2) -> wp.vec3:
            return wp.vec3(point[0], point[1], 0.0)

        @wp.func
        def from_space(point: wp.vec3) -> wp.vec2:
            return wp.vec2(point[0], point[1])

    return to_space, from_space
