# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers of triangles that are far away, by six points of each: closed forms cost many times as much there.

A triangle is far from ``_FAR`` times its radius on; what is left out of its layers is then about 1e-5 of them.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from .spans import Span, WideSpan, inverse_root, offset_from

_FAR = 3.0
"""Distance of a triangle's centre from which it is far, in units of its corners' greatest distance from there."""

# A rule for triangles that is exact to degree 4: three points near the corners and three near the middles of the edges.
_NEAR_CORNER, _NEAR_EDGE = 0.816847572980459, 0.108103018168070
_CORNER_WEIGHT, _EDGE_WEIGHT = 0.109951743655322, 0.223381589678011
_CORNER_BASE = wp.constant(wp.float32(_CORNER_WEIGHT * (1.0 - _NEAR_CORNER) / 2.0))
_CORNER_RISE = wp.constant(wp.float32(_CORNER_WEIGHT * (3.0 * _NEAR_CORNER - 1.0) / 2.0))
_EDGE_BASE = wp.constant(wp.float32(_EDGE_WEIGHT * (1.0 - _NEAR_EDGE) / 2.0))
_EDGE_RISE = wp.constant(wp.float32(_EDGE_WEIGHT * (3.0 * _NEAR_EDGE - 1.0) / 2.0))


@wp.struct
class FarTriangle:
    """A triangle as seen from afar.

    ``squared`` is the squared distance of its centre from which it is far, ``scale`` its area over 4 pi. The points
    ``outer`` lie near the corners, ``inner`` near the middles of the opposite edges, both from the centre.
    """

    center: wp.vec3d
    normal: wp.vec3
    outer: wp.mat33
    inner: wp.mat33
    squared: float
    scale: float


@wp.struct
class FarTriangleView:
    """A far triangle as seen from the points of a span.

    ``place_x`` and so on run from its centre to the points, ``above`` is how high they are over its plane, ``outer``
    and ``inner`` are one over their distances from the triangle's points.
    """

    place_x: Span
    place_y: Span
    place_z: Span
    squared: Span
    above: Span
    outer_0: Span
    outer_1: Span
    outer_2: Span
    inner_0: Span
    inner_1: Span
    inner_2: Span


@wp.struct
class TriangleSpan:
    """Layers of a triangle's three hat functions at the points of a span, or a component of their gradients."""

    charge_0: Span
    charge_1: Span
    charge_2: Span
    dipole_0: Span
    dipole_1: Span
    dipole_2: Span


@wp.func
def _inverse_distance(x: Span, y: Span, z: Span, point: wp.vec3) -> Span:
    dx = x - Span(point[0])
    dy = y - Span(point[1])
    dz = z - Span(point[2])
    return inverse_root(wp.cw_mul(dx, dx) + wp.cw_mul(dy, dy) + wp.cw_mul(dz, dz))


@wp.func
def _cube(values: Span) -> Span:
    return wp.cw_mul(values, wp.cw_mul(values, values))


@wp.func
def view_far_triangle(panel: FarTriangle, places: wp.array2d[WideSpan], span: int) -> FarTriangleView:
    """A triangle as seen from the points of a span, whose coordinates are a row of the places."""
    view = FarTriangleView()
    x = offset_from(places[span, 0], panel.center[0])
    y = offset_from(places[span, 1], panel.center[1])
    z = offset_from(places[span, 2], panel.center[2])
    view.place_x = x
    view.place_y = y
    view.place_z = z
    view.squared = wp.cw_mul(x, x) + wp.cw_mul(y, y) + wp.cw_mul(z, z)
    view.above = panel.normal[0] * x + panel.normal[1] * y + panel.normal[2] * z
    view.outer_0 = _inverse_distance(x, y, z, panel.outer[0])
    view.outer_1 = _inverse_distance(x, y, z, panel.outer[1])
    view.outer_2 = _inverse_distance(x, y, z, panel.outer[2])
    view.inner_0 = _inverse_distance(x, y, z, panel.inner[0])
    view.inner_1 = _inverse_distance(x, y, z, panel.inner[1])
    view.inner_2 = _inverse_distance(x, y, z, panel.inner[2])
    return view


@wp.func
def _base(outer_0: Span, outer_1: Span, outer_2: Span, inner_0: Span, inner_1: Span, inner_2: Span) -> Span:
    """What values at the points count for every hat function."""
    return _CORNER_BASE * (outer_0 + outer_1 + outer_2) + _EDGE_BASE * (inner_0 + inner_1 + inner_2)


@wp.func
def _hat(base: Span, outer: Span, inner: Span) -> Span:
    """The integral with a hat function, from that base and the values at its own points."""
    return base + _CORNER_RISE * outer + _EDGE_RISE * inner


