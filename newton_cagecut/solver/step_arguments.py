# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The arguments of a step, checked before anything is launched.

A step may be one of thousands a second: what was looked at once is known again by its identity, and the host only
compares references then.
"""

from __future__ import annotations

import weakref

import newton

from ..geometry import as_instance, as_number
from .body.edit_stamps import EditStamps

_SECONDS = (1.0e-9, 1.0e9)


class StepArguments:
    """Checks of what steps are passed.

    Args:
        model: The solver's model.
        stamps: The numbers of its bodies' edits, which know its states.
    """

    def __init__(self, model: newton.Model, stamps: EditStamps) -> None:
        self._model, self._stamps = model, stamps
        self._contacts: weakref.WeakSet[newton.Contacts] = weakref.WeakSet()

    def check(
        self,
        state_in: newton.State,
        state_out: newton.State,
        control: newton.Control | None,
        contacts: newton.Contacts | None,
        dt: float,
    ) -> float:
        """The time step, if the arguments are right.

        Args:
            state_in: State before the step.
            state_out: State after it.
            control: Newton's control, or None.
            contacts: Contacts of the model, or None.
            dt: Time step [s].

        Raises:
            TypeError: An argument has the wrong type.
            ValueError: The time step is out of its range, or states or contacts are of another model.
        """
        seconds = as_number(dt, "SolverCageCut.step dt")
        if not _SECONDS[0] <= seconds <= _SECONDS[1]:
            raise ValueError(f"SolverCageCut.step dt must be a positive number of seconds, 1e-9 to 1e9, got {seconds}")
        self._stamps.require_own(state_in, "state_in")
        if state_out is not state_in:
            self._stamps.require_own(state_out, "state_out")
        if control is not None:
            as_instance(control, newton.Control, "control", hint="or None")
        if contacts is not None:
            as_instance(contacts, newton.Contacts, "contacts", hint="CollisionPipeline(model).contacts() makes some")
            if contacts not in self._contacts:
                self._check_contacts(contacts)
                self._contacts.add(contacts)
        return seconds

    def _check_contacts(self, contacts: newton.Contacts) -> None:
        """Refuse contacts that cannot be of the model: they have room for more pairs than it has."""
        model, device = self._model, contacts.soft_contact_count.device
        if device != model.device:
            raise ValueError(
                f"contacts are on {device}, the model on {model.device}; make them of the model's pipeline"
            )
        pairs = (model.particle_count + model.edge_count + model.tri_count) * model.shape_count
        found = contacts.soft_contact_tids.size
        if found > pairs:
            raise ValueError(
                f"contacts are of another model: they are for {found} pairs of a particle and a shape, this one has at "
                f"most {pairs}; pass those of CollisionPipeline(model).contacts()"
            )
