# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on error against time a step: one bar pushed at its tip, by this solver and by Newton's on tetrahedra."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from ....elastic import Material
from ..answers.book_answers import tip_deflection
from ..outcome import Outcome
from ..workbench import BAR, Workbench
from .tetrahedra import SOLVERS, Grid

_DT = 1.0 / 240.0
_STEPS, _LEFT_OUT = 720, 240
_FORCE = 0.01 * 1.0e6 * BAR[1] * BAR[2] * (BAR[1] / BAR[0]) ** 2
"""Force at the tip [N]."""
_AGAINST = "Timoshenko"
_POISSON = (0.3, 0.499)


def ours(bench: Workbench, poisson: float, segments: int, strain: str) -> Outcome:
    """Three seconds of a cage body; the deflection is the mean of the last two."""
    material = Material(young=1.0e6, poisson=poisson)
    points = {"walks": 256, "quadrature": 40 * segments}
    trial = bench.bar(material, segments=segments, fixed=_clamped, key="clamped", strain=strain, **points)
    rest = trial.rest
    tip, force, course = rest[:, 0] > BAR[0] - 1.0e-6, np.zeros_like(rest), []
    force[tip, 2] = _FORCE / tip.sum()
    trial.run(_STEPS, _DT, force=force, watch=lambda: course.append((trial.positions - rest)[tip, 2].mean()))
    error, note = _judged(course, poisson)
    note = f"{note}; {len(rest)} vertices"
    return trial.outcome(energy_gain=None, error=error, against=_AGAINST, note=note)


def theirs(bench: Workbench, solver: str, poisson: float, cells: tuple[int, int, int], iterations: int) -> Outcome:
    """The same of tetrahedra."""
    material = Material(young=1.0e6, poisson=poisson)
    grid = Grid(cells, BAR, material, clamped=True, iterations=iterations, solver=solver)
    rest = grid.positions
    tip, force, course = rest[:, 0] > BAR[0] - 1.0e-6, np.zeros((len(rest), 3), dtype=np.float32), []
    force[tip, 2] = _FORCE / tip.sum()
    for _ in range(_STEPS):
        grid.run(1, _DT, force)
        course.append((grid.positions - rest)[tip, 2].mean())
    error, note = _judged(course, poisson)
    return grid.outcome(error, _AGAINST, note)


def _judged(course: Sequence[float], poisson: float) -> tuple[float, str]:
    """Error of the mean deflection after the first second, and what it is."""
    expected = tip_deflection(_FORCE, size=BAR, young=1.0e6, poisson=poisson)
    ratio = float(np.mean(course[_LEFT_OUT:])) / expected
    return abs(ratio - 1.0), f"{ratio:.3f} of it"


def _clamped(vertices: np.ndarray) -> np.ndarray:
    return np.flatnonzero(vertices[:, 0] < 1.0e-6)


ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = (
    *(
        (
            f"SolverCageCut{text}: pushed, Poisson {poisson}, {segments} segments",
            partial(ours, poisson=poisson, segments=segments, strain=strain),
            False,
        )
        for strain, text in (("points", ""), ("averaged", " with averaged strain"))
        for poisson in _POISSON
        for segments in (2, 4, 8, 16)
    ),
    *(
        (
            f"{solver}: pushed, Poisson {poisson}, {' x '.join(map(str, cells))} cells, {iterations} iterations",
            partial(theirs, solver=solver, poisson=poisson, cells=cells, iterations=iterations),
            False,
        )
        for poisson in _POISSON
        for solver in SOLVERS
        for cells in ((5, 1, 1), (10, 2, 2), (20, 4, 4))
        for iterations in (10, 40)
    ),
)
