# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Steps that cannot be made, and what the solver tells of its steps."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import newton_cagecut as cagecut
from solver_scenes import make_solver, run, simulated, slanted_blade, vertex_rows


@pytest.mark.parametrize("dt", [float("nan"), float("inf"), -1.0 / 60.0, 0.0])
def test_bad_time_steps_are_refused(dt: float):
    """A time step that is no positive number is refused before anything has changed."""
    _, solver, *states = make_solver(walks=8)
    before = [state.particle_q.numpy().copy() for state in states]
    with pytest.raises(ValueError, match="dt must be"):
        solver.step(*states, None, None, dt)
    for state, positions in zip(states, before, strict=True):
        assert np.array_equal(state.particle_q.numpy(), positions)
    assert solver.statistics()[0]["steps"] == 0


@pytest.mark.parametrize("culprit", ["gravity", "force"])
def test_step_that_cannot_be_made_leaves_the_body(culprit: str):
    """Where the result would not be finite the body stays, the statistics say why, and one warning is given."""
    model, solver, *states = make_solver(walks=8)
    states = run(solver, states, 3)
    if culprit == "gravity":
        model.set_gravity((0.0, 0.0, float("inf")))
    else:
        forces = states[0].particle_f.numpy()
        forces[simulated(solver).vertices.start] = np.nan
        states[0].particle_f.assign(forces)
    before = states[0].particle_q.numpy().copy()
    solver.step(*states, None, None, 1.0 / 60.0)
    assert np.array_equal(states[1].particle_q.numpy(), before)
    found = solver.statistics()[0]
    assert (found["steps"], found["refused"]) == (4, 1)
    assert "not finite" in found["reason"]
    with pytest.warns(RuntimeWarning, match="left where it was"):
        solver.step(*states, None, None, 1.0 / 60.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solver.step(*states, None, None, 1.0 / 60.0)


def test_missed_tolerance_is_told_once():
    """Solves that end short of the tolerance are counted, and one warning is given."""
    _, solver, *states = make_solver(walks=8, gravity=-9.81, fixed=[0, 1, 2])
    coarse = cagecut.SolverCageCut(solver.model, max_iterations=1)
    states = coarse.model.state(), coarse.model.state()
    coarse.step(*states, None, None, 1.0 / 60.0)
    with pytest.warns(RuntimeWarning, match="ended before it reached the tolerance"):
        coarse.step(*states, None, None, 1.0 / 60.0)
    found = coarse.statistics()[0]
    assert found["missed"] == 2
    assert found["worst_residual"] > coarse.config.tolerance


def test_pieces_do_not_slow_each_other():
    """A piece of a cut body that is squeezed flat does not change the flight of another."""
    _, solver, *states = make_solver()
    cut = solver.begin_cut(0, slanted_blade())
    solver.advance_cut(cut, to=1.01 * cut.length, states=states)
    first, second = (piece.vertices for piece in solver.pieces())
    positions, velocities = vertex_rows(solver, states[0]), vertex_rows(solver, states[0], "particle_qd")
    center = positions[first].mean(axis=0)
    positions[first] = center + (positions[first] - center) * [1.0, 1.0, 0.1]
    velocities[second] = [0.0, 0.0, 5.0]
    rows = slice(solver.bodies[0].vertices.start, solver.bodies[0].vertices.start + len(positions))
    for field, values in (("particle_q", positions), ("particle_qd", velocities)):
        array = getattr(states[0], field)
        host = array.numpy()
        host[rows] = values
        array.assign(host)
    states = run(solver, states, 15)
    mass = simulated(solver).system.vertex_mass.numpy()[second]
    mean = mass @ vertex_rows(solver, states[0], "particle_qd")[second] / mass.sum()
    np.testing.assert_allclose(mean, [0.0, 0.0, 5.0], atol=1.0e-3)
