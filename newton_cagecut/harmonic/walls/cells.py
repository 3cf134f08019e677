# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cells of a uniform grid, each with a list of wall triangles."""

from __future__ import annotations

import numpy as np
import warp as wp

from ..launch import launch

wp.set_module_options({"enable_backward": False})


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


@wp.kernel(enable_backward=False)
def _count_cells(offset: int, cells: GridCells, counts: wp.array[wp.int32]):
    cell = offset + wp.tid()
    counts[cell] = cells.last[cell] - cells.first[cell]


@wp.kernel(enable_backward=False)
def _copy_cells(offset: int, old: GridCells, cells: GridCells):
    cell = offset + wp.tid()
    for item in range(old.last[cell] - old.first[cell]):
        cells.items[cells.first[cell] + item] = old.items[old.first[cell] + item]


def uniform_cells(box: list[np.ndarray], resolution: int, device: wp.context.Device) -> GridCells:
    """Cells over a box, without lists.

    Args:
        box: Its corners in the unit frame, shape (dimension,) each.
        resolution: Cells along its longest side.
        device: Where the lists are to be.
    """
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


def single_cell(box: list[np.ndarray], triangle_count: int, device: wp.context.Device) -> GridCells:
    """One cell with all triangles."""
    cells = uniform_cells(box, 1, device)
    cells.shape = wp.vec3i(1, 1, 1)
    cells.first = wp.array([0], dtype=wp.int32, device=device)
    cells.last = wp.array([triangle_count], dtype=wp.int32, device=device)
    cells.items = wp.array(np.arange(triangle_count, dtype=np.int32), device=device)
    return cells


def _same_box(cells: GridCells) -> GridCells:
    result = GridCells()
    result.low, result.size, result.diagonal, result.shape = cells.low, cells.size, cells.diagonal, cells.shape
    return result


def with_counts(cells: GridCells, counts: wp.array) -> GridCells:
    """The same cells with empty lists of the given lengths."""
    result = _same_box(cells)
    ends = wp.zeros(counts.size + 1, dtype=wp.int32, device=counts.device)
    wp.utils.array_scan(counts, ends[1:], inclusive=True)
    result.first, result.last = ends[:-1], ends[1:]
    result.items = wp.empty(int(ends[-1:].numpy()[0]), dtype=wp.int32, device=counts.device)
    return result


def copied(cells: GridCells, more: int) -> GridCells:
    """A copy of cells and their lists, with room for more items."""
    result = _same_box(cells)
    result.first, result.last = wp.clone(cells.first), wp.clone(cells.last)
    result.items = wp.empty(cells.items.size + more, dtype=wp.int32, device=cells.items.device)
    wp.copy(result.items, cells.items, count=cells.items.size)
    return result


def compacted(cells: GridCells) -> GridCells:
    """The same lists without what lies between them."""
    device = cells.items.device
    counts = wp.empty(cells.first.size, dtype=wp.int32, device=device)
    launch(_count_cells, counts.size, [cells, counts], device=device)
    result = with_counts(cells, counts)
    launch(_copy_cells, counts.size, [cells, result], device=device)
    return result
