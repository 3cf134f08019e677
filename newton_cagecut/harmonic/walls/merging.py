# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels that merge new walls into the lists of the cells that they can reach: see ``grid.py`` for the rule."""

from __future__ import annotations

import warp as wp

from .candidates import MARGIN, center_distance, put_nearest_first
from .cells import GridCells, cell_center
from .wall_triangles import WallTriangles, closest_point_on_triangle, plane_distance

wp.set_module_options({"enable_backward": False})

BLOCK_SIDE = wp.constant(4)
"""Cells along the side of a block; new walls are merged into the blocks that they can reach."""

_LATERAL = wp.constant(2.0e-3)
"""Added to the rule within a plane: its square is wider than the rounding of the squared distances from the plane."""


@wp.struct
class NewTriangles:
    """The triangles from ``first`` on, all of one wall, and the first cells of the blocks that they can reach."""

    all: WallTriangles
    first: int
    wall: int
    blocks: wp.array[wp.vec3i]


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
def _is_candidate(added: NewTriangles, t: int, cells: GridCells, center: wp.vec3, reach: Reach) -> bool:
    """The rule at the head of the file, and for the new triangles' wall the same rule within its plane.

    The triangles of one wall are all as far from a point as their plane is, so the nearest of them is the one that is
    nearest within the plane. The pieces of a long cut would crowd the cells beside it otherwise.
    """
    diagonal = cells.diagonal
    if center_distance(added.all, t, center) > reach.nearest + diagonal + MARGIN:
        return False
    if added.all.rows[t].wall != added.wall:
        return True
    return _lateral_distance(added.all, t, center) <= reach.lateral + diagonal + _LATERAL


@wp.func
def _reach_of_new(added: NewTriangles, cells: GridCells, cell: int, center: wp.vec3, nearest: float) -> Reach:
    """Least distances with the new triangles; ``lateral`` is negative where none of them reaches the cell."""
    reach = Reach()
    reach.nearest = nearest
    reach.lateral = -1.0
    lateral = float(1.0e30)
    farthest = nearest + cells.diagonal + MARGIN
    for t in range(added.first, added.all.count):
        if wp.abs(plane_distance(added.all, t, center)) <= farthest + MARGIN:  # most cells are out of reach
            distance = center_distance(added.all, t, center)
            if distance <= farthest:
                reach.nearest = wp.min(reach.nearest, distance)
                lateral = wp.min(lateral, _lateral_distance(added.all, t, center))
    if lateral < 1.0e30:
        for item in range(cells.first[cell], cells.last[cell]):
            if added.all.rows[cells.items[item]].wall == added.wall:
                lateral = wp.min(lateral, _lateral_distance(added.all, cells.items[item], center))
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
    added: NewTriangles,
    cells: GridCells,
    nearest: wp.array[float],
    reaches: wp.array[Reach],
    counts: wp.array[wp.int32],
):
    """What new triangles mean for the cells of some blocks: least distances, and lengths of the lists that change."""
    begin = (offset + wp.tid()) * block
    for number in range(begin, wp.min(begin + block, cell_count)):
        cell = _cell_in_blocks(cells, added.blocks, number)
        reach = Reach()
        reach.lateral = -1.0
        center = cell_center(cells, cell)
        if cell >= 0:
            reach = _reach_of_new(added, cells, cell, center, nearest[cell])
        reaches[number] = reach
        count = int(0)
        if reach.lateral >= 0.0:
            for item in range(cells.first[cell], cells.last[cell]):
                if _is_candidate(added, cells.items[item], cells, center, reach):
                    count += 1
            for t in range(added.first, added.all.count):
                if _is_candidate(added, t, cells, center, reach):
                    count += 1
        counts[number] = count


@wp.kernel(enable_backward=False)
def fill_merged(
    offset: int,
    block: int,
    cell_count: int,
    added: NewTriangles,
    ends: wp.array[wp.int32],
    old: GridCells,
    cells: GridCells,
    reaches: wp.array[Reach],
    nearest: wp.array[float],
):
    """Write the lists of the cells that new triangles reach behind all others, and leave those of other cells."""
    begin = (offset + wp.tid()) * block
    for number in range(begin, wp.min(begin + block, cell_count)):
        reach = reaches[number]
        if reach.lateral >= 0.0:
            cell = _cell_in_blocks(cells, added.blocks, number)
            center = cell_center(cells, cell)
            slot = old.items.shape[0]
            if number > 0:
                slot += ends[number - 1]
            cells.first[cell] = slot
            for item in range(old.first[cell], old.last[cell]):
                t = old.items[item]
                if _is_candidate(added, t, cells, center, reach):
                    cells.items[slot] = t
                    slot += 1
            for t in range(added.first, added.all.count):
                if _is_candidate(added, t, cells, center, reach):
                    cells.items[slot] = t
                    slot += 1
            cells.last[cell] = slot
            put_nearest_first(added.all, cells, cells.first[cell], slot, center)
            nearest[cell] = reach.nearest
