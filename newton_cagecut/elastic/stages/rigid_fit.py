# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The first guess of a stage: each piece is moved rigidly, to where its momentum takes it.

Of all rigid motions of the shape that a piece has, that of the least incremental potential: the linear system, which
holds for small rotations only, is left with the change of shape. So rotation costs no iterations and loses no angular
momentum, however stiff the body. A piece that is held at a point or along a line turns about it; one that is held at
more points stays, or goes where one of them is driven. In the plane it turns about the normal.

The least-squares rotation is the minimum of -A : R with A = sum (M target + impulse) (x) place; Newton's method on R
starts from the identity, so that a body at rest stays where it is to the bit.
"""

from __future__ import annotations

import warp as wp

from ..arrays import DRIVEN, BodyArrays
from .stage_arrays import PieceArrays, StageArrays

wp.set_module_options({"enable_backward": False})

_ITERATIONS = wp.constant(16)
_LONGEST_TURN = wp.constant(wp.float64(0.5))
"""Greatest rotation of one iteration [rad]."""
_SMALL = wp.constant(wp.float64(1.0e-14))
_COLLINEAR = wp.constant(wp.float64(1.0e-4))
"""Sine of the angle below which three held vertices lie on a line."""


@wp.func
def place_of(i: int, stage: StageArrays) -> wp.vec3d:
    """Where a vertex is in the shape that the stage starts from."""
    return wp.vec3d(stage.start[i]) + stage.reached[i]


@wp.func
def cross_matrix(v: wp.vec3d) -> wp.mat33d:
    """The matrix that takes the cross product with a vector."""
    zero = wp.float64(0.0)
    return wp.mat33d(zero, -v[2], v[1], v[2], zero, -v[0], -v[1], v[0], zero)


@wp.func
def turn_about(v: wp.vec3d) -> wp.mat33d:
    """Rotation by a rotation vector [rad]."""
    angle = wp.length(v)
    unit = wp.identity(3, dtype=wp.float64)
    if angle == wp.float64(0.0):
        return unit
    half_sine = wp.sin(wp.float64(0.5) * angle) / (wp.float64(0.5) * angle)
    K = cross_matrix(v)
    return unit + (wp.sin(angle) / angle) * K + (wp.float64(0.5) * half_sine * half_sine) * K * K


@wp.func
def turn_towards(A: wp.mat33d, R: wp.mat33d, axis: wp.vec3d) -> wp.vec3d:
    """One step of Newton's method towards the rotation closest to A, as a rotation vector."""
    B = A * wp.transpose(R)
    torque = wp.vec3d(B[2, 1] - B[1, 2], B[0, 2] - B[2, 0], B[1, 0] - B[0, 1])
    S = wp.float64(0.5) * (B + wp.transpose(B))
    trace = wp.trace(S)
    H = trace * wp.identity(3, dtype=wp.float64) - S
    result = wp.vec3d()
    if wp.length_sq(axis) > wp.float64(0.0):
        stiffness, along = wp.dot(axis, H * axis), wp.dot(axis, torque)
        scale = wp.abs(along) + wp.abs(trace)
        if stiffness > _SMALL * scale:
            result = (along / stiffness) * axis
        elif scale > wp.float64(0.0):
            result = (along / scale) * axis
    else:
        minor = H[0, 0] * H[1, 1] - H[0, 1] * H[1, 0]
        size = wp.abs(trace) + wp.length(torque)
        definite = H[0, 0] > wp.float64(0.0) and minor > wp.float64(0.0)
        if definite and wp.determinant(H) > _SMALL * size * size * size:
            result = wp.inverse(H) * torque
        elif size > wp.float64(0.0):
            result = torque / size
    angle = wp.length(result)
    if angle > _LONGEST_TURN:
        result = (_LONGEST_TURN / angle) * result
    return result


