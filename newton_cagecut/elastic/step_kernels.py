# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of one backward-Euler step: per quadrature point and per vertex (paper, section 6.1).

F = I + sum_j (u_j - u_a) (x) grad w_j with u the displacement from rest and a the vertex of greatest weight: any
translation drops out exactly, also for a piece that a cut has let fall far from the others. Gradients are those of the
rest frame of the cage, and F is taken there; ``rotation`` turns that frame into the one of the rest positions.
"""

from __future__ import annotations

import functools

import warp as wp

from .arrays import (
    DAMPING,
    ELASTIC_FORCE,
    ELASTIC_STIFFNESS,
    END_TIME,
    FORCE,
    IMPULSE_SHARE,
    STIFFNESS,
    TIME_STEP,
    BodyArrays,
    LinearSystem,
    StepArrays,
    matrix_of,
    put_matrix,
)
from .averaging.row_functions import make_row_stiffness, make_row_stress
from .stiffness import Stiffness, apply_stiffness

wp.set_module_options({"enable_backward": False})


@wp.func
def gather(q: int, values: wp.array[wp.vec3], body: BodyArrays) -> wp.mat33:
    """Gradient of a field of vertex values at one quadrature point, in the cage's rest frame."""
    origin = values[body.anchors[q]]
    result = wp.mat33()
    for j in range(body.vertex_count[0]):
        result += wp.outer(values[j] - origin, body.gradients[q, j])
    return result


@functools.cache
def make_deformation_function(plane: bool) -> wp.Function:
    """The function that makes F, in the cage's rest frame, of a displacement's gradient; of a plane or a solid body."""

    @wp.func
    def deformation(gradient: wp.mat33, body: BodyArrays) -> wp.mat33d:
        change = wp.transpose(body.rotation[0]) * gradient
        if wp.static(plane):
            change[2] = wp.vec3()
        return wp.identity(3, dtype=wp.float64) + wp.mat33d(change)

    return deformation


@wp.kernel(enable_backward=False)
def begin_step(
    dt: float,
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    gravity: wp.array[wp.vec3],
    body: BodyArrays,
    step: StepArrays,
    system: LinearSystem,
):
    """Displacements, the first guess of the velocities' change (free fall), and the velocity that it predicts."""
    i = wp.tid()
    fall = dt * gravity[0]
    guess = fall
    if body.fixed[i] != 0:
        guess = wp.vec3()
    step.displacement[i] = positions[i] - body.rest[i]
    system.solution[i] = guess
    step.lag[i] = fall - guess
    step.predicted[i] = velocities[i] + guess
    if i == 0:
        seconds = wp.float64(dt)
        step.scales[FORCE] = seconds
        step.scales[STIFFNESS] = seconds * seconds
        step.scales[DAMPING] = seconds
        step.scales[ELASTIC_FORCE] = seconds
        step.scales[ELASTIC_STIFFNESS] = seconds * (seconds + body.material[0][2])
        step.scales[TIME_STEP] = seconds
        step.scales[END_TIME] = seconds
        step.scales[IMPULSE_SHARE] = seconds


@functools.cache
def make_strain_kernel(model: str, plane: bool) -> wp.Kernel:
    """The kernel that finds stress and stiffness at the quadrature points, for one constitutive model."""
    stress = make_row_stress(model)
    stiffness_function = make_row_stiffness(model, plane)
    deformation = make_deformation_function(plane)

    @wp.kernel(enable_backward=False, module="unique")
    def strain(body: BodyArrays, step: StepArrays):
        q = wp.tid()
        volume = wp.float64(body.volumes[q])
        stiffness, force = Stiffness(), wp.mat33()
        if volume != wp.float64(0.0):
            R = body.rotation[0]
            F = deformation(matrix_of(step.strain, q), body)
            stiffness = stiffness_function(q, F, body, volume * step.scales[ELASTIC_STIFFNESS])
            stiffness.left = R * stiffness.left
            force = R * wp.mat33(step.scales[ELASTIC_FORCE] * volume * stress(q, F, body))
            force += apply_stiffness(stiffness, matrix_of(step.drift, q))
        step.stiffnesses[q] = stiffness
        put_matrix(step.tensions, q, force)

    return strain


@wp.func
def add_inertia(total: wp.vec3, i: int, values: wp.array[wp.vec3], body: BodyArrays) -> wp.vec3:
    """A sum, and on top of it row i of the mass matrix times a field."""
    for j in range(body.vertex_count[0]):
        total += body.mass[i, j] * values[j]
    return total


@wp.func
def tie(i: int, values: wp.array[wp.vec3], body: BodyArrays) -> wp.vec3:
    """Row i of the stabilising stiffness over mu, whose rows sum to zero, times a field."""
    total = wp.vec3()
    for j in range(body.vertex_count[0]):
        total += body.stabilizing_stiffness[i, j] * (values[j] - values[i])
    return total


@wp.kernel(enable_backward=False)
def find_residual(forces: wp.array[wp.vec3], body: BodyArrays, step: StepArrays, system: LinearSystem):
    """Right-hand side minus matrix times the first guess, without the quadrature's part."""
    i = wp.tid()
    r = wp.vec3()
    if i < body.vertex_count[0]:
        r = add_inertia(float(step.scales[TIME_STEP]) * forces[i], i, step.lag, body)
        if body.stabilizing_stiffness[i, i] > 0.0:
            mu = body.material[0][0]
            r -= float(mu * step.scales[ELASTIC_FORCE]) * tie(i, step.displacement, body)
            r -= float(mu * step.scales[ELASTIC_STIFFNESS]) * tie(i, step.predicted, body)
    system.residual[i] = r
