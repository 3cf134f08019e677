# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on cuts: of stretched, spinning and falling bodies, slivers, and tips beside an edge."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ....elastic import Material
from ....section import Blade
from ..outcome import Outcome
from ..trial import Trial
from ..workbench import Workbench
from .starts import FRAME, MODELS

_STEPS = 10
"""Advances of a cut."""


def stretched(bench: Workbench, model: str, segments: int) -> Outcome:
    """A bar stretched three times between clamps is cut through; the error is the energy that the cut puts in."""
    material = Material(young=1.0e5, damping=0.02, model=model)
    trial = bench.bar(material, segments=segments, fixed=_ends, cuttable=True, quadrature=300)
    trial.place(trial.rest * (3.0, 1.0, 1.0), np.zeros_like(trial.rest))
    trial.run(60, FRAME)
    trial.begin()
    elastic = trial.energy()[0]
    given = _cut_through(trial, _across(0.5), steps_between=3)
    trial.run(30, FRAME)
    error = sum(max(energy, 0.0) for energy in given) / elastic
    note = f"most in one advance {100.0 * max(given) / elastic:.2g} %"
    return trial.outcome(error=error, against="no energy from the cut", note=note)


def spinning(bench: Workbench) -> Outcome:
    """A spinning, flying bar is cut through: the cut changes neither momentum; the error is that of both."""
    trial = bench.bar(Material(young=1.0e5), segments=2, cuttable=True, quadrature=150)
    center = trial.center()
    trial.place(trial.rest, np.cross((0.0, 3.0, 2.0), trial.rest - center) + (1.0, 2.0, 3.0))
    start, start_spin = trial.momentum(), trial.angular_momentum()
    _cut_through(trial, Blade((0.7, 0.0, 1.0), (0.0, 1.0, 0.0), (0.3, 0.0, -1.0)), steps_between=0)
    change = np.linalg.norm(trial.momentum() - start) / np.linalg.norm(start)
    spin_change = np.linalg.norm(trial.angular_momentum() - start_spin) / np.linalg.norm(start_spin)
    trial.begin()
    trial.run(60, FRAME)
    note = f"linear {change:.1e}, angular {spin_change:.1e}"
    return trial.outcome(free=True, error=float(max(change, spin_change)), against="momenta before", note=note)


def falling(bench: Workbench) -> Outcome:
    """A falling bar is cut through while it falls: it goes on falling as it did."""
    trial = bench.bar(Material(young=1.0e5), segments=2, cuttable=True, quadrature=150, gravity=(0.0, 0.0, -9.81))
    trial.run(30, FRAME)
    _cut_through(trial, _across(0.6), steps_between=3)
    trial.run(30, FRAME)
    expected = -9.81 * FRAME * trial.step_count
    speed = float(trial.momentum()[2] / trial.vertex_masses().sum())
    return trial.outcome(free=True, error=abs(speed / expected - 1.0), against="speed g t", note=f"{speed:.5g} m/s")


def sliver(bench: Workbench, model: str, thickness: float) -> Outcome:
    """A slice is cut off the end of a spinning bar; the error is that of its mass."""
    material = Material(young=1.0e5, model=model)
    trial = bench.bar(material, segments=1, cuttable=True, quadrature=80)
    trial.place(trial.rest, np.cross((0.0, 3.0, 0.0), trial.rest - trial.center()))
    _cut_through(trial, _across(1.0 - thickness), steps_between=0)
    return _with_mass(trial, "mass of the slice")


def light_piece(bench: Workbench, ratio: float) -> Outcome:
    """A corner is cut off that has a tiny part of the bar's mass; the error is that of its mass."""
    trial = bench.bar(Material(young=1.0e5), segments=2, cuttable=True, quadrature=150)
    normal, edge = np.full(3, 3.0**-0.5), np.array([1.0, -1.0, 0.0]) * 2.0**-0.5
    # A plane at distance h from a cube's corner cuts off the volume sqrt(3)/2 h^3.
    depth = (ratio * 0.04 * 2.0 / 3.0**0.5) ** (1.0 / 3.0)
    direction = -np.cross(normal, edge)
    blade = Blade(np.array([1.0, 0.1, 0.1]) - depth * normal - 2.0 * direction, edge, direction)
    trial.place(trial.rest, np.cross((0.0, 3.0, 0.0), trial.rest - trial.center()))
    _cut_through(trial, blade, steps_between=0)
    return _with_mass(trial, "mass of the corner")


def tip_beside_edge(bench: Workbench, model: str, distance: float) -> Outcome:
    """A cut ends just before it is through: nothing is thrown about by the vertices beside the edge."""
    material = Material(young=1.0e5, model=model)
    trial = bench.bar(material, segments=1, cuttable=True, quadrature=80)
    trial.place(trial.rest, np.cross((0.0, 3.0, 0.0), trial.rest - trial.center()))
    cut = trial.solver.begin_cut(0, _across(0.5))
    trial.solver.advance_cut(cut, to=cut.length - distance, states=trial.states)
    trial.begin()
    trial.run(100, FRAME)
    return trial.outcome(free=True)


def _with_mass(trial: Trial, against: str) -> Outcome:
    """Let pieces fly, and compare the mass of the smallest with its volume's."""
    piece = min(trial.solver.pieces(), key=lambda piece: piece.volume)
    mass = float(trial.vertex_masses()[piece.vertices].sum())
    trial.begin()
    trial.run(60, FRAME)
    share = piece.mass / trial.vertex_masses().sum()
    note = f"{share:.1e} of all mass; its kinetic mass is {mass / piece.mass:.3f} of its own"
    return trial.outcome(free=True, error=abs(mass / piece.mass - 1.0), against=against, note=note)


def _cut_through(trial: Trial, blade: Blade, *, steps_between: int) -> list[float]:
    """Cut through in several advances, with steps between; returns the energy that each advance put in [J]."""
    cut, given = trial.solver.begin_cut(0, blade), []
    for index in range(_STEPS):
        depth = cut.length * (index + 1) / _STEPS
        given.append(trial.solver.advance_cut(cut, to=depth, states=trial.states).energy_injected)
        trial.run(steps_between, FRAME)
    return given


def _across(place: float) -> Blade:
    """A blade from above, across the bar."""
    return Blade((place, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0))


def _ends(vertices: np.ndarray) -> np.ndarray:
    return np.flatnonzero((vertices[:, 0] < 1.0e-6) | (vertices[:, 0] > 1.0 - 1.0e-6))


ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = (
    *(
        (f"cut, stretched 3 times, {n} segments, {text}", partial(stretched, model=model, segments=n), n == 4)
        for n in (2, 4, 8)
        for model, text in MODELS.items()
    ),
    ("cut while spinning", spinning, True),
    ("cut while falling", falling, True),
    *(
        (f"sliver of {thickness:.0e} m, {text}", partial(sliver, model=model, thickness=thickness), thickness > 1e-4)
        for thickness in (1.0e-3, 1.0e-6)
        for model, text in MODELS.items()
    ),
    ("mass ratio 1e-3", partial(light_piece, ratio=1.0e-3), False),
    ("mass ratio 1e-6", partial(light_piece, ratio=1.0e-6), True),
    *(
        (f"tip 1e-6 m from an edge, {text}", partial(tip_beside_edge, model=model, distance=1.0e-6), True)
        for model, text in MODELS.items()
    ),
)
