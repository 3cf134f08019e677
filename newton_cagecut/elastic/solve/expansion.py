# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The points' stiffness written out as symmetric 9x9 matrices, and the 3x3 blocks that vertices take from it."""

import functools

import warp as wp

from ..arrays import ELASTIC_STIFFNESS, BodyArrays, LinearSystem, StepArrays
from ..stiffness import Stiffness
from .lanes import entry, lane_struct, lane_type, make_lane_sum
from .point_forces import PointForces, slot_weight, unpacked

wp.set_module_options({"enable_backward": False})

Matrix9 = wp.types.matrix(shape=(9, 9), dtype=wp.float32)


@wp.func
def expanded(stiffness: Stiffness) -> Matrix9:
    """A point's stiffness as a matrix: E T E^T, where column 3 i + j of E is left_i (x) right_j."""
    E, T = Matrix9(), Matrix9()
    for i in range(3):
        for j in range(3):
            for a in range(3):
                for c in range(3):
                    E[3 * a + c, 3 * i + j] = stiffness.left[a, i] * stiffness.right[c, j]
            T[4 * i, 4 * j] = stiffness.stretch[i, j]
            if i != j:
                k = 3 - i - j
                T[3 * i + j, 3 * i + j] = stiffness.straight[k]
                T[3 * i + j, 3 * j + i] = stiffness.crossed[k]
    return E * T * wp.transpose(E)


@wp.kernel(enable_backward=False)
def expand_stiffness(step: StepArrays):
    """Write the points' stiffness out."""
    q = wp.tid()
    K = expanded(step.stiffnesses[q])
    for m in range(9):
        for n in range(m, 9):
            step.moduli[entry(m, n), q] = K[m, n]
    if step.blocks.shape[0] > 0:
        for a in range(3):
            for b in range(3):
                block = wp.mat33()
                for c in range(3):
                    for d in range(3):
                        block[c, d] = K[3 * a + c, 3 * b + d]
                step.blocks[q, 3 * a + b] = block


@functools.cache
def make_block_kernel(width: int) -> wp.Kernel:
    """The kernel that finds the matrix's diagonal blocks; one thread a vertex."""
    lane, Lanes = lane_type(width), lane_struct(width)
    lane_sum = make_lane_sum(width)

    @wp.kernel(enable_backward=False, module="unique")
    def find_blocks(body: BodyArrays, step: StepArrays, system: LinearSystem, points: PointForces, lanes: Lanes):
        i = wp.tid()
        if i >= body.vertex_count[0]:
            return
        ties = body.material[0][0] * step.scales[ELASTIC_STIFFNESS] * wp.float64(body.stabilizing_stiffness[i, i])
        block = (body.mass[i, i] + float(ties)) * wp.identity(3, dtype=float)
        for a in range(3):
            for b in range(3):
                total = lane()
                for k in range(lanes.tensions.shape[1]):
                    for c in range(3):
                        for d in range(3):
                            gradient = wp.cw_mul(lanes.gradients[i, c, k], lanes.gradients[i, d, k])
                            total += wp.cw_mul(lanes.stiffness[entry(3 * a + c, 3 * b + d), k], gradient)
                block[a, b] = block[a, b] + lane_sum(total)
        for slot in range(points.count[0]):
            weight = slot_weight(slot, i, points)
            block += (weight * weight) * unpacked(points.system[slot])
        system.blocks[i] = block

    return find_blocks
