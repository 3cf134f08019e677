# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a step does to vertices beside the physics: prescribed motion before it, limits after it.

A fixed vertex with a target goes there in a straight line within the step, and has that line's velocity in it; without
one it stays where it is. Of a body without elasticity every vertex can have a target. Targets are the rows of
``control.cagecut.target_q``, one a particle; infinity is no target.
"""

from __future__ import annotations

import newton
import warp as wp

from ...elastic import DRIVEN, HELD

wp.set_module_options({"enable_backward": False})


@wp.func
def has_target(target: wp.vec3, is_current: wp.array[wp.int32]) -> bool:
    """Whether a vertex goes to a target, in a state of the body's present edit."""
    return is_current[0] != 0 and wp.isfinite(target)


@wp.kernel(enable_backward=False)
def prescribe_motion(
    dt: float,
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    targets: wp.array[wp.vec3],
    is_current: wp.array[wp.int32],
    fixed: wp.array[wp.int32],
    prescribed: wp.array[wp.vec3],
):
    """Velocities that a step starts from: of fixed vertices those that take them to their targets."""
    i = wp.tid()
    velocity = wp.vec3(velocities[i])
    if fixed[i] != 0:
        velocity = wp.vec3()
        fixed[i] = HELD
        target = wp.vec3(targets[i])
        if has_target(target, is_current):
            velocity = (target - positions[i]) / dt
            fixed[i] = DRIVEN
    prescribed[i] = velocity


@wp.kernel(enable_backward=False)
def place_vertices(
    dt: float,
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    targets: wp.array[wp.vec3],
    is_current: wp.array[wp.int32],
    positions_out: wp.array[wp.vec3],
    velocities_out: wp.array[wp.vec3],
):
    """The step of a body without elasticity: vertices with targets go there, the others stay."""
    i = wp.tid()
    position, velocity, target = wp.vec3(positions[i]), wp.vec3(velocities[i]), wp.vec3(targets[i])
    if has_target(target, is_current):
        velocity = (target - position) / dt
        position = target
    positions_out[i] = position
    velocities_out[i] = velocity


@wp.kernel(enable_backward=False)
def finish_vertices(
    dt: float,
    greatest_speed: float,
    is_current: wp.array[wp.int32],
    fixed: wp.array[wp.int32],
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    positions_out: wp.array[wp.vec3],
    velocities_out: wp.array[wp.vec3],
):
    """Carry vertices over as they are where the state is of another edit; elsewhere limit the speed of free ones."""
    i = wp.tid()
    if is_current[0] == 0:
        positions_out[i] = positions[i]
        velocities_out[i] = velocities[i]
    elif fixed[i] == 0:
        speed = wp.length(velocities_out[i])
        if speed > greatest_speed:
            velocities_out[i] = velocities_out[i] * (greatest_speed / speed)
        way = positions_out[i] - positions[i]
        length = wp.length(way)
        if length > greatest_speed * dt:
            positions_out[i] = positions[i] + way * (greatest_speed * dt / length)


def targets_of(model: newton.Model, control: newton.Control | None) -> wp.array:
    """Where fixed vertices are to go, one row a particle.

    Args:
        model: The model, whose own targets count without a control.
        control: A control of the model, or None.

    Raises:
        TypeError: The control has no targets.
    """
    rows = getattr(model if control is None else control, "cagecut", None)
    targets = getattr(rows, "target_q", None)
    if targets is None:
        raise TypeError(
            f"a control of a model with cage bodies is needed, from model.control(); got {type(control).__name__}"
        )
    return targets
