# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Resets, live edits and prescribed motion."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from failure_injection import FailingCalls, InjectedFailure
from newton_cagecut.solver.live.live_edits import undo_cuts
from solver_scenes import (
    assert_same,
    ball,
    both_dimensions,
    box_cage,
    corners,
    everything,
    make_solver,
    run,
    simulated,
    slanted_blade,
    vertex_rows,
)

DT = 1.0 / 60.0


def _worlds(count: int, *, gravity: float = -9.81, **options):
    """A solver of replicated worlds with a ball each, and two states."""
    template = newton.ModelBuilder(gravity=(0.0, 0.0, gravity))
    cagecut.SolverCageCut.register_custom_attributes(template)
    cagecut.add_cage_body(template, box_cage(), ball(), walks=16, quadrature=40, **options)
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, gravity))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    builder.replicate(template, count, spacing=(3.0, 0.0, 0.0))
    model = builder.finalize(device="cpu")
    return model, cagecut.SolverCageCut(model), [model.state(), model.state()]


def _cut(solver, states, *, part: float = 0.6, row: int = 0) -> None:
    """Cut a body part of the way through."""
    cut = solver.begin_cut(row, slanted_blade(solver.bodies[row].cage.dimension))
    solver.advance_cut(cut, to=part * cut.length, states=states)


def test_reset_gives_the_rest_pose_of_the_chosen_worlds():
    """Bodies of masked worlds are at rest as the model has them, surface particles too; those of others go on."""
    model, solver, states = _worlds(2, velocity=(0.0, 1.0, 0.0), contact_radius=0.01)
    states = run(solver, states, 5)
    before, start = states[0].particle_q.numpy(), model.particle_q.numpy()
    mask = wp.array([False, True, False], dtype=wp.bool, device="cpu")
    solver.reset(states[0], mask)
    after = states[0].particle_q.numpy()
    for row, expected in ((0, before), (1, start)):
        body = solver.bodies[row]
        for part in (body.vertices, body.surface_particles):
            np.testing.assert_array_equal(after[part], expected[part])
    np.testing.assert_array_equal(states[0].particle_qd.numpy()[solver.bodies[1].vertices][:8, 1], 1.0)
    solver.reset(states[0], flags=newton.StateFlags.PARTICLE_QD)
    np.testing.assert_array_equal(states[0].particle_q.numpy(), after)
    np.testing.assert_array_equal(states[0].particle_qd.numpy(), model.particle_qd.numpy())


@both_dimensions
def test_reset_after_a_cut_is_the_cut_body_at_rest(dimension: int):
    """A state that missed the cut is good after a reset, and starts as model.state() does."""
    model, solver, *states = make_solver(gravity=-9.81, dimension=dimension, velocity=(0.0, 0.0, 0.5))
    states = run(solver, states, 4)
    _cut(solver, ())
    solver.reset(states[0])
    fresh = [model.state(), model.state()]
    np.testing.assert_array_equal(states[0].particle_q.numpy(), fresh[0].particle_q.numpy())
    first, second = run(solver, states, 3), run(solver, fresh, 3)
    np.testing.assert_array_equal(vertex_rows(solver, first[0]), vertex_rows(solver, second[0]))


@both_dimensions
@pytest.mark.parametrize("contact_radius", [None, 0.01])
def test_uncut_brings_every_bit_back(dimension: int, contact_radius: float | None):
    """After reset(uncut=True) everything is as before the first cut, and the same cut gives the same body again."""
    options = {"gravity": -9.81, "dimension": dimension, "contact_radius": contact_radius, "fixed": [0, 1]}
    model, solver, *states = make_solver(**options)
    for owner in (model, *states) if contact_radius else ():
        simulated(solver).embed_particles(owner)
    before = everything(solver, states)
    _cut(solver, states)
    cut_once = everything(solver, ())
    for _ in range(2):
        solver.reset(states[0], uncut=True)
        states[1].assign(states[0])
        assert_same(before, everything(solver, states))
        states = run(solver, states, 2)
        _cut(solver, states, part=0.3)
        _cut(solver, states, part=0.8)
        solver.reset(states[0], uncut=True)
        states[1].assign(states[0])
    _cut(solver, states)
    assert_same(cut_once, everything(solver, ()))


