# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Dense products and the solution of dense systems, the same bit for bit on any number of threads.

Every number is computed by one thread in an order that only the sizes of the matrices decide; libraries choose theirs
by the threads that they find. Matrices are stored as rows of lanes, eight columns each; columns that only fill the last
lane are 0.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from ...launch import launch

wp.set_module_options({"enable_backward": False})

WIDTH = 8
"""Columns of a lane."""
LANE = wp.types.vector(length=WIDTH, dtype=wp.float64)
_BLOCK_LANES = 4
_BLOCK = _BLOCK_LANES * WIDTH
"""Unknowns that are eliminated together."""
_ROWS = 4
"""Rows that a thread works on, so that what it reads of the others serves all of them."""


def lane_count(columns: int) -> int:
    """Lanes of a row with so many columns."""
    return -(-columns // WIDTH)


@wp.kernel(enable_backward=False)
def multiply_lanes(offset: int, left: wp.array2d[LANE], right: wp.array2d[LANE], inner: int, out: wp.array2d[LANE]):
    """Add the product of two matrices to a third one; ``inner`` lanes of the left one are used."""
    t = offset + wp.tid()
    lane = t % out.shape[1]
    first = (t // out.shape[1]) * wp.static(_ROWS)
    last = out.shape[0] - 1
    row_1 = wp.min(first + 1, last)
    row_2 = wp.min(first + 2, last)
    row_3 = wp.min(first + 3, last)
    sum_0 = out[first, lane]
    sum_1 = out[row_1, lane]
    sum_2 = out[row_2, lane]
    sum_3 = out[row_3, lane]
    for k in range(inner):
        a_0 = left[first, k]
        a_1 = left[row_1, k]
        a_2 = left[row_2, k]
        a_3 = left[row_3, k]
        for c in range(wp.static(WIDTH)):
            b = right[k * wp.static(WIDTH) + c, lane]
            sum_0 += a_0[c] * b
            sum_1 += a_1[c] * b
            sum_2 += a_2[c] * b
            sum_3 += a_3[c] * b
    out[first, lane] = sum_0
    if first + 1 <= last:
        out[row_1, lane] = sum_1
    if first + 2 <= last:
        out[row_2, lane] = sum_2
    if first + 3 <= last:
        out[row_3, lane] = sum_3


@wp.kernel(enable_backward=False)
def _factor_block(offset: int, matrix: wp.array2d[LANE], block: int):
    """Factor a block on the diagonal into a lower triangle with ones on its diagonal and an upper one."""
    first = (offset + wp.tid() + block) * wp.static(_BLOCK)
    first_lane = block * wp.static(_BLOCK_LANES)
    for k in range(wp.static(_BLOCK)):
        lane_of_k = first_lane + k // wp.static(WIDTH)
        pivot = matrix[first + k, lane_of_k][k % wp.static(WIDTH)]
        for i in range(k + 1, wp.static(_BLOCK)):
            factor = matrix[first + i, lane_of_k][k % wp.static(WIDTH)] / pivot
            for lane in range(lane_of_k, first_lane + wp.static(_BLOCK_LANES)):
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
def _spread_block(offset: int, matrix: wp.array2d[LANE], block: int, row_count: int):
    """Apply a factored block: from the right to the rows below it, then from the left to the lanes beside it."""
    t = offset + wp.tid()
    first = block * wp.static(_BLOCK)
    first_lane = block * wp.static(_BLOCK_LANES)
    if t < row_count:
        i = first + wp.static(_BLOCK) + t
        for k in range(wp.static(_BLOCK)):
            lane_of_k = first_lane + k // wp.static(WIDTH)
            own = matrix[i, lane_of_k]
            factor = own[k % wp.static(WIDTH)] / matrix[first + k, lane_of_k][k % wp.static(WIDTH)]
            for lane in range(lane_of_k, first_lane + wp.static(_BLOCK_LANES)):
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
        lane = first_lane + wp.static(_BLOCK_LANES) + t - row_count
        for k in range(wp.static(_BLOCK)):
            lane_of_k = first_lane + k // wp.static(WIDTH)
            row = matrix[first + k, lane]
            for i in range(k + 1, wp.static(_BLOCK)):
                matrix[first + i, lane] -= matrix[first + i, lane_of_k][k % wp.static(WIDTH)] * row


@wp.kernel(enable_backward=False)
def _subtract_product(offset: int, matrix: wp.array2d[LANE], block: int, first_row: int, first_lane: int, lanes: int):
    """Take the product of a block's column of factors and its row of the matrix from a part of the matrix."""
    t = offset + wp.tid()
    lane = first_lane + t % lanes
    i = first_row + (t // lanes) * wp.static(_ROWS)
    sum_0 = matrix[i, lane]
    sum_1 = matrix[i + 1, lane]
    sum_2 = matrix[i + 2, lane]
    sum_3 = matrix[i + 3, lane]
    for k in range(wp.static(_BLOCK_LANES)):
        a_0 = matrix[i, block * wp.static(_BLOCK_LANES) + k]
        a_1 = matrix[i + 1, block * wp.static(_BLOCK_LANES) + k]
        a_2 = matrix[i + 2, block * wp.static(_BLOCK_LANES) + k]
        a_3 = matrix[i + 3, block * wp.static(_BLOCK_LANES) + k]
        for c in range(wp.static(WIDTH)):
            b = matrix[block * wp.static(_BLOCK) + k * wp.static(WIDTH) + c, lane]
            sum_0 -= a_0[c] * b
            sum_1 -= a_1[c] * b
            sum_2 -= a_2[c] * b
            sum_3 -= a_3[c] * b
    matrix[i, lane] = sum_0
    matrix[i + 1, lane] = sum_1
    matrix[i + 2, lane] = sum_2
    matrix[i + 3, lane] = sum_3


@wp.kernel(enable_backward=False)
def _solve_block(offset: int, matrix: wp.array2d[LANE], block: int, first_lane: int):
    """Solve with the upper triangle of a factored block for the lanes of the right-hand sides."""
    lane = first_lane + offset + wp.tid()
    for reverse in range(wp.static(_BLOCK)):
        k = wp.static(_BLOCK) - 1 - reverse
        lane_of_k = block * wp.static(_BLOCK_LANES) + k // wp.static(WIDTH)
        row = matrix[block * wp.static(_BLOCK) + k, lane]
        row = row / matrix[block * wp.static(_BLOCK) + k, lane_of_k][k % wp.static(WIDTH)]
        matrix[block * wp.static(_BLOCK) + k, lane] = row
        for i in range(k):
            factor = matrix[block * wp.static(_BLOCK) + i, lane_of_k][k % wp.static(WIDTH)]
            matrix[block * wp.static(_BLOCK) + i, lane] -= factor * row


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
        self.block_count = max(1, -(-unknown_count // _BLOCK))
        self.first_lane = self.block_count * _BLOCK_LANES
        self.lanes = lane_count(column_count)
        rows = self.block_count * _BLOCK
        self.matrix = wp.zeros((rows, self.first_lane + self.lanes), dtype=LANE, device=device)
        fill = np.zeros((rows - unknown_count, self.matrix.shape[1] * WIDTH))
        fill[np.arange(len(fill)), unknown_count + np.arange(len(fill))] = 1.0
        if len(fill):
            self.matrix[unknown_count:].assign(fill.reshape(len(fill), -1, WIDTH))

    def solve(self) -> wp.array:
        """Solve the system, whose matrix is overwritten.

        Returns:
            The solutions as lanes, a row an unknown and fill rows of 0, a view of the matrix.
        """
        matrix, blocks, lanes = self.matrix, self.block_count, self.matrix.shape[1]
        for block in range(blocks):
            launch(_factor_block, 1, [matrix, block], device=self.device)
            rows = (blocks - 1 - block) * _BLOCK
            beside = lanes - (block + 1) * _BLOCK_LANES
            self._launch(_spread_block, rows + beside, block, rows)
            size = (block + 1) * _BLOCK, (block + 1) * _BLOCK_LANES, beside
            self._launch(_subtract_product, rows // _ROWS * beside, block, *size)
        for block in reversed(range(blocks)):
            self._launch(_solve_block, self.lanes, block, self.first_lane)
            count = block * _BLOCK // _ROWS * self.lanes
            self._launch(_subtract_product, count, block, 0, self.first_lane, self.lanes)
        return matrix[:, self.first_lane :]

    def _launch(self, kernel: wp.Kernel, count: int, *arguments: int) -> None:
        launch(kernel, count, [self.matrix, *arguments], device=self.device, smallest_chunk=16)
