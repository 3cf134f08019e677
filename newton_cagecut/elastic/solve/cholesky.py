# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cholesky's factor of a dense matrix, and solves with it, by one thread block; on a CPU by one thread with lanes.

The matrix is taken in blocks of eight rows, from the top: what rows above take from a block, the factor of the
diagonal's 8x8 block, and the rest of the rows. The factor is float32, which is as good as the matrix is; it conditions
an iteration, and does not have to be exact. Where rounding leaves a pivot that is not positive, the matrix's own
diagonal takes its place: the factor stays that of a positive definite matrix.
"""

import functools

import warp as wp

from .lanes import lane_type
from .stiffness_matrix import DenseMatrix

wp.set_module_options({"enable_backward": False})

BLOCK = 8
"""Rows of a block, which all widths of lanes divide."""
_SMALL = wp.constant(1.0e-6)
"""Share of the diagonal below which a pivot is rounding."""


@wp.func
def wait():
    """Let the threads of the block wait for each other."""
    wp.tile_sum(wp.tile(float(0.0)))


@wp.func
def pad_matrix(thread: int, used: int, matrix: DenseMatrix):
    """Rows of the identity up to a full block."""
    for r in range(used, (used + 7) / 8 * 8):
        for c in range(thread, r + 1, wp.block_dim()):
            value = wp.where(r == c, 1.0, 0.0)
            matrix.values[r, c] = value
            matrix.values[c, r] = value
        matrix.diagonal[r] = 1.0


@wp.func
def factor_pivot(first: int, matrix: DenseMatrix):
    """Factor one 8x8 block of the diagonal in place."""
    for r in range(first, first + 8):
        pivot = matrix.values[r, r]
        for p in range(first, r):
            pivot -= matrix.values[p, r] * matrix.values[p, r]
        if not (pivot > _SMALL * matrix.diagonal[r]):
            pivot = matrix.diagonal[r]
        root = wp.sqrt(pivot)
        matrix.values[r, r] = root
        for c in range(r + 1, first + 8):
            value = matrix.values[r, c]
            for p in range(first, r):
                value -= matrix.values[p, r] * matrix.values[p, c]
            matrix.values[r, c] = value / root
            matrix.values[c, r] = value / root


@functools.cache
def make_factor_kernel(width: int) -> wp.Kernel:
    """The kernel that replaces a matrix by its factor; one thread block."""
    lane = lane_type(width)
    per_block = BLOCK // width

    @wp.kernel(enable_backward=False, module="unique")
    def factor_matrix(row_count: wp.array(dtype=int), matrix: DenseMatrix, lanes: wp.array2d(dtype=lane)):
        thread = wp.tid()
        if matrix.stale[0] == 0:
            return
        used = 3 * row_count[0]
        pad_matrix(thread, used, matrix)
        wait()
        blocks = (used + 7) / 8
        columns = blocks * wp.static(per_block)
        for block in range(blocks):
            first = 8 * block
            for column in range(wp.static(per_block) * block + thread, columns, wp.block_dim()):
                r0 = lane(lanes[first + 0, column])
                r1 = lane(lanes[first + 1, column])
                r2 = lane(lanes[first + 2, column])
                r3 = lane(lanes[first + 3, column])
                r4 = lane(lanes[first + 4, column])
                r5 = lane(lanes[first + 5, column])
                r6 = lane(lanes[first + 6, column])
                r7 = lane(lanes[first + 7, column])
                for p in range(first):
                    x = lanes[p, column]
                    r0 -= matrix.values[p, first] * x
                    r1 -= matrix.values[p, first + 1] * x
                    r2 -= matrix.values[p, first + 2] * x
                    r3 -= matrix.values[p, first + 3] * x
                    r4 -= matrix.values[p, first + 4] * x
                    r5 -= matrix.values[p, first + 5] * x
                    r6 -= matrix.values[p, first + 6] * x
                    r7 -= matrix.values[p, first + 7] * x
                lanes[first + 0, column] = r0
                lanes[first + 1, column] = r1
                lanes[first + 2, column] = r2
                lanes[first + 3, column] = r3
                lanes[first + 4, column] = r4
                lanes[first + 5, column] = r5
                lanes[first + 6, column] = r6
                lanes[first + 7, column] = r7
            wait()
            if thread == 0:
                factor_pivot(first, matrix)
            wait()
            for column in range(wp.static(per_block) * (block + 1) + thread, columns, wp.block_dim()):
                for r in range(first, first + 8):
                    row = lanes[r, column]
                    for p in range(first, r):
                        row -= matrix.values[p, r] * lanes[p, column]
                    row = row / matrix.values[r, r]
                    lanes[r, column] = row
                    for s in range(wp.static(width)):
                        matrix.values[wp.static(width) * column + s, r] = row[s]
            wait()
        if thread == 0:
            matrix.stale[0] = 0

    return factor_matrix


@functools.cache
def make_factor_solve(width: int) -> wp.Function:
    """The function that solves with the factor; all threads of the block call it.

    ``rows`` holds the right-hand side in use, then scratch; ``solution`` the solution.
    """
    lane = lane_type(width)
    per_block = BLOCK // width

    @wp.func
    def factor_solve(
        thread: int,
        used: int,
        matrix: DenseMatrix,
        lanes: wp.array2d(dtype=lane),
        rows: wp.array(dtype=float),
        row_lanes: wp.array(dtype=lane),
        solution: wp.array(dtype=float),
    ):
        blocks = (used + 7) / 8
        columns = blocks * wp.static(per_block)
        for block in range(blocks):
            first = 8 * block
            if thread == 0:
                for r in range(first, first + 8):
                    value = rows[r]
                    for p in range(first, r):
                        value -= matrix.values[p, r] * rows[p]
                    rows[r] = value / matrix.values[r, r]
            wait()
            for column in range(wp.static(per_block) * (block + 1) + thread, columns, wp.block_dim()):
                total = row_lanes[column]
                for r in range(first, first + 8):
                    total -= rows[r] * lanes[r, column]
                row_lanes[column] = total
            wait()
        for step in range(blocks):
            block = blocks - 1 - step
            first = 8 * block
            if thread == 0:
                for back in range(8):
                    r = first + 7 - back
                    value = rows[r]
                    for p in range(r + 1, first + 8):
                        value -= matrix.values[r, p] * solution[p]
                    solution[r] = value / matrix.values[r, r]
            wait()
            for column in range(thread, wp.static(per_block) * block, wp.block_dim()):
                total = row_lanes[column]
                for r in range(first, first + 8):
                    total -= solution[r] * lanes[r, column]
                row_lanes[column] = total
            wait()

    return factor_solve
