# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Many small systems of equations at once, a thread each; ``solve`` has large ones, whose parts are shared out."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...launch import launch
from .products import LANE, WIDTH, lane_count

wp.set_module_options({"enable_backward": False, "max_unroll": 0})


@wp.kernel(enable_backward=False)
def _eliminate(
    offset: int, first: wp.array[wp.int32], columns: wp.array[wp.int32], right: int, matrix: wp.array2d[LANE]
):
    """Solve systems in place without pivoting; right-hand sides are the lanes from ``right`` on."""
    s = offset + wp.tid()
    start = first[s]
    count = first[s + 1] - start
    lanes = (columns[s] + WIDTH - 1) // WIDTH
    for k in range(count):
        lane_of_k = k // WIDTH
        pivot = matrix[start + k, lane_of_k][k % WIDTH]
        for i in range(k + 1, count):
            factor = matrix[start + i, lane_of_k][k % WIDTH] / pivot
            for lane in range(lane_of_k, lanes):
                matrix[start + i, lane] = matrix[start + i, lane] - factor * matrix[start + k, lane]
            for lane in range(right, matrix.shape[1]):
                matrix[start + i, lane] = matrix[start + i, lane] - factor * matrix[start + k, lane]
    for reverse in range(count):
        k = count - 1 - reverse
        lane_of_k = k // WIDTH
        pivot = matrix[start + k, lane_of_k][k % WIDTH]
        for lane in range(right, matrix.shape[1]):
            matrix[start + k, lane] = matrix[start + k, lane] / pivot
            for i in range(k):
                factor = matrix[start + i, lane_of_k][k % WIDTH]
                matrix[start + i, lane] = matrix[start + i, lane] - factor * matrix[start + k, lane]


def solve_each(
    matrices: list[np.ndarray], right_sides: list[np.ndarray], device: wp.context.Device
) -> list[np.ndarray]:
    """Solve systems that need no pivoting.

    Args:
        matrices: Their matrices, shape (n, n) each.
        right_sides: Their right-hand sides, shape (n, m) each.
        device: Where to solve them.

    Returns:
        Their solutions, shape (n, m) each.
    """
    counts = np.array([len(matrix) for matrix in matrices])
    first = np.cumsum([0, *counts])
    right = lane_count(int(counts.max()))
    width = right + lane_count(max(side.shape[1] for side in right_sides))
    rows = np.zeros((first[-1], width * WIDTH))
    for at, matrix, side in zip(first, matrices, right_sides):
        own = rows[at : at + len(matrix)]
        own[:, : len(matrix)], own[:, right * WIDTH : right * WIDTH + side.shape[1]] = matrix, side
    solved = wp.array(rows.reshape(len(rows), width, WIDTH), dtype=LANE, device=device)
    starts, columns = (wp.array(part.astype(np.int32), dtype=wp.int32, device=device) for part in (first, counts))
    launch(_eliminate, len(matrices), [starts, columns, right, solved], device=device, smallest_chunk=1)
    found = solved.numpy().reshape(len(rows), -1)[:, right * WIDTH :]
    return [found[at : at + len(side), : side.shape[1]] for at, side in zip(first, right_sides)]
