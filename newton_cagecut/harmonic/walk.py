# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walk on Spheres from query points to the walls (Muller 1956; paper, sections 3 and 4).

A walk is a pure function of (seed, point, walk, walls): walking it again on walls of which the new ones met none of
its spheres gives the same landing and bounds, bit for bit, and otherwise it retraces itself up to the first sphere
that a new wall entered and goes on from there, which is the paper's section 4.2.
"""

from functools import cache

import warp as wp

from .bounds_kind import BoundsKind
from .grid import GridCells, nearest_in_grid
from .landing import CAPPED, landing_type, point_functions
from .points import QueryPoints
from .random import make_direction
from .walls import Nearest, WallTriangles, closest_point_on_triangle, nearest_of_all

wp.set_module_options({"enable_backward": False})


_ON_WALL = wp.constant(1.0e-6)
"""Distance below which a query point counts as lying on the wall."""


@wp.func
def landing_key(triangles: WallTriangles, triangle: int, x: wp.vec3) -> wp.int32:
    """Key 2 * wall + side of a landing seen from x; a wall of the cage has side 0 only."""
    key = 2 * triangles.wall[triangle]
    if triangles.two_sided[triangle] == 1:
        if wp.dot(triangles.normal[triangle], x - triangles.corner_0[triangle]) > 0.0:
            key += 1
    return key


@wp.func
def differs(a: wp.vec3, b: wp.vec3) -> bool:
    """Whether two points differ in any bit that counts."""
    return a[0] != b[0] or a[1] != b[1] or a[2] != b[2]


@cache
def make_walk_kernel(*, dimension: int, distance: str, bounded: bool, bounds_kind: BoundsKind) -> wp.Kernel:
    """Make the kernel that walks.

    Args:
        dimension: 3 for spheres, 2 for circles in the plane z = 0.
        distance: "grid" for the candidate grid, "all" for every wall.
        bounded: Whether to keep the walks' bounds; without, their code is left out.
        bounds_kind: Kind of the walks' bounds.
    """
    use_grid = distance == "grid"
    Landings = landing_type(dimension)
    to_space, from_space = point_functions(dimension)
    direction = make_direction(dimension)

    @wp.kernel(enable_backward=False, module="unique")
    def walk_on_spheres(
        offset: int,
        work: wp.array[wp.int32],
        walks: int,
        first_walk: int,
        seed: wp.uint32,
        points: QueryPoints,
        triangles: WallTriangles,
        cells: GridCells,
        epsilon: float,
        max_steps: int,
        landings: Landings,
        bounds: wp.array[bounds_kind.Quantized],
        touched: wp.array[wp.uint8],
    ):
        slot = offset + wp.tid()
        walk = slot
        if work.shape[0] > 0:
            walk = work[slot]
        point = (first_walk + walk) // walks
        number = wp.uint32((first_walk + walk) % walks)
        x = points.position[point]
        extents = bounds_kind.empty()
        if points.key[point] >= 0:
            landings.key[walk] = points.key[point]
            landings.point[walk] = from_space(x)
            if wp.static(bounded):
                bounds[walk] = bounds_kind.quantize(extents)
            return
        nearest = Nearest()
        nearest.distance_squared = 1.0e30
        step = int(0)
        walking = bool(True)
        while walking:
            if wp.static(use_grid):
                nearest = nearest_in_grid(triangles, cells, x, nearest)
            else:
                nearest = nearest_of_all(triangles, x, nearest)
            radius = wp.sqrt(nearest.distance_squared)
            if wp.static(bounded):
                extents = bounds_kind.extend(extents, x, radius)
            if step == 0 and number == wp.uint32(0):
                if wp.static(bounded):
                    if points.first_radius[point] != radius:
                        touched[point] = wp.uint8(1)
                points.first_radius[point] = radius
            # A point inside the shell still takes its first step, so that its weights reproduce it exactly.
            if radius < wp.where(step == 0, _ON_WALL, epsilon) or step >= max_steps:
                walking = False
            else:
                x += radius * direction(seed, wp.uint32(point), number, wp.uint32(step))
                step += 1
                # Search from the wall that was nearest before: most others are then rejected at once.
                nearest.point = closest_point_on_triangle(triangles, nearest.triangle, x)
                nearest.distance_squared = wp.length_sq(x - nearest.point)
        key = landing_key(triangles, nearest.triangle, x)
        if wp.sqrt(nearest.distance_squared) >= epsilon:
            key = key | CAPPED
        if wp.static(bounded):
            # A walk that ends where it did before leaves its point's weights alone.
            if landings.key[walk] != key or differs(to_space(landings.point[walk]), nearest.point):
                touched[point] = wp.uint8(1)
        landings.key[walk] = key
        landings.point[walk] = from_space(nearest.point)
        if wp.static(bounded):
            bounds[walk] = bounds_kind.quantize(extents)

    return walk_on_spheres
