# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Dense products, the same bit for bit on any number of threads.

Every number is computed by one thread in an order that only the sizes of the matrices decide; libraries choose theirs
by the threads that they find. Matrices are stored as rows of lanes, eight columns each; columns that only fill the last
lane are 0.
"""

from __future__ import annotations

import warp as wp

# Loops stay loops: unrolled they are no faster here, and take thirty times as long to compile.
wp.set_module_options({"enable_backward": False, "max_unroll": 0})

WIDTH = 8
"""Columns of a lane."""
LANE = wp.types.vector(length=WIDTH, dtype=wp.float64)
BLOCK_LANES = 4
BLOCK = BLOCK_LANES * WIDTH
"""Rows of a block, and the columns of its lanes."""
ROWS = 4
"""Rows that a thread works on, so that what it reads of the others serves all of them."""


def lane_count(columns: int) -> int:
    """Lanes of a row with so many columns."""
    return -(-columns // WIDTH)


@wp.kernel(enable_backward=False)
def multiply_lanes(offset: int, left: wp.array2d[LANE], right: wp.array2d[LANE], inner: int, out: wp.array2d[LANE]):
    """Add the product of two matrices to a third one; ``inner`` lanes of the left one are used."""
    t = offset + wp.tid()
    lane = t % out.shape[1]
    first = (t // out.shape[1]) * wp.static(ROWS)
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
def subtract_product(offset: int, matrix: wp.array2d[LANE], block: int, first_row: int, first_lane: int, lanes: int):
    """Take the product of a block's column of factors and its row of the matrix from a part of the matrix."""
    t = offset + wp.tid()
    lane = first_lane + t % lanes
    i = first_row + (t // lanes) * wp.static(ROWS)
    sum_0 = matrix[i, lane]
    sum_1 = matrix[i + 1, lane]
    sum_2 = matrix[i + 2, lane]
    sum_3 = matrix[i + 3, lane]
    for k in range(wp.static(BLOCK_LANES)):
        a_0 = matrix[i, block * wp.static(BLOCK_LANES) + k]
        a_1 = matrix[i + 1, block * wp.static(BLOCK_LANES) + k]
        a_2 = matrix[i + 2, block * wp.static(BLOCK_LANES) + k]
        a_3 = matrix[i + 3, block * wp.static(BLOCK_LANES) + k]
        for c in range(wp.static(WIDTH)):
            b = matrix[block * wp.static(BLOCK) + k * wp.static(WIDTH) + c, lane]
            sum_0 -= a_0[c] * b
            sum_1 -= a_1[c] * b
            sum_2 -= a_2[c] * b
            sum_3 -= a_3[c] * b
    matrix[i, lane] = sum_0
    matrix[i + 1, lane] = sum_1
    matrix[i + 2, lane] = sum_2
    matrix[i + 3, lane] = sum_3
