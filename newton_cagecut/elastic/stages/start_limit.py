# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A limit on velocities that a step cannot resolve.

A linearisation says nothing beyond a change of F of about one. Where the velocities at the start would deform a piece
by more than that in a step, what they are beside its rigid motion is scaled down, at the start. That keeps momentum and
angular momentum of the piece, takes energy out, and does not see how fast it flies or turns. Other pieces, and ordinary
steps, are left as they are.
"""

from __future__ import annotations

import warp as wp

from ..arrays import TIME_STEP, BodyArrays, StepArrays, matrix_of
from .rigid_fit import place_of
from .stage_arrays import PieceArrays, StageArrays
from .start_forces import turning
from .step_record import StepRecord

wp.set_module_options({"enable_backward": False})

_GREATEST_CHANGE = wp.constant(0.5)
"""Greatest change of F in a step beside rotation (Frobenius norm)."""


@wp.kernel(enable_backward=False)
def fit_spins(body: BodyArrays, stage: StageArrays, pieces: PieceArrays):
    """Velocity and angular velocity of each piece, from its momenta."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    shape = wp.mat33d()
    spin, momentum = wp.vec3d(), wp.vec3d()
    for i in range(body.vertex_count[0]):
        if body.piece[i] == p:
            place = place_of(i, stage) - pieces.center[p]
            shape += wp.outer(stage.inertia[i], place)
            spin += wp.cross(place, stage.momentum[i])
            momentum += stage.momentum[i]
    inertia = wp.trace(shape) * wp.identity(3, dtype=wp.float64) - wp.float64(0.5) * (shape + wp.transpose(shape))
    pieces.spin[p] = wp.vec3d()
    if pieces.freedom[p][1] != 0:
        pieces.spin[p] = turning(inertia, spin, pieces.axis[p])
    pieces.shift[p] = wp.vec3d()
    if pieces.freedom[p][0] != 0:
        pieces.shift[p] = momentum / pieces.mass[p]


@wp.func
def rigid_velocity(i: int, body: BodyArrays, stage: StageArrays, pieces: PieceArrays) -> wp.vec3d:
    """Velocity of a vertex in the rigid motion of its piece."""
    p = body.piece[i]
    velocity = pieces.shift[p] + wp.cross(pieces.spin[p], place_of(i, stage) - pieces.center[p])
    if body.fixed[i] != 0:
        velocity = wp.vec3d()
    return velocity


@wp.kernel(enable_backward=False)
def find_relative(body: BodyArrays, step: StepArrays, stage: StageArrays, pieces: PieceArrays):
    """Velocities beside the rigid motions."""
    i = wp.tid()
    relative = wp.vec3d()
    if i < body.vertex_count[0]:
        relative = stage.velocity[i] - rigid_velocity(i, body, stage, pieces)
    step.predicted[i] = wp.vec3(relative)


@wp.kernel(enable_backward=False)
def find_changes(body: BodyArrays, step: StepArrays):
    """Size of the change of F at each quadrature point in this step, beside rotation."""
    q = wp.tid()
    change = matrix_of(step.drift, q)
    size = float(step.scales[TIME_STEP]) * wp.sqrt(wp.ddot(change, change))
    step.rates[q] = wp.where(body.volumes[q] > 0.0, size, 0.0)


@wp.kernel(enable_backward=False)
def choose_limits(body: BodyArrays, step: StepArrays, pieces: PieceArrays, record: StepRecord):
    """The factor on each piece's velocities beside its rigid motion."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    greatest = float(0.0)
    for q in range(step.rates.shape[0]):
        if body.piece[body.anchors[q]] == p:
            greatest = wp.max(greatest, step.rates[q])
    factor = float(1.0)
    if greatest > _GREATEST_CHANGE:
        factor = _GREATEST_CHANGE / greatest
        wp.atomic_max(record.limited, 0, 1)
    pieces.factor[p] = wp.float64(factor)


@wp.kernel(enable_backward=False)
def limit_velocities(body: BodyArrays, step: StepArrays, stage: StageArrays, pieces: PieceArrays):
    """Scale the velocities beside the rigid motions."""
    i = wp.tid()
    if i < body.vertex_count[0]:
        factor = pieces.factor[body.piece[i]]
        if factor < wp.float64(1.0) and body.fixed[i] == 0:
            rigid = rigid_velocity(i, body, stage, pieces)
            stage.velocity[i] = rigid + factor * (stage.velocity[i] - rigid)
    step.predicted[i] = wp.vec3()
