# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Motion of cage bodies: rest, free fall, momentum, settling, contact."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from solver_scenes import (
    SIZE,
    UPRIGHT,
    ball,
    both_dimensions,
    box_cage,
    corners,
    make_solver,
    run,
    simulated,
    slanted_blade,
    vertex_rows,
)


def cut_to(solver, states, share: float, steps: int = 5):
    """Cut the first body to a share of the cut's length."""
    cut = solver.begin_cut(0, slanted_blade(solver.bodies[0].cage.dimension))
    for k in range(1, steps + 1):
        report = solver.advance_cut(cut, to=share * cut.length * k / steps, states=states)
    return cut, report


@both_dimensions
@pytest.mark.parametrize("share", [0.0, 0.6, 1.01])
def test_nothing_moves_at_rest(share: float, dimension: int):
    """Without gravity speeds stay under 1e-5 of the size per second, uncut, half cut and in two pieces."""
    xform = wp.transform((1.0, -2.0, 0.5), wp.quat_from_axis_angle(wp.vec3(0.6, 0.0, 0.8), 0.7))
    _, solver, *states = make_solver(xform=xform, dimension=dimension)
    if share:
        cut_to(solver, states, share)
    fastest = 0.0
    for _ in range(60):
        states = run(solver, states, 1)
        fastest = max(fastest, np.abs(vertex_rows(solver, states[0], "particle_qd")).max())
    assert fastest < 1.0e-5 * SIZE


@both_dimensions
def test_free_fall_follows_gravity_of_the_world(dimension: int):
    """A body falls with the gravity that its model has now, before and after a cut through it."""
    model, solver, *states = make_solver(gravity=-9.81, dimension=dimension)
    start = vertex_rows(solver, states[0])
    states = run(solver, states, 10)
    fall = 9.81 * (10 / 60.0) ** 2 / 2
    np.testing.assert_allclose(vertex_rows(solver, states[0]) - start, [[0.0, 0.0, -fall]] * len(start), atol=2.0e-6)
    cut_to(solver, states, 1.01)
    model.set_gravity((0.0, 0.0, 0.0))
    before = vertex_rows(solver, states[0], "particle_qd")
    states = run(solver, states, 10)
    np.testing.assert_allclose(vertex_rows(solver, states[0], "particle_qd"), before, atol=2.0e-4)


@both_dimensions
@pytest.mark.parametrize("share", [0.0, 0.5])
def test_free_body_conserves_momentum(share: float, dimension: int):
    """Internal forces add no linear momentum to a body that starts with random velocities."""
    _, solver, *states = make_solver(dimension=dimension)
    if share:
        cut_to(solver, states, share)
    body = solver.bodies[0]
    velocities = states[0].particle_qd.numpy()
    count = body.cage.vertex_count
    velocities[body.vertices][:count] = np.random.default_rng(3).normal(size=(count, 3)) * [1, dimension == 3, 1]
    states[0].particle_qd.assign(velocities)
    mass = simulated(solver).system.mass.numpy()[:count, :count].astype(np.float64).sum(axis=0)
    before = mass @ vertex_rows(solver, states[0], "particle_qd")
    states = run(solver, states, 60)
    after = mass @ vertex_rows(solver, states[0], "particle_qd")
    np.testing.assert_allclose(after, before, atol=2.0e-4 * mass.sum())
    assert np.abs(before).max() > 1.0e-2 * mass.sum()


@both_dimensions
def test_hung_body_settles(dimension: int):
    """A body hung from its top face sags and comes to rest."""
    top, bottom = corners(-1, 1.0, dimension), corners(-1, 0.0, dimension)
    material = cagecut.Material(young=3.0e4, damping=0.1)
    _, solver, *states = make_solver(gravity=-9.81, fixed=top, material=material, dimension=dimension)
    rest = vertex_rows(solver, states[0])
    assert (rest[top, 2] == 1.0).all()
    states = run(solver, states, 150)
    sag = rest[:, 2] - vertex_rows(solver, states[0])[:, 2]
    assert np.abs(sag[top]).max() == 0.0
    # rho g L^2 / (2 E) = 0.16 m for a bar of this length; the clamped face makes it stiffer
    assert 0.05 < sag[bottom].mean() < 0.2
    assert np.abs(vertex_rows(solver, states[0], "particle_qd")).max() < 1.0e-3


