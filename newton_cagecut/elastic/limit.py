# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels that end a step: new velocities and positions, with a limit on the change of strain in one step.

A single Newton step from an inverted state can overshoot by orders of magnitude, since negative stiffness is projected
away and only the mass holds back. The linearisation says nothing beyond a change of F of about one, so a step that goes
further is cut to that size by scaling the velocities relative to their mean. This takes energy out, and keeps the
linear momentum of a free body. Ordinary steps are left as they are, to the bit.
"""

from __future__ import annotations

import warp as wp

from .arrays import TIME_STEP, BodyArrays, LinearSystem, StepArrays, matrix_of
from .stages.step_record import StepRecord

wp.set_module_options({"enable_backward": False})

GREATEST_CHANGE = wp.constant(1.0)
"""Greatest change of F in one step (Frobenius norm)."""


@wp.kernel(enable_backward=False)
def find_velocities(velocities: wp.array[wp.vec3], step: StepArrays, system: LinearSystem):
    """Velocities after the solve."""
    i = wp.tid()
    step.predicted[i] = velocities[i] + system.solution[i]


@wp.kernel(enable_backward=False)
def find_rates(step: StepArrays):
    """Size of the change of F at each quadrature point in this step."""
    q = wp.tid()
    change = matrix_of(step.drift, q)
    step.rates[q] = float(step.scales[TIME_STEP]) * wp.sqrt(wp.ddot(change, change))


@wp.kernel(enable_backward=False)
def find_limit(body: BodyArrays, step: StepArrays, record: StepRecord):
    """Mean velocity, and the factor on velocities relative to it that keeps changes of F small; one thread block."""
    thread = wp.tid()
    greatest_part = float(0.0)
    for q in range(thread, step.rates.shape[0], wp.block_dim()):
        greatest_part = wp.max(greatest_part, step.rates[q])
    momentum_part = wp.vec4()
    for i in range(thread, body.vertex_count[0], wp.block_dim()):
        v, m = step.predicted[i], body.vertex_mass[i]
        momentum_part += wp.vec4(m * v[0], m * v[1], m * v[2], m)
    greatest = wp.tile_max(wp.tile(greatest_part))[0]
    momentum = wp.tile_sum(wp.tile(momentum_part, preserve_type=True))[0]
    if thread == 0:
        factor = float(1.0)
        if greatest > GREATEST_CHANGE:
            factor = GREATEST_CHANGE / greatest
            record.limited[0] = 1
        mass = momentum[3]
        step.limit[0] = wp.vec4(momentum[0] / mass, momentum[1] / mass, momentum[2] / mass, factor)


@wp.kernel(enable_backward=False)
def finish_step(
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    body: BodyArrays,
    step: StepArrays,
    positions_out: wp.array[wp.vec3],
    velocities_out: wp.array[wp.vec3],
):
    """New velocities and positions, and what further terms see of them; spare vertices are copied."""
    i = wp.tid()
    velocity = velocities[i]
    position = positions[i]
    if i < body.vertex_count[0]:
        velocity = step.predicted[i]
        limit = step.limit[0]
        factor = limit[3]
        if factor < 1.0 and body.fixed[i] == 0:
            mean = wp.vec3(limit[0], limit[1], limit[2])
            velocity = mean + factor * (velocity - mean)
        position += float(step.scales[TIME_STEP]) * velocity
    velocities_out[i] = velocity
    positions_out[i] = position
    step.predicted[i] = velocity
    step.displacement[i] = float(step.scales[TIME_STEP]) * velocity
