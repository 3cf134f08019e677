# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The candidate grid: for each cell, every wall triangle that can be nearest to some point of the cell.

A triangle w is a candidate of a cell with centre c and diagonal D when d(c, w) <= min_w' d(c, w') + D: for any q in
the cell, |d(q, w) - d(c, w)| <= D / 2, for every w. Gates do not count in the minimum, since some walks ignore them.
So the query over the list returns bit for bit what the query over all walls returns, medial axis included (the paper's
grid, section 6.2, is not exact there). The grid is refined level by level, each cell choosing among its parent's
candidates, and new walls are merged into the cells that they can reach.

The finer it is, the longer it takes to build and the shorter its lists are. Measured on one core, in milliseconds to
build it and microseconds a walk (a box of 12 triangles, then balls with eight arms; polygons in the plane):

    cells  |   12        50        100       400        1600       | 4 segments  50         400
    8      |   2  2.34   3  2.97   5  5.13   15  13.0    39  36.5  |  1  0.87    2  1.54    3  5.24
    16     |   6  2.30   6  2.40  10  3.55   25   7.45   82  15.3  |  2  0.89    2  1.23    5  3.10
    24     |   8  2.25  15  2.28  22  3.12   50   5.64  140  10.8  |  3  0.91    3  1.18    6  2.54
    32     |  12  2.23  18  2.28  29  2.90   67   4.69  219   9.1  |  2  0.85    3  1.06    7  2.31
    48     |  23  2.81  39  2.16  55  2.73  127   4.03  382   7.0  |  3  0.84    4  1.01    9  2.01
    64     |  61  2.62  69  2.64  96  2.82  209   4.02  588   6.1  |  3  0.84    5  1.00   13  1.79
    128    |                                                       |  5  0.96    9  0.95   24  1.46

The walls that cuts add make no finer grid worth its while: a box of 289 triangles after six cuts has walks of 3.4, 2.8
and 2.9 microseconds with 16, 32 and 64 cells.
"""

from __future__ import annotations

import copy

import numpy as np
import warp as wp

from ..launch import launch, launch_blocks
from .candidates import fill_cells, measure_cells
from .cells import compacted, copied, single_cell, uniform_cells, with_counts
from .merging import BLOCK_SIDE, NewTriangles, Reach, fill_merged, measure_new
from .walls import Walls

_COARSEST = 4

_RESOLUTIONS = {2: ((24, 32), (100, 64), (None, 128)), 3: ((24, 16), (64, 24), (200, 32), (800, 48), (None, 64))}
"""Of each dimension: up to so many triangles, or segments, so many cells along the longest side; see above."""

_MOST_GROWTH = 4
"""Size of all lists, in sizes of what was built, above which those that are out of date are dropped."""


class CandidateGrid:
    """Uniform grid of nearest-wall candidates over the box of the walls.

    Args:
        walls: The walls to index; at least those of the cage.
        resolution: Cells along the box's longest side; by default, what suits the number of walls.
    """

    def __init__(self, walls: Walls, *, resolution: int | None = None) -> None:
        self.walls = walls
        self.resolution = resolution
        self._build()

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return 4 * (2 * self.cells.first.size + self.cells.items.size + self._nearest.size)

    def merged(self, walls: Walls, first_new: int) -> CandidateGrid:
        """This grid with further triangles in the cells that they can reach; it is not written to itself.

        Args:
            walls: The walls as they are now.
            first_new: The first triangle that is not in the grid; those from it on are all of one wall.
        """
        grid, device = copy.copy(self), walls.device
        grid.walls = walls
        blocks = grid._reachable_blocks(first_new)
        if not len(blocks):
            return grid
        cell_count = len(blocks) * BLOCK_SIDE**3
        counts = wp.empty(cell_count, dtype=wp.int32, device=device)
        reaches = wp.empty(cell_count, dtype=Reach, device=device)
        added = NewTriangles()
        added.all, added.first, added.wall = walls.data, first_new, int(walls.rows["wall"][first_new])
        added.blocks = wp.array(blocks, dtype=wp.vec3i, device=device)
        launch_blocks(measure_new, cell_count, [added, self.cells, self._nearest, reaches, counts], device=device)
        wp.utils.array_scan(counts, counts, inclusive=True)
        cells = copied(self.cells, int(counts[-1:].numpy()[0]))
        grid._nearest = wp.clone(self._nearest)
        launch_blocks(
            fill_merged, cell_count, [added, counts, self.cells, cells, reaches, grid._nearest], device=device
        )
        grid.cells = cells if cells.items.size <= _MOST_GROWTH * self._built_size else compacted(cells)
        return grid

    def _reachable_blocks(self, first_new: int) -> np.ndarray:
        """First cells of the blocks in which new triangles may be nearest somewhere, shape (block_count, 3)."""
        low, high = self.walls.box(first_new)
        size, half = self.cells.size, 0.5 * BLOCK_SIDE * self.cells.size
        corner = np.stack(np.unravel_index(np.arange(self._farthest.size), self._farthest.shape), axis=1) * BLOCK_SIDE
        center = np.array(list(self.cells.low)) + size * corner + half
        away = np.linalg.norm(np.maximum(np.maximum(low - center, center - high), 0.0), axis=1)
        reach = self._farthest.reshape(-1) + self.cells.diagonal + 3.0**0.5 * half + 1.0e-3
        return corner[away <= reach].astype(np.int32)

    def _build(self) -> None:
        device = self.walls.device
        box = [corner[: len(self.walls.frame.center)] for corner in self.walls.box()]
        parent = single_cell(box, self.walls.triangle_count, device)
        for resolution in _levels(self.resolution or _fitting_resolution(self.walls.triangle_count, len(box[0]))):
            cells = uniform_cells(box, resolution, device)
            cell_count = int(np.prod(list(cells.shape)))
            counts = wp.empty(cell_count, dtype=wp.int32, device=device)
            self._nearest = wp.empty(cell_count, dtype=float, device=device)
            launch(measure_cells, cell_count, [self.walls.data, parent, cells, self._nearest, counts], device=device)
            cells = with_counts(cells, counts)
            launch(fill_cells, cell_count, [self.walls.data, parent, cells, self._nearest], device=device)
            self.cells = parent = cells
        self._built_size = self.cells.items.size
        self._farthest = _block_maxima(self._nearest.numpy().reshape(list(self.cells.shape)))


def _block_maxima(values: np.ndarray) -> np.ndarray:
    """Greatest value in each block of cells."""
    padding = [(0, -count % BLOCK_SIDE) for count in values.shape]
    padded = np.pad(values, padding)
    i, j, k = (count // BLOCK_SIDE for count in padded.shape)
    return padded.reshape(i, BLOCK_SIDE, j, BLOCK_SIDE, k, BLOCK_SIDE).max(axis=(1, 3, 5))


def _fitting_resolution(triangle_count: int, dimension: int) -> int:
    """Cells along the longest side that are worth building for so many triangles, or segments of the plane."""
    return next(cells for most, cells in _RESOLUTIONS[dimension] if most is None or triangle_count <= most)


def _levels(resolution: int) -> list[int]:
    """Resolutions from coarse to fine whose cells nest: each is half of the next."""
    levels = [resolution]
    while levels[0] > _COARSEST and levels[0] % 2 == 0:
        levels.insert(0, levels[0] // 2)
    return levels
