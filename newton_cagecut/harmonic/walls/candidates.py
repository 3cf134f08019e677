# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels that find each cell's candidates: see ``grid.py`` for the rule."""

from __future__ import annotations

import warp as wp

from .cells import GridCells, cell_center, cell_of
from .wall_triangles import WallTriangles, closest_point_on_triangle, plane_distance

wp.set_module_options({"enable_backward": False})

BLOCK_SIDE = wp.constant(4)
"""Cells along the side of a block; new walls are merged into the blocks that they can reach."""

_MARGIN = wp.constant(1.0e-5)
"""Added to the candidate rule: wider than the rounding of the distances that it compares."""

_LATERAL = wp.constant(2.0e-3)
"""Added to the rule within a plane: its square is wider than the rounding of the squared distances from the plane."""


@wp.func
def _center_distance(triangles: WallTriangles, t: int, center: wp.vec3) -> float:
    return wp.length(center - closest_point_on_triangle(triangles, t, center))


@wp.kernel(enable_backward=False)
def measure_cells(
    offset: int,
    triangles: WallTriangles,
    parent: GridCells,
    cells: GridCells,
    nearest: wp.array[float],
    counts: wp.array[wp.int32],
):
    """Distance of each cell's centre from the nearest wall, and how many of its parent's candidates it keeps."""
    cell = offset + wp.tid()
    center = cell_center(cells, cell)
    parent_cell = cell_of(parent, center)
    first = parent.first[parent_cell]
    last = parent.last[parent_cell]
    best = float(1.0e30)
    for item in range(first, last):
        if triangles.rows[parent.items[item]].gate < 0:
            best = wp.min(best, _center_distance(triangles, parent.items[item], center))
    reach = best + cells.diagonal + _MARGIN
    count = int(0)
    for item in range(first, last):
        if _center_distance(triangles, parent.items[item], center) <= reach:
            count += 1
    nearest[cell] = best
    counts[cell] = count


@wp.func
def _put_nearest_first(triangles: WallTriangles, cells: GridCells, first: int, last: int, center: wp.vec3):
    """Swap the candidate that is nearest to the cell's centre to the front: most others are then rejected at once."""
    best = first
    least = float(1.0e30)
    for slot in range(first, last):
        distance = _center_distance(triangles, cells.items[slot], center)
        if distance < least:
            least = distance
            best = slot
    front = cells.items[first]
    cells.items[first] = cells.items[best]
    cells.items[best] = front


@wp.kernel(enable_backward=False)
def fill_cells(offset: int, triangles: WallTriangles, parent: GridCells, cells: GridCells, nearest: wp.array[float]):
    """Write each cell's list."""
    cell = offset + wp.tid()
    center = cell_center(cells, cell)
    parent_cell = cell_of(parent, center)
    reach = nearest[cell] + cells.diagonal + _MARGIN
    slot = cells.first[cell]
    for item in range(parent.first[parent_cell], parent.last[parent_cell]):
        if _center_distance(triangles, parent.items[item], center) <= reach:
            cells.items[slot] = parent.items[item]
            slot += 1
    _put_nearest_first(triangles, cells, cells.first[cell], slot, center)


@wp.func
def _lateral_distance(triangles: WallTriangles, t: int, center: wp.vec3) -> float:
    """Distance within the triangle's plane of a point's projection."""
    projected = center - triangles.rows[t].normal * plane_distance(triangles, t, center)
    return wp.length(projected - closest_point_on_triangle(triangles, t, projected))


@wp.struct
class Reach:
    """What a cell that new triangles of one wall reach still has to list: see ``_is_candidate``."""

    nearest: float
    lateral: float


@wp.func
def _is_candidate(triangles: WallTriangles, t: int, wall: int, cells: GridCells, center: wp.vec3, reach: Reach) -> bool:
    """The rule at the head of the file, and for the new triangles' wall the same rule within its plane.

    The triangles of one wall are all as far from a point as their plane is, so the nearest of them is the one that is
    nearest within the plane. The pieces of a long cut would crowd the cells beside it otherwise.
    """
    diagonal = cells.diagonal
    if _center_distance(triangles, t, center) > reach.nearest + diagonal + _MARGIN:
        return False
    return (
        triangles.rows[t].wall != wall or _lateral_distance(triangles, t, center) <= reach.lateral + diagonal + _LATERAL
    )


