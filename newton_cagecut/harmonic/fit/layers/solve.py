# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The solution of dense systems, the same bit for bit on any number of threads; see ``products``."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...launch import launch
from .products import BLOCK, BLOCK_LANES, LANE, ROWS, WIDTH, lane_count, subtract_product

wp.set_module_options({"enable_backward": False, "max_unroll": 0})


@wp.kernel(enable_backward=False)
def _factor_block(offset: int, matrix: wp.array2d[LANE], block: int):
    """Factor a block on the diagonal into a lower triangle with ones on its diagonal and an upper one."""
    first = (offset + wp.tid() + block) * wp.static(BLOCK)
    first_lane = block * wp.static(BLOCK_LANES)
    for k in range(wp.static(BLOCK)):
        lane_of_k = first_lane + k // wp.static(WIDTH)
        pivot = matrix[first + k, lane_of_k][k % wp.static(WIDTH)]
        for i in range(k + 1, wp.static(BLOCK)):
            factor = matrix[first + i, lane_of_k][k % wp.static(WIDTH)] / pivot
            for lane in range(lane_of_k, first_lane + wp.static(BLOCK_LANES)):
                row = matrix[first + k, lane]
                if lane == lane_of_k:
                    for c in range(wp.static(WIDTH)):
                        if c <= k % wp.static(WIDTH):
                            row[c] = wp.float64(0.0)
                change = matrix[first + i, lane] - factor * row
                if lane == lane_of_k:
                    change[k % wp.static(WIDTH)] = factor
                matrix[first + i, lane] = change


@wp.kernel(enable_backward=False)
def _spread_block(
    offset: int, matrix: wp.array2d[LANE], block: int, row_count: int, first_row: int, first_lane_beside: int
):
    """Apply a factored block: from the right to rows below it, then from the left to lanes beside it."""
    t = offset + wp.tid()
    first = block * wp.static(BLOCK)
    first_lane = block * wp.static(BLOCK_LANES)
    if t < row_count:
        i = first_row + t
        for k in range(wp.static(BLOCK)):
            lane_of_k = first_lane + k // wp.static(WIDTH)
            own = matrix[i, lane_of_k]
            factor = own[k % wp.static(WIDTH)] / matrix[first + k, lane_of_k][k % wp.static(WIDTH)]
            for lane in range(lane_of_k, first_lane + wp.static(BLOCK_LANES)):
                row = matrix[first + k, lane]
                if lane == lane_of_k:
                    for c in range(wp.static(WIDTH)):
                        if c <= k % wp.static(WIDTH):
                            row[c] = wp.float64(0.0)
                change = matrix[i, lane] - factor * row
                if lane == lane_of_k:
                    change[k % wp.static(WIDTH)] = factor
                matrix[i, lane] = change
    else:
        lane = first_lane_beside + t - row_count
        for k in range(wp.static(BLOCK)):
            lane_of_k = first_lane + k // wp.static(WIDTH)
            row = matrix[first + k, lane]
            for i in range(k + 1, wp.static(BLOCK)):
                matrix[first + i, lane] -= matrix[first + i, lane_of_k][k % wp.static(WIDTH)] * row


@wp.kernel(enable_backward=False)
def _solve_block(offset: int, matrix: wp.array2d[LANE], block: int, first_lane: int):
    """Solve with the upper triangle of a factored block for the lanes of the right-hand sides."""
    lane = first_lane + offset + wp.tid()
    for reverse in range(wp.static(BLOCK)):
        k = wp.static(BLOCK) - 1 - reverse
        lane_of_k = block * wp.static(BLOCK_LANES) + k // wp.static(WIDTH)
        row = matrix[block * wp.static(BLOCK) + k, lane]
        row = row / matrix[block * wp.static(BLOCK) + k, lane_of_k][k % wp.static(WIDTH)]
        matrix[block * wp.static(BLOCK) + k, lane] = row
        for i in range(k):
            factor = matrix[block * wp.static(BLOCK) + i, lane_of_k][k % wp.static(WIDTH)]
            matrix[block * wp.static(BLOCK) + i, lane] -= factor * row


