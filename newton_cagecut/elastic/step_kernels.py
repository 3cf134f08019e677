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

from .constitutive import CONSTITUTIVE_MODELS
from .stiffness import Stiffness, apply_stiffness, make_stiffness_function, vertex_block

wp.set_module_options({"enable_backward": False})


@wp.func
def gather(
    q: int,
    values: wp.array[wp.vec3],
    gradients: wp.array2d[wp.vec3],
    anchor: int,
    vertex_count: int,
) -> wp.mat33:
    """Gradient of a field of vertex values at one quadrature point, in the cage's rest frame."""
    origin = values[anchor]
    result = wp.mat33()
    for j in range(vertex_count):
        result += wp.outer(values[j] - origin, gradients[q, j])
    return result


@functools.cache
def make_deformation_function(plane: bool) -> wp.Function:
    """The function that finds F at one quadrature point, in the cage's rest frame, of a plane or a solid body."""

    @wp.func
    def deformation(
        q: int,
        displacement: wp.array[wp.vec3],
        gradients: wp.array2d[wp.vec3],
        anchor: int,
        vertex_count: int,
        rotation: wp.mat33,
    ) -> wp.mat33d:
        change = wp.transpose(rotation) * gather(q, displacement, gradients, anchor, vertex_count)
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
    rest: wp.array[wp.vec3],
    fixed: wp.array[int],
    material: wp.array[wp.vec4d],
    displacement: wp.array[wp.vec3],
    change: wp.array[wp.vec3],
    lag: wp.array[wp.vec3],
    predicted: wp.array[wp.vec3],
    scales: wp.array[wp.float64],
):
    """Displacements, the first guess of the velocities' change (free fall), and the velocity that it predicts."""
    i = wp.tid()
    fall = dt * gravity[0]
    guess = fall
    if fixed[i] != 0:
        guess = wp.vec3()
    displacement[i] = positions[i] - rest[i]
    change[i] = guess
    lag[i] = fall - guess
    predicted[i] = velocities[i] + guess
    if i == 0:
        step = wp.float64(dt)
        scales[0] = step
        scales[1] = step * (step + material[0][2])


@functools.cache
def make_strain_kernel(model: str, plane: bool) -> wp.Kernel:
    """The kernel that finds stress and stiffness at the quadrature points, for one constitutive model."""
    stress = CONSTITUTIVE_MODELS[model].stress
    stiffness_function = make_stiffness_function(model, plane)
    deformation = make_deformation_function(plane)

    @wp.kernel(enable_backward=False, module="unique")
    def strain(
        displacement: wp.array[wp.vec3],
        predicted: wp.array[wp.vec3],
        gradients: wp.array2d[wp.vec3],
        anchors: wp.array[int],
        volumes: wp.array[float],
        material: wp.array[wp.vec4d],
        rotation: wp.array[wp.mat33],
        scales: wp.array[wp.float64],
        vertex_count: wp.array[int],
        stiffnesses: wp.array[Stiffness],
        tensions: wp.array[wp.mat33],
    ):
        q = wp.tid()
        count, anchor, R = vertex_count[0], anchors[q], rotation[0]
        mu, lam = material[0][0], material[0][1]
        volume = wp.float64(volumes[q])
        F = deformation(q, displacement, gradients, anchor, count, R)
        stiffness = stiffness_function(F, mu, lam, volume * scales[1])
        stiffness.left = R * stiffness.left
        stiffnesses[q] = stiffness
        force = R * wp.mat33(scales[0] * volume * stress(F, mu, lam))
        tensions[q] = force + apply_stiffness(stiffness, gather(q, predicted, gradients, anchor, count))

    return strain


@wp.func
def tie(i: int, stabilizing: wp.array2d[float], values: wp.array[wp.vec3], vertex_count: int) -> wp.vec3:
    """Row i of the stabilising matrix, whose rows sum to zero, times a field."""
    total = wp.vec3()
    for j in range(vertex_count):
        total += stabilizing[i, j] * (values[j] - values[i])
    return total


@wp.kernel(enable_backward=False)
def find_residual(
    dt: float,
    forces: wp.array[wp.vec3],
    displacement: wp.array[wp.vec3],
    predicted: wp.array[wp.vec3],
    stabilizing: wp.array2d[float],
    material: wp.array[wp.vec4d],
    scales: wp.array[wp.float64],
    mass: wp.array2d[float],
    lag: wp.array[wp.vec3],
    gradients: wp.array2d[wp.vec3],
    stiffnesses: wp.array[Stiffness],
    tensions: wp.array[wp.mat33],
    vertex_count: wp.array[int],
    residual: wp.array[wp.vec3],
    blocks: wp.array[wp.mat33],
):
    """Right-hand side minus matrix times the first guess, and the matrix's diagonal blocks."""
    i = wp.tid()
    r = wp.vec3()
    block = wp.identity(3, dtype=float)
    if i < vertex_count[0]:
        r = dt * forces[i]
        for j in range(vertex_count[0]):
            r += mass[i, j] * lag[j]
        block = mass[i, i] * block
        for q in range(gradients.shape[0]):
            r -= tensions[q] * gradients[q, i]
            block += vertex_block(stiffnesses[q], gradients[q, i])
        if stabilizing[i, i] > 0.0:
            ties = float(material[0][0] * scales[1])
            r -= float(material[0][0] * scales[0]) * tie(i, stabilizing, displacement, vertex_count[0])
            r -= ties * tie(i, stabilizing, predicted, vertex_count[0])
            block += (ties * stabilizing[i, i]) * wp.identity(3, dtype=float)
    residual[i] = r
    blocks[i] = block


@wp.kernel(enable_backward=False)
def find_tensions(
    direction: wp.array[wp.vec3],
    gradients: wp.array2d[wp.vec3],
    anchors: wp.array[int],
    stiffnesses: wp.array[Stiffness],
    vertex_count: wp.array[int],
    tensions: wp.array[wp.mat33],
):
    """Change of stress, times volume and time scale, with a direction of velocities."""
    q = wp.tid()
    tensions[q] = apply_stiffness(stiffnesses[q], gather(q, direction, gradients, anchors[q], vertex_count[0]))


@wp.kernel(enable_backward=False)
def multiply_system(
    direction: wp.array[wp.vec3],
    gradients: wp.array2d[wp.vec3],
    tensions: wp.array[wp.mat33],
    mass: wp.array2d[float],
    stabilizing: wp.array2d[float],
    material: wp.array[wp.vec4d],
    scales: wp.array[wp.float64],
    fixed: wp.array[int],
    vertex_count: wp.array[int],
    product: wp.array[wp.vec3],
):
    """The system matrix times a direction that is zero on fixed vertices."""
    i = wp.tid()
    result = wp.vec3()
    if i < vertex_count[0] and fixed[i] == 0:
        for j in range(vertex_count[0]):
            result += mass[i, j] * direction[j]
        for q in range(gradients.shape[0]):
            result += tensions[q] * gradients[q, i]
        if stabilizing[i, i] > 0.0:
            result += float(material[0][0] * scales[1]) * tie(i, stabilizing, direction, vertex_count[0])
    product[i] = result
