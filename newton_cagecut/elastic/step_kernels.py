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

from .arrays import BodyArrays, LinearSystem, StepArrays
from .constitutive import CONSTITUTIVE_MODELS
from .stiffness import apply_stiffness, make_stiffness_function, vertex_block

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
    """The function that finds F at one quadrature point, in the cage's rest frame, of a plane or a solid body."""

    @wp.func
    def deformation(q: int, displacement: wp.array[wp.vec3], body: BodyArrays) -> wp.mat33d:
        change = wp.transpose(body.rotation[0]) * gather(q, displacement, body)
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
        step.scales[0] = seconds
        step.scales[1] = seconds * (seconds + body.material[0][2])


@functools.cache
def make_strain_kernel(model: str, plane: bool) -> wp.Kernel:
    """The kernel that finds stress and stiffness at the quadrature points, for one constitutive model."""
    stress = CONSTITUTIVE_MODELS[model].stress
    stiffness_function = make_stiffness_function(model, plane)
    deformation = make_deformation_function(plane)

    @wp.kernel(enable_backward=False, module="unique")
    def strain(body: BodyArrays, step: StepArrays):
        q = wp.tid()
        R = body.rotation[0]
        mu, lam = body.material[0][0], body.material[0][1]
        volume = wp.float64(body.volumes[q])
        F = deformation(q, step.displacement, body)
        stiffness = stiffness_function(F, mu, lam, volume * step.scales[1])
        stiffness.left = R * stiffness.left
        step.stiffnesses[q] = stiffness
        force = R * wp.mat33(step.scales[0] * volume * stress(F, mu, lam))
        step.tensions[q] = force + apply_stiffness(stiffness, gather(q, step.predicted, body))

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
def find_residual(dt: float, forces: wp.array[wp.vec3], body: BodyArrays, step: StepArrays, system: LinearSystem):
    """Right-hand side minus matrix times the first guess, and the matrix's diagonal blocks."""
    i = wp.tid()
    r = wp.vec3()
    block = wp.identity(3, dtype=float)
    if i < body.vertex_count[0]:
        r = add_inertia(dt * forces[i], i, step.lag, body)
        block = body.mass[i, i] * block
        for q in range(body.volumes.shape[0]):
            r -= step.tensions[q] * body.gradients[q, i]
            block += vertex_block(step.stiffnesses[q], body.gradients[q, i])
        if body.stabilizing_stiffness[i, i] > 0.0:
            mu = body.material[0][0]
            ties = float(mu * step.scales[1])
            r -= float(mu * step.scales[0]) * tie(i, step.displacement, body)
            r -= ties * tie(i, step.predicted, body)
            block += (ties * body.stabilizing_stiffness[i, i]) * wp.identity(3, dtype=float)
    system.residual[i] = r
    system.blocks[i] = block


@wp.kernel(enable_backward=False)
def find_tensions(direction: wp.array[wp.vec3], body: BodyArrays, step: StepArrays):
    """Change of stress, times volume and time scale, with a direction of velocities."""
    q = wp.tid()
    step.tensions[q] = apply_stiffness(step.stiffnesses[q], gather(q, direction, body))


@wp.kernel(enable_backward=False)
def multiply_system(direction: wp.array[wp.vec3], body: BodyArrays, step: StepArrays, product: wp.array[wp.vec3]):
    """The system matrix times a direction that is zero on fixed vertices."""
    i = wp.tid()
    result = wp.vec3()
    if i < body.vertex_count[0] and body.fixed[i] == 0:
        result = add_inertia(result, i, direction, body)
        for q in range(body.volumes.shape[0]):
            result += step.tensions[q] * body.gradients[q, i]
        if body.stabilizing_stiffness[i, i] > 0.0:
            result += float(body.material[0][0] * step.scales[1]) * tie(i, direction, body)
    product[i] = result
