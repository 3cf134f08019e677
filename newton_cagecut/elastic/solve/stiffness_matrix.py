# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The matrix of a step's system, assembled: of the quadrature points' stiffness, mass, ties and forces on points.

Row 3 i + a belongs to component a of vertex i. Rows of fixed vertices, and those that fill up the last block, are the
identity's.
"""

import functools

import warp as wp

from ..arrays import ELASTIC_STIFFNESS, BodyArrays, StepArrays
from .lanes import lane_type
from .point_forces import PointForces, Symmetric, slot_weight, unpacked

wp.set_module_options({"enable_backward": False})

ROWS = wp.constant(8)
"""Vertices whose rows one thread assembles."""


@wp.struct
class DenseMatrix:
    """A matrix, later its factor: U of U^T U on and above the diagonal, U^T below."""

    values: wp.array2d[float]
    """The matrix, shape (row_capacity, row_capacity)."""
    diagonal: wp.array[float]
    """Its diagonal, one a row."""
    stale: wp.array[int]
    """Whether it has to be made anew, shape (1,)."""


def make_dense_matrix(row_count: int, device: wp.Device) -> DenseMatrix:
    """Room for a matrix."""
    matrix = DenseMatrix()
    with wp.ScopedDevice(device):
        matrix.values = wp.zeros((row_count, row_count), dtype=float)
        matrix.diagonal = wp.zeros(row_count, dtype=float)
        matrix.stale = wp.zeros(1, dtype=int)
    return matrix


@wp.func
def put_entry(i: int, j: int, a: int, b: int, elastic: float, body: BodyArrays, step: StepArrays, matrix: DenseMatrix):
    """Write an entry and its mirror image, given the quadrature's part."""
    if j <= i and i < body.vertex_count[0] and (i != j or a <= b):
        value = elastic
        if a == b:
            ties = body.material[0][0] * step.scales[ELASTIC_STIFFNESS] * wp.float64(body.stabilizing_stiffness[i, j])
            value += body.mass[i, j] + float(ties)
        if body.fixed[i] != 0 or body.fixed[j] != 0:
            value = wp.where(i == j and a == b, 1.0, 0.0)
        matrix.values[3 * i + a, 3 * j + b] = value
        matrix.values[3 * j + b, 3 * i + a] = value
        if i == j and a == b:
            matrix.diagonal[3 * i + a] = value


@functools.cache
def make_column_kernel(width: int) -> wp.Kernel:
    """The kernel that lays the gradients out with vertices in lanes, after an edit; a thread a point and block."""
    lane = lane_type(width)

    @wp.kernel(enable_backward=False, module="unique")
    def pack_columns(body: BodyArrays, columns: wp.array3d(dtype=lane)):
        q, block = wp.tid()
        x, y, z = lane(), lane(), lane()
        for s in range(wp.static(width)):
            j = wp.static(width) * block + s
            if j < body.vertex_count[0]:
                gradient = body.gradients[q, j]
                x[s] = gradient[0]
                y[s] = gradient[1]
                z[s] = gradient[2]
        columns[q, 0, block] = x
        columns[q, 1, block] = y
        columns[q, 2, block] = z

    return pack_columns


