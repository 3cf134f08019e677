# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Rotation against what a rigid body does: spin, pendulum, a tumbling box."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from elastic_bodies import DT, SIZE, Body


@pytest.mark.parametrize("young", [1e4, 1e6, 1e9])
@pytest.mark.parametrize("speed", [1.0, 10.0])
def test_spin_is_kept(young, speed):
    """After a second a free body has its angular momentum within 1 %, and never more energy than at the start."""
    body = Body(3, points=2, young=young)
    axis = np.array([1.0, 2.0, -2.0]) / 3.0 if young < 1e5 else np.array([0.0, 0.0, 1.0])
    body.place(velocities=np.cross(speed * axis, body.rest - body.rest.mean(axis=0)))
    start, energy = body.angular_momentum(), body.energy()
    for _ in range(60):
        assert body.run(1).energy() < 1.001 * energy
        off = np.linalg.norm(body.angular_momentum() - start)
        assert off < 0.01 * np.linalg.norm(start)


@pytest.mark.parametrize("young", [1e6, 1e8])
def test_pendulum_falls_in_time(young):
    """A stiff body hinged along a line swings down as a rigid one does, in time and in speed within 2 %."""
    body = Body(3, points=2, young=young)
    hinge = (body.rest[:, 0] < 1e-6) & (body.rest[:, 2] > SIZE[2] - 1e-6)
    body.system.fixed.assign(np.pad(hinge, (0, 2)).astype(np.int32))
    pivot = body.rest[hinge].mean(axis=0)
    mass = body.system.mass.numpy()[: body.count, : body.count].astype(np.float64)
    arm, total = body.rest - pivot, mass.sum()
    center = mass.sum(axis=1) @ arm / total
    inertia = np.einsum("ij,ik,jk->", mass, arm[:, [0, 2]], arm[:, [0, 2]])
    length, start = np.hypot(center[0], center[2]), np.arctan2(center[0], -center[2])

    def rate(t, y):
        return [y[1], -total * 9.81 * length / inertia * np.sin(y[0])]

    def bottom(t, y):
        return y[0]

    bottom.terminal = True
    exact = solve_ivp(rate, (0.0, 3.0), [start, 0.0], events=bottom, rtol=1e-9, atol=1e-9)
    time, angle = 0.0, start
    while angle > 0.0:
        body.run(1, body.gravity)
        before, place = angle, mass.sum(axis=1) @ (body.positions - pivot) / total
        angle = np.arctan2(place[0], -place[2])
        time += DT
    assert time + DT * angle / (before - angle) == pytest.approx(exact.t[-1], rel=0.02)
    speed = np.linalg.norm(mass.sum(axis=1) @ body.velocities / total)
    assert speed == pytest.approx(abs(exact.y[1, -1]) * length, rel=0.02)


def test_middle_axis_flips_in_time():
    """A stiff box that spins about its middle axis flips when Euler's equations say so, within 2 %."""
    body = Body(3, points=2, young=1e8)
    mass = body.system.mass.numpy()[: body.count, : body.count].astype(np.float64)
    offset = body.rest - mass.sum(axis=1) @ body.rest / mass.sum()
    second = np.einsum("ij,ik,jk->k", mass, offset, offset)
    inertia = second.sum() - second
    spin = np.array([0.1, 8.0, 0.1])

    def rate(t, omega):
        return -np.cross(omega, inertia * omega) / inertia

    def flip(t, omega):
        return omega[1]

    flip.terminal = True
    exact = solve_ivp(rate, (0.0, 5.0), spin, events=flip, rtol=1e-9, atol=1e-9).t[-1]
    body.place(velocities=np.cross(spin, offset))
    axis, time, along = np.array([0.0, 1.0, 0.0]), 0.0, 1.0
    while along > 0.0:
        body.run(1)
        F = body.deformation(body.positions - body.rest).mean(axis=0)
        before, along = along, (F @ axis) @ body.angular_momentum()
        time += DT
    assert time + DT * along / (before - along) == pytest.approx(exact, rel=0.02)
