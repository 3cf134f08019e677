# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The map: a spinning, trembling body over Young's modulus and time step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...elastic import Material
from .kept import KeptOutcomes
from .limits import limits_of
from .outcome import Outcome
from .rows.starts import MODELS
from .workbench import Workbench

_YOUNG = tuple(10.0**power for power in range(2, 11))
_TIME_STEPS = (1.0e-5, 1.0e-4, 1.0e-3, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 30.0, 1.0 / 10.0)
_MOST_STEPS, _LONGEST = 200, 1.0
_TREMBLE = 0.05
"""Random part of the velocities, of the fastest one."""


@dataclass(frozen=True, kw_only=True)
class Cell:
    """One place of the map.

    Args:
        young: Young's modulus [Pa].
        dt: Time step [s].
        outcome: What came out; the error is the share of the angular momentum that was lost or won.
    """

    young: float
    dt: float
    outcome: Outcome

    @property
    def kept(self) -> float | None:
        """Share of the angular momentum that is left; None if something holds the body."""
        return self.outcome.error if self.outcome.error is None else 1.0 - self.outcome.error


@dataclass(frozen=True, kw_only=True)
class Map:
    """The map of one material.

    Args:
        model: The material's model.
        young: Young's moduli [Pa], ascending.
        time_steps: Time steps [s], ascending.
        cells: A cell for each pair.
    """

    model: str
    young: tuple[float, ...]
    time_steps: tuple[float, ...]
    cells: dict[tuple[float, float], Cell]

    def failures(self) -> list[Cell]:
        """The cells out of the map's limits."""
        limits = limits_of("map")
        return [cell for cell in self.cells.values() if limits.failures(cell.outcome)]


def axes(*, quick: bool) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Young's moduli [Pa] and time steps [s] of the map."""
    return (_YOUNG[::2], _TIME_STEPS[0::2]) if quick else (_YOUNG, _TIME_STEPS)


def sweep(bench: Workbench, model: str, kept: KeptOutcomes, advance: Callable[[], None]) -> Map:
    """Make the map of one material.

    Args:
        bench: Where the body comes from.
        model: The material's model, one of ``MODELS``.
        kept: What is measured already.
        advance: Called after each cell.
    """
    young, time_steps = axes(quick=bench.quick)
    cells = {}
    for stiffness in young:
        for dt in time_steps:
            outcome, _ = kept.outcome(
                cell_name(model, stiffness, dt), lambda young=stiffness, dt=dt: (_cell(bench, model, young, dt), 0.0)
            )
            cells[stiffness, dt] = Cell(young=stiffness, dt=dt, outcome=outcome)
            advance()
    return Map(model=model, young=young, time_steps=time_steps, cells=cells)


def map_name(model: str) -> str:
    """The name of a map."""
    return f"map, {MODELS[model]}"


def cell_name(model: str, young: float, dt: float) -> str:
    """The name of a place of a map."""
    return f"{map_name(model)}, {young:g} Pa, {dt:g} s"


def _cell(bench: Workbench, model: str, young: float, dt: float) -> Outcome:
    """200 steps or a second of a body that turns once a second and trembles."""
    trial = bench.subject(Material(young=young, model=model))
    arms = trial.positions - trial.center()
    velocities = np.cross((0.0, 0.0, 2.0 * math.pi), arms)
    tremble = np.random.default_rng(0).normal(size=velocities.shape)
    velocities = velocities + _TREMBLE * np.abs(velocities).max() * tremble
    velocities[trial.held] = 0.0
    trial.place(velocities=velocities)
    start = trial.angular_momentum()
    trial.run(min(_MOST_STEPS, math.ceil(_LONGEST / dt - 1.0e-6)), dt)
    free = not trial.held.any() and not trial.gravity.any()
    lost = None
    if free:
        lost = 1.0 - float(trial.angular_momentum() @ start / (start @ start)) if trial.finite else math.nan
    return trial.outcome(free=free, error=lost, against="angular momentum")
