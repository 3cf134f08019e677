# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""States that missed an edit: nothing takes them silently, and none is corrupted."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from solver_scenes import both_dimensions, make_solver, run, simulated, slanted_blade, vertex_rows

MISSED = "missed an edit"
OF_ANOTHER = "as of edit"


def _cut(solver: cagecut.SolverCageCut, states=(), *, part: float = 0.5) -> cagecut.CutReport:
    """Cut the first body part of the way through."""
    cut = solver.begin_cut(0, slanted_blade(solver.bodies[0].cage.dimension))
    return solver.advance_cut(cut, to=part * cut.length, states=states)


def _rows(solver: cagecut.SolverCageCut, state) -> np.ndarray:
    """All rows of the first body's particles in a state."""
    body = solver.bodies[0]
    parts = [body.vertices] if body.surface_particles is None else [body.vertices, body.surface_particles]
    fields = (state.particle_q.numpy(), state.particle_qd.numpy())
    return np.concatenate([field[part] for field in fields for part in parts])


@both_dimensions
@pytest.mark.parametrize("options", [{}, {"contact_radius": 0.01}, {"quadrature": 0}])
def test_state_that_was_not_passed_is_refused(dimension: int, options: dict[str, float]):
    """A cut without states= leaves them as they were; steps, surfaces and energies from them say what to do."""
    _, solver, *states = make_solver(gravity=-9.81, dimension=dimension, **options)
    states = run(solver, states, 3)
    before = [_rows(solver, state) for state in states]
    _cut(solver)
    for call in (
        lambda: solver.step(*states, None, None, 1.0 / 60.0),
        lambda: solver.surface(states[0]),
        lambda: solver.bodies[0].energy(states[0]),
        lambda: _cut(solver, states, part=0.7),
        lambda: solver.snapshot(0, states=states),
    ):
        with pytest.raises(ValueError, match=f"{MISSED}|{OF_ANOTHER} 0") as error:
            call()
        assert "states=(state_0, state_1)" in str(error.value)
        assert "cage_body_0" in str(error.value)
    for state, rows in zip(states, before, strict=True):
        np.testing.assert_array_equal(_rows(solver, state), rows)


@both_dimensions
def test_older_state_assigned_back(dimension: int):
    """The everyday reset: a state kept from before a cut is recognised wherever it is assigned to."""
    model, solver, *states = make_solver(gravity=-9.81, dimension=dimension)
    keep = model.state()
    states = run(solver, states, 3)
    keep.assign(states[0])
    _cut(solver, states)
    states = run(solver, states, 2)
    known = _rows(solver, states[1])
    states[0].assign(keep)
    with pytest.raises(ValueError, match=MISSED):
        solver.step(*states, None, None, 1.0 / 60.0)
    np.testing.assert_array_equal(_rows(solver, states[1]), known)
    states[0].assign(states[1])
    run(solver, states, 2)


@both_dimensions
def test_kept_state_that_is_passed_stays_good(dimension: int):
    """A kept state passed to the cut follows it: assigned back, the body goes on from there, cut."""
    model, solver, *states = make_solver(gravity=-9.81, dimension=dimension, walks=256)
    states = run(solver, states, 5)
    keep = model.state()
    keep.assign(states[0])
    surface, _ = solver.surface(states[0])
    _cut(solver, (*states, keep))
    states = run(solver, states, 5)
    states[0].assign(keep)
    again, _ = solver.surface(states[0])
    assert np.abs(again[: len(surface)] - surface).max() < 1.0e-3
    run(solver, states, 2)


@both_dimensions
@pytest.mark.parametrize("contact_radius", [None, 0.01])
def test_new_states_start_from_rest(dimension: int, contact_radius: float | None):
    """model.state() made after a cut is the cut body at rest: no energy, the surface where it is at rest."""
    model, solver, *states = make_solver(dimension=dimension, contact_radius=contact_radius, velocity=(0.0, 0.0, 0.5))
    before = model.state()
    _cut(solver, states)
    after, body = model.state(), solver.bodies[0]
    np.testing.assert_allclose(vertex_rows(solver, after), body.to_world(body.cage.vertices), atol=1.0e-6)
    np.testing.assert_allclose(vertex_rows(solver, after, "particle_qd")[:, 2], 0.5, atol=1.0e-6)
    assert body.energy(after).elastic == pytest.approx(0.0, abs=1.0e-6)
    points = body.to_world(body.surface.points)
    if contact_radius:
        found = after.particle_q.numpy()[body.surface_particles][: len(points)]
        np.testing.assert_allclose(found, points, atol=1.0e-5)
    np.testing.assert_allclose(solver.surface(after)[0], points, atol=1.0e-5)
    for _ in range(3):
        solver.step(after, after, None, None, 1.0 / 60.0)
    moved = np.array([0.0, 0.0, 0.5]) * 3.0 / 60.0
    np.testing.assert_allclose(solver.surface(after)[0], points + moved, atol=1.0e-4)
    with pytest.raises(ValueError, match=MISSED):
        solver.step(before, before, None, None, 1.0 / 60.0)


