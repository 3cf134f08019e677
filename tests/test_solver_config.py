# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``SolverCageCut.Config``: what it accepts, what it refuses, and that it reaches the solve."""

from __future__ import annotations

import dataclasses

import newton
import numpy as np
import pytest

import newton_cagecut as cagecut
from solver_scenes import ball, box_cage, corners, make_solver, run, simulated, vertex_rows

Config = cagecut.SolverCageCut.Config


@pytest.fixture(scope="module")
def model() -> newton.Model:
    """A model of one small body that hangs."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    material = cagecut.Material(young=1.0e4)
    fixed = corners(2, 1.0)
    cagecut.add_cage_body(builder, box_cage(), ball(), walks=8, quadrature=60, material=material, fixed=fixed)
    return builder.finalize(device="cpu")


def test_defaults():
    """Without a configuration the solver takes the defaults."""
    assert Config() == Config(integrator="tr_bdf2", newton_iterations=1, tolerance=1.0e-5, max_iterations=150)
    assert make_solver(walks=8)[1].config == Config()


def test_keywords_and_configuration_agree(model):
    """Options come in a configuration, as keywords, or as keywords that override it; the configuration stays."""
    config = Config(max_iterations=3)
    assert cagecut.SolverCageCut(model, config).config == config
    assert cagecut.SolverCageCut(model, max_iterations=3).config == config
    assert cagecut.SolverCageCut(model, config, tolerance=0.1).config == Config(max_iterations=3, tolerance=0.1)
    assert cagecut.SolverCageCut(model, config=config, max_iterations=np.int64(4)).config == Config(max_iterations=4)
    assert config == Config(max_iterations=3)
    with pytest.raises(dataclasses.FrozenInstanceError):
        config.tolerance = 0.1


def test_options_reach_the_solve(model):
    """The bound stops the solve, and a coarse tolerance ends it sooner; both move the body otherwise."""
    found = {}
    for name, options in {"default": {}, "bounded": {"max_iterations": 2}, "coarse": {"tolerance": 0.1}}.items():
        solver = cagecut.SolverCageCut(model, **options)
        state, _ = run(solver, (model.state(), model.state()), 3)
        found[name] = int(simulated(solver).system.iterations.numpy()[0]), vertex_rows(solver, state)
    assert found["bounded"][0] == 2
    assert 0 < found["coarse"][0] < found["default"][0]
    assert not np.array_equal(found["coarse"][1], found["default"][1])


@pytest.mark.parametrize(
    ("options", "error", "match"),
    [
        ({"tolerance": 0.0}, ValueError, r"tolerance must lie in \(0, 1\), got 0\.0"),
        ({"tolerance": 1.0}, ValueError, r"tolerance must lie in \(0, 1\), got 1\.0"),
        ({"tolerance": float("nan")}, ValueError, "tolerance must be a number, got nan"),
        ({"tolerance": float("inf")}, ValueError, r"tolerance must lie in \(0, 1\), got inf"),
        ({"tolerance": "fine"}, TypeError, "tolerance must be a number, got 'fine'"),
        ({"tolerance": None}, TypeError, "tolerance must be a number, got None"),
        ({"max_iterations": 0}, ValueError, "max_iterations must be at least 1, got 0"),
        ({"max_iterations": 2.5}, TypeError, r"max_iterations must be an integer, got 2\.5"),
    ],
)
def test_values_out_of_range_are_refused(model, options, error, match):
    """A configuration and a solver refuse alike, and name the option and its value."""
    with pytest.raises(error, match=match):
        Config(**options)
    with pytest.raises(error, match=match):
        cagecut.SolverCageCut(model, **options)


def test_unknown_options_are_refused(model):
    """An unknown option is named, with those that there are."""
    with pytest.raises(
        TypeError, match="no option tolerence; there are integrator, newton_iterations, max_iterations, tolerance"
    ):
        cagecut.SolverCageCut(model, tolerence=0.1)
    with pytest.raises(TypeError, match=r"config must be a SolverCageCut\.Config, or be left out, got a dict"):
        cagecut.SolverCageCut(model, {"tolerance": 0.1})
