# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walk on Spheres from query points to the walls (Muller 1956; paper, sections 3 and 4).

A walk is a pure function of (seed, point, walk, walls): walking it again on walls of which the new ones met none of
its spheres gives the same landing and bounds, bit for bit, and otherwise it retraces itself up to the first sphere
that a new wall entered and goes on from there, which is the paper's section 4.2.

Where an edit has made a gate of a wall, a walk that comes within epsilon of it goes on behind it from the landing, with
counters of its own. So it can be resumed from that landing alone (paper, section 8), and is the same walk.
"""

from collections.abc import Callable
from functools import cache

import warp as wp

from ..launch import launch
from ..options import WalkOptions
from ..walls.cells import GridCells
from ..walls.grid import CandidateGrid
from ..walls.nearest_wall import ALL_GATES, make_nearest, nearest_at, nothing_yet
from ..walls.wall_triangles import WallTriangles, closest_point_on_triangle
from .bounds.kind import BoundsKind
from .landing import CAPPED, PASSED, landing_type, point_functions
from .query_points import QueryPoints
from .random import GATE_STREAM, make_direction
from .records import WalkRecords
from .work import Work, WorkList, number_of, place_of, point_of

wp.set_module_options({"enable_backward": False})


ON_WALL = wp.constant(1.0e-6)
"""Distance below which a query point counts as lying on the wall."""


@wp.func
def landing_key(triangles: WallTriangles, triangle: int, x: wp.vec3) -> wp.int32:
    """Key 2 * wall + side of a landing seen from x; a wall of the cage has side 0 only."""
    key = 2 * triangles.rows[triangle].wall
    if triangles.rows[triangle].two_sided == 1:
        if wp.dot(triangles.rows[triangle].normal, x - triangles.rows[triangle].corner_0) > 0.0:
            key += 1
    return key


@wp.func
def differs(a: wp.vec3, b: wp.vec3) -> bool:
    """Whether two points differ in any bit that counts."""
    return a[0] != b[0] or a[1] != b[1] or a[2] != b[2]


@wp.func
def gate_bit(gate: int) -> wp.uint32:
    """The bit of a gate among those that a walk has passed."""
    return wp.uint32(1) << wp.uint32(gate)


@wp.func
def stream_behind(seed: wp.uint32, gate: int) -> wp.uint32:
    """Seed of the part of a walk behind a gate."""
    return seed + GATE_STREAM * wp.uint32(gate + 1)


@cache
def make_walk_kernel(
    *, dimension: int, distance: str, bounded: bool, bounds_kind: BoundsKind, gated: bool, resumed: bool = False
) -> wp.Kernel:
    """Make the kernel that walks.

    Args:
        dimension: 3 for spheres, 2 for circles in the plane z = 0.
        distance: "grid" for the candidate grid, "all" for every wall.
        bounded: Whether to keep the walks' bounds; without, their code is left out.
        bounds_kind: Kind of the walks' bounds.
        gated: Whether there are gates; without, their code is left out.
        resumed: Whether to go on behind the gates on which the walks have landed.
    """
    Landings = landing_type(dimension)
    to_space, from_space = point_functions(dimension)
    direction = make_direction(dimension)
    nearest_wall = make_nearest(distance=distance, gated=gated)

    @wp.kernel(enable_backward=False, module="unique")
    def walk_on_spheres(
        offset: int,
        work: WorkList,
        points: QueryPoints,
        triangles: WallTriangles,
        cells: GridCells,
        wall_gate: wp.array[wp.int32],
        epsilon: float,
        max_steps: int,
        landings: Landings,
        bounds: wp.array2d[bounds_kind.level_type],
        touched: wp.array[wp.uint8],
    ):
        walk = place_of(work, offset + wp.tid())
        point = point_of(work, walk)
        number = number_of(work, walk)
        seed = work.seed
        x = points.position[point]
        stream = seed
        passed = wp.uint32(0)
        extents = bounds_kind.empty()
        earlier = bounds_kind.quantize(extents)  # bounds of the parts before gates
        if wp.static(resumed):
            gate = wall_gate[landings.key[walk] // 2]
            x = to_space(landings.point[walk])
            stream = stream_behind(seed, gate)
            passed = gate_bit(gate)
            earlier = bounds_kind.load(bounds, walk)
        elif points.key[point] >= 0:
            landings.key[walk] = points.key[point]
            landings.point[walk] = from_space(x)
            if wp.static(bounded):
                bounds_kind.store(bounds, walk, earlier)
            return
        nearest = nothing_yet()
        step = int(0)
        landed = bool(False)
        walking = bool(True)
        while walking:
            nearest = nearest_wall(triangles, cells, x, nearest, passed)
            radius = wp.sqrt(nearest.distance_squared)
            at_start = step == 0 and stream == seed
            gate = int(-1)
            if wp.static(gated):
                gate = triangles.rows[nearest.triangle].gate
                if at_start and gate >= 0 and radius < ON_WALL:
                    # The point lies on the gate: it is behind it from the start.
                    passed = passed | gate_bit(gate)
                    nearest = nothing_yet()
                    continue
            if wp.static(bounded):
                if not at_start:  # the first sphere is the point's, and is tested with it
                    extents = bounds_kind.extend(extents, x, radius)
            if at_start and number == wp.uint32(0):
                if wp.static(bounded):
                    if points.first_radius[point] != radius:
                        touched[point] = wp.uint8(1)
                points.first_radius[point] = radius
            # A point inside the shell still takes its first step, so that its weights reproduce it exactly; one that
            # lies outside, within the cage's tolerance, takes none, which could lead around the cage.
            landed = radius < wp.where(at_start, ON_WALL, epsilon)
            if at_start and passed == wp.uint32(0) and points.piece[point] < 0:
                landed = True
            if landed and gate >= 0:
                if wp.static(gated):
                    x = nearest.point
                    stream = stream_behind(seed, gate)
                    passed = passed | gate_bit(gate)
                    nearest = nothing_yet()
                    step = 0
                    if wp.static(bounded):
                        earlier = bounds_kind.merge(earlier, bounds_kind.quantize(extents))
                        extents = bounds_kind.empty()
            elif landed or step >= max_steps:
                walking = False
            else:
                x += radius * direction(stream, wp.uint32(point), number, wp.uint32(step))
                step += 1
                # Search from the wall that was nearest before: most others are then rejected at once.
                hint = nearest.triangle
                nearest = nearest_at(hint, x, closest_point_on_triangle(triangles, hint, x))
        if wp.static(gated):
            if triangles.rows[nearest.triangle].gate >= 0:  # a capped walk lands on a wall all the same
                nearest = nearest_wall(triangles, cells, x, nothing_yet(), ALL_GATES)
        key = landing_key(triangles, nearest.triangle, x)
        if not landed:
            key = key | CAPPED
        if stream != seed:
            key = key | PASSED
        if wp.static(bounded):
            # A walk that ends where it did before leaves its point's weights alone.
            if landings.key[walk] != key or differs(to_space(landings.point[walk]), nearest.point):
                touched[point] = wp.uint8(1)
        landings.key[walk] = key
        landings.point[walk] = from_space(nearest.point)
        if wp.static(bounded):
            whole = bounds_kind.quantize(extents)
            if wp.static(gated):
                whole = bounds_kind.merge(earlier, whole)
            bounds_kind.store(bounds, walk, whole)

    return walk_on_spheres


def run_walks(
    work: Work,
    records: WalkRecords,
    points: QueryPoints,
    grid: CandidateGrid,
    options: WalkOptions,
    *,
    distance: str,
    touched: wp.array | None = None,
    resumed: bool = False,
    progress: Callable[[float], None] | None = None,
) -> None:
    """Walk, and record where the walks landed and their bounds.

    Args:
        work: The walks.
        records: Where they are recorded.
        points: Where they start.
        grid: The walls, indexed.
        options: Options of the walks.
        distance: "grid" or "all": how the nearest wall is found.
        touched: Where to mark points of which a walk has landed elsewhere than before, shape (point_count,).
        resumed: Whether to go on from the gates on which the walks have landed.
        progress: Called with the finished fraction, between 0 and 1.
    """
    walls, device = grid.walls, records.device
    kernel = make_walk_kernel(
        dimension=records.dimension,
        distance=distance,
        bounded=records.bounded,
        bounds_kind=records.kind,
        gated=walls.gate_count > 0,
        resumed=resumed,
    )
    if touched is None:
        touched = wp.empty(points.key.size if records.bounded else 0, dtype=wp.uint8, device=device)
    inputs = [work.list, points, walls.data, grid.cells, walls.gate_of_wall, options.epsilon, options.max_steps]
    inputs += [records.landings, records.bounds, touched]
    launch(kernel, work.count, inputs, device=device, progress=progress)
