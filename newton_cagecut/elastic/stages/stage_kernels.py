# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of the stages of a step: targets, first guesses, residuals, and the state at the end."""

from __future__ import annotations

import warp as wp

from ..arrays import (
    DAMPING,
    DAMPING_SHARE,
    DRIVEN,
    ELASTIC_FORCE,
    ELASTIC_STIFFNESS,
    END_TIME,
    FORCE,
    HELD,
    IMPULSE_SHARE,
    JOINED,
    STAGE_TIME,
    START_SHARE,
    STIFFNESS,
    TARGET_REACHED,
    TARGET_VELOCITY,
    TIME_STEP,
    TOUCHED,
    VELOCITY_KEPT,
    VELOCITY_REACHED,
    BodyArrays,
    LinearSystem,
    StepArrays,
    matrix_of,
    put_matrix,
)
from ..step_kernels import tie
from .stage_arrays import PieceArrays, StageArrays, StageFactors
from .step_record import BAD_FORCE, BAD_RESULT, BAD_START, StepRecord

wp.set_module_options({"enable_backward": False})


@wp.func
def confined(v: wp.vec3d, body: BodyArrays) -> wp.vec3d:
    """The part of a vector in a plane body's plane; of a solid body all of it."""
    if body.normal.shape[0] > 0:
        return v - wp.dot(body.normal[0], v) * body.normal[0]
    return v


@wp.kernel(enable_backward=False)
def begin_stages(
    dt: wp.float64,
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    gravity: wp.array[wp.vec3],
    forces: wp.array[wp.vec3],
    touching: wp.array[int],
    body: BodyArrays,
    step: StepArrays,
    stage: StageArrays,
    record: StepRecord,
):
    """Where a step starts from."""
    i = wp.tid()
    velocity, load = wp.vec3d(), wp.vec3d()
    row_mass = wp.float64(0.0)
    if i == 0:
        step.scales[TIME_STEP] = dt
        step.scales[TOUCHED] = wp.float64(touching[0])
    if i < body.vertex_count[0]:
        if not (wp.isfinite(positions[i]) and wp.isfinite(velocities[i])):
            wp.atomic_max(record.reason, 0, BAD_START)
        elif not (wp.isfinite(gravity[0]) and wp.isfinite(forces[i])):
            wp.atomic_max(record.reason, 0, BAD_FORCE)
        if body.fixed[i] != HELD:
            velocity = confined(wp.vec3d(velocities[i]), body)
        for j in range(body.vertex_count[0]):
            row_mass += wp.float64(body.mass[i, j])
        load = confined(row_mass * wp.vec3d(gravity[0]) + wp.vec3d(forces[i]), body)
    stage.row_mass[i] = row_mass
    stage.load[i] = load
    stage.start[i] = positions[i]
    stage.velocity[i] = velocity
    stage.reached[i] = wp.vec3d()
    step.displacement[i] = positions[i] - body.rest[i]
    step.predicted[i] = wp.vec3()


@wp.func
def scale_stage(factors: StageFactors, damping_time: wp.float64, scales: wp.array[wp.float64]):
    """The factors of a stage for the present time step."""
    dt = scales[TIME_STEP]
    scale = factors.scale * dt
    damping = factors.damping_share * damping_time
    scales[STAGE_TIME] = scale
    scales[FORCE] = factors.force_share * scale * scale
    scales[STIFFNESS] = factors.force_share * scale * scale
    scales[DAMPING] = factors.force_share * scale
    scales[ELASTIC_FORCE] = scale * scale
    scales[ELASTIC_STIFFNESS] = scale * (scale + damping)
    scales[DAMPING_SHARE] = damping / (scale + damping)
    scales[START_SHARE] = factors.start_share
    scales[TARGET_VELOCITY] = factors.target_velocity * dt
    scales[TARGET_REACHED] = factors.target_reached
    scales[VELOCITY_KEPT] = factors.velocity_kept
    scales[VELOCITY_REACHED] = factors.velocity_reached / dt
    scales[END_TIME] = factors.end_time * dt
    scales[IMPULSE_SHARE] = factors.impulse_share * dt
    scales[JOINED] = wp.float64(0.0)


@wp.kernel(enable_backward=False)
def set_scales(free: StageFactors, touched: StageFactors, body: BodyArrays, step: StepArrays):
    """The factors of a stage, as something touches the body or nothing does; see ``Scheme``."""
    if step.scales[TOUCHED] > wp.float64(0.0):
        scale_stage(touched, body.material[0][2], step.scales)
    else:
        scale_stage(free, body.material[0][2], step.scales)


@wp.kernel(enable_backward=False)
def begin_stage(body: BodyArrays, step: StepArrays, stage: StageArrays):
    """Targets of a stage, and the impulses of its loads."""
    i = wp.tid()
    target, earlier, impulse = wp.vec3d(), wp.vec3d(), wp.vec3d()
    if i < body.vertex_count[0]:
        v, reached = stage.velocity[i], stage.reached[i]
        target = step.scales[TARGET_VELOCITY] * v + step.scales[TARGET_REACHED] * reached
        earlier = step.scales[VELOCITY_KEPT] * v + step.scales[VELOCITY_REACHED] * reached
        impulse = step.scales[FORCE] * stage.load[i]
    stage.target[i] = target
    stage.earlier_velocity[i] = wp.vec3(earlier)
    stage.impulse[i] = impulse


