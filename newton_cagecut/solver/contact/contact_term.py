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

from ...elastic import TermScales
from . import contact_kernels
from .contact_arrays import contact_model, contact_state, make_touched_points, soft_contacts

if TYPE_CHECKING:
    from ..body.simulated_body import SimulatedBody


class ContactTerm:
    """Contact as a further linear term of a body's step; see ``elastic.LinearTerm``.

    Args:
        body: The body, with surface particles.
    """

    def __init__(self, body: SimulatedBody) -> None:
        self._body = body
        self.points = make_touched_points(body.capacity.surface_points, body.device)

    def collect(self, state: newton.State, contacts: newton.Contacts) -> None:
        """Sum the soft contacts of each surface point."""
        body, model, points = self._body, self._body.model, self.points
        for array in (points.force, points.stiffness, points.damping, points.touching_count):
            array.zero_()
        if model.shape_count == 0 or contacts.soft_contact_max == 0:
            return
        wp.launch(
            contact_kernels.collect_contacts,
            dim=contacts.soft_contact_max,
            inputs=[
                soft_contacts(contacts),
                contact_model(model),
                contact_state(state),
                body.surface_particles.start,
                body.surface_rows,
                points,
            ],
            device=body.device,
        )
        self._launch_points(contact_kernels.list_touching, [])

    def add_residual(
        self, scales: TermScales, guess: wp.array, earlier: wp.array, residual: wp.array, blocks: wp.array
    ) -> None:
        """Add contact to the residual and to the matrix's diagonal blocks."""
        self._launch_points(contact_kernels.find_contact_residual, [wp.vec3(*scales), guess, earlier])
        self._launch_vertices(contact_kernels.add_contact_residual, [residual, blocks])

    def add_product(self, direction: wp.array, product: wp.array) -> None:
        """Add the product of the contact matrix with a direction."""
        self._launch_points(contact_kernels.find_contact_product, [direction])
        self._launch_vertices(contact_kernels.add_contact_product, [product])

    def _launch_points(self, kernel: wp.Kernel, inputs: list) -> None:
        """One launch over the surface's points."""
        body = self._body
        inputs = [*inputs, body.surface_rows, self.points]
        wp.launch(kernel, dim=body.capacity.surface_points, inputs=inputs, device=body.device)

    def _launch_vertices(self, kernel: wp.Kernel, results: list[wp.array]) -> None:
        """One launch over the cage's vertices, which adds to results."""
        body = self._body
        inputs = [body.fixed, body.surface_rows, self.points, *results]
        wp.launch(kernel, dim=body.capacity.vertices, inputs=inputs, device=body.device)
