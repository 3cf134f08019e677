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

from ...elastic import make_point_forces
from . import contact_kernels
from .contact_arrays import contact_model, contact_state, soft_contacts

if TYPE_CHECKING:
    from ..body.simulated_body import SimulatedBody


class ContactTerm:
    """Contact as forces on the surface points, which a body's step takes.

    Args:
        body: The body, with surface particles.
    """

    def __init__(self, body: SimulatedBody) -> None:
        self._body = body
        rows = body.surface_rows
        self.points = make_point_forces(rows.weights, rows.first_row, body.capacity.surface_points)

    def collect(self, state: newton.State, contacts: newton.Contacts) -> None:
        """Sum the soft contacts of each surface point."""
        body, model, points = self._body, self._body.model, self.points
        for array in (points.force, points.stiffness, points.damping, points.count):
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
        wp.launch(
            contact_kernels.list_touching,
            dim=body.capacity.surface_points,
            inputs=[body.surface_rows, points],
            device=body.device,
        )
