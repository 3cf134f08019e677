# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels that find each cell's candidates among those of a coarser cell: see ``grid.py`` for the rule."""

from __future__ import annotations

import warp as wp

from .cells import GridCells, cell_center, cell_of
from .wall_triangles import WallTriangles, closest_point_on_triangle

wp.set_module_options({"enable_backward": False})

MARGIN = wp.constant(1.0e-5)
"""Added to the candidate rule: wider than the rounding of the distances that it compares."""


@wp.func
def center_distance(triangles: WallTriangles, t: int, center: wp.vec3) -> float:
    """Distance of a cell's centre from a triangle."""
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
            best = wp.min(best, center_distance(triangles, parent.items[item], center))
    reach = best + cells.diagonal + MARGIN
    count = int(0)
    for item in range(first, last):
        if center_distance(triangles, parent.items[item], center) <= reach:
            count += 1
    nearest[cell] = best
    counts[cell] = count


@wp.func
def put_nearest_first(triangles: WallTriangles, cells: GridCells, first: int, last: int, center: wp.vec3):
    """Swap the candidate that is nearest to the cell's centre to the front: most others are then rejected at once."""
    best = first
    least = float(1.0e30)
    for slot in range(first, last):
        distance = center_distance(triangles, cells.items[slot], center)
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
    reach = nearest[cell] + cells.diagonal + MARGIN
    slot = cells.first[cell]
    for item in range(parent.first[parent_cell], parent.last[parent_cell]):
        if center_distance(triangles, parent.items[item], center) <= reach:
            cells.items[slot] = parent.items[item]
            slot += 1
    put_nearest_first(triangles, cells, cells.first[cell], slot, center)
