# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Dense products, the same bit for bit on any number of threads.

Every number is computed by one thread in an order that only the sizes of the matrices decide; libraries choose theirs
by the threads that they find. Matrices are stored as rows of lanes, eight columns each; columns that only fill the last
lane are 0.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from ...launch import launch
from .spans import SPAN, Span

# Loops stay loops: unrolled they are no faster here, and take thirty times as long to compile.
wp.set_module_options({"enable_backward": False, "max_unroll": 0})

WIDTH = 8
"""Columns of a lane."""
LANE = wp.types.vector(length=WIDTH, dtype=wp.float64)
BLOCK_LANES = 8
BLOCK = BLOCK_LANES * WIDTH
"""Rows of a block, and the columns of its lanes."""
ROWS = 4
"""Rows or columns that a thread works on, so that what it reads of the others serves all of them."""


def lane_count(columns: int) -> int:
    """Lanes of a row with so many columns."""
    return -(-columns // WIDTH)


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


@wp.kernel(enable_backward=False)
def _multiply_spans(
    offset: int,
    jobs: wp.array[wp.vec3i],
    left: wp.array2d[Span],
    columns: wp.array[wp.int32],
    right: wp.array2d[float],
    out: wp.array2d[Span],
):
    """Products of rows of spans and a matrix, a thread some columns of a job: its row, and its range of the columns."""
    t = offset + wp.tid()
    quads = out.shape[1] // wp.static(ROWS)
    i = t // quads
    j = (t % quads) * wp.static(ROWS)
    job = jobs[i]
    sum_0 = Span()
    sum_1 = Span()
    sum_2 = Span()
    sum_3 = Span()
    for k in range(job[1], job[2]):
        a = left[job[0], columns[k]]
        sum_0 += right[k, j] * a
        sum_1 += right[k, j + 1] * a
        sum_2 += right[k, j + 2] * a
        sum_3 += right[k, j + 3] * a
    out[i, j] = sum_0
    out[i, j + 1] = sum_1
    out[i, j + 2] = sum_2
    out[i, j + 3] = sum_3


def multiply_spans(jobs: np.ndarray, left: wp.array, columns: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Products of rows of spans and a matrix.

    Args:
        jobs: For each product a row of ``left``, and the first and the end of its columns, shape (job_count, 3).
        left: The spans.
        columns: Columns of ``left``, in the order in which they are summed.
        right: What each of these counts, shape (column_count, function_count).

    Returns:
        Products, a row a point, shape (job_count * 16, function_count), float32.
    """
    device, count = left.device, right.shape[1]
    filled = np.zeros((len(right), -(-count // ROWS) * ROWS), dtype=np.float32)
    filled[:, :count] = right
    out = wp.empty((len(jobs), filled.shape[1]), dtype=Span, device=device)
    inputs = [
        wp.array(np.ascontiguousarray(jobs, dtype=np.int32), dtype=wp.vec3i, device=device),
        left,
        wp.array(np.asarray(columns, dtype=np.int32), dtype=wp.int32, device=device),
        wp.array(filled, dtype=float, device=device),
        out,
    ]
    launch(_multiply_spans, len(jobs) * (filled.shape[1] // ROWS), inputs, device=device, smallest_chunk=16)
    return out.numpy().swapaxes(1, 2).reshape(len(jobs) * SPAN, -1)[:, :count]