@wp.kernel(enable_backward=False)
def turn_strain(body: BodyArrays, step: StepArrays, pieces: PieceArrays):
    """Turn stress and stiffness of the reached shape with the first guess."""
    q = wp.tid()
    R = wp.mat33(pieces.rotation[body.piece[body.anchors[q]]])
    stiffness = step.stiffnesses[q]
    stiffness.left = R * stiffness.left
    step.stiffnesses[q] = stiffness
    put_matrix(step.tensions, q, R * matrix_of(step.tensions, q))


@wp.kernel(enable_backward=False)
def show_moved(body: BodyArrays, step: StepArrays, stage: StageArrays, system: LinearSystem):
    """What strain, ties and further terms see of the displacements now."""
    i = wp.tid()
    moved = wp.vec3d(stage.moved[i])
    stage.moved_single[i] = wp.vec3(moved)
    step.displacement[i] = wp.vec3(wp.vec3d(stage.start[i]) - wp.vec3d(body.rest[i]) + moved)
    step.predicted[i] = wp.vec3(step.scales[DAMPING_SHARE] * (moved - stage.guess[i]))
    system.solution[i] = wp.vec3()


@wp.kernel(enable_backward=False)
def find_inertial_residual(body: BodyArrays, step: StepArrays, stage: StageArrays, system: LinearSystem):
    """The residual without the quadrature's part."""
    i = wp.tid()
    r = wp.vec3d()
    if i < body.vertex_count[0]:
        r += stage.impulse[i]
        for j in range(body.vertex_count[0]):
            r += wp.float64(body.mass[i, j]) * (stage.target[j] - stage.moved[j])
        if body.stabilizing_stiffness[i, i] > 0.0:
            mu = body.material[0][0]
            r -= mu * step.scales[ELASTIC_FORCE] * wp.vec3d(tie(i, step.displacement, body))
            r -= mu * step.scales[ELASTIC_STIFFNESS] * wp.vec3d(tie(i, step.predicted, body))
    system.residual[i] = wp.vec3(r)


@wp.kernel(enable_backward=False)
def multiply_inertia(body: BodyArrays, step: StepArrays, stage: StageArrays, system: LinearSystem):
    """The matrix without the quadrature's part, times the change of the solution."""
    i = wp.tid()
    result = wp.vec3()
    if i < body.vertex_count[0] and body.fixed[i] == 0:
        for j in range(body.vertex_count[0]):
            result += body.mass[i, j] * system.solution[j]
        if body.stabilizing_stiffness[i, i] > 0.0:
            result += float(body.material[0][0] * step.scales[ELASTIC_STIFFNESS]) * tie(i, system.solution, body)
    stage.product[i] = result


@wp.kernel(enable_backward=False)
def take_solution(body: BodyArrays, stage: StageArrays, pieces: PieceArrays, system: LinearSystem):
    """Move the vertices by the part of the solution that was chosen."""
    i = wp.tid()
    if i < body.vertex_count[0] and body.fixed[i] == 0:
        change = confined(wp.vec3d(system.solution[i]), body)
        factor = pieces.factor[body.piece[i]]
        if factor > wp.float64(0.0):
            stage.moved[i] = stage.moved[i] + factor * change


@wp.kernel(enable_backward=False)
def end_stage(body: BodyArrays, step: StepArrays, stage: StageArrays):
    """Hand the displacements on to the next stage."""
    i = wp.tid()
    moved = stage.moved[i]
    stage.reached[i] = moved
    stage.moved_single[i] = wp.vec3(moved)
    stage.end_velocity[i] = wp.vec3(moved / step.scales[STAGE_TIME] - wp.vec3d(stage.earlier_velocity[i]))
    step.displacement[i] = wp.vec3(wp.vec3d(stage.start[i]) - wp.vec3d(body.rest[i]) + moved)
    step.predicted[i] = wp.vec3()


@wp.kernel(enable_backward=False)
def end_stages(
    velocities: wp.array[wp.vec3],
    body: BodyArrays,
    step: StepArrays,
    stage: StageArrays,
    record: StepRecord,
):
    """Positions and velocities at the end of the step; spare vertices are copied."""
    i = wp.tid()
    position, velocity = wp.vec3(stage.start[i]), wp.vec3(velocities[i])
    if i < body.vertex_count[0]:
        if body.fixed[i] == HELD:
            velocity = wp.vec3()
        elif body.fixed[i] == DRIVEN:
            velocity = wp.vec3(stage.velocity[i])
            position = wp.vec3(wp.vec3d(position) + stage.moved[i])
        else:
            moved = stage.moved[i]
            velocity = wp.vec3(confined(moved / step.scales[STAGE_TIME] - wp.vec3d(stage.earlier_velocity[i]), body))
            place = wp.vec3d(position) + moved
            if body.normal.shape[0] > 0:
                normal = body.normal[0]
                place -= wp.dot(normal, place - wp.vec3d(body.rest[i])) * normal
            position = wp.vec3(place)
        if not (wp.isfinite(position) and wp.isfinite(velocity)):
            wp.atomic_max(record.reason, 0, BAD_RESULT)
    stage.position_out[i] = position
    stage.velocity_out[i] = velocity


@wp.kernel(enable_backward=False)
def accept_step(
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    stage: StageArrays,
    record: StepRecord,
    positions_out: wp.array[wp.vec3],
    velocities_out: wp.array[wp.vec3],
):
    """Hand the new state on; where something is not finite, the body stays where it was."""
    i = wp.tid()
    if record.reason[0] == 0:
        positions_out[i] = stage.position_out[i]
        velocities_out[i] = stage.velocity_out[i]
    else:
        positions_out[i] = positions[i]
        velocities_out[i] = velocities[i]