@wp.func
def _reach_of_new(
    triangles: WallTriangles, first_new: int, cells: GridCells, cell: int, center: wp.vec3, nearest: float
) -> Reach:
    """Least distances with the new triangles; ``lateral`` is negative where none of them reaches the cell."""
    wall = triangles.rows[first_new].wall
    reach = Reach()
    reach.nearest = nearest
    reach.lateral = -1.0
    lateral = float(1.0e30)
    farthest = nearest + cells.diagonal + _MARGIN
    for t in range(first_new, triangles.count):
        if wp.abs(plane_distance(triangles, t, center)) <= farthest + _MARGIN:  # most cells are out of reach
            distance = _center_distance(triangles, t, center)
            if distance <= farthest:
                reach.nearest = wp.min(reach.nearest, distance)
                lateral = wp.min(lateral, _lateral_distance(triangles, t, center))
    if lateral < 1.0e30:
        for item in range(cells.first[cell], cells.last[cell]):
            if triangles.rows[cells.items[item]].wall == wall:
                lateral = wp.min(lateral, _lateral_distance(triangles, cells.items[item], center))
        reach.lateral = lateral
    return reach


@wp.func
def _cell_in_blocks(cells: GridCells, blocks: wp.array[wp.vec3i], number: int) -> int:
    """Cell of a running number over all cells of some blocks; -1 where a block reaches out of the grid."""
    corner = blocks[number // wp.static(BLOCK_SIDE**3)]
    i = corner[0] + (number // wp.static(BLOCK_SIDE**2)) % BLOCK_SIDE
    j = corner[1] + (number // BLOCK_SIDE) % BLOCK_SIDE
    k = corner[2] + number % BLOCK_SIDE
    if i >= cells.shape[0] or j >= cells.shape[1] or k >= cells.shape[2]:
        return -1
    return (i * cells.shape[1] + j) * cells.shape[2] + k


@wp.kernel(enable_backward=False)
def measure_new(
    offset: int,
    block: int,
    cell_count: int,
    blocks: wp.array[wp.vec3i],
    triangles: WallTriangles,
    first_new: int,
    cells: GridCells,
    nearest: wp.array[float],
    reaches: wp.array[Reach],
    counts: wp.array[wp.int32],
):
    """What new triangles mean for the cells of some blocks: least distances, and lengths of the lists that change."""
    begin = (offset + wp.tid()) * block
    wall = triangles.rows[first_new].wall
    for number in range(begin, wp.min(begin + block, cell_count)):
        cell = _cell_in_blocks(cells, blocks, number)
        reach = Reach()
        reach.lateral = -1.0
        center = cell_center(cells, cell)
        if cell >= 0:
            reach = _reach_of_new(triangles, first_new, cells, cell, center, nearest[cell])
        reaches[number] = reach
        count = int(0)
        if reach.lateral >= 0.0:
            for item in range(cells.first[cell], cells.last[cell]):
                if _is_candidate(triangles, cells.items[item], wall, cells, center, reach):
                    count += 1
            for t in range(first_new, triangles.count):
                if _is_candidate(triangles, t, wall, cells, center, reach):
                    count += 1
        counts[number] = count


@wp.kernel(enable_backward=False)
def fill_merged(
    offset: int,
    block: int,
    cell_count: int,
    blocks: wp.array[wp.vec3i],
    triangles: WallTriangles,
    first_new: int,
    ends: wp.array[wp.int32],
    old: GridCells,
    cells: GridCells,
    reaches: wp.array[Reach],
    nearest: wp.array[float],
):
    """Write the lists of the cells that new triangles reach behind all others, and leave those of other cells."""
    begin = (offset + wp.tid()) * block
    wall = triangles.rows[first_new].wall
    for number in range(begin, wp.min(begin + block, cell_count)):
        reach = reaches[number]
        if reach.lateral >= 0.0:
            cell = _cell_in_blocks(cells, blocks, number)
            center = cell_center(cells, cell)
            slot = old.items.shape[0]
            if number > 0:
                slot += ends[number - 1]
            cells.first[cell] = slot
            for item in range(old.first[cell], old.last[cell]):
                t = old.items[item]
                if _is_candidate(triangles, t, wall, cells, center, reach):
                    cells.items[slot] = t
                    slot += 1
            for t in range(first_new, triangles.count):
                if _is_candidate(triangles, t, wall, cells, center, reach):
                    cells.items[slot] = t
                    slot += 1
            cells.last[cell] = slot
            _put_nearest_first(triangles, cells, cells.first[cell], slot, center)
            nearest[cell] = reach.nearest
