# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A cut of a body as a model edit: cage, weights, surface, states and masses, all or nothing.

New cage vertices take position and velocity from the deformed shape at their rest position, an advancing tip those of
its new rest position. Displacements from rest are what is interpolated, so a body at rest stays at rest exactly.
"""

from __future__ import annotations

import copy
import time
from collections.abc import Sequence

import newton
import numpy as np

from ...cage import CageEdit, Cut
from ...harmonic import UpdateStats
from ...section import Blade
from ...surface import SurfaceCut, SurfaceEdit
from ..body import CageBody
from .cut_report import CutReport

_TRANSFER_WALKS = 4096
_HELD = 0.999
_NUDGE = 1.0e-6


class BodyCut:
    """A blade on its way through a body; made by ``SolverCageCut.begin_cut``.

    Args:
        body: The body.
        blade: The blade in the cage's rest frame.
    """

    def __init__(self, body: CageBody, blade: Blade) -> None:
        if not body.definition.cuttable:
            raise ValueError(f"{body.label} was added with cuttable=False; it keeps no walk cache to cut with")
        self.body = body
        self.cut = Cut(body.cage, blade)
        self._surface_cut = SurfaceCut(body.surface, self.cut.plane, self.cut.wall, window=self.cut.window)

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

    def _resumed(self) -> tuple[Cut, SurfaceCut]:
        """Copies of the cuts of cage and surface, gone on to the body as it is."""
        body, cut, surface_cut = self.body, copy.copy(self.cut), copy.copy(self._surface_cut)
        if cut.cage is not body.cage:
            cut.resume(body.cage)
            surface_cut.go_on(cut.plane, cut.wall, surface=body.surface, hinged=cut.hinged, window=cut.window)
        return cut, surface_cut

    def advance(self, to: float, states: Sequence[newton.State]) -> CutReport:
        """Advance the blade to a depth [m] and carry the body's data over, in the given states too."""
        body = self.body
        _check_states(body, states)
        seconds: dict[str, float] = {}
        clock = _Clock(seconds)
        cut, surface_cut = self._resumed()
        edit = cut.advance(to=to)
        clock.lap("topology")
        surface_edit = surface_cut.advance(edit.front) if edit.cage is not edit.before else _no_change(body)
        body.capacity.require(edit.cage, surface_edit.surface)
        clock.lap("surface")
        energy_before = _total_energy(body, states)
        transfer = _Transfer(body, edit)
        clock.lap("transfer")
        stats = self._update_weights(edit, surface_edit)
        if edit.cage.piece_count > edit.before.piece_count:
            body.distribute_quadrature()
        clock.lap("coordinates")
        self.cut, self._surface_cut = cut, surface_cut
        transfer.apply(states)
        body.set_surface(surface_edit.surface)
        body.refresh()
        if body.has_contact:
            for state in states:
                body.embed_particles(state)
        clock.lap("transfer")
        return CutReport(
            depth=cut.depth,
            complete=cut.complete,
            components=edit.cage.piece_count,
            separated=edit.separated,
            vertices_created=len(edit.created),
            points_created=len(surface_edit.created),
            stats=stats,
            seconds=seconds,
            energy_before=energy_before,
            energy_after=_total_energy(body, states),
        )

    def _update_weights(self, edit: CageEdit, surface_edit: SurfaceEdit) -> UpdateStats:
        body = self.body
        stats = body.coordinates.update(edit)
        changed = np.concatenate([surface_edit.created, surface_edit.moved])
        if len(changed):
            surface = surface_edit.surface
            # Off the other cuts that a point may lie on, into its own piece: faces that meet there are told apart.
            nudge = _NUDGE * edit.cage.diameter * surface.directions_inward(changed)
            added = body.coordinates.set_points(
                body.surface_row + changed, surface.points[changed] + nudge, surface.point_key[changed]
            )
            stats.seconds["new_points"] = added.total_seconds
        return stats


class _Clock:
    """Adds the time since the last lap to a part."""

    def __init__(self, seconds: dict[str, float]) -> None:
        self._seconds, self._last = seconds, time.perf_counter()

    def lap(self, part: str) -> None:
        now = time.perf_counter()
        self._seconds[part] = self._seconds.get(part, 0.0) + now - self._last
        self._last = now


class _Transfer:
    """What new and moved cage vertices inherit, worked out on the cage before the edit."""

    def __init__(self, body: CageBody, edit: CageEdit) -> None:
        self._body = body
        self._vertices = np.concatenate([edit.created, edit.moved])
        self._vertex_count = edit.cage.vertex_count
        points = edit.cage.vertices[self._vertices]
        self._on_face = edit.source_faces >= 0
        keys = np.where(self._on_face, edit.before.face_key[edit.source_faces], -1)
        self._rest = body.to_world(points)
        self._weights = np.zeros((0, edit.before.vertex_count))
        if len(points):
            weights = body.coordinates.weights_at(points, keys, walks=_TRANSFER_WALKS)
            self._weights = weights.astype(np.float64)

    def apply(self, states: Sequence[newton.State]) -> None:
        """Write the vertices' rest positions, constraints, positions and velocities."""
        body, count = self._body, self._weights.shape[1]
        body.vertex_count.fill_(self._vertex_count)
        if not len(self._vertices):
            return
        rest, fixed = body.rest.numpy(), body.fixed.numpy()
        old_rest = rest[:count].astype(np.float64)
        rest[self._vertices] = self._rest
        new_rest = rest[self._vertices].astype(np.float64)
        for state in states:
            for field, start in (("particle_q", old_rest), ("particle_qd", np.zeros_like(old_rest))):
                array = getattr(state, field)[body.vertices]
                rows = array.numpy()
                change = self._weights @ (rows[:count] - start)
                rows[self._vertices] = new_rest + change if field == "particle_q" else change
                array.assign(rows)
        fixed[self._vertices] = self._on_face & (self._weights @ (fixed[:count] != 0) > _HELD)
        body.rest.assign(rest)
        body.fixed.assign(fixed)


def _check_states(body: CageBody, states: Sequence[newton.State]) -> None:
    count = body.model.particle_count
    for number, state in enumerate(states):
        for name in ("particle_q", "particle_qd"):
            array = getattr(state, name, None)
            if array is None:
                raise TypeError(f"states[{number}] must be a state with particles, got {type(state).__name__}")
            if array.shape != (count,):
                raise ValueError(
                    f"states[{number}].{name} has the shape {array.shape}, the model has {count} particles; pass "
                    "states of the body's own model"
                )


def _no_change(body: CageBody) -> SurfaceEdit:
    none = np.zeros(0, dtype=np.int64)
    return SurfaceEdit(body.surface, body.surface, none, none)


def _total_energy(body: CageBody, states: Sequence[newton.State]) -> float:
    return float(sum(body.energy(states[0]))) if states else 0.0
