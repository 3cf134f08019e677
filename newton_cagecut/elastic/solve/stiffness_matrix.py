# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The matrix of a step's system, assembled: of the quadrature points' stiffness, mass, ties and forces on points.

Row 3 i + a belongs to component a of vertex i. Rows of fixed vertices, and those that fill up the last block, are the
identity's.
"""

import functools

import warp as wp

from ..arrays import ELASTIC_STIFFNESS, BodyArrays, StepArrays
from .lanes import entry, lane_struct, lane_type, make_lane_sum
from .point_forces import PointForces

wp.set_module_options({"enable_backward": False})

ROWS = wp.constant(4)
"""Vertices whose rows one thread assembles."""
COLUMNS = wp.constant(16)
"""Vertices whose columns it assembles."""


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
def make_assembly_kernel(width: int) -> wp.Kernel:
    """The kernel that assembles all but the forces on points; a thread a few rows, columns and one component."""
    lane, Lanes = lane_type(width), lane_struct(width)
    lane_sum = make_lane_sum(width)

    @wp.kernel(enable_backward=False, module="unique")
    def assemble_matrix(body: BodyArrays, step: StepArrays, lanes: Lanes, matrix: DenseMatrix):
        rows, columns, b = wp.tid()
        i = ROWS * rows
        count = body.vertex_count[0]
        if matrix.stale[0] == 0 or i >= count:
            return
        for j in range(COLUMNS * columns, wp.min(wp.min(COLUMNS * (columns + 1), count), i + ROWS)):
            x0, y0, z0 = lane(), lane(), lane()
            x1, y1, z1 = lane(), lane(), lane()
            x2, y2, z2 = lane(), lane(), lane()
            x3, y3, z3 = lane(), lane(), lane()
            second, third, fourth = wp.min(i + 1, count - 1), wp.min(i + 2, count - 1), wp.min(i + 3, count - 1)
            for k in range(lanes.tensions.shape[1]):
                gx, gy, gz = lanes.gradients[j, 0, k], lanes.gradients[j, 1, k], lanes.gradients[j, 2, k]
                for c in range(3):
                    u0, u1 = lane(lanes.gradients[i, c, k]), lane(lanes.gradients[second, c, k])
                    u2, u3 = lane(lanes.gradients[third, c, k]), lane(lanes.gradients[fourth, c, k])
                    t = wp.cw_mul(lanes.stiffness[entry(c, 3 * b), k], gx)
                    t += wp.cw_mul(lanes.stiffness[entry(c, 3 * b + 1), k], gy)
                    t += wp.cw_mul(lanes.stiffness[entry(c, 3 * b + 2), k], gz)
                    x0 += wp.cw_mul(u0, t)
                    x1 += wp.cw_mul(u1, t)
                    x2 += wp.cw_mul(u2, t)
                    x3 += wp.cw_mul(u3, t)
                    t = wp.cw_mul(lanes.stiffness[entry(3 + c, 3 * b), k], gx)
                    t += wp.cw_mul(lanes.stiffness[entry(3 + c, 3 * b + 1), k], gy)
                    t += wp.cw_mul(lanes.stiffness[entry(3 + c, 3 * b + 2), k], gz)
                    y0 += wp.cw_mul(u0, t)
                    y1 += wp.cw_mul(u1, t)
                    y2 += wp.cw_mul(u2, t)
                    y3 += wp.cw_mul(u3, t)
                    t = wp.cw_mul(lanes.stiffness[entry(6 + c, 3 * b), k], gx)
                    t += wp.cw_mul(lanes.stiffness[entry(6 + c, 3 * b + 1), k], gy)
                    t += wp.cw_mul(lanes.stiffness[entry(6 + c, 3 * b + 2), k], gz)
                    z0 += wp.cw_mul(u0, t)
                    z1 += wp.cw_mul(u1, t)
                    z2 += wp.cw_mul(u2, t)
                    z3 += wp.cw_mul(u3, t)
            put_entry(i, j, 0, b, lane_sum(x0), body, step, matrix)
            put_entry(i, j, 1, b, lane_sum(y0), body, step, matrix)
            put_entry(i, j, 2, b, lane_sum(z0), body, step, matrix)
            put_entry(i + 1, j, 0, b, lane_sum(x1), body, step, matrix)
            put_entry(i + 1, j, 1, b, lane_sum(y1), body, step, matrix)
            put_entry(i + 1, j, 2, b, lane_sum(z1), body, step, matrix)
            put_entry(i + 2, j, 0, b, lane_sum(x2), body, step, matrix)
            put_entry(i + 2, j, 1, b, lane_sum(y2), body, step, matrix)
            put_entry(i + 2, j, 2, b, lane_sum(z2), body, step, matrix)
            put_entry(i + 3, j, 0, b, lane_sum(x3), body, step, matrix)
            put_entry(i + 3, j, 1, b, lane_sum(y3), body, step, matrix)
            put_entry(i + 3, j, 2, b, lane_sum(z3), body, step, matrix)

    return assemble_matrix


@functools.cache
def make_point_kernel(width: int) -> wp.Kernel:
    """The kernel that adds the forces on points to the matrix; a thread a vertex and a block of others."""
    lane = lane_type(width)

    @wp.kernel(enable_backward=False, module="unique")
    def add_points(body: BodyArrays, points: PointForces, matrix: DenseMatrix):
        i, block = wp.tid()
        start = wp.static(width) * block
        if matrix.stale[0] == 0 or i >= body.vertex_count[0] or start > i or points.count[0] == 0:
            return
        if body.fixed[i] != 0:
            return
        xx, yy, zz = lane(), lane(), lane()
        xy, yz, zx = lane(), lane(), lane()
        columns = points.weights.shape[1]
        for slot in range(points.count[0]):
            row = points.first_row + points.touched[slot]
            own = points.weights[row, i]
            if own != 0.0:
                weight = lane()
                for s in range(wp.static(width)):
                    if start + s < columns:
                        weight[s] = points.weights[row, start + s]
                weight = own * weight
                S = points.system[slot]
                xx += S[0, 0] * weight
                yy += S[1, 1] * weight
                zz += S[2, 2] * weight
                xy += S[0, 1] * weight
                yz += S[1, 2] * weight
                zx += S[2, 0] * weight
        for s in range(wp.static(width)):
            j = start + s
            if j <= i:
                if body.fixed[j] == 0:
                    add_block(i, j, xx[s], yy[s], zz[s], xy[s], yz[s], zx[s], matrix)

    return add_points


@wp.func
def add_block(i: int, j: int, xx: float, yy: float, zz: float, xy: float, yz: float, zx: float, matrix: DenseMatrix):
    """Add a symmetric 3x3 block and its mirror image."""
    block = wp.mat33(xx, xy, zx, xy, yy, yz, zx, yz, zz)
    for a in range(3):
        for b in range(3):
            r, c = 3 * i + a, 3 * j + b
            value = matrix.values[r, c] + block[a, b]
            matrix.values[r, c] = value
            if i != j:
                matrix.values[c, r] = value
        if i == j:
            matrix.diagonal[3 * i + a] = matrix.values[3 * i + a, 3 * i + a]