@wp.func
def far_triangle_layers(panel: FarTriangle, view: FarTriangleView) -> TriangleSpan:
    """Layers of the hat functions of a triangle far away."""
    out = TriangleSpan()
    base = _base(view.outer_0, view.outer_1, view.outer_2, view.inner_0, view.inner_1, view.inner_2)
    out.charge_0 = panel.scale * _hat(base, view.outer_0, view.inner_0)
    out.charge_1 = panel.scale * _hat(base, view.outer_1, view.inner_1)
    out.charge_2 = panel.scale * _hat(base, view.outer_2, view.inner_2)
    outer_0 = _cube(view.outer_0)
    outer_1 = _cube(view.outer_1)
    outer_2 = _cube(view.outer_2)
    inner_0 = _cube(view.inner_0)
    inner_1 = _cube(view.inner_1)
    inner_2 = _cube(view.inner_2)
    above = panel.scale * view.above
    base = _base(outer_0, outer_1, outer_2, inner_0, inner_1, inner_2)
    out.dipole_0 = wp.cw_mul(above, _hat(base, outer_0, inner_0))
    out.dipole_1 = wp.cw_mul(above, _hat(base, outer_1, inner_1))
    out.dipole_2 = wp.cw_mul(above, _hat(base, outer_2, inner_2))
    return out


@wp.func
def _point_slope(scale: float, inverse_distance: Span, offset: Span, above: Span, normal: float) -> Span:
    """Slope along an axis of the dipole of a point."""
    squared = wp.cw_mul(inverse_distance, inverse_distance)
    return scale * wp.cw_mul(
        wp.cw_mul(inverse_distance, squared), Span(normal) - 3.0 * wp.cw_mul(wp.cw_mul(above, squared), offset)
    )


@wp.func
def far_triangle_slopes(panel: FarTriangle, view: FarTriangleView, axis: int) -> TriangleSpan:
    """Components along an axis of the gradients of the layers of a triangle far away."""
    place = view.place_x
    if axis == 1:
        place = view.place_y
    if axis == 2:
        place = view.place_z
    arm_0 = place - Span(panel.outer[0, axis])
    arm_1 = place - Span(panel.outer[1, axis])
    arm_2 = place - Span(panel.outer[2, axis])
    edge_0 = place - Span(panel.inner[0, axis])
    edge_1 = place - Span(panel.inner[1, axis])
    edge_2 = place - Span(panel.inner[2, axis])
    out = TriangleSpan()
    down = -panel.scale
    outer_0 = down * wp.cw_mul(_cube(view.outer_0), arm_0)
    outer_1 = down * wp.cw_mul(_cube(view.outer_1), arm_1)
    outer_2 = down * wp.cw_mul(_cube(view.outer_2), arm_2)
    inner_0 = down * wp.cw_mul(_cube(view.inner_0), edge_0)
    inner_1 = down * wp.cw_mul(_cube(view.inner_1), edge_1)
    inner_2 = down * wp.cw_mul(_cube(view.inner_2), edge_2)
    base = _base(outer_0, outer_1, outer_2, inner_0, inner_1, inner_2)
    out.charge_0 = _hat(base, outer_0, inner_0)
    out.charge_1 = _hat(base, outer_1, inner_1)
    out.charge_2 = _hat(base, outer_2, inner_2)
    normal = panel.normal[axis]
    outer_0 = _point_slope(panel.scale, view.outer_0, arm_0, view.above, normal)
    outer_1 = _point_slope(panel.scale, view.outer_1, arm_1, view.above, normal)
    outer_2 = _point_slope(panel.scale, view.outer_2, arm_2, view.above, normal)
    inner_0 = _point_slope(panel.scale, view.inner_0, edge_0, view.above, normal)
    inner_1 = _point_slope(panel.scale, view.inner_1, edge_1, view.above, normal)
    inner_2 = _point_slope(panel.scale, view.inner_2, edge_2, view.above, normal)
    base = _base(outer_0, outer_1, outer_2, inner_0, inner_1, inner_2)
    out.dipole_0 = _hat(base, outer_0, inner_0)
    out.dipole_1 = _hat(base, outer_1, inner_1)
    out.dipole_2 = _hat(base, outer_2, inner_2)
    return out


def far_triangle_rows(corners: np.ndarray) -> np.ndarray:
    """Triangles as rows of ``FarTriangle``.

    Args:
        corners: Corners, counterclockwise about the normals, shape (triangle_count, 3, 3).
    """
    corners = np.asarray(corners, dtype=np.float64)
    rows = np.zeros(len(corners), dtype=FarTriangle.numpy_dtype())
    center = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0
    area_vector = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.sqrt((area_vector**2).sum(axis=1))
    # A point is what its corner has more than the others, and an equal share of all, which is 0 from the centre.
    arm = corners - center[:, None]
    rows["outer"] = (1.5 * _NEAR_CORNER - 0.5) * arm
    rows["inner"] = (1.5 * _NEAR_EDGE - 0.5) * arm
    rows["center"], rows["normal"], rows["scale"] = center, area_vector / area[:, None], area * (0.25 / np.pi)
    rows["squared"] = _FAR**2 * (arm**2).sum(axis=2).max(axis=1)
    return rows
