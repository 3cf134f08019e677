# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on small deformations, against beams and finite elements: deflections, torsion, frequencies, an edge crack."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from ....elastic import Material
from ....section import Blade
from ..answers.book_answers import bending_mode, tip_deflection
from ..answers.solid_answers import ELEMENTS, bar_deflection, bracket_deflection, crack_opening, torsion_energy
from ..outcome import Outcome
from ..trial import Trial
from ..workbench import BAR, BRACKET, Workbench

YOUNG, DENSITY = 1.0e6, 1000.0
_FLAT_BAR = (1.0, 0.1, 0.3)
_SLOW = 10.0
"""A time step so long that inertia says nothing [s]."""

_TURN = 1.0e-3
"""Angle between the ends of a bar under torsion [rad]."""


def cantilever(bench: Workbench, poisson: float, segments: int, strain: str) -> Outcome:
    """The tip of a clamped bar under a small force across it."""
    force, deflection, trial = _bent(bench, poisson, segments, BAR, 2, strain)
    expected = tip_deflection(force, size=BAR, young=YOUNG, poisson=poisson)
    return _against(trial, deflection, expected, "Timoshenko")


def flat_cantilever(bench: Workbench, poisson: float, segments: int, axis: int, strain: str) -> Outcome:
    """The same with a flat bar, along its thin side or its wide one."""
    force, deflection, trial = _bent(bench, poisson, segments, _FLAT_BAR, axis, strain)
    return _against(trial, deflection, force / YOUNG * bar_deflection(_FLAT_BAR, poisson, axis), ELEMENTS)


def torsion(bench: Workbench, poisson: float, segments: int, strain: str) -> Outcome:
    """A bar between held ends that are turned against each other: the moment, by the elastic energy."""
    material = Material(young=YOUNG, poisson=poisson)
    trial = bench.bar(material, segments=segments, fixed=_ends, key="ends", strain=strain, **_fine(segments))
    turned = trial.rest.copy()
    end = turned[:, 0] > BAR[0] - 1.0e-6
    turned[end, 1:] += _TURN * np.stack([-turned[end, 2], turned[end, 1]], axis=1)
    trial.place(turned, np.zeros_like(turned))
    trial.run(20, _SLOW)
    expected = YOUNG * torsion_energy(BAR, poisson, _TURN)
    # The energy is that of a moment; a body that is too stiff has too much of it, and would turn too little.
    return _against(trial, expected, trial.energy()[0], f"{ELEMENTS}, turn under a moment")


def bracket(bench: Workbench, poisson: float, segments: int, axis: int, strain: str) -> Outcome:
    """An L, clamped at one end, under a small force at the other."""
    material = Material(young=YOUNG, poisson=poisson)
    trial = bench.bracket(material, segments, fixed=_clamped, strain=strain, **_fine(2 * segments))
    tip = trial.rest[:, 2] > sum(BRACKET) - 1.0e-6
    force = 1.0e-4 * YOUNG * BRACKET[1] ** 2
    expected = force / YOUNG * bracket_deflection(*BRACKET, poisson, axis)
    return _against(trial, _pushed(trial, tip, axis, force), expected, ELEMENTS)


def frequency(bench: Workbench, bending: bool, segments: int, strain: str) -> Outcome:
    """A free bar in its first axial or bending mode, in steps of a hundredth of a period."""
    material = Material(young=YOUNG, poisson=0.3, density=DENSITY)
    trial = bench.bar(material, segments=segments, strain=strain, **_fine(segments))
    rest, masses, length = trial.rest, trial.vertex_masses(), BAR[0]
    shape = np.zeros_like(rest)
    if bending:
        expected, deflection, turn = bending_mode(BAR, YOUNG, 0.3, DENSITY)
        nodes = np.linspace(0.0, length, len(deflection))
        shape[:, 2] = np.interp(rest[:, 0], nodes, deflection)
        shape[:, 0] = -rest[:, 2] * np.interp(rest[:, 0], nodes, turn)
    else:
        expected = math.sqrt(YOUNG / DENSITY) / (2.0 * length)
        shape[:, 0] = np.cos(np.pi * rest[:, 0] / length)
    trial.place(rest + 1.0e-3 * shape / np.abs(shape).max(), np.zeros_like(rest))
    dt, course = 0.01 / expected, []
    trial.run(250, dt, watch=lambda: course.append(float(masses @ ((trial.positions - rest) * shape).sum(axis=1))))
    crossings = _zeros(np.array(course))
    if len(crossings) < 3:
        return trial.outcome(free=True, error=math.inf, against="beam", note="no whole period was seen")
    found = (len(crossings) - 1) / 2.0 / ((crossings[-1] - crossings[0]) * dt)
    return _against(trial, found, expected, "Timoshenko" if bending else "sqrt(E / rho) / 2 L", free=True)


