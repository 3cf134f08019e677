# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Contact of a body's surface with Newton's shapes: implicit penalty forces, pulled back to the cage.

Newton's pipeline finds soft contacts of the surface particles. Each pushes with the mean stiffness of body and shape,
as in Newton's other solvers, and drags with Coulomb friction of the push at the start of the step; force and stiffness
reach the cage through the weights, w^T f and w^T S w, so the step stays one symmetric positive definite solve.

Firm contacts act already if their gap is closed by the end of the step, and are as much stiffer as stops a point's
share of the body's mass within its radius. What is deeper than that meets what bears its share of Young's modulus too,
and is pushed out at 1 m/s at most. Points that slide too fast to be stopped in the step are rubbed with a known force;
others as by a viscous one, which holds them.

A rigid body gives way: each of its n contacts is in series with an n-th of its inertia. What the contacts gave to the
cage in the step, with the sign turned, goes to ``body_f``, so the pair keeps its momentum.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import newton
import warp as wp

from ...elastic import make_point_forces
from . import contact_kernels
from .contact_arrays import (
    ContactModel,
    RigidResponse,
    contact_model,
    contact_state,
    make_contact_slots,
    soft_contacts,
)
from .self_contact import SelfContact

if TYPE_CHECKING:
    from ..body.simulated_body import SimulatedBody

_SLOTS = 2
"""Room for forces, in surface points: each may be pushed and given a force."""
_PAIRS = 4096
"""Most contacts of a body with itself."""


class ContactTerm:
    """Contact as forces on the surface points, which a body's step takes.

    Args:
        body: The body, with surface particles.
    """

    def __init__(self, body: SimulatedBody) -> None:
        self._body = body
        rows, room = body.surface_rows, body.capacity.surface_points
        definition = body.definition
        touches = definition.self_contact or definition.pieces_touch
        pairs = min(room, _PAIRS) if touches else 0
        self.points = make_point_forces(rows.weights, rows.first_row, _SLOTS * room + pairs, pairs=pairs)
        self._touching = SelfContact(body, pairs) if touches else None
        with wp.ScopedDevice(body.device):
            self.slots = make_contact_slots(room, _SLOTS * room)

    def collect(
        self, state: newton.State, contacts: newton.Contacts | None, response: RigidResponse, dt: float
    ) -> None:
        """List the forces on the surface points that act in a step.

        Args:
            state: State before the step.
            contacts: What the pipeline has found, if anything.
            response: How rigid bodies give way; their contacts are counted.
            dt: Time step [s].
        """
        body, points, slots, room = self._body, self.points, self.slots, self._body.capacity.surface_points
        model, now = self._model(), contact_state(state)
        rows, first, device = body.surface_rows, body.surface_particles.start, body.device
        inputs = [body.system.vertex_mass, rows, now, first, slots]
        wp.launch(contact_kernels.begin_contacts, dim=room, inputs=inputs, device=device)
        found = contacts is not None and body.model.shape_count > 0 and contacts.soft_contact_max > 0
        finding = [dt, soft_contacts(contacts), model, now, response, first, rows, slots] if found else []
        if found:
            wp.launch(contact_kernels.count_contacts, dim=contacts.soft_contact_max, inputs=finding, device=device)
        wp.utils.array_scan(slots.point_count, slots.point_first, inclusive=False)
        inputs = [rows, now, first, slots, points]
        wp.launch(contact_kernels.place_forces, dim=room, inputs=inputs, device=device)
        if found:
            wp.launch(contact_kernels.place_contacts, dim=contacts.soft_contact_max, inputs=finding, device=device)
            wp.launch(contact_kernels.sort_contacts, dim=room, inputs=[finding[1], slots], device=device)

    def _model(self) -> ContactModel:
        """What contact of the body reads of its model, as it is now."""
        body, definition = self._body, self._body.definition
        firmness = 0.0
        if body.config.contact == "firm":
            firmness = definition.material.young * definition.cage.diameter**2 / definition.contact_radius
        return contact_model(body.model, definition.contact_material, firmness)

    def refresh(self) -> None:
        """Follow an edit of the surface."""
        if self._touching is not None:
            self._touching.refresh()

    def fill(self, state: newton.State, contacts: newton.Contacts | None, response: RigidResponse, dt: float) -> None:
        """Find the forces, once the contacts of all bodies are counted; see :meth:`collect`."""
        if contacts is not None and self._body.model.shape_count > 0 and contacts.soft_contact_max > 0:
            self._fill(state, contacts, response, dt)
        if self._touching is not None:
            rows = self._body.surface_particles
            self._touching.collect(state.particle_q[rows], state.particle_qd[rows], self.points, dt)

    def _fill(self, state: newton.State, contacts: newton.Contacts, response: RigidResponse, dt: float) -> None:
        """Find the forces of the contacts with shapes."""
        body, model, now = self._body, self._model(), contact_state(state)
        inputs = [dt, soft_contacts(contacts), model, now, response, body.surface_particles.start, body.surface_rows]
        wp.launch(
            contact_kernels.fill_contacts,
            dim=self.slots.source.shape[0],
            inputs=[*inputs, self.slots, self.points],
            device=body.device,
        )

    def react(self, body_f: wp.array, response: RigidResponse, dt: float) -> None:
        """Add what the contacts of the last step do to rigid bodies.

        Args:
            body_f: Wrenches about the centres of mass [N, N m].
            response: How they gave way.
            dt: Time step [s].
        """
        inputs = [self._body.is_current, dt, self.slots, self.points, response, body_f]
        wp.launch(contact_kernels.react, dim=body_f.size, inputs=inputs, device=self._body.device)
