# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What cuts do to energy and momentum: stretched, spinning and cut-off bodies."""

from __future__ import annotations

import numpy as np
import pytest

import newton_cagecut as cagecut
from newton_cagecut.report.stability.rows.cuts import light_piece, sliver
from newton_cagecut.report.stability.workbench import Workbench

FRAME = 1.0 / 60.0
ACROSS = cagecut.Blade((0.5, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0))
SLANTED = cagecut.Blade((0.7, 0.0, 1.0), (0.0, 1.0, 0.0), (0.3, 0.0, -1.0))


@pytest.fixture
def bench() -> Workbench:
    """Makes bars of 1 x 0.2 x 0.2 m."""
    return Workbench(quick=True)


def ends(vertices: np.ndarray) -> np.ndarray:
    """Vertices at both ends of the bar."""
    return np.flatnonzero((vertices[:, 0] < 1e-6) | (vertices[:, 0] > 1.0 - 1e-6))


@pytest.mark.parametrize("model", ["neo_hookean", "stvk"])
def test_cut_of_a_stretched_bar_gives_no_energy(bench, model: str):
    """Over a whole cut of a bar of four segments, stretched three times, no advance adds energy."""
    material = cagecut.Material(young=1e5, damping=0.02, model=model)
    trial = bench.bar(material, segments=4, fixed=ends, cuttable=True, quadrature=300)
    trial.place(trial.rest * (3.0, 1.0, 1.0), np.zeros_like(trial.rest))
    trial.run(30, FRAME)
    elastic, kinetic = trial.energy()
    cut, total = trial.solver.begin_cut(0, ACROSS), 0.0
    for k in range(10):
        report = trial.solver.advance_cut(cut, to=cut.length * (k + 1) / 10, states=trial.states)
        total += report.energy_injected
        assert report.energy_injected < 1e-6 * elastic
        assert report.energy_after == pytest.approx(sum(trial.energy()))
        trial.run(3, FRAME)
    assert cut.complete
    assert -0.3 * elastic < total < 0.0
    assert sum(trial.energy()) < elastic + kinetic


@pytest.mark.parametrize("young", [1e4, 1e9])
def test_cut_keeps_momenta(bench, young: float):
    """A bar that spins, flies and swings keeps both momenta to rounding over every advance, through the separation."""
    trial = bench.bar(cagecut.Material(young=young), segments=2, cuttable=True, quadrature=150)
    center, rest = trial.center(), trial.rest
    swing = 0.3 * np.random.default_rng(0).normal(size=rest.shape)
    stretch = center + 1.02 * (rest - center)
    trial.place(stretch, np.cross((0.0, 3.0, 2.0), rest - center) + (1.0, 2.0, 3.0) + swing)
    cut = trial.solver.begin_cut(0, SLANTED)
    momentum, spin = trial.momentum(), trial.angular_momentum()
    for k in range(8):
        place = trial.center()
        report = trial.solver.advance_cut(cut, to=cut.length * (k + 1) / 8, states=trial.states)
        np.testing.assert_allclose(trial.momentum(), momentum, atol=1e-6 * np.linalg.norm(momentum))
        np.testing.assert_allclose(trial.angular_momentum(), spin, atol=1e-6 * np.linalg.norm(spin))
        np.testing.assert_allclose(trial.center(), place, atol=1e-6)
        assert report.energy_injected < 1e-6 * report.energy_before
    assert report.separated


@pytest.mark.parametrize("measure", [lambda b: sliver(b, "neo_hookean", 1e-6), lambda b: light_piece(b, 1e-6)])
def test_sliver_has_its_own_mass(bench, measure):
    """A slice or a corner of a millionth of the body weighs what its volume says, and gains no energy."""
    outcome = measure(bench)
    assert outcome.finite
    assert outcome.error < 1e-5
    assert outcome.energy_gain < 1e-3
    assert outcome.momentum_drift < 1e-4


def test_a_cut_is_no_step(bench):
    """What the edit does to relax a body is not counted among its steps."""
    trial = bench.bar(cagecut.Material(young=1e5), segments=4, fixed=ends, cuttable=True, quadrature=300)
    trial.place(trial.rest * (3.0, 1.0, 1.0), np.zeros_like(trial.rest))
    before = trial.solver.statistics()
    trial.solver.advance_cut(trial.solver.begin_cut(0, ACROSS), 0.02, states=trial.states)
    assert trial.solver.statistics() == before