def test_uncut_of_one_world():
    """Only bodies of chosen worlds lose their cuts; their material stays as it was changed."""
    _, solver, states = _worlds(2)
    for row in (0, 1):
        _cut(solver, states, row=row)
    solver.set_material(1, cagecut.Material(young=3.0e4))
    solver.reset(states[0], wp.array([False, True, False], dtype=wp.bool, device="cpu"), uncut=True)
    assert solver.bodies[0].cage.vertex_count > solver.bodies[1].cage.vertex_count == 8
    assert solver.bodies[1].material.young == 3.0e4
    run(solver, states, 2)


def test_failed_uncut_changes_nothing():
    """An undoing that fails anywhere leaves the cut body."""
    _, solver, *states = make_solver(walks=4, quadrature=12, contact_radius=0.01)
    _cut(solver, states)
    solver.reset(states[0], uncut=True)
    _cut(solver, states[:1])
    body, before = simulated(solver), everything(solver, states[:1])
    for n in range(1000):
        with FailingCalls(n) as failing:
            try:
                undo_cuts(body)
            except InjectedFailure:
                assert_same(before, everything(solver, states[:1]))
        if not failing.raised:
            break
    assert 20 < n < 999


@pytest.mark.parametrize("quadrature", [60, 0])
def test_masses_agree_after_a_change_of_density(quadrature: int):
    """particle_mass, pieces and the system say the same mass, before and after a complete cut."""
    model, solver, *states = make_solver(quadrature=quadrature)
    solver.set_material(0, cagecut.Material(young=2.0e4, density=2000.0))
    _cut(solver, states, part=1.0)
    solver.set_material("cage_body_0", cagecut.Material(young=2.0e4, density=500.0))
    masses = [piece.mass for piece in solver.pieces()]
    assert len(masses) == 2
    if not quadrature:
        assert masses == [0.0, 0.0]
        return
    assert sum(masses) == pytest.approx(500.0, rel=1.0e-6)
    rows = model.particle_mass.numpy()[solver.bodies[0].vertices]
    for piece, mass in zip(solver.pieces(), masses, strict=True):
        assert rows[piece.vertices].sum() == pytest.approx(mass, rel=1.0e-3)


def test_softer_material_hangs_lower():
    """A change of Young's modulus acts from the next step on, as if the body had been made so."""
    young = cagecut.Material(young=4.0e4, damping=0.05)
    _, changed, *states = make_solver(gravity=-9.81, fixed=corners(2, 0.0), material=young)
    soft = cagecut.Material(young=2.0e4, damping=0.05)
    changed.set_material(0, soft)
    _, made, *others = make_solver(gravity=-9.81, fixed=corners(2, 0.0), material=soft)
    first, second = run(changed, states, 20), run(made, others, 20)
    np.testing.assert_array_equal(vertex_rows(changed, first[0]), vertex_rows(made, second[0]))


def test_refused_edits_change_nothing():
    """Another constitutive model, a vertex that is not there and a wrong type are refused before anything changes."""
    _, solver, *states = make_solver(fixed=[0])
    before = everything(solver, states)
    with pytest.raises(ValueError, match="material model 'neo_hookean', not 'stvk'"):
        solver.set_material(0, cagecut.Material(model="stvk"))
    with pytest.raises(TypeError, match="must be a Material"):
        solver.set_material(0, 1.0e4)
    with pytest.raises(ValueError, match="names vertex 8"):
        solver.set_fixed(0, [8])
    with pytest.raises(ValueError, match="no cage body 'leg'"):
        solver.set_fixed("leg", [0])
    assert_same(before, everything(solver, states))
    assert solver.bodies[0].fixed.tolist() == [True] + 7 * [False]


