# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cage bodies beside rigid bodies and particles of other solvers, and Newton's own tests with cage bodies."""

from __future__ import annotations

import unittest
import warnings

import newton
import numpy as np
import pytest
import warp as wp
from newton.tests import test_runtime_gravity, test_softbody_simulation

import newton_cagecut as cagecut
from cage_shapes import box
from solver_scenes import ball, box_cage
from surface_shapes import sphere

DT = 1.0 / 120.0
STEPS = 12


def _add_cage(builder: newton.ModelBuilder, **options) -> None:
    """Add the ball in the box."""
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cagecut.add_cage_body(builder, box_cage(), ball(), **{"walks": 16, "quadrature": 40, **options})


def _add_others(builder: newton.ModelBuilder) -> None:
    """Add a rigid box that is thrown, and two particles tied by a spring."""
    rigid = builder.add_body(xform=wp.transform((4.0, 0.0, 2.0)), label="crate")
    builder.add_shape_box(rigid, hx=0.1, hy=0.1, hz=0.1)
    for height in (1.0, 1.4):
        builder.add_particle(pos=(8.0, 0.0, height), vel=(0.1, 0.0, 0.0), mass=0.2)
    builder.add_spring(builder.particle_count - 2, builder.particle_count - 1, ke=50.0, kd=0.5, control=0.0)


def _model(*, cage: bool, others: bool) -> newton.Model:
    builder = newton.ModelBuilder()
    if others:
        _add_others(builder)
    if cage:
        _add_cage(builder, contact_radius=0.01)
    return builder.finalize(device="cpu")


def _run(model: newton.Model, *solvers: newton.solvers.SolverBase) -> newton.State:
    """The loop of the guide: each solver steps from the same state to the same state, the soft one last."""
    state_0, state_1 = model.state(), model.state()
    for _ in range(STEPS):
        state_0.clear_forces()
        for solver in solvers:
            solver.step(state_0, state_1, None, None, DT)
        state_0, state_1 = state_1, state_0
    return state_0


@pytest.mark.parametrize("other", [newton.solvers.SolverSemiImplicit, newton.solvers.SolverXPBD])
def test_two_solvers_in_one_loop(other: type):
    """Each body moves as it does in a scene of its own: no solver reverts what the other wrote."""
    model = _model(cage=True, others=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        soft = cagecut.SolverCageCut(model, foreign="keep")
    mixed = _run(model, other(model), soft)
    rigid_model = _model(cage=False, others=True)
    rigid = _run(rigid_model, other(rigid_model))
    soft_model = _model(cage=True, others=False)
    alone = _run(soft_model, cagecut.SolverCageCut(soft_model))
    for name in ("body_q", "body_qd"):
        np.testing.assert_array_equal(getattr(mixed, name).numpy(), getattr(rigid, name).numpy())
    for name in ("particle_q", "particle_qd"):
        found = getattr(mixed, name).numpy()
        np.testing.assert_array_equal(found[:2], getattr(rigid, name).numpy())
        np.testing.assert_array_equal(found[2:], getattr(alone, name).numpy())
    assert np.abs(mixed.body_qd.numpy()).max() > 0.5


def test_what_nobody_integrates_is_copied_and_named():
    """Alone, the solver carries foreign rows from state to state, and names them once in a warning."""
    model = _model(cage=True, others=True)
    with pytest.warns(UserWarning, match=r"1 rigid body \(.*crate.*\) and 2 particles \(0, 1\).*foreign=\"keep\""):
        solver = cagecut.SolverCageCut(model)
    start = model.state()
    start.body_q.assign(start.body_q.numpy() + np.float32(0.25))
    start.particle_q.assign(start.particle_q.numpy() + np.float32(0.5))
    end = model.state()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solver.step(start, end, None, None, DT)
    np.testing.assert_array_equal(end.body_q.numpy(), start.body_q.numpy())
    np.testing.assert_array_equal(end.particle_q.numpy()[:2], start.particle_q.numpy()[:2])


def test_kinematic_bodies_and_idle_particles_are_not_named():
    """A body that is moved by hand, and particles that nothing moves, are no reason for a warning."""
    builder = newton.ModelBuilder()
    builder.add_body(is_kinematic=True)
    builder.add_particle(pos=(5.0, 0.0, 0.0), vel=(0.0, 0.0, 0.0), mass=0.0)
    _add_cage(builder)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cagecut.SolverCageCut(builder.finalize(device="cpu"))


class CageBuilder(newton.ModelBuilder):
    """A builder that makes a cage body where Newton's tests ask for a particle."""

    def add_particle(self, pos, vel, mass, **_) -> int:
        """Add a small ball in a box whose first vertex is the particle."""
        cagecut.SolverCageCut.register_custom_attributes(self)
        first, cage, options = self.particle_count, box(), {"walks": 4, "quadrature": 24, "cuttable": False}
        material = cagecut.Material(density=mass)
        pose = wp.transform(wp.vec3(*map(float, pos)))
        surface = sphere(level=1, radius=0.4)
        cagecut.add_cage_body(self, cage, surface, xform=pose, velocity=vel, material=material, **options)
        return first


@pytest.mark.parametrize("name", ["test_runtime_gravity_particles", "test_global_gravity_particles"])
def test_newtons_gravity_tests_pass(name: str, monkeypatch: pytest.MonkeyPatch):
    """Newton's own tests of gravity, unchanged, with a cage body in the place of each particle."""
    monkeypatch.setattr(newton, "ModelBuilder", CageBuilder)
    getattr(test_runtime_gravity, name)(unittest.TestCase(), "cpu", cagecut.SolverCageCut)


@pytest.mark.parametrize(
    "name", ["test_runtime_gravity_bodies", "test_per_world_gravity_bodies", "test_global_gravity_bodies"]
)
def test_newtons_tests_of_rigid_bodies_are_refused(name: str):
    """A model with rigid bodies alone is refused with the reason, before anything is stepped."""
    with pytest.raises(ValueError, match="no cage bodies"):
        getattr(test_runtime_gravity, name)(unittest.TestCase(), "cpu", cagecut.SolverCageCut)


def test_newtons_free_fall_passes(monkeypatch: pytest.MonkeyPatch):
    """Newton's test of a falling soft grid, unchanged, with a cage of the grid's box and tetrahedra of its corners."""
    corners = 0.3 * np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    tetrahedra = [(0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 6, 4), (3, 6, 5, 7), (0, 3, 6, 5)]

    def build(device, **_) -> newton.Model:
        builder = newton.ModelBuilder()
        cagecut.SolverCageCut.register_custom_attributes(builder)
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        surface = sphere(level=1, radius=0.12)
        surface = cagecut.Surface(surface.points - surface.points.mean(axis=0) + 0.15, surface.triangles)
        options = {"walks": 64, "cuttable": False, "xform": wp.transform((0.0, 0.0, 1.0))}
        material = cagecut.Material(young=1.3e5, poisson=0.25)
        cagecut.add_cage_body(builder, cagecut.Cage(corners, faces), surface, material=material, **options)
        model = builder.finalize(device=device)
        model.tet_indices = wp.array(tetrahedra, dtype=wp.int32, device=device)
        model.set_gravity((0.0, 0.0, -9.81))
        return model

    monkeypatch.setattr(test_softbody_simulation, "_build_soft_grid", build)
    monkeypatch.setattr(test_softbody_simulation, "_make_solver", lambda model, _: cagecut.SolverCageCut(model))
    test_softbody_simulation.test_soft_grid_free_fall(unittest.TestCase(), "cpu", "cage_cut")
