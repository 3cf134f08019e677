# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The triangles of walls on a device, and the point of one that is closest to another point.

In 2D everything lies in the plane z = 0, and a segment is a triangle of which two corners are the same.
"""

from __future__ import annotations

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class WallTriangle:
    """A triangle in the unit frame.

    ``inward_k`` is the unit normal, in the plane, of the edge that starts at corner k, and points into the triangle.
    ``gate`` is the number of the gate that the triangle belongs to, -1 for walls.
    """

    corner_0: wp.vec3
    corner_1: wp.vec3
    corner_2: wp.vec3
    inward_0: wp.vec3
    inward_1: wp.vec3
    inward_2: wp.vec3
    normal: wp.vec3
    wall: wp.int32
    two_sided: wp.int32
    gate: wp.int32


@wp.struct
class WallTriangles:
    """All triangles: what a query needs of one lies side by side."""

    rows: wp.array[WallTriangle]
    count: int


@wp.func
def closest_point_on_segment(a: wp.vec3, b: wp.vec3, x: wp.vec3) -> wp.vec3:
    """Closest point of the segment from ``a`` to ``b``."""
    ab = b - a
    length_squared = wp.dot(ab, ab)
    if length_squared <= 0.0:
        return a
    return a + ab * wp.clamp(wp.dot(ab, x - a) / length_squared, 0.0, 1.0)


@wp.func
def inward_distances(triangles: WallTriangles, t: int, x: wp.vec3) -> wp.vec3:
    """Signed distances from the planes through a triangle's edges, across its own plane; negative outside."""
    return wp.vec3(
        wp.dot(triangles.rows[t].inward_0, x - triangles.rows[t].corner_0),
        wp.dot(triangles.rows[t].inward_1, x - triangles.rows[t].corner_1),
        wp.dot(triangles.rows[t].inward_2, x - triangles.rows[t].corner_2),
    )


@wp.func
def plane_distance(triangles: WallTriangles, t: int, x: wp.vec3) -> float:
    """Signed distance from the triangle's plane, measured from a corner to keep the digits."""
    return wp.dot(triangles.rows[t].normal, x - triangles.rows[t].corner_0)


@wp.func
def closest_point(triangles: WallTriangles, t: int, x: wp.vec3, off: float, inward: wp.vec3) -> wp.vec3:
    """Closest point of a triangle, by the edges that x is outside of.

    Outside is decided against unit edge normals that were made in float64, so the slivers that cuts leave are as
    exact as any other triangle (products of barycentric areas are not, in float32).
    """
    if inward[0] >= 0.0 and inward[1] >= 0.0 and inward[2] >= 0.0:
        return x - triangles.rows[t].normal * off
    a = triangles.rows[t].corner_0
    b = triangles.rows[t].corner_1
    c = triangles.rows[t].corner_2
    best = a
    best_squared = float(1.0e30)
    if inward[0] < 0.0:
        point = closest_point_on_segment(a, b, x)
        best = point
        best_squared = wp.length_sq(x - point)
    if inward[1] < 0.0:
        point = closest_point_on_segment(b, c, x)
        squared = wp.length_sq(x - point)
        if squared < best_squared:
            best = point
            best_squared = squared
    if inward[2] < 0.0:
        point = closest_point_on_segment(c, a, x)
        squared = wp.length_sq(x - point)
        if squared < best_squared:
            best = point
            best_squared = squared
    return best


@wp.func
def closest_point_on_triangle(triangles: WallTriangles, t: int, x: wp.vec3) -> wp.vec3:
    """Closest point of a triangle."""
    return closest_point(triangles, t, x, plane_distance(triangles, t, x), inward_distances(triangles, t, x))