@both_dimensions
def test_released_body_falls(dimension: int):
    """A hung body whose pins are released falls freely; pinned again it stops."""
    top = corners(-1, box_cage(dimension).vertices[:, -1].max(), dimension)
    _, solver, *states = make_solver(gravity=-9.81, dimension=dimension, fixed=top)
    states = run(solver, states, 10)
    solver.set_fixed(0, None)
    before = vertex_rows(solver, states[0]).mean(axis=0)
    speed = vertex_rows(solver, states[0], "particle_qd").mean(axis=0)
    states = run(solver, states, 30)
    after = vertex_rows(solver, states[0]).mean(axis=0)
    assert after[2] - before[2] < -0.8 * 0.5 * 9.81 * 0.25 + 0.5 * speed[2]
    held = np.flatnonzero(vertex_rows(solver, states[0])[:, 2] > after[2])
    solver.set_fixed(0, held)
    kept = vertex_rows(solver, states[0])[held]
    states = run(solver, states, 10)
    np.testing.assert_array_equal(vertex_rows(solver, states[0])[held], kept)


@both_dimensions
@pytest.mark.parametrize("integrator", ["tr_bdf2", "backward_euler", "paper"])
def test_fixed_vertices_follow_their_targets(dimension: int, integrator: str):
    """Driven at a constant speed, the whole body comes to move at it, without strain; without targets it stops."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    side = box_cage(dimension).vertices[:, 0].min()
    model, _, *states = make_solver(
        builder=builder,
        dimension=dimension,
        fixed=corners(0, side, dimension),
        material=cagecut.Material(young=1.0e5, damping=0.2),
    )
    solver = cagecut.SolverCageCut(model, integrator=integrator)
    control, body = model.control(), solver.bodies[0]
    start, fixed = vertex_rows(solver, states[0]), np.flatnonzero(body.fixed)
    target = control.cagecut.target_q.numpy()
    assert np.isinf(target).all()
    for step in range(1, 121):
        target[body.vertices.start + fixed] = start[fixed] + [0.0, 0.0, 0.5 * step * DT]
        control.cagecut.target_q.assign(target)
        solver.step(states[0], states[1], control, None, DT)
        states.reverse()
    moved = vertex_rows(solver, states[0]) - start
    np.testing.assert_allclose(moved[fixed], np.tile([0.0, 0.0, 1.0], (len(fixed), 1)), atol=1.0e-6)
    np.testing.assert_allclose(moved, np.tile([0.0, 0.0, 1.0], (len(moved), 1)), atol=5.0e-3)
    speeds = vertex_rows(solver, states[0], "particle_qd")
    np.testing.assert_allclose(speeds[fixed], np.tile([0.0, 0.0, 0.5], (len(fixed), 1)), atol=1.0e-4)
    assert body.energy(states[0]).elastic < 0.05
    kept = vertex_rows(solver, states[0])[fixed]
    states = run(solver, states, 3)
    np.testing.assert_array_equal(vertex_rows(solver, states[0])[fixed], kept)


def test_keyframed_body_follows_targets():
    """Every vertex of a body without elasticity can have a target; those of a model count without a control."""
    model, solver, *states = make_solver(quadrature=0)
    body = solver.bodies[0]
    target = model.cagecut.target_q.numpy()
    target[body.vertices][:4] = body.to_world(body.cage.vertices[:4]) + [1.0, 0.0, 0.0]
    model.cagecut.target_q.assign(target)
    states = run(solver, states, 1)
    moved = vertex_rows(solver, states[0]) - body.to_world(body.cage.vertices)
    np.testing.assert_allclose(moved[:, 0], [1.0] * 4 + [0.0] * 4, atol=1.0e-6)


def test_gravity_counts_when_its_array_is_replaced():
    """Gravity set in place or replaced acts from the next step on."""
    model, solver, *states = make_solver(gravity=0.0)
    model.gravity = wp.array(np.tile([0.0, 0.0, -2.0], (model.gravity.shape[0], 1)), dtype=wp.vec3, device="cpu")
    solver.notify_model_changed(newton.ModelFlags.MODEL_PROPERTIES)
    states = run(solver, states, 30)
    np.testing.assert_allclose(vertex_rows(solver, states[0], "particle_qd")[:, 2], -1.0, atol=1.0e-3)


def test_greatest_speed_is_honoured():
    """No vertex is faster, or goes farther, than model.particle_max_velocity allows."""
    model, solver, *states = make_solver(gravity=-9.81)
    model.particle_max_velocity = 0.4
    states = run(solver, states, 20)
    before = vertex_rows(solver, states[0])
    states = run(solver, states, 1)
    np.testing.assert_allclose(vertex_rows(solver, states[0], "particle_qd")[:, 2], -0.4, rtol=1.0e-3)
    np.testing.assert_allclose(vertex_rows(solver, states[0])[:, 2] - before[:, 2], -0.4 * DT, rtol=1.0e-3)


def test_notified_solver_takes_over_the_others_edits():
    """What one solver of a model changes, another takes over when told."""
    model, first, *_ = make_solver()
    second = cagecut.SolverCageCut(model)
    first.set_material(0, cagecut.Material(young=5.0e4))
    first.set_fixed(0, [1])
    second.notify_model_changed(newton.ModelFlags.SHAPE_PROPERTIES)
    assert second.bodies[0].material.young == 1.0e4
    second.notify_model_changed(second.CAGE_PROPERTIES)
    assert second.bodies[0].material.young == 5.0e4
    assert np.flatnonzero(second.bodies[0].fixed).tolist() == [1]


def test_gradients_are_refused():
    """A model or a state that is to carry gradients is refused: they would be zero."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cagecut.add_cage_body(builder, box_cage(), ball(), walks=4, quadrature=12)
    with pytest.raises(ValueError, match="not differentiable"):
        cagecut.SolverCageCut(builder.finalize(device="cpu", requires_grad=True))
    model, solver, *_ = make_solver()
    state = model.state(requires_grad=True)
    with pytest.raises(ValueError, match="requires_grad=False"):
        solver.step(state, state, None, None, DT)


