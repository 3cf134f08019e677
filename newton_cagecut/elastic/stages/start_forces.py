# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The internal forces at the start of a step, as the trapezoidal rule needs them.

Positions come in float32: what a stiff body's stress says below their rounding is noise, and the trapezoidal rule would
make spin of it (a body of 1 GPa at one radian a second gains or loses 0.1 % in a step). So the forces are taken from
the strain as far as that can be trusted, and otherwise from the motion: those that keep each piece rigid, under its
loads and with the angular velocity that it has. Both agree where a body is stiff and moves as one.
"""

import functools

import warp as wp

from ..arrays import ELASTIC_FORCE, START_SHARE, BodyArrays, StepArrays
from ..solve.lanes import lane_struct, make_scatter
from ..step_kernels import tie
from .rigid_fit import place_of
from .stage_arrays import PieceArrays, StageArrays

wp.set_module_options({"enable_backward": False})

_ROUNDING = wp.constant(wp.float64(1.2e-7))
"""Rounding of a float32 position and of the strain that is found from it, as a share."""
_TRUSTED = wp.constant(wp.float64(1.0e-5))
"""Share of the angular momentum that rounding may change in a step."""


@wp.kernel(enable_backward=False)
def find_spins(body: BodyArrays, stage: StageArrays, pieces: PieceArrays):
    """Rows of the mass matrix times places and velocities."""
    i = wp.tid()
    inertia, momentum = wp.vec3d(), wp.vec3d()
    if i < body.vertex_count[0]:
        p = body.piece[i]
        for j in range(body.vertex_count[0]):
            if body.piece[j] == p:
                m = wp.float64(body.mass[i, j])
                inertia += m * (place_of(j, stage) - pieces.center[p])
                momentum += m * stage.velocity[j]
    stage.inertia[i] = inertia
    stage.momentum[i] = momentum


@wp.func
def turning(inertia: wp.mat33d, torque: wp.vec3d, axis: wp.vec3d) -> wp.vec3d:
    """Inertia to the power of -1 times a vector, about an axis if there is one."""
    if wp.length_sq(axis) > wp.float64(0.0):
        about = wp.dot(axis, inertia * axis)
        if about > wp.float64(0.0):
            return (wp.dot(axis, torque) / about) * axis
    elif wp.determinant(inertia) > wp.float64(0.0):
        return wp.inverse(inertia) * torque
    return wp.vec3d()


@wp.kernel(enable_backward=False)
def fit_accelerations(body: BodyArrays, step: StepArrays, stage: StageArrays, pieces: PieceArrays):
    """The acceleration of each piece if it were rigid, and how far its stress is trusted."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    shape = wp.mat33d()
    spin, torque, load = wp.vec3d(), wp.vec3d(), wp.vec3d()
    reach = wp.float64(0.0)
    for i in range(body.vertex_count[0]):
        if body.piece[i] == p:
            place = place_of(i, stage) - pieces.center[p]
            shape += wp.outer(stage.inertia[i], place)
            spin += wp.cross(place, stage.momentum[i])
            torque += wp.cross(place, stage.load[i])
            load += stage.load[i]
            reach = wp.max(reach, wp.length(place_of(i, stage)))
    trace = wp.trace(shape)
    inertia = trace * wp.identity(3, dtype=wp.float64) - wp.float64(0.5) * (shape + wp.transpose(shape))
    velocity, acceleration = wp.vec3d(), wp.vec3d()
    if pieces.freedom[p][1] != 0:
        axis = pieces.axis[p]
        velocity = turning(inertia, spin, axis)
        acceleration = turning(inertia, torque - wp.cross(velocity, inertia * velocity), axis)
    pieces.spin[p] = velocity
    pieces.spin_rate[p] = acceleration
    pieces.shift[p] = wp.vec3d()
    if pieces.freedom[p][0] != 0:
        pieces.shift[p] = load / pieces.mass[p]
    # stress of a rounding [Pa], and the share of the angular momentum that it can change in a step
    material = body.material[0]
    size = wp.sqrt(wp.max(trace, wp.float64(0.0)) / pieces.mass[p])
    trust = wp.float64(1.0)
    resolved = wp.length_sq(velocity) * step.scales[ELASTIC_FORCE] < wp.float64(1.0)
    if size > wp.float64(0.0) and resolved:
        stress = (material[1] + wp.float64(2.0) * material[0]) * _ROUNDING * (reach + size) / size
        change = wp.float64(3.0) * step.scales[ELASTIC_FORCE] * stress / (material[3] * size * size)
        trust = wp.min(wp.float64(1.0), _TRUSTED / wp.max(change, wp.float64(1.0e-30)))
    pieces.factor[p] = trust


@functools.cache
def make_start_kernel(width: int) -> wp.Kernel:
    """The kernel that adds the forces at the start to the impulse, for one width of lanes."""
    Lanes, scatter = lane_struct(width), make_scatter(width)

    @wp.kernel(enable_backward=False, module="unique")
    def add_start_forces(body: BodyArrays, step: StepArrays, stage: StageArrays, pieces: PieceArrays, lanes: Lanes):
        """Add the forces at the start, times the square of the stage's scale, to the impulse."""
        i = wp.tid()
        if i >= body.vertex_count[0] or step.scales[START_SHARE] == wp.float64(0.0):
            return
        p = body.piece[i]
        omega, alpha = pieces.spin[p], pieces.spin_rate[p]
        rigid = -stage.load[i]
        for j in range(body.vertex_count[0]):
            if body.piece[j] == p:
                place = place_of(j, stage) - pieces.center[p]
                turned = wp.cross(alpha, place) + wp.cross(omega, wp.cross(omega, place))
                rigid += wp.float64(body.mass[i, j]) * (pieces.shift[p] + turned)
        rigid = step.scales[ELASTIC_FORCE] * rigid
        internal = -wp.vec3d(scatter(i, lanes))
        if body.stabilizing_stiffness[i, i] > 0.0:
            stiffness = body.material[0][0] * step.scales[ELASTIC_FORCE]
            internal -= stiffness * wp.vec3d(tie(i, step.displacement, body))
        if body.normal.shape[0] > 0:
            internal -= wp.dot(body.normal[0], internal) * body.normal[0]
        trust = pieces.factor[p]
        force = trust * internal + (wp.float64(1.0) - trust) * rigid
        stage.impulse[i] = stage.impulse[i] + step.scales[START_SHARE] * force

    return add_start_forces
