# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Snapshots of a body, so that its cuts can be undone.

The paper only cuts. A snapshot holds what cuts change: the coordinates, the surface, the quadrature, the rows of model
and states that belong to the body, and where its cuts were.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import newton
import warp as wp

from ..body import CageBody
from .body_cut import BodyCut


class BodySnapshot:
    """A body at one time; made by ``SolverCageCut.snapshot``.

    Args:
        body: The body.
        states: States whose rows of the body are to be brought back too.
        cuts: Cuts of the body that are to go on from where they are.
    """

    def __init__(self, body: CageBody, states: Sequence[newton.State], cuts: Sequence[BodyCut]) -> None:
        self._body, self._surface = body, body.surface
        self._coordinates = body.coordinates.snapshot()
        self._quadrature = copy.deepcopy(body._quadrature)
        self._arrays = [(array, wp.clone(array)) for array in self._changing(states)]
        self._cuts = [(cut, cut.cut, cut._surface_cut) for cut in cuts]

    def _changing(self, states: Sequence[newton.State]) -> list[wp.array]:
        body = self._body
        arrays = [body.rest, body.fixed, body.vertex_count]
        parts = [body.vertices, body.surface_particles] if body.has_contact else [body.vertices]
        arrays += [array[part] for s in states for array in (s.particle_q, s.particle_qd) for part in parts]
        if body.has_contact:
            arrays.append(body.model.particle_flags[body.surface_particles])
        if body.system is not None:
            arrays.append(body.system.volumes)
        return arrays

    def restore(self) -> None:
        """Bring everything back; it can be done any number of times."""
        body = self._body
        body.coordinates.restore(self._coordinates)
        body._quadrature = copy.deepcopy(self._quadrature)
        body.set_surface(self._surface)
        for array, kept in self._arrays:
            wp.copy(array, kept)
        for cut, cage_cut, surface_cut in self._cuts:
            cut.cut, cut._surface_cut = cage_cut, surface_cut
        body.refresh()
