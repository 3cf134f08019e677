# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The candidate grid: for each cell, every wall triangle that can be nearest to some point of the cell.

A triangle w is a candidate of a cell with centre c and diagonal D when d(c, w) <= min_w' d(c, w') + D: for any q in
the cell, |d(q, w) - d(c, w)| <= D / 2, for every w. Gates do not count in the minimum, since some walks ignore them.
So the query over the list returns bit for bit what the query
over all walls returns, medial axis included (the paper's grid, section 6.2, is not exact there). The grid is refined
level by level, each cell choosing among its parent's candidates, and new walls are merged into the cells that they
can reach.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from .launch import launch, launch_blocks
from .walls import Walls, WallTriangles, closest_point_on_triangle, plane_distance

wp.set_module_options({"enable_backward": False})

_MARGIN = wp.constant(1.0e-5)
"""Added to the candidate rule: wider than the rounding of the distances that it compares."""

_LATERAL = wp.constant(2.0e-3)
"""Added to the rule within a plane: its square is wider than the rounding of the squared distances from the plane."""

_COARSEST = 4

_BLOCK_SIDE = wp.constant(4)
"""Cells along the side of a block; new walls are merged into the blocks that they can reach."""

_MOST_GROWTH = 4
"""Size of all lists, in sizes of what was built, above which those that are out of date are dropped."""


@wp.struct
class GridCells:
    """Cells of a uniform grid; cell (i, j, k) holds items[first[cell] : last[cell]]."""

    low: wp.vec3
    size: float
    diagonal: float
    shape: wp.vec3i
    first: wp.array[wp.int32]
    last: wp.array[wp.int32]
    items: wp.array[wp.int32]


@wp.func
def cell_center(cells: GridCells, cell: int) -> wp.vec3:
    """Centre of a cell."""
    i = cell // (cells.shape[1] * cells.shape[2])
    j = (cell // cells.shape[2]) % cells.shape[1]
    k = cell % cells.shape[2]
    return cells.low + cells.size * wp.vec3(float(i) + 0.5, float(j) + 0.5, float(k) + 0.5)


@wp.func
def cell_of(cells: GridCells, x: wp.vec3) -> int:
    """Cell that holds a point; points outside take the nearest cell."""
    q = (x - cells.low) / cells.size
    i = wp.clamp(int(q[0]), 0, cells.shape[0] - 1)
    j = wp.clamp(int(q[1]), 0, cells.shape[1] - 1)
    k = wp.clamp(int(q[2]), 0, cells.shape[2] - 1)
    return (i * cells.shape[1] + j) * cells.shape[2] + k


@wp.func
def _center_distance(triangles: WallTriangles, t: int, center: wp.vec3) -> float:
    return wp.length(center - closest_point_on_triangle(triangles, t, center))


@wp.kernel(enable_backward=False)
def _measure_cells(
    offset: int,
    triangles: WallTriangles,
    parent: GridCells,
    cells: GridCells,
    nearest: wp.array[float],
    counts: wp.array[wp.int32],
):
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


@wp.kernel(enable_backward=False)
def _fill_cells(offset: int, triangles: WallTriangles, parent: GridCells, cells: GridCells, nearest: wp.array[float]):
    cell = offset + wp.tid()
    center = cell_center(cells, cell)
    parent_cell = cell_of(parent, center)
    reach = nearest[cell] + cells.diagonal + _MARGIN
    slot = cells.first[cell]
    for item in range(parent.first[parent_cell], parent.last[parent_cell]):
        if _center_distance(triangles, parent.items[item], center) <= reach:
            cells.items[slot] = parent.items[item]
            slot += 1


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
    corner = blocks[number // wp.static(_BLOCK_SIDE**3)]
    i = corner[0] + (number // wp.static(_BLOCK_SIDE**2)) % _BLOCK_SIDE
    j = corner[1] + (number // _BLOCK_SIDE) % _BLOCK_SIDE
    k = corner[2] + number % _BLOCK_SIDE
    if i >= cells.shape[0] or j >= cells.shape[1] or k >= cells.shape[2]:
        return -1
    return (i * cells.shape[1] + j) * cells.shape[2] + k


@wp.kernel(enable_backward=False)
def _measure_new(
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
def _fill_merged(
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
            nearest[cell] = reach.nearest


@wp.kernel(enable_backward=False)
def _count_cells(offset: int, cells: GridCells, counts: wp.array[wp.int32]):
    cell = offset + wp.tid()
    counts[cell] = cells.last[cell] - cells.first[cell]


@wp.kernel(enable_backward=False)
def _copy_cells(offset: int, old: GridCells, cells: GridCells):
    cell = offset + wp.tid()
    for item in range(old.last[cell] - old.first[cell]):
        cells.items[cells.first[cell] + item] = old.items[old.first[cell] + item]


class CandidateGrid:
    """Uniform grid of nearest-wall candidates over the box of the walls.

    Args:
        walls: The walls to index; at least those of the cage.
        resolution: Cells along the box's longest side.
    """

    def __init__(self, walls: Walls, *, resolution: int = 32) -> None:
        self.walls = walls
        self.resolution = resolution
        self._build()

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return 4 * (2 * self.cells.first.size + self.cells.items.size + self._nearest.size)

    def rebuild(self) -> None:
        """Index all walls anew, over the box that they take now: after gates have opened a way out of the old one."""
        self._build()

    def merge(self, first_new: int) -> None:
        """Add the triangles from ``first_new`` on, all of one wall, to the cells that they can reach."""
        old, device = self.cells, self.walls.device
        blocks = self._reachable_blocks(first_new)
        if not len(blocks):
            return
        cell_count = len(blocks) * _BLOCK_SIDE**3
        counts = wp.empty(cell_count, dtype=wp.int32, device=device)
        reaches = wp.empty(cell_count, dtype=Reach, device=device)
        new = [wp.array(blocks, dtype=wp.vec3i, device=device), self.walls.data, first_new]
        launch_blocks(_measure_new, cell_count, [*new, old, self._nearest, reaches, counts], device=device)
        wp.utils.array_scan(counts, counts, inclusive=True)
        cells = _copied(old, int(counts[-1:].numpy()[0]))
        launch_blocks(_fill_merged, cell_count, [*new, counts, old, cells, reaches, self._nearest], device=device)
        self.cells = cells if cells.items.size <= _MOST_GROWTH * self._built_size else _compacted(cells)

    def _reachable_blocks(self, first_new: int) -> np.ndarray:
        """First cells of the blocks in which new triangles may be nearest somewhere, shape (block_count, 3)."""
        low, high = self.walls.box(first_new)
        size, half = self.cells.size, 0.5 * _BLOCK_SIDE * self.cells.size
        corner = np.stack(np.unravel_index(np.arange(self._farthest.size), self._farthest.shape), axis=1) * _BLOCK_SIDE
        center = np.array(list(self.cells.low)) + size * corner + half
        away = np.linalg.norm(np.maximum(np.maximum(low - center, center - high), 0.0), axis=1)
        reach = self._farthest.reshape(-1) + self.cells.diagonal + 3.0**0.5 * half + 1.0e-3
        return corner[away <= reach].astype(np.int32)

    def state(self) -> tuple:
        """The grid as it is: merging replaces the cells, and writes to the distances, of which this has a copy."""
        return self.cells, wp.clone(self._nearest), self._built_size, self._farthest

    def restore(self, state: tuple) -> None:
        """Forget the walls that were merged since a state."""
        self.cells, nearest, self._built_size, self._farthest = state
        self._nearest = wp.clone(nearest)

    def _build(self) -> None:
        device = self.walls.device
        box = [corner[: len(self.walls.frame.center)] for corner in self.walls.box()]
        parent = _single_cell(box, self.walls.triangle_count, device)
        for resolution in _levels(self.resolution):
            cells = _uniform_cells(box, resolution, device)
            cell_count = int(np.prod(list(cells.shape)))
            counts = wp.empty(cell_count, dtype=wp.int32, device=device)
            self._nearest = wp.empty(cell_count, dtype=float, device=device)
            launch(_measure_cells, cell_count, [self.walls.data, parent, cells, self._nearest, counts], device=device)
            cells = _with_counts(cells, counts)
            launch(_fill_cells, cell_count, [self.walls.data, parent, cells, self._nearest], device=device)
            self.cells = parent = cells
        self._built_size = self.cells.items.size
        self._farthest = _block_maxima(self._nearest.numpy().reshape(list(self.cells.shape)))


def _block_maxima(values: np.ndarray) -> np.ndarray:
    """Greatest value in each block of cells."""
    padding = [(0, -count % _BLOCK_SIDE) for count in values.shape]
    padded = np.pad(values, padding)
    i, j, k = (count // _BLOCK_SIDE for count in padded.shape)
    return padded.reshape(i, _BLOCK_SIDE, j, _BLOCK_SIDE, k, _BLOCK_SIDE).max(axis=(1, 3, 5))


def _levels(resolution: int) -> list[int]:
    """Resolutions from coarse to fine whose cells nest: each is half of the next."""
    levels = [resolution]
    while levels[0] > _COARSEST and levels[0] % 2 == 0:
        levels.insert(0, levels[0] // 2)
    return levels


def _uniform_cells(box: list[np.ndarray], resolution: int, device: wp.context.Device) -> GridCells:
    dimension = len(box[0])
    pad = 1.0e-3
    extents = box[1] - box[0] + 2.0 * pad
    size = float(extents.max()) / resolution
    low, shape = np.full(3, -0.5 * size), np.ones(3, dtype=int)  # of 2D: one layer around the plane z = 0
    low[:dimension] = box[0] - pad
    shape[:dimension] = np.maximum(1, np.ceil(extents / size - 1e-6))
    cells = GridCells()
    cells.low = wp.vec3(*low.tolist())
    cells.size = size
    cells.diagonal = size * dimension**0.5
    cells.shape = wp.vec3i(*shape.tolist())
    return cells


def _single_cell(box: list[np.ndarray], triangle_count: int, device: wp.context.Device) -> GridCells:
    cells = _uniform_cells(box, 1, device)
    cells.shape = wp.vec3i(1, 1, 1)
    cells.first = wp.array([0], dtype=wp.int32, device=device)
    cells.last = wp.array([triangle_count], dtype=wp.int32, device=device)
    cells.items = wp.array(np.arange(triangle_count, dtype=np.int32), device=device)
    return cells


def _same_box(cells: GridCells) -> GridCells:
    result = GridCells()
    result.low, result.size, result.diagonal, result.shape = cells.low, cells.size, cells.diagonal, cells.shape
    return result


def _with_counts(cells: GridCells, counts: wp.array) -> GridCells:
    """The same cells with empty lists of the given lengths."""
    result = _same_box(cells)
    ends = wp.zeros(counts.size + 1, dtype=wp.int32, device=counts.device)
    wp.utils.array_scan(counts, ends[1:], inclusive=True)
    result.first, result.last = ends[:-1], ends[1:]
    result.items = wp.empty(int(ends[-1:].numpy()[0]), dtype=wp.int32, device=counts.device)
    return result


def _copied(cells: GridCells, more: int) -> GridCells:
    """A copy of cells and their lists, with room for more items."""
    result = _same_box(cells)
    result.first, result.last = wp.clone(cells.first), wp.clone(cells.last)
    result.items = wp.empty(cells.items.size + more, dtype=wp.int32, device=cells.items.device)
    wp.copy(result.items, cells.items, count=cells.items.size)
    return result


def _compacted(cells: GridCells) -> GridCells:
    """The same lists without what lies between them."""
    device = cells.items.device
    counts = wp.empty(cells.first.size, dtype=wp.int32, device=device)
    launch(_count_cells, counts.size, [cells, counts], device=device)
    result = _with_counts(cells, counts)
    launch(_copy_cells, counts.size, [cells, result], device=device)
    return result
