# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of contact between the pieces of a body and between the sides of its cuts; see ``self_contact``."""

from __future__ import annotations

import warp as wp

from ...elastic import PointForces
from ..body.embedding import SurfaceRows

wp.set_module_options({"enable_backward": False})

_FAR = wp.constant(1.0e9)
"""Where the boxes of spare triangles are [m]."""
_AHEAD = wp.constant(2.0)
"""How far to look beyond the reach, in what a sample moves in a step."""
_PUSHED = wp.constant(0.2)
"""Share of an overlap that is pushed out in a step; the whole would rebound."""
_SLOWEST = wp.constant(1.0e-5)
"""Sliding speed below which friction is viscous [m/s]."""
_BEHIND = wp.constant(1.0e-6)
"""How far behind a triangle a sample may lie at rest, in the size of the body."""


@wp.struct
class TouchingSurface:
    """The surface of a body as it is now: triangles, and samples on them that may touch others."""

    triangles: wp.array[wp.vec3i]
    """Surface points of the triangles."""
    piece: wp.array[wp.int32]
    """The piece that a triangle belongs to."""
    triangle_count: wp.array[wp.int32]
    """Number of triangles, shape (1,)."""
    piece_count: wp.array[wp.int32]
    """Number of pieces, shape (1,)."""
    rest: wp.array[wp.vec3]
    """Rest positions of the surface points [m]."""
    sample_triangle: wp.array[wp.int32]
    """The triangle that a sample lies on."""
    sample_place: wp.array[wp.vec3]
    """Its barycentric coordinates there."""
    sample_area: wp.array[float]
    """Its area [m^2]."""
    sample_count: wp.array[wp.int32]
    """Number of samples, shape (1,)."""
    lower: wp.array[wp.vec3]
    """Lower corners of the triangles' boxes [m]."""
    upper: wp.array[wp.vec3]
    """Upper corners of the triangles' boxes [m]."""


@wp.struct
class TouchLaw:
    """What touches what, and how firmly."""

    own: int
    """Whether samples touch their own piece."""
    others: int
    """Whether samples touch other pieces."""
    reach: float
    """Greatest overlap that is found [m]."""
    size: float
    """Size of the body [m]."""
    stiffness: float
    """Stiffness of an area that touches, from both sides together [Pa/m]."""
    density: float
    """Density of the body times its size [kg/m^2]."""
    friction: float
    """Coefficient of friction."""


@wp.struct
class Touches:
    """What the samples touch, one row each."""

    triangle: wp.array[wp.int32]
    """The triangle; -1 for none."""
    place: wp.array[wp.vec3]
    """Barycentric coordinates of the place touched."""
    normal: wp.array[wp.vec3]
    """Its outward normal."""
    gap: wp.array[float]
    """Signed distance from it [m]."""
    acts: wp.array[wp.int32]
    """Whether the sample touches anything."""
    rank: wp.array[wp.int32]
    """How many samples before it do."""
    listed: wp.array[wp.int32]
    """The samples that touch, in their order, one a row of pair weights."""
    count: wp.array[wp.int32]
    """Number of these, shape (1,)."""


@wp.func
def blend(place: wp.vec3, corners: wp.vec3i, values: wp.array[wp.vec3]) -> wp.vec3:
    """A value inside of a triangle."""
    return place[0] * values[corners[0]] + place[1] * values[corners[1]] + place[2] * values[corners[2]]


@wp.kernel(enable_backward=False)
def bound_triangles(points: wp.array[wp.vec3], surface: TouchingSurface):
    """Boxes of the triangles."""
    t = wp.tid()
    lower, upper = wp.vec3(_FAR, _FAR, _FAR), wp.vec3(_FAR, _FAR, _FAR)
    if t < surface.triangle_count[0]:
        corners = surface.triangles[t]
        a, b, c = points[corners[0]], points[corners[1]], points[corners[2]]
        lower, upper = wp.min(wp.min(a, b), c), wp.max(wp.max(a, b), c)
    surface.lower[t] = lower
    surface.upper[t] = upper


@wp.func
def has_corner(own: wp.vec3i, place: wp.vec3, other: wp.vec3i) -> bool:
    """Whether a sample lies at, or between, corners that another triangle has too."""
    shared = bool(False)
    for i in range(3):
        for j in range(3):
            if own[i] == other[j] and place[i] > 0.0:
                shared = True
    return shared


