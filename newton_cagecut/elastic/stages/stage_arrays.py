# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Warp structs of a stage: where the vertices are on their way through a step, and the pieces that they belong to.

Everything is a displacement from where the step starts, in float64: a body at rest gives exact zeros, and places far
from the origin cost no digits.
"""

from __future__ import annotations

import warp as wp

from ..arrays import BodyArrays
from .scheme import Stage, StageCourse


@wp.struct
class StageFactors:
    """A ``Stage`` for kernels; see ``scheme.py``."""

    scale: wp.float64
    target_velocity: wp.float64
    target_reached: wp.float64
    velocity_kept: wp.float64
    velocity_reached: wp.float64
    force_share: wp.float64
    damping_share: wp.float64
    start_share: wp.float64
    end_time: wp.float64
    impulse_share: wp.float64


@wp.struct
class StageArrays:
    """What a stage works on, one row a vertex. Displacements are from the positions at the start of the step [m]."""

    start: wp.array[wp.vec3]
    """Positions at the start of the step [m]."""
    velocity: wp.array[wp.vec3d]
    """Velocities at the start of the step, zero of held vertices [m/s]."""
    row_mass: wp.array[wp.float64]
    """Sums of the mass matrix's rows, free of their rounding [kg]."""
    reached: wp.array[wp.vec3d]
    """Displacements at the end of the stage before: the shape that this stage turns rigidly for its first guess."""
    target: wp.array[wp.vec3d]
    """Displacements without any force."""
    impulse: wp.array[wp.vec3d]
    """Known forces times the square of the stage's scale [kg m]."""
    load: wp.array[wp.vec3d]
    """Weights and further constant forces [N]."""
    guess: wp.array[wp.vec3d]
    """Displacements of the first guess."""
    moved: wp.array[wp.vec3d]
    """Displacements now."""
    moved_single: wp.array[wp.vec3]
    """The same, for further terms of the system."""
    earlier_velocity: wp.array[wp.vec3]
    """What the velocity at the end lacks of ``moved`` over the stage's scale [m/s]."""
    end_velocity: wp.array[wp.vec3]
    """Velocity at the end of the stage, for further terms [m/s]."""
    inertia: wp.array[wp.vec3d]
    """Mass matrix times the places in the piece [kg m]."""
    momentum: wp.array[wp.vec3d]
    """Mass matrix times ``target``, and the impulse [kg m]."""
    product: wp.array[wp.vec3]
    """The matrix without the quadrature's part, times the change of the solution [kg m]."""
    position_out: wp.array[wp.vec3]
    """Positions at the end of the step, before they are accepted [m]."""
    velocity_out: wp.array[wp.vec3]
    """Velocities at the end of the step, before they are accepted [m/s]."""


@wp.struct
class PieceArrays:
    """The pieces of a body, one row a piece; there is room for as many as vertices."""

    mass: wp.array[wp.float64]
    """Mass [kg]."""
    center: wp.array[wp.vec3d]
    """Centre of mass, or a point that is held [m]."""
    axis: wp.array[wp.vec3d]
    """Unit axis that a piece turns about; zero if any is free."""
    freedom: wp.array[wp.vec2i]
    """Whether it may be shifted, and turned."""
    spin: wp.array[wp.vec3d]
    """Angular velocity at the start of the step [rad/s]."""
    spin_rate: wp.array[wp.vec3d]
    """Its rate, if the piece is rigid [rad/s^2]."""
    rotation: wp.array[wp.mat33d]
    """Rotation of the first guess."""
    shift: wp.array[wp.vec3d]
    """Shift of the centre in the first guess [m]; before, its acceleration [m/s^2]."""
    factor: wp.array[wp.float64]
    """Part of the solution that is taken; before, how far the stress at the start is trusted; in [0, 1]."""


def make_stage_factors(stage: Stage, course: StageCourse) -> StageFactors:
    """The factors of a stage."""
    factors = StageFactors()
    for name, value in (stage._asdict() | course._asdict()).items():
        setattr(factors, name, value)
    return factors


def make_stage_arrays(body: BodyArrays) -> StageArrays:
    """Scratch for the stages of a body."""
    stage, capacity = StageArrays(), body.rest.shape[0]
    with wp.ScopedDevice(body.rest.device):
        for name in ("velocity", "reached", "target", "impulse", "load", "guess", "moved", "inertia", "momentum"):
            setattr(stage, name, wp.zeros(capacity, dtype=wp.vec3d))
        stage.row_mass = wp.zeros(capacity, dtype=wp.float64)
        names = ("start", "moved_single", "earlier_velocity", "end_velocity", "product", "position_out", "velocity_out")
        for name in names:
            setattr(stage, name, wp.zeros(capacity, dtype=wp.vec3))
    return stage


def make_piece_arrays(body: BodyArrays) -> PieceArrays:
    """Room for the pieces of a body."""
    pieces, capacity = PieceArrays(), body.rest.shape[0]
    with wp.ScopedDevice(body.rest.device):
        pieces.mass, pieces.factor = (wp.zeros(capacity, dtype=wp.float64) for _ in range(2))
        for name in ("center", "axis", "shift", "spin", "spin_rate"):
            setattr(pieces, name, wp.zeros(capacity, dtype=wp.vec3d))
        pieces.freedom = wp.zeros(capacity, dtype=wp.vec2i)
        pieces.rotation = wp.zeros(capacity, dtype=wp.mat33d)
    return pieces