def test_undo_makes_later_states_stale():
    """After restore, a state that the snapshot did not hold is refused; those it held and older ones are good."""
    model, solver, *states = make_solver(gravity=-9.81)
    _cut(solver, states, part=0.3)
    snapshot, kept = solver.snapshot(0, states=states[:1]), model.state()
    _cut(solver, states, part=0.8)
    solver.restore(snapshot)
    with pytest.raises(ValueError, match=MISSED):
        solver.step(states[1], states[0], None, None, 1.0 / 60.0)
    solver.step(states[0], states[1], None, None, 1.0 / 60.0)
    solver.step(kept, kept, None, None, 1.0 / 60.0)
    late = model.state()
    _cut(solver, states, part=0.8)
    with pytest.raises(ValueError, match=MISSED):
        solver.step(late, late, None, None, 1.0 / 60.0)


def test_edits_of_two_branches_are_told_apart():
    """A state of an edit that was undone is not taken for one of the edit that came in its place."""
    model, solver, *states = make_solver()
    snapshot = solver.snapshot(0, states=states)
    _cut(solver, states, part=0.4)
    undone = model.state()
    solver.restore(snapshot)
    _cut(solver, states, part=0.7)
    with pytest.raises(ValueError, match=MISSED):
        solver.step(undone, undone, None, None, 1.0 / 60.0)


@both_dimensions
def test_second_solver_takes_the_body_as_it_is(dimension: int):
    """A solver made after a cut has the cut body, and new states of the model fit it."""
    model, solver, *states = make_solver(gravity=-9.81, dimension=dimension, contact_radius=0.01)
    _cut(solver, states, part=2.0)
    other = cagecut.SolverCageCut(model)
    one, two = solver.bodies[0], other.bodies[0]
    assert two.cage is one.cage
    assert two.surface is one.surface
    assert len(two.pieces) == 2
    np.testing.assert_array_equal(two.fixed, one.fixed)
    state = model.state()
    np.testing.assert_allclose(other.surface(state)[0], one.to_world(one.surface.points), atol=1.0e-5)
    assert two.energy(state).elastic == pytest.approx(0.0, abs=1.0e-5)
    run(other, (state, model.state()), 3)
    run(solver, states, 3)


def test_cuts_of_two_solvers_are_refused():
    """Once one solver of a model has cut a body, another one that was made before cannot, and says why."""
    model, solver, *states = make_solver()
    other = cagecut.SolverCageCut(model)
    cut = other.begin_cut(0, slanted_blade())
    _cut(solver, states)
    with pytest.raises(ValueError, match="through another solver"):
        other.advance_cut(cut, 0.2)
    with pytest.raises(ValueError, match=MISSED):
        other.step(*states, None, None, 1.0 / 60.0)
    run(solver, states, 1)


@pytest.mark.parametrize("in_place", [False, True])
def test_replay_holds_a_body_whose_state_missed_a_cut(in_place: bool):
    """A captured step replayed after a cut that its states missed leaves the body where it is; then a call says so."""
    _, solver, *states = make_solver(gravity=-9.81, contact_radius=0.01)
    states = run(solver, states, 3)
    target = states[0] if in_place else states[1]
    with wp.ScopedCapture(device="cpu") as capture:
        solver.step(states[0], target, None, None, 1.0 / 60.0)
    wp.capture_launch(capture.graph)
    assert not np.array_equal(_rows(solver, target), _rows(solver, states[1 if in_place else 0]))
    _cut(solver)
    known = _rows(solver, states[0])
    for _ in range(2):
        wp.capture_launch(capture.graph)
    np.testing.assert_array_equal(_rows(solver, states[0]), known)
    np.testing.assert_array_equal(_rows(solver, target), known)
    with pytest.raises(ValueError, match=r"cage_body_0 \(3\)"):
        solver.step(states[0], target, None, None, 1.0 / 60.0)


def test_same_state_twice_is_carried_once():
    """A state that is passed twice gets its rows once."""
    _, solver, *states = make_solver(gravity=-9.81)
    states = run(solver, states, 3)
    states[1].assign(states[0])
    cut = solver.begin_cut(0, slanted_blade())
    for part in (0.3, 0.6):
        solver.advance_cut(cut, to=part * cut.length, states=(states[0], states[0], states[1]))
    np.testing.assert_array_equal(_rows(solver, states[0]), _rows(solver, states[1]))
    with pytest.raises(TypeError, match=r"states=\(state,\)"):
        solver.advance_cut(cut, 0.1, states=states[0])


def test_model_follows_an_undo():
    """What a cut wrote to the model, an undo takes back: initial state, flags, masses and the body's definition."""
    model, solver, *states = make_solver(contact_radius=0.01)
    names = ("particle_q", "particle_qd", "particle_flags", "particle_mass")
    known, definition = {name: getattr(model, name).numpy().copy() for name in names}, model.cagecut.definition[0]
    snapshot = solver.snapshot(0, states=states)
    _cut(solver, states, part=2.0)
    assert model.cagecut.definition[0].cage is solver.bodies[0].cage
    solver.restore(snapshot)
    for name, values in known.items():
        np.testing.assert_array_equal(getattr(model, name).numpy(), values, err_msg=name)
    assert model.cagecut.definition[0].cage is definition.cage
    assert simulated(solver).definition.edit == 0
