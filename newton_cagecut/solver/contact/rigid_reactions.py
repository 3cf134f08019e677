# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Contact of all bodies of a solver with rigid bodies: how those give way, and what they take."""

from __future__ import annotations

from typing import TYPE_CHECKING

import newton
import warp as wp

from .contact_arrays import RigidResponse

if TYPE_CHECKING:
    from ..body.simulated_body import SimulatedBody


class RigidReactions:
    """Contact terms of the bodies of one solver, which share what they touch; only launches kernels.

    Args:
        model: The model.
        bodies: The solver's bodies.
    """

    def __init__(self, model: newton.Model, bodies: list[SimulatedBody]) -> None:
        self._bodies = [body for body in bodies if body.contact is not None]
        count = model.body_count if self._bodies else 0
        self.response = RigidResponse()
        with wp.ScopedDevice(model.device):
            self.response.twist = wp.zeros(count, dtype=wp.spatial_vector)
            self.response.share = wp.ones(count, dtype=float)
            self.response.count = wp.zeros(count, dtype=wp.int32)

    def collect(self, state: newton.State, contacts: newton.Contacts | None, dt: float) -> None:
        """Find the forces on surface points that act in a step.

        Args:
            state: State before the step.
            contacts: What the pipeline has found, if anything.
            dt: Time step [s].
        """
        if self.response.count.size:
            self.response.count.zero_()
            wp.copy(self.response.twist, state.body_qd)
        for body in self._bodies:
            body.contact.collect(state, contacts, self.response, dt)
        for body in self._bodies:
            body.contact.fill(state, contacts, self.response, dt)

    def react(self, state: newton.State, dt: float) -> None:
        """Add what the contacts of the step did to ``body_f`` of the state before it.

        Args:
            state: State before the step.
            dt: Time step [s].
        """
        if self.response.count.size and state.body_f is not None:
            for body in self._bodies:
                body.contact.react(state.body_f, self.response, dt)
