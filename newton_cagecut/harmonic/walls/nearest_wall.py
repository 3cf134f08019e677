# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The nearest wall to a point: the distance query of the walks (paper, section 6.2)."""

from functools import cache

import warp as wp

from .cells import GridCells, cell_of
from .wall_triangles import WallTriangles, closest_point, inward_distances, plane_distance

wp.set_module_options({"enable_backward": False})

_ROUNDING = wp.constant(2.0e-6)
"""More than the distances by which triangles are rejected, and the distance itself, are rounded off."""

ALL_GATES = wp.constant(wp.uint32(0xFFFFFFFF))
"""Gates passed by who ignores them all."""


@wp.struct
class Nearest:
    """The wall triangle nearest to a point: squared distance, triangle, closest point.

    ``reach`` is a squared distance beyond which no triangle can be nearer, whatever is rounded.
    """

    distance_squared: float
    reach: float
    triangle: int
    point: wp.vec3


@wp.func
def nearest_at(triangle: int, x: wp.vec3, point: wp.vec3) -> Nearest:
    """A triangle as the nearest, by its closest point."""
    nearest = Nearest()
    nearest.distance_squared = wp.length_sq(x - point)
    distance = wp.sqrt(nearest.distance_squared) + _ROUNDING
    nearest.reach = distance * distance
    nearest.triangle = triangle
    nearest.point = point
    return nearest


@wp.func
def nearer(triangles: WallTriangles, t: int, x: wp.vec3, best: Nearest) -> Nearest:
    """Keep the nearer of ``best`` and triangle ``t``; on a tie the lower index.

    The distance from the plane, then the one across the edges, reject most triangles first, with a margin. So the
    result is the least pair of squared distance and index, in whatever order triangles are offered, and a list that
    leaves far ones out gives the same, bit for bit.
    """
    off = plane_distance(triangles, t, x)
    if off * off > best.reach:
        return best
    inward = inward_distances(triangles, t, x)
    outside = wp.min(wp.min(inward), 0.0)
    if off * off + outside * outside > best.reach:
        return best
    point = closest_point(triangles, t, x, off, inward)
    distance_squared = wp.length_sq(x - point)
    if distance_squared < best.distance_squared or (distance_squared == best.distance_squared and t < best.triangle):
        best = nearest_at(t, x, point)
    return best


@wp.func
def nothing_yet() -> Nearest:
    """The nearest wall before any was looked at."""
    nearest = Nearest()
    nearest.distance_squared = 1.0e30
    nearest.reach = 1.0e30
    return nearest


@wp.func
def is_passed(triangles: WallTriangles, t: int, passed: wp.uint32) -> bool:
    """Whether a triangle belongs to a gate that was passed."""
    gate = triangles.rows[t].gate
    if gate < 0:
        return False
    return ((passed >> wp.uint32(gate)) & wp.uint32(1)) == wp.uint32(1)


@cache
def make_nearest(*, distance: str, gated: bool) -> wp.Function:
    """Make the function (triangles, cells, x, best, passed) -> nearest wall, starting from a guess.

    Args:
        distance: "grid" for the cell's candidates, "all" for every wall: the reference, the same bit for bit.
        gated: Whether there are gates; without, their code is left out.
    """

    @wp.func
    def offered(triangles: WallTriangles, t: int, x: wp.vec3, best: Nearest, passed: wp.uint32) -> Nearest:
        if wp.static(gated):
            if is_passed(triangles, t, passed):
                return best
        return nearer(triangles, t, x, best)

    @wp.func
    def nearest_in_grid(
        triangles: WallTriangles, cells: GridCells, x: wp.vec3, best: Nearest, passed: wp.uint32
    ) -> Nearest:
        cell = cell_of(cells, x)
        for item in range(cells.first[cell], cells.last[cell]):
            best = offered(triangles, cells.items[item], x, best, passed)
        return best

    @wp.func
    def nearest_of_all(
        triangles: WallTriangles, cells: GridCells, x: wp.vec3, best: Nearest, passed: wp.uint32
    ) -> Nearest:
        for t in range(triangles.count):
            best = offered(triangles, t, x, best, passed)
        return best

    return nearest_in_grid if distance == "grid" else nearest_of_all


_nearest_wall = make_nearest(distance="all", gated=True)


@wp.kernel(enable_backward=False)
def measure_distance(
    offset: int, triangles: WallTriangles, cells: GridCells, points: wp.array[wp.vec3], distance: wp.array[float]
):
    """Distance of points to the nearest of all walls."""
    i = offset + wp.tid()
    nearest = _nearest_wall(triangles, cells, points[i], nothing_yet(), ALL_GATES)
    distance[i] = wp.sqrt(nearest.distance_squared)