@both_dimensions
def test_pieces_fall_apart(dimension: int):
    """After a complete cut the hung piece stays and the other falls freely."""
    material, held = cagecut.Material(young=1.0e5, damping=0.05), corners(0, 1.0, dimension)
    _, solver, *states = make_solver(gravity=-9.81, fixed=held, material=material, dimension=dimension)
    cut, report = cut_to(solver, states, 1.01)
    assert cut.complete
    assert report.piece_count == 2
    piece = solver.bodies[0].cage.vertex_component
    states = run(solver, states, 30)
    heights = vertex_rows(solver, states[0])[:, 2]
    falling = piece == piece[corners(0, 0.0, dimension)[0]]
    assert heights[falling].max() < 0.2
    assert heights[~falling].min() > -0.2


def dropped_on_the_ground(dimension: int, steps: int, **options):
    """The energy that a body dropped on Newton's ground plane has lost in its fall [J], its solver and its state."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
    builder.add_ground_plane()
    radius = 0.02
    model, solver, *states = make_solver(builder=builder, contact_radius=radius, dimension=dimension, **options)
    model.soft_contact_ke = 2.0e5
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    height = vertex_rows(solver, states[0])[:, 2].mean()
    for _ in range(steps):
        pipeline.collide(states[0], contacts)
        states = run(solver, states, 1, contacts=contacts)
    points, _ = solver.surface(states[0])
    assert -0.01 < points[:, 2].min() < 2.0 * radius
    dropped = 1000.0 * 9.81 * (height - points[:, 2].mean())
    assert dropped > 1000.0
    return dropped, solver, states[0]


@both_dimensions
def test_body_comes_to_rest_on_the_ground(dimension: int):
    """With a contact radius a body dropped on Newton's ground plane stays above it and loses its energy.

    It lands on a corner of its cage. The cage weighs, its round surface touches: flat on a side, in the plane, it
    stands on a saddle of its energy and rolls off as soon as anything tilts it (the test below).
    """
    turn = wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), 0.25 * np.pi)
    pose = {"xform": wp.transform((0.0, 0.0, 0.0), UPRIGHT * turn)} if dimension == 2 else {}
    dropped, solver, state = dropped_on_the_ground(dimension, 300, **pose)
    assert solver.bodies[0].energy(state).kinetic < 0.01 * dropped


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_round_body_in_a_square_cage_rolls_to_its_lowest_place(seed: int):
    """From flat on a side a disk rolls, to one side or the other, to where it lies as when it was put down there."""
    turn = wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), 0.25 * np.pi)
    _, put, state = dropped_on_the_ground(2, 600, xform=wp.transform((0.0, 0.0, 0.0), UPRIGHT * turn))
    expected = vertex_rows(put, state)[:, 2].mean()
    _, solver, state = dropped_on_the_ground(2, 600, seed=seed)
    rolled = vertex_rows(solver, state)
    assert abs(rolled[:, 0].mean() - 0.5) > 0.3
    assert rolled[:, 2].mean() == pytest.approx(expected, abs=0.01)
    assert solver.bodies[0].energy(state).kinetic < 0.5


@both_dimensions
def test_step_does_no_host_work(monkeypatch: pytest.MonkeyPatch, dimension: int):
    """A step reads nothing back and allocates nothing, so that it can be captured."""
    _, solver, *states = make_solver(gravity=-9.81, dimension=dimension)
    states = run(solver, states, 1)

    def refuse(*args, **kwargs):
        raise AssertionError("host work in step")

    monkeypatch.setattr(wp.array, "numpy", refuse)
    monkeypatch.setattr(wp.array, "assign", refuse)
    for name in ("zeros", "empty", "full", "clone"):
        monkeypatch.setattr(wp, name, refuse)
    states = run(solver, states, 3)
    monkeypatch.undo()
    assert vertex_rows(solver, states[0])[:, 2].max() < 1.0


@both_dimensions
def test_worlds_are_independent(dimension: int):
    """Replicated worlds share one definition, and each falls with its own gravity."""
    template = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
    cagecut.SolverCageCut.register_custom_attributes(template)
    pose = wp.transform((0.0, 0.0, 0.0), UPRIGHT if dimension == 2 else wp.quat_identity())
    cagecut.add_cage_body(template, box_cage(dimension), ball(dimension), walks=16, quadrature=40, xform=pose)
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    builder.replicate(template, 2, spacing=(3.0, 0.0, 0.0))
    model = builder.finalize(device="cpu")
    solver = cagecut.SolverCageCut(model)
    model.set_gravity((0.0, 0.0, 0.0), world=1)
    states = run(solver, (model.state(), model.state()), 10)
    heights = [states[0].particle_q[body.vertices].numpy()[:4, 2].min() for body in solver.bodies]
    assert heights[0] < -0.1
    assert heights[1] == pytest.approx(0.0, abs=1.0e-6)