@functools.cache
def make_assembly_kernel(width: int) -> wp.Kernel:
    """The kernel that assembles all but the forces on points.

    A thread has the rows of eight vertices, the columns of a lane vector and one pair of components.
    """
    lane = lane_type(width)

    @wp.func
    def put_row(i: int, block: int, a: int, b: int, row: lane, body: BodyArrays, step: StepArrays, matrix: DenseMatrix):
        for s in range(wp.static(width)):
            put_entry(i, wp.static(width) * block + s, a, b, row[s], body, step, matrix)

    @wp.kernel(enable_backward=False, module="unique")
    def assemble_matrix(
        body: BodyArrays,
        step: StepArrays,
        columns: wp.array3d(dtype=lane),
        rows: wp.array3d(dtype=float),
        matrix: DenseMatrix,
    ):
        tile, block, pair = wp.tid()
        i = ROWS * tile
        if matrix.stale[0] == 0 or i >= body.vertex_count[0] or wp.static(width) * block >= i + ROWS:
            return
        r0, r1, r2, r3 = lane(), lane(), lane(), lane()
        r4, r5, r6, r7 = lane(), lane(), lane(), lane()
        for q in range(body.volumes.shape[0]):
            if body.volumes[q] != 0.0:
                x, y, z = lane(columns[q, 0, block]), lane(columns[q, 1, block]), lane(columns[q, 2, block])
                K = step.blocks[q, pair]
                for c in range(3):
                    t = K[c, 0] * x + K[c, 1] * y + K[c, 2] * z
                    r0 += rows[q, c, i] * t
                    r1 += rows[q, c, i + 1] * t
                    r2 += rows[q, c, i + 2] * t
                    r3 += rows[q, c, i + 3] * t
                    r4 += rows[q, c, i + 4] * t
                    r5 += rows[q, c, i + 5] * t
                    r6 += rows[q, c, i + 6] * t
                    r7 += rows[q, c, i + 7] * t
        a, b = pair / 3, pair % 3
        put_row(i, block, a, b, r0, body, step, matrix)
        put_row(i + 1, block, a, b, r1, body, step, matrix)
        put_row(i + 2, block, a, b, r2, body, step, matrix)
        put_row(i + 3, block, a, b, r3, body, step, matrix)
        put_row(i + 4, block, a, b, r4, body, step, matrix)
        put_row(i + 5, block, a, b, r5, body, step, matrix)
        put_row(i + 6, block, a, b, r6, body, step, matrix)
        put_row(i + 7, block, a, b, r7, body, step, matrix)

    return assemble_matrix


@wp.kernel(enable_backward=False)
def add_points(body: BodyArrays, points: PointForces, matrix: DenseMatrix):
    """Add the forces on points to the matrix; a thread a vertex and eight others."""
    i, block = wp.tid()
    j = 8 * block
    count = body.vertex_count[0]
    if matrix.stale[0] == 0 or i >= count or j > i or points.count[0] == 0:
        return
    if body.fixed[i] != 0:
        return
    b0, b1, b2, b3 = Symmetric(), Symmetric(), Symmetric(), Symmetric()
    b4, b5, b6, b7 = Symmetric(), Symmetric(), Symmetric(), Symmetric()
    last = points.weights.shape[1] - 1
    j1, j2, j3, j4 = wp.min(j + 1, last), wp.min(j + 2, last), wp.min(j + 3, last), wp.min(j + 4, last)
    j5, j6, j7 = wp.min(j + 5, last), wp.min(j + 6, last), wp.min(j + 7, last)
    for slot in range(points.count[0]):
        own = slot_weight(slot, i, points)
        if own != 0.0:
            S = own * points.system[slot]
            b0 += slot_weight(slot, j, points) * S
            b1 += slot_weight(slot, j1, points) * S
            b2 += slot_weight(slot, j2, points) * S
            b3 += slot_weight(slot, j3, points) * S
            b4 += slot_weight(slot, j4, points) * S
            b5 += slot_weight(slot, j5, points) * S
            b6 += slot_weight(slot, j6, points) * S
            b7 += slot_weight(slot, j7, points) * S
    add_block(i, j, b0, body, matrix)
    add_block(i, j + 1, b1, body, matrix)
    add_block(i, j + 2, b2, body, matrix)
    add_block(i, j + 3, b3, body, matrix)
    add_block(i, j + 4, b4, body, matrix)
    add_block(i, j + 5, b5, body, matrix)
    add_block(i, j + 6, b6, body, matrix)
    add_block(i, j + 7, b7, body, matrix)


@wp.func
def add_block(i: int, j: int, symmetric: Symmetric, body: BodyArrays, matrix: DenseMatrix):
    """Add a block and its mirror image, unless it is above the diagonal or of a fixed vertex."""
    if j > i or body.fixed[j] != 0:
        return
    block = unpacked(symmetric)
    for a in range(3):
        for b in range(3):
            r, c = 3 * i + a, 3 * j + b
            value = matrix.values[r, c] + block[a, b]
            matrix.values[r, c] = value
            if i != j:
                matrix.values[c, r] = value
        if i == j:
            matrix.diagonal[3 * i + a] = matrix.values[3 * i + a, 3 * i + a]