@wp.kernel(enable_backward=False)
def find_touches(
    bvh: wp.uint64,
    dt: float,
    points: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    law: TouchLaw,
    surface: TouchingSurface,
    touches: Touches,
):
    """The nearest triangle that each sample is before or behind, where it will be behind at the end of the step."""
    s = wp.tid()
    touches.triangle[s] = -1
    touches.acts[s] = 0
    if s >= surface.sample_count[0]:
        return
    home = surface.sample_triangle[s]
    own, place = surface.triangles[home], surface.sample_place[s]
    point, velocity = blend(place, own, points), blend(place, own, velocities)
    start = blend(place, own, surface.rest)
    nearest = law.reach + _AHEAD * dt * wp.length(velocity)
    margin = wp.vec3(nearest, nearest, nearest)
    found = int(-1)
    for piece in range(surface.piece_count[0]):
        same = piece == surface.piece[home]
        if (same and law.own == 0) or (not same and law.others == 0):
            continue
        query = wp.bvh_query_aabb(bvh, point - margin, point + margin, wp.bvh_get_group_root(bvh, piece))
        t = int(0)
        while wp.bvh_query_next(query, t):
            if t >= surface.triangle_count[0]:
                continue
            corners = surface.triangles[t]
            origin = points[corners[0]]
            first, second = points[corners[1]] - origin, points[corners[2]] - origin
            along = wp.cross(first, second)
            square = wp.length_sq(along)
            if square <= 0.0:
                continue
            arm = point - origin
            u = wp.dot(wp.cross(arm, second), along) / square
            v = wp.dot(wp.cross(first, arm), along) / square
            if u < 0.0 or v < 0.0 or u + v > 1.0:
                continue
            normal = along / wp.sqrt(square)
            gap = wp.dot(normal, arm)
            if wp.abs(gap) >= nearest:
                continue
            if same:
                rest_origin = surface.rest[corners[0]]
                out = wp.cross(surface.rest[corners[1]] - rest_origin, surface.rest[corners[2]] - rest_origin)
                behind = wp.dot(out, start - rest_origin) < -_BEHIND * law.size * wp.length(out)
                if behind or has_corner(own, place, corners):
                    continue
            nearest = wp.abs(gap)
            found = t
            touches.gap[s] = gap
            touches.place[s] = wp.vec3(1.0 - u - v, u, v)
            touches.normal[s] = normal
    if found >= 0:
        relative = velocity - blend(touches.place[s], surface.triangles[found], velocities)
        gap = touches.gap[s]
        if gap < 0.0 or gap + dt * wp.dot(touches.normal[s], relative) < 0.0:
            touches.triangle[s] = found
            touches.acts[s] = 1


@wp.kernel(enable_backward=False)
def list_touches(touches: Touches):
    """List the samples that touch; as many as there is room for."""
    s = wp.tid()
    room = touches.listed.shape[0]
    if touches.acts[s] != 0 and touches.rank[s] < room:
        touches.listed[touches.rank[s]] = s
    if s == touches.acts.shape[0] - 1:
        touches.count[0] = wp.min(touches.rank[s] + touches.acts[s], room)


@wp.kernel(enable_backward=False)
def weigh_touches(rows: SurfaceRows, surface: TouchingSurface, touches: Touches, points: PointForces):
    """Weights of each sample that touches, less those of the place touched."""
    r, j = wp.tid()
    if r >= touches.count[0]:
        return
    s = touches.listed[r]
    own, other = surface.triangles[surface.sample_triangle[s]], surface.triangles[touches.triangle[s]]
    place, there = surface.sample_place[s], touches.place[s]
    total = float(0.0)
    if j < rows.vertex_count[0]:
        for i in range(3):
            total += place[i] * rows.weights[rows.first_row + own[i], j]
            total -= there[i] * rows.weights[rows.first_row + other[i], j]
    points.pair_weights[r, j] = total


@wp.kernel(enable_backward=False)
def push_touches(
    dt: float,
    first_slot: wp.array[wp.int32],
    velocities: wp.array[wp.vec3],
    law: TouchLaw,
    surface: TouchingSurface,
    touches: Touches,
    points: PointForces,
):
    """Force and damping of each sample that touches, in slots behind those of the other contacts."""
    r = wp.tid()
    if r >= touches.count[0]:
        return
    s = touches.listed[r]
    slot = first_slot[0] + r
    normal, gap = touches.normal[s], touches.gap[s]
    relative = blend(surface.sample_place[s], surface.triangles[surface.sample_triangle[s]], velocities)
    relative -= blend(touches.place[s], surface.triangles[touches.triangle[s]], velocities)
    sliding = wp.length(relative - normal * wp.dot(normal, relative))
    k = 0.5 * surface.sample_area[s] * wp.max(law.stiffness, law.density / (dt * dt))
    push = -k * gap
    if gap < 0.0:
        push *= _PUSHED
    drag = law.friction * wp.max(push, 0.0) / wp.max(sliding, _SLOWEST)
    along = wp.outer(normal, normal)
    points.touched[slot] = -1 - r
    points.force[slot] = push * normal
    points.stiffness[slot] = wp.mat33()
    points.damping[slot] = dt * k * along + drag * (wp.identity(3, dtype=float) - along)
    points.drift[slot] = wp.vec3()
    points.impulse[slot] = wp.vec3()


@wp.kernel(enable_backward=False)
def note_first_slot(points: PointForces, first_slot: wp.array[wp.int32]):
    """Keep the number of slots that are in use."""
    first_slot[0] = points.count[0]


@wp.kernel(enable_backward=False)
def add_slots(touches: Touches, points: PointForces):
    """Take the slots of the samples that touch into use."""
    points.count[0] = points.count[0] + touches.count[0]
    points.pair_count[0] = touches.count[0]