def test_reset_checks_its_arguments():
    """A mask of the wrong length, a foreign state and flags that are none are refused."""
    _, solver, *states = make_solver()
    with pytest.raises(ValueError, match="length 3"):
        solver.reset(states[0], wp.zeros(3, dtype=wp.bool, device="cpu"))
    with pytest.raises(TypeError, match="model with cage bodies"):
        solver.reset(newton.ModelBuilder().finalize(device="cpu").state())
    other = _worlds(2)[2][0]
    with pytest.raises(ValueError, match="the solver's own model"):
        solver.reset(other)
    with pytest.raises(TypeError, match="newton.ModelFlags"):
        solver.notify_model_changed("gravity")


def test_labels_are_each_bodys_own():
    """Replicated bodies are told apart by their worlds, prefixes count, and two of one name are refused."""
    _, solver, states = _worlds(2)
    assert [body.label for body in solver.bodies] == ["world_0/cage_body_0", "world_1/cage_body_0"]
    assert solver.body("world_1/cage_body_0") is solver.bodies[1]
    template, builder = newton.ModelBuilder(), newton.ModelBuilder()
    for one in (template, builder):
        cagecut.SolverCageCut.register_custom_attributes(one)
    cagecut.add_cage_body(template, box_cage(), ball(), walks=4, quadrature=12)
    builder.add_builder(template)
    builder.add_builder(template, label_prefix="left")
    labels = [body.label for body in cagecut.SolverCageCut(builder.finalize(device="cpu")).bodies]
    assert labels == ["cage_body_0", "left/cage_body_0"]
    builder.add_builder(template)
    with pytest.raises(ValueError, match="two cage bodies have the label 'cage_body_0'"):
        cagecut.SolverCageCut(builder.finalize(device="cpu"))