def edge_crack(bench: Workbench, segments: int, strain: str) -> Outcome:
    """A bar cut half through in its middle, its ends pulled apart: how far the cut opens."""
    material = Material(young=YOUNG, poisson=0.3)
    trial = bench.bar(material, segments=segments, fixed=_ends, cuttable=True, strain=strain, walks=128, quadrature=300)
    cut = trial.solver.begin_cut(0, Blade((0.5, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)))
    trial.solver.advance_cut(cut, to=0.5 * BAR[2], states=trial.states)
    rest, pull = trial.rest, 1.0e-3
    trial.place(rest + pull * np.where(rest[:, :1] > 1.0 - 1.0e-6, 1.0, 0.0) * (1.0, 0.0, 0.0), np.zeros_like(rest))
    trial.run(20, _SLOW)
    mouth = (np.abs(rest[:, 0] - 0.5) < 1.0e-5) & (rest[:, 2] > 0.5 * BAR[2] - 1.0e-6)
    opening = float(np.ptp((trial.positions - rest)[mouth, 0])) / pull
    return _against(trial, opening, crack_opening(BAR, 0.3), ELEMENTS)


def _fine(segments: int) -> dict[str, int]:
    """Walks and quadrature points that a bar of so many segments is measured with."""
    return {"walks": 256, "quadrature": max(300, 40 * segments)}


def _bent(
    bench: Workbench, poisson: float, segments: int, size: tuple[float, float, float], axis: int, strain: str
) -> tuple[float, float, Trial]:
    """A clamped bar under a force at its tip: the force [N], how far the tip goes [m], and the bar."""
    material = Material(young=YOUNG, poisson=poisson)
    trial = bench.bar(
        material, segments=segments, size=size, fixed=_clamped, key="clamped", strain=strain, **_fine(segments)
    )
    force = 0.01 * YOUNG * size[1] * size[2] * (min(size[1:]) / size[0]) ** 2
    return force, _pushed(trial, trial.rest[:, 0] > size[0] - 1.0e-6, axis, force), trial


def _pushed(trial: Trial, tip: np.ndarray, axis: int, force: float) -> float:
    """How far some vertices go when a force acts on them [m]."""
    forces = np.zeros_like(trial.rest)
    forces[tip, axis] = force / tip.sum()
    trial.run(10, _SLOW, force=forces)
    return float((trial.positions - trial.rest)[tip, axis].mean())


def _against(trial: Trial, found: float, expected: float, against: str, *, free: bool = False) -> Outcome:
    ratio = found / expected
    note = f"{found:.4g}, {ratio:.3f} of {expected:.4g}"
    return trial.outcome(free=free, energy_gain=None, error=abs(ratio - 1.0), against=against, note=note)


def _zeros(course: np.ndarray) -> np.ndarray:
    """Where a sampled course crosses zero, in samples."""
    before = np.flatnonzero(np.diff(np.sign(course)) != 0)
    return before + course[before] / (course[before] - course[before + 1])


def _clamped(vertices: np.ndarray) -> np.ndarray:
    return np.flatnonzero(vertices[:, 0] < 1.0e-6)


def _ends(vertices: np.ndarray) -> np.ndarray:
    return np.flatnonzero((vertices[:, 0] < 1.0e-6) | (vertices[:, 0] > 1.0 - 1.0e-6))


_ROWS: tuple[tuple[str, Callable[..., Outcome], bool], ...] = (
    *(
        (f"cantilever, 8 segments, Poisson {poisson}", partial(cantilever, poisson=poisson, segments=8), True)
        for poisson in (0.0, 0.3, 0.45, 0.49, 0.499)
    ),
    *(
        (f"cantilever, 16 segments, Poisson {poisson}", partial(cantilever, poisson=poisson, segments=16), False)
        for poisson in (0.3, 0.45, 0.49, 0.499)
    ),
    *(
        (
            f"cantilever 1 x 0.1 x 0.3 along {'yz'[axis - 1]}, 8 segments, Poisson {poisson}",
            partial(flat_cantilever, poisson=poisson, segments=8, axis=axis),
            False,
        )
        for axis in (1, 2)
        for poisson in (0.3, 0.499)
    ),
    *(
        (f"torsion, {n} segments, Poisson {poisson}", partial(torsion, poisson=poisson, segments=n), n == 8)
        for n in (8, 16)
        for poisson in (0.3, 0.499)
    ),
    *(
        (
            f"bracket along {'xyz'[axis]}, {n} segments a leg, Poisson {poisson}",
            partial(bracket, poisson=poisson, segments=n, axis=axis),
            False,
        )
        for n in (4, 8)
        for axis in (0, 1)
        for poisson in (0.3, 0.499)
    ),
    *(
        (f"{name} frequency, {n} segments", partial(frequency, bending=name == "bending", segments=n), n == 4)
        for name in ("axial", "bending")
        for n in (4, 8)
    ),
    *((f"edge crack, {n} segments", partial(edge_crack, segments=n), n == 4) for n in (4, 8, 16)),
)

ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = tuple(
    (f"{name}{text}", partial(run, strain=strain), quick)
    for strain, text in (("points", ""), ("averaged", ", averaged strain"))
    for name, run, quick in _ROWS
)