_CHUNKS = {subtract_product: 256, _spread_block: 64, _solve_block: 16}
"""Elements of each kernel that are worth a thread: some 100 us of work, twice what starting it costs."""


class System:
    """A square system of equations with several right-hand sides, solved in place by elimination without pivoting.

    That is stable for what it is meant for: single layers tested by their own densities, which are nearly symmetric and
    positive. The rows of ``matrix`` are those of the system, then identity rows up to a whole block; their lanes are
    the unknowns', then the right-hand sides'.

    Args:
        unknown_count: Number of unknowns.
        column_count: Number of right-hand sides.
        device: Where to solve.
    """

    def __init__(self, unknown_count: int, column_count: int, device: wp.context.Device) -> None:
        self.unknown_count = unknown_count
        self.column_count = column_count
        self.device = device
        self.block_count = max(1, -(-unknown_count // BLOCK))
        self.first_lane = self.block_count * BLOCK_LANES
        self.lanes = lane_count(column_count)
        rows = self.block_count * BLOCK
        self.matrix = wp.zeros((rows, self.first_lane + self.lanes), dtype=LANE, device=device)
        fill = np.zeros((rows - unknown_count, self.matrix.shape[1] * WIDTH))
        fill[np.arange(len(fill)), unknown_count + np.arange(len(fill))] = 1.0
        if len(fill):
            self.matrix[unknown_count:].assign(fill.reshape(len(fill), -1, WIDTH))

    def take_over(self, other: System, unknown_count: int) -> int:
        """Take over what another system, that is solved, has in common with this one.

        Args:
            other: The other system.
            unknown_count: Number of first unknowns whose equations are the same in both.

        Returns:
            Number of rows and columns that are there now, factored: whole blocks.
        """
        blocks = unknown_count // BLOCK
        if blocks:
            part = slice(blocks * BLOCK), slice(blocks * BLOCK_LANES)
            wp.copy(self.matrix[part], other.matrix[part])
        return blocks * BLOCK

    def solve(self, *, kept: int = 0) -> wp.array:
        """Solve the system, whose matrix is overwritten.

        Args:
            kept: Rows and columns that are factored already. What comes out has the bits that it has without any.

        Returns:
            The solutions as lanes, a row an unknown and fill rows of 0, a view of the matrix.
        """
        matrix, blocks, lanes, kept = self.matrix, self.block_count, self.matrix.shape[1], kept // BLOCK
        for block in range(blocks):
            first = max(block + 1, kept)
            rows, beside = (blocks - first) * BLOCK, lanes - first * BLOCK_LANES
            if block >= kept:
                launch(_factor_block, 1, [matrix, block], device=self.device)
            self._launch(_spread_block, rows + beside, block, rows, first * BLOCK, first * BLOCK_LANES)
            # Rows that are kept have new lanes only, new rows all of them.
            between = (first - block - 1) * BLOCK
            self._subtract(block, block + 1, between, first * BLOCK_LANES, beside)
            beside = lanes - (block + 1) * BLOCK_LANES
            self._subtract(block, first, rows, (block + 1) * BLOCK_LANES, beside)
        for block in reversed(range(blocks)):
            self._launch(_solve_block, self.lanes, block, self.first_lane)
            self._subtract(block, 0, block * BLOCK, self.first_lane, self.lanes)
        return matrix[:, self.first_lane :]

    def _subtract(self, block: int, first_block: int, rows: int, first_lane: int, lanes: int) -> None:
        count = rows // ROWS * lanes
        self._launch(subtract_product, count, block, first_block * BLOCK, first_lane, lanes)

    def _launch(self, kernel: wp.Kernel, count: int, *arguments: int) -> None:
        chunk = _CHUNKS[kernel]
        launch(kernel, count, [self.matrix, *arguments], device=self.device, smallest_chunk=chunk)
