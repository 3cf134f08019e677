# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Boundary values of landings: the few cage vertices that a landing speaks for, and their weights.

Segments are linear, triangles barycentric, convex quads mean value (paper, equation 4); everything else has had a
nested walk that ended on an edge, where it is linear (paper, section 5.1).
"""

from functools import cache

import warp as wp

from ..walks.landing import KEY_MASK, NOWHERE, landing_type, point_functions
from .face_tables import TRIANGLE, FaceTables, cross2, plane_point

wp.set_module_options({"enable_backward": False})


@wp.struct
class BoundaryValue:
    """Up to four cage vertices and their weights, which sum to 1."""

    vertex: wp.vec4i
    weight: wp.vec4d
    count: int


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
def edge_value(a: int, b: int, t: wp.float64) -> BoundaryValue:
    """The two ends of an edge and their weights, linear along it."""
    value = BoundaryValue()
    value.count = 2
    value.vertex[0] = a
    value.vertex[1] = b
    value.weight = wp.vec4d(wp.float64(1.0) - t, t, wp.float64(0.0), wp.float64(0.0))
    return value


@wp.func
def boundary_value(tables: FaceTables, face: int, edge: int, param: float, local: wp.vec2) -> BoundaryValue:
    """The cage vertices of a landing and their weights."""
    first = tables.loop_start[face]
    if edge != NOWHERE:
        last = first + (edge + 1) % (tables.loop_start[face + 1] - first)
        return edge_value(tables.loop_vertex[first + edge], tables.loop_vertex[last], wp.float64(param))
    c0 = tables.loop_point[first]
    c1 = tables.loop_point[first + 1]
    c2 = tables.loop_point[first + 2]
    value = BoundaryValue()
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
    value.weight = value.weight * (wp.float64(1.0) / total)
    return value


@wp.func
def segment_value(tables: FaceTables, face: int, local: wp.vec2) -> BoundaryValue:
    """The two vertices of a landing on a segment and their weights."""
    first = tables.loop_start[face]
    a = tables.loop_point[first][0]
    t = wp.clamp((local[0] - a) / (tables.loop_point[first + 1][0] - a), 0.0, 1.0)
    return edge_value(tables.loop_vertex[first], tables.loop_vertex[first + 1], wp.float64(t))


@cache
def make_landing_value(dimension: int) -> wp.Function:
    """Make the function (tables, landings, walk) -> boundary value of a landing, in a dimension."""
    Landings = landing_type(dimension)
    to_space = point_functions(dimension)[0]

    @wp.func
    def landing_value(tables: FaceTables, landings: Landings, walk: int) -> BoundaryValue:
        local = plane_point(tables, (landings.key[walk] & KEY_MASK) // 2, to_space(landings.point[walk]))
        if wp.static(dimension == 2):
            return segment_value(tables, landings.face[walk], local)
        else:
            return boundary_value(tables, landings.face[walk], landings.edge[walk], landings.param[walk], local)

    return landing_value
