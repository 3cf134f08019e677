# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A cut of a body as a model edit: cage, weights, surface, states and masses, all or nothing.

An advance first prepares all that changes nothing: the cage and the surface after it, whether they fit, and what new
vertices inherit. Then it commits, with a journal of what it overwrites.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import newton
import numpy as np

from ...cage import CageEdit, Cut
from ...harmonic import Journal, PointChange, UpdateStats
from ...section import Blade
from ...surface import SurfaceCut, SurfaceEdit
from ..body.simulated_body import SimulatedBody
from .cut_report import Clock, CutReport
from .edited_states import checked_states
from .motion_fit import MotionFit
from .transfer import Transfer


class BodyCut:
    """A blade on its way through a body; made by ``SolverCageCut.begin_cut``.

    Args:
        body: The body.
        blade: The blade in the cage's rest frame.
    """

    def __init__(self, body: SimulatedBody, blade: Blade) -> None:
        if not body.definition.cuttable:
            raise ValueError(f"{body.label} was added with cuttable=False; it keeps no walk cache to cut with")
        self._body = body
        self.cut = Cut(body.cage, blade)
        """The cut of the cage."""
        self._surface_cut = SurfaceCut(body.surface, self.cut.plane, self.cut.wall, window=self.cut.window)

    @property
    def body(self) -> SimulatedBody:
        """The body that is cut, as the solver holds it."""
        return self._body

    @property
    def label(self) -> str:
        """Name of the body."""
        return self._body.label

    @property
    def depth(self) -> float:
        """Depth from where the blade first touches [m]."""
        return self.cut.depth

    @property
    def length(self) -> float:
        """Depth at which the cut is complete [m]; 0 when the blade misses."""
        return self.cut.length

    @property
    def complete(self) -> bool:
        """Whether nothing is left to cut."""
        return self.cut.complete

    def turn(self, direction: np.ndarray) -> None:
        """Turn the blade about its present front line, in the cage's rest frame; see ``Cut.turn``."""
        cut, surface_cut = self._resumed()
        cut.turn(direction)
        surface_cut.go_on(cut.plane, cut.wall, hinged=cut.hinged)
        self.cut, self._surface_cut = cut, surface_cut

    def advance(self, to: float, states: Sequence[newton.State]) -> CutReport:
        """Advance the blade to a depth [m] and carry the body's data over, in the given states too."""
        body, clock = self._body, Clock()
        states = checked_states(body, states)
        cut, surface_cut = self._resumed()
        edit = cut.advance(to=to)
        clock.lap("topology")
        if edit.is_empty:
            self.cut, self._surface_cut = cut, surface_cut
            energy = _total_energy(body, states)
            stats = UpdateStats(body.coordinates.walks * body.coordinates.point_count)
            return _report(cut, edit, 0, stats, clock, (energy, energy))
        surface_edit = surface_cut.advance(edit.front)
        body.capacity.require(edit.cage, surface_edit.surface)
        clock.lap("surface")
        before = _total_energy(body, states)
        transfer, motion = Transfer(body, edit), MotionFit(body, states)
        clock.lap("transfer")
        with Journal() as journal:
            journal.keep_attributes(self, "cut", "_surface_cut")
            body.keep(journal, states)
            stats = self._update_weights(edit, surface_edit, journal)
            clock.lap("coordinates")
            self.cut, self._surface_cut = cut, surface_cut
            transfer.apply(states)
            body.set_surface(surface_edit.surface)
            body.refresh()
            motion.apply(transfer.piece_before, journal)
            body.commit_edit(body.definition.last_edit + 1, states)
            after = _total_energy(body, states)
        clock.lap("transfer")
        return _report(cut, edit, len(surface_edit.created), stats, clock, (before, after))

    def _resumed(self) -> tuple[Cut, SurfaceCut]:
        """Copies of the cuts of cage and surface, gone on to the body as it is."""
        body, cut, surface_cut = self._body, copy.copy(self.cut), copy.copy(self._surface_cut)
        if cut.cage is not body.cage:
            cut.resume(body.cage)
            surface_cut.go_on(cut.plane, cut.wall, surface=body.surface, hinged=cut.hinged, window=cut.window)
        return cut, surface_cut

    def _update_weights(self, edit: CageEdit, surface_edit: SurfaceEdit, journal: Journal) -> UpdateStats:
        """Bring weights up to date, of the surface's changed points and of quadrature points in new pieces too."""
        body, surface = self._body, surface_edit.surface
        changed = np.concatenate([surface_edit.created, surface_edit.moved])
        points = None
        if len(changed):
            places = body.nudged_sites(surface, changed)
            points = PointChange(body.surface_row + changed, places, surface.site_key[changed])
        stats = body.coordinates.update(edit, points=points, journal=journal)
        if edit.cage.piece_count > edit.before.piece_count:
            body.distribute_quadrature(journal)
        return stats


def _report(
    cut: Cut, edit: CageEdit, points_created: int, stats: UpdateStats, clock: Clock, energies: tuple[float, float]
) -> CutReport:
    return CutReport(
        depth=cut.depth,
        complete=cut.complete,
        piece_count=edit.cage.piece_count,
        separated=edit.separated,
        vertices_created=len(edit.created),
        points_created=points_created,
        stats=stats,
        seconds=clock.seconds,
        energy_before=energies[0],
        energy_after=energies[1],
    )


def _total_energy(body: SimulatedBody, states: Sequence[newton.State]) -> float:
    return float(sum(body.energy(states[0]))) if states else 0.0
