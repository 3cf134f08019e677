# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Contact of a body's surface with Newton's shapes: implicit penalty forces, pulled back to the cage.

Newton's pipeline finds soft contacts of the surface particles. Each pushes with stiffness k along its normal and
drags with Coulomb friction, lagged by one step; force and stiffness reach the cage through the weights, w^T f and
w^T S w, so the step stays one symmetric positive definite solve.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import newton
import warp as wp

from . import contact_kernels as kernels

if TYPE_CHECKING:
    from ..simulated_body import SimulatedBody


class ContactTerm:
    """Contact as a further linear term of a body's step; see ``elastic.LinearTerm``.

    Args:
        body: The body, with surface particles.
    """

    def __init__(self, body: SimulatedBody) -> None:
        self._body = body
        count = body.capacity.surface_points
        with wp.ScopedDevice(body.device):
            self._force = wp.zeros(count, dtype=wp.vec3)
            self._stiffness = wp.zeros(count, dtype=wp.mat33)
            self._damping = wp.zeros(count, dtype=wp.mat33)
            self._system = wp.zeros(count, dtype=wp.mat33)
            self._product = wp.zeros(count, dtype=wp.vec3)
            self._touching = wp.zeros(count, dtype=wp.int32)
            self._touching_count = wp.zeros(1, dtype=wp.int32)

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return self._force.size * (3 * 36 + 2 * 12 + 4)

    def collect(self, state: newton.State, contacts: newton.Contacts) -> None:
        """Sum the soft contacts of each surface point."""
        body, model = self._body, self._body.model
        for array in (self._force, self._stiffness, self._damping, self._touching_count):
            array.zero_()
        if model.shape_count == 0 or contacts.soft_contact_max == 0:
            return
        material = wp.vec3(model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu)
        wp.launch(
            kernels.collect_contacts,
            dim=contacts.soft_contact_max,
            inputs=[
                contacts.soft_contact_count,
                contacts.soft_contact_particle,
                contacts.soft_contact_shape,
                contacts.soft_contact_body_pos,
                contacts.soft_contact_body_vel,
                contacts.soft_contact_normal,
                body.surface_particles.start,
                body.point_count,
                state.particle_q,
                state.particle_qd,
                model.particle_radius,
                state.body_q,
                state.body_qd,
                model.body_com,
                model.shape_body,
                model.shape_material_ke,
                model.shape_material_kd,
                model.shape_material_mu,
                material,
                self._force,
                self._stiffness,
                self._damping,
            ],
            device=body.device,
        )
        wp.launch(
            kernels.list_touching,
            dim=body.capacity.surface_points,
            inputs=[body.point_count, self._stiffness, self._touching, self._touching_count],
            device=body.device,
        )

    def add_residual(self, dt: float, predicted: wp.array, residual: wp.array, blocks: wp.array) -> None:
        """Add contact to the residual and to the matrix's diagonal blocks."""
        self._launch_rows(
            kernels.find_contact_residual,
            [dt, predicted, self._force, self._stiffness, self._damping, self._system, self._product],
        )
        self._launch_vertices(kernels.scatter_contact_residual, [self._system, self._product, residual, blocks])

    def add_product(self, direction: wp.array, product: wp.array) -> None:
        """Add the product of the contact matrix with a direction."""
        self._launch_rows(kernels.find_contact_product, [direction, self._system, self._product])
        self._launch_vertices(kernels.scatter_contact_product, [self._product, product])

    def _launch_rows(self, kernel: wp.Kernel, inputs: list) -> None:
        body = self._body
        lists = [self._touching, self._touching_count, body.coordinates.weights_array, body.surface_row]
        wp.launch(
            kernel, dim=body.capacity.surface_points, inputs=[*lists, body.vertex_count, *inputs], device=body.device
        )

    def _launch_vertices(self, kernel: wp.Kernel, inputs: list) -> None:
        body = self._body
        lists = [self._touching, self._touching_count, body.coordinates.weights_array, body.surface_row]
        inputs = [*lists, body.vertex_count, body.fixed, *inputs]
        wp.launch(kernel, dim=body.capacity.vertices, inputs=inputs, device=body.device)
