# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels that find the energies of a state, for reports."""

from __future__ import annotations

import functools

import warp as wp

from .constitutive import CONSTITUTIVE_MODELS
from .step_kernels import make_deformation_function, tie

wp.set_module_options({"enable_backward": False})


@wp.kernel(enable_backward=False)
def find_displacement(
    positions: wp.array[wp.vec3],
    rest: wp.array[wp.vec3],
    displacement: wp.array[wp.vec3],
):
    """Displacements from rest."""
    i = wp.tid()
    displacement[i] = positions[i] - rest[i]


@functools.cache
def make_elastic_energy_kernel(model: str, plane: bool) -> wp.Kernel:
    """The kernel that finds the elastic energy of every quadrature point, for one constitutive model."""
    energy = CONSTITUTIVE_MODELS[model].energy
    deformation = make_deformation_function(plane)

    @wp.kernel(enable_backward=False, module="unique")
    def elastic_energy(
        displacement: wp.array[wp.vec3],
        gradients: wp.array2d[wp.vec3],
        anchors: wp.array[int],
        volumes: wp.array[float],
        material: wp.array[wp.vec4d],
        rotation: wp.array[wp.mat33],
        vertex_count: wp.array[int],
        energies: wp.array[wp.float64],
    ):
        q = wp.tid()
        F = deformation(q, displacement, gradients, anchors[q], vertex_count[0], rotation[0])
        energies[q] = wp.float64(volumes[q]) * energy(F, material[0][0], material[0][1])

    return elastic_energy


@wp.kernel(enable_backward=False)
def find_kinetic_energy(
    velocities: wp.array[wp.vec3],
    mass: wp.array2d[float],
    vertex_count: wp.array[int],
    energies: wp.array[wp.float64],
):
    """Each vertex's part of the kinetic energy."""
    i = wp.tid()
    momentum = wp.vec3d()
    if i < vertex_count[0]:
        for j in range(vertex_count[0]):
            momentum += wp.float64(mass[i, j]) * wp.vec3d(velocities[j])
    energies[i] = wp.float64(0.5) * wp.dot(wp.vec3d(velocities[i]), momentum)


@wp.kernel(enable_backward=False)
def find_tie_energy(
    displacement: wp.array[wp.vec3],
    stabilizing: wp.array2d[float],
    material: wp.array[wp.vec4d],
    vertex_count: wp.array[int],
    energies: wp.array[wp.float64],
):
    """Each vertex's part of the stabilising energy."""
    i = wp.tid()
    energies[i] = wp.float64(0.0)
    if i < vertex_count[0] and stabilizing[i, i] > 0.0:
        force = tie(i, stabilizing, displacement, vertex_count[0])
        energies[i] = wp.float64(0.5) * material[0][0] * wp.float64(wp.dot(displacement[i], force))
