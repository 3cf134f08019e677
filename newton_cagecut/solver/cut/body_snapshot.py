# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Snapshots of a body, so that its cuts can be undone.

The paper only cuts. A snapshot holds what cuts change: the coordinates, the surface, the quadrature, the rows of model
and states that belong to the body, and where its cuts were.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import newton
import warp as wp

from ...geometry import as_sequence
from ...harmonic import Journal
from ..body.simulated_body import SimulatedBody
from .body_cut import BodyCut
from .edited_states import checked_states


class BodySnapshot:
    """A body at one time; made by ``SolverCageCut.snapshot``.

    Args:
        body: The body.
        states: States whose rows of the body are to be brought back too.
        cuts: Cuts of the body that are to go on from where they are.
    """

    def __init__(self, body: SimulatedBody, states: Sequence[newton.State], cuts: Sequence[BodyCut]) -> None:
        self._body, self._states = body, checked_states(body, states)
        for number, cut in enumerate(as_sequence(cuts, BodyCut, "cuts")):
            if cut.body is not body:
                raise ValueError(f"cuts[{number}] is of another body than {body.label}; snapshot that one too")
        self._surface, self._definition, self._quadrature = body.surface, body.definition, body.quadrature
        self._coordinates = body.coordinates.snapshot()
        self._arrays = [(array, wp.clone(array)) for array in body.edited_arrays(self._states)]
        self._cuts = [(cut, cut.cut, cut._surface_cut) for cut in cuts]

    @property
    def body(self) -> SimulatedBody:
        """The body, as the solver holds it."""
        return self._body

    @property
    def label(self) -> str:
        """Name of the body."""
        return self._body.label

    @property
    def states(self) -> tuple[newton.State, ...]:
        """The states whose rows are brought back."""
        return self._states

    def restore(self) -> None:
        """Bring everything back, all or nothing; it can be done any number of times."""
        body = self._body
        body.require_own_edits()
        with Journal() as journal:
            for cut, _, _ in self._cuts:
                journal.keep_attributes(cut, "cut", "_surface_cut")
            body.keep(journal, self._states)
            body.coordinates.restore(self._coordinates, journal=journal)
            for cut, cage_cut, surface_cut in self._cuts:
                cut.cut, cut._surface_cut = cage_cut, surface_cut
            body.surface, body.quadrature = self._surface, self._quadrature
            for array, kept in self._arrays:
                wp.copy(array, kept)
            last = body.definition.last_edit
            body.definition = replace(self._definition, last_edit=last)
            body.model.cagecut.definition[body.row] = body.definition
            body.refresh()
