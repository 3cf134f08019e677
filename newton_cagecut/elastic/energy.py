# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The energies of a state, for reports."""

from __future__ import annotations

import functools
from typing import NamedTuple

import warp as wp

from .arrays import BodyArrays
from .averaging.row_functions import make_row_energy
from .launching import launch_later
from .step_kernels import gather, make_deformation_function, tie

wp.set_module_options({"enable_backward": False})


class Energy(NamedTuple):
    """Energies of a state [J]."""

    elastic: float
    kinetic: float


@wp.struct
class EnergyArrays:
    """What the energies of a state are found from."""

    displacement: wp.array[wp.vec3]
    """Displacements from rest, one a vertex [m]."""
    elastic: wp.array[wp.float64]
    """Elastic energy, one a quadrature point [J]."""
    ties: wp.array[wp.float64]
    """Stabilising energy, one a vertex [J]."""
    kinetic: wp.array[wp.float64]
    """Kinetic energy, one a vertex [J]."""


@wp.kernel(enable_backward=False)
def find_displacement(positions: wp.array[wp.vec3], body: BodyArrays, energies: EnergyArrays):
    """Displacements from rest."""
    i = wp.tid()
    energies.displacement[i] = positions[i] - body.rest[i]


@functools.cache
def make_elastic_energy_kernel(model: str, plane: bool) -> wp.Kernel:
    """The kernel that finds the elastic energy of every quadrature point, for one constitutive model."""
    energy = make_row_energy(model)
    deformation = make_deformation_function(plane)

    @wp.kernel(enable_backward=False, module="unique")
    def elastic_energy(body: BodyArrays, energies: EnergyArrays):
        q = wp.tid()
        F = deformation(gather(q, energies.displacement, body), body)
        energies.elastic[q] = wp.float64(body.volumes[q]) * energy(q, F, body)

    return elastic_energy


@wp.kernel(enable_backward=False)
def find_tie_energy(body: BodyArrays, energies: EnergyArrays):
    """Each vertex's part of the stabilising energy."""
    i = wp.tid()
    energies.ties[i] = wp.float64(0.0)
    if i < body.vertex_count[0] and body.stabilizing_stiffness[i, i] > 0.0:
        work = wp.dot(energies.displacement[i], tie(i, energies.displacement, body))
        energies.ties[i] = wp.float64(0.5) * body.material[0][0] * wp.float64(work)


@wp.kernel(enable_backward=False)
def find_kinetic_energy(velocities: wp.array[wp.vec3], body: BodyArrays, energies: EnergyArrays):
    """Each vertex's part of the kinetic energy."""
    i = wp.tid()
    momentum = wp.vec3d()
    if i < body.vertex_count[0]:
        for j in range(body.vertex_count[0]):
            momentum += wp.float64(body.mass[i, j]) * wp.vec3d(velocities[j])
    energies.kinetic[i] = wp.float64(0.5) * wp.dot(wp.vec3d(velocities[i]), momentum)


class EnergyMeter:
    """Finds the energies of a body's states.

    Args:
        body: The body.
        model: Its constitutive model.
    """

    def __init__(self, body: BodyArrays, model: str):
        self.device, self.energies = body.rest.device, EnergyArrays()
        self._body, self._capacity, points = body, body.rest.shape[0], body.volumes.shape[0]
        energies = self.energies
        with wp.ScopedDevice(self.device):
            energies.displacement = wp.zeros(self._capacity, dtype=wp.vec3)
            energies.elastic = wp.zeros(points, dtype=wp.float64)
            energies.ties, energies.kinetic = (wp.zeros(self._capacity, dtype=wp.float64) for _ in range(2))
        elastic_energy = make_elastic_energy_kernel(model, body.normal is not None)
        self._elastic_energy = launch_later(elastic_energy, points, [body, energies], self.device)
        self._tie_energy = launch_later(find_tie_energy, self._capacity, [body, energies], self.device)

    def of(self, positions: wp.array, velocities: wp.array) -> Energy:
        """Energies of a state, read on the host.

        Args:
            positions: Positions, shape (vertex_capacity,) vec3 [m].
            velocities: Velocities, shape (vertex_capacity,) vec3 [m/s].
        """
        energies = self.energies
        for kernel, values in ((find_displacement, positions), (find_kinetic_energy, velocities)):
            wp.launch(kernel, dim=self._capacity, inputs=[values, self._body, energies], device=self.device)
        self._elastic_energy.launch()
        self._tie_energy.launch()
        elastic = float(energies.elastic.numpy().sum() + energies.ties.numpy().sum())
        return Energy(elastic, float(energies.kinetic.numpy().sum()))
