# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the reduced system on stiff, light, heavy, fast, crushed and nearly incompressible bodies."""

import itertools

import numpy as np
import pytest

from elastic_bodies import DT, Body, both_dimensions

MODELS = ("neo_hookean", "stvk")
YOUNG, POISSON, DENSITY, TIME_STEPS = (1e3, 1e6, 1e10), (0.3, 0.499), (10.0, 2e4), (1.0 / 30.0, 1.0 / 1000.0)


@both_dimensions
@pytest.mark.parametrize("model", MODELS)
def test_thrown_body_flies_like_a_point(dimension, model):
    """Thrown at 100 m/s while it shakes, a body of any stiffness, weight and time step flies on and gains no energy."""
    for young, poisson, density, dt in itertools.product(YOUNG, POISSON, DENSITY, TIME_STEPS):
        body = Body(dimension, (1, 1, 2), 2, model=model, young=young, poisson=poisson, density=density)
        speed = 100.0 * body.to_world(np.ones(dimension) / dimension**0.5)
        body.place(velocities=speed + body.random(1, 1.0))
        mass = density * body.volume
        start, velocity = body.energy(), body.momentum() / mass
        body.run(30, body.gravity, dt=dt)
        case = f"young {young:g}, poisson {poisson}, density {density}, dt {dt:g}"
        assert np.isfinite(body.positions).all(), case
        fall = 30.0 * dt * body.gravity
        np.testing.assert_allclose(body.momentum() / mass, velocity + fall, atol=1.0, err_msg=case)
        work = 0.5 * mass * (np.sum((velocity + fall) ** 2) - np.sum(velocity**2))
        assert body.energy() < 1.02 * start + work, case


@both_dimensions
@pytest.mark.parametrize("model", MODELS)
def test_body_in_one_point_stays_finite(dimension, model):
    """All vertices in one point are an equilibrium without stretches: nothing divides by them, and no energy comes."""
    for young, dt in itertools.product(YOUNG, TIME_STEPS):
        body = Body(dimension, (1, 1, 2), 2, model=model, young=young)
        start = body.place(positions=np.zeros_like(body.rest)).energy()
        body.run(20, body.gravity, dt=dt)
        assert np.isfinite(body.positions).all()
        assert body.system.energy(body.x, body.v).elastic < 1.01 * start


@both_dimensions
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("share", [0.01, -1.0])
def test_squeezed_stiff_body_loses_energy(dimension, model, share):
    """A body of 1 GPa pressed to a hundredth of its height or turned inside out gains no energy beyond the start's."""
    body = Body(dimension, (1, 1, 2), 2, model=model, young=1e9)
    body.place(positions=body.rest + (share - 1.0) * np.outer(body.rest @ body.up, body.up) + body.random(3, 1e-4))
    start = body.energy()
    body.run(120)
    assert np.isfinite(body.positions).all()
    assert body.energy() < start


@both_dimensions
@pytest.mark.parametrize("dt", [1.0 / 30.0, DT])
def test_nearly_incompressible_body_comes_to_rest(dimension, dt):
    """Rubber with Poisson's ratio 0.499 that is thrown about keeps its volume and only turns and drifts in the end."""
    body = Body(dimension, (1, 1, 2), 2, young=1e6, poisson=0.499)
    start = body.place(velocities=body.random(1, 1.0)).energy()
    body.run(60, dt=dt)
    end = body.system.energy(body.x, body.v)
    assert end.elastic < 1e-4 * start
    assert end.kinetic < start
    np.testing.assert_allclose(np.linalg.det(body.deformation(body.positions - body.rest)), 1.0, atol=1e-4)


@both_dimensions
def test_stiff_hung_body_hardly_moves(dimension):
    """A body of 10 GPa that hangs for a second, or carries twenty times the density, moves by micrometres only."""
    for density, dt in itertools.product((1e3, 2e4), TIME_STEPS):
        body = Body(dimension, (1, 1, 2), 2, young=1e10, density=density, fix_top=True)
        body.run(60, body.gravity, dt=dt)
        assert np.abs(body.positions - body.rest).max() < 1e-5


@both_dimensions
@pytest.mark.parametrize("poisson", [-0.3, 0.0, 0.3, 0.4])
def test_squeezed_body_recovers(dimension, poisson):
    """A neo-Hookean body that is squeezed to a tenth in all directions comes back to its size."""
    body = Body(dimension, (1, 1, 2), 2, young=1e5, poisson=poisson, damping=0.01)
    center = body.rest.mean(axis=0)
    squeezed = center + 0.1 * (body.rest - center)
    start = body.place(positions=squeezed + body.random(3, 1e-4)).energy()
    body.run(240)
    assert body.system.energy(body.x, body.v).elastic < 1e-3 * start
    sizes = [np.linalg.norm(points - points.mean(axis=0), axis=1) for points in (body.positions, body.rest)]
    np.testing.assert_allclose(sizes[0], sizes[1], rtol=0.02)