@wp.kernel(enable_backward=False)
def find_centers(body: BodyArrays, stage: StageArrays, pieces: PieceArrays):
    """Mass and centre of each piece, and how it may move."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    origin, first, second = wp.vec3d(), wp.vec3d(), wp.vec3d()
    moment = wp.vec3d()
    mass = wp.float64(0.0)
    seen, held = int(0), int(0)
    for i in range(body.vertex_count[0]):
        if body.piece[i] == p:
            place = place_of(i, stage)
            if seen == 0:
                origin = place
            seen = 1
            m = stage.row_mass[i]
            mass += m
            moment += m * (place - origin)
            if body.fixed[i] != 0:
                if held == 0:
                    first = place
                    held = 1
                elif held == 1 and wp.length_sq(place - first) > wp.float64(0.0):
                    second = wp.normalize(place - first)
                    held = 2
                elif held == 2:
                    apart = wp.length(wp.cross(place - first, second))
                    if apart > _COLLINEAR * wp.length(place - first):
                        held = 3
    axis = wp.vec3d()
    turns = wp.where(held < 3, 1, 0)
    if held == 2:
        axis = second
    if body.normal.shape[0] > 0:
        axis = body.normal[0]
        turns = wp.where(held < 2, 1, 0)
    center = origin + moment / mass
    if held > 0:
        center = first
    pieces.mass[p] = mass
    pieces.center[p] = center
    pieces.axis[p] = axis
    pieces.freedom[p] = wp.vec2i(wp.where(held == 0, 1, 0), turns)


@wp.kernel(enable_backward=False)
def find_momenta(body: BodyArrays, stage: StageArrays, pieces: PieceArrays):
    """Rows of the mass matrix times places and target displacements, with the impulse."""
    i = wp.tid()
    inertia, momentum = wp.vec3d(), wp.vec3d()
    if i < body.vertex_count[0]:
        p = body.piece[i]
        center = pieces.center[p]
        for j in range(body.vertex_count[0]):
            if body.piece[j] == p:
                m = wp.float64(body.mass[i, j])
                inertia += m * (place_of(j, stage) - center)
                momentum += m * (stage.target[j] - stage.reached[j])
        momentum += stage.impulse[i]
    stage.inertia[i] = inertia
    stage.momentum[i] = momentum


@wp.kernel(enable_backward=False)
def fit_motions(body: BodyArrays, stage: StageArrays, pieces: PieceArrays):
    """The rigid motion of each piece."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    shape, change = wp.mat33d(), wp.mat33d()
    total = wp.vec3d()
    center = pieces.center[p]
    driven = wp.vec3d()
    for i in range(body.vertex_count[0]):
        if body.piece[i] == p:
            if body.fixed[i] == DRIVEN:
                driven = stage.target[i] - stage.reached[i]
            place = place_of(i, stage) - center
            shape += wp.outer(stage.inertia[i], place)
            change += wp.outer(stage.momentum[i], place)
            total += stage.momentum[i]
    A = wp.float64(0.5) * (shape + wp.transpose(shape)) + change
    R = wp.identity(3, dtype=wp.float64)
    if pieces.freedom[p][1] != 0:
        for _ in range(_ITERATIONS):
            turn = turn_towards(A, R, pieces.axis[p])
            R = turn_about(turn) * R
            if wp.length(turn) < _SMALL:
                break
    pieces.rotation[p] = R
    pieces.shift[p] = driven
    if pieces.freedom[p][0] != 0:
        pieces.shift[p] = total / pieces.mass[p]


@wp.kernel(enable_backward=False)
def move_rigidly(body: BodyArrays, stage: StageArrays, pieces: PieceArrays):
    """Each vertex's first guess."""
    i = wp.tid()
    guess = wp.vec3d(stage.reached[i])
    if i < body.vertex_count[0] and body.fixed[i] == 0:
        p = body.piece[i]
        place = place_of(i, stage) - pieces.center[p]
        guess += pieces.shift[p] + (pieces.rotation[p] - wp.identity(3, dtype=wp.float64)) * place
    if i < body.vertex_count[0] and body.fixed[i] == DRIVEN:
        guess = stage.target[i]
    stage.guess[i] = guess
    stage.moved[i] = guess
