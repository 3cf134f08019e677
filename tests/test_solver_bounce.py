# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Bodies thrown onto the ground: contact gives no energy, whatever the step, the stiffness and the phase."""

from __future__ import annotations

import newton
import numpy as np
import pytest

import newton_cagecut as cagecut
from newton_cagecut.report.stability.workbench import CUBE, Workbench

FRAME = 1.0 / 60.0
RADIUS, GRAVITY = 0.01, 9.81


class Drop:
    """A cube above the ground; energies are those of the body, without the ground's."""

    def __init__(self) -> None:
        self.trial = Workbench(quick=True).bar(
            cagecut.Material(), segments=1, size=CUBE, gravity=(0.0, 0.0, -GRAVITY), ground=True
        )
        self.mass = float(self.trial.vertex_masses().sum())
        self.particles = self.trial.solver.bodies[0].surface_particles
        self.surface = self.trial.model.particle_q.numpy()[self.particles]
        self.lift = np.array([0.0, 0.0, 0.5 * CUBE[2] + RADIUS])

    def throw(self, *, height: float, speed: float, young: float, stiffness: float = 1e6, damping: float = 0.0) -> Drop:
        """Set the cube above the ground, at a speed towards it."""
        model: newton.Model = self.trial.model
        self.trial.set_material(cagecut.Material(young=young, damping=damping))
        for array, value in ((model.shape_material_ke, stiffness), (model.shape_material_kd, 0.0)):
            array.fill_(value)
        model.soft_contact_ke, model.soft_contact_kd = stiffness, 0.0
        place = self.lift + (0.0, 0.0, height)
        self.trial.place(self.trial.rest + place, (0.0, 0.0, -speed))
        for state in self.trial.states:
            for field, values in ((state.particle_q, self.surface + place), (state.particle_qd, (0.0, 0.0, -speed))):
                rows = field.numpy()
                rows[self.particles] = values
                field.assign(rows)
        self.start = self.energy()
        return self

    def energy(self) -> float:
        """Elastic, kinetic and potential energy above the ground [J]."""
        height = self.trial.center()[2] - self.lift[2]
        return sum(self.trial.energy()) + self.mass * GRAVITY * height

    @property
    def speed(self) -> float:
        """Speed of the centre of mass upwards [m/s]."""
        return float(self.trial.momentum()[2] / self.mass)


@pytest.fixture(scope="module")
def drop() -> Drop:
    """A cube, built once."""
    return Drop()


@pytest.mark.parametrize("speed", [1.0, 10.0, 100.0])
@pytest.mark.parametrize("young", [1e4, 1e5, 1e7])
def test_blow_gives_no_energy(drop: Drop, young: float, speed: float):
    """After the blow there is no more energy than before it, however deep in the ground the cube is found.

    The heights differ by parts of what it falls in a step. Within the blow a cube that is found half in the ground may
    be squeezed by a tenth more than its energy; one that is found a little deep never has more.
    """
    for part in (0.0, 0.3, 0.6, 0.9):
        drop.throw(height=0.001 + part * speed * FRAME, speed=speed, young=young)
        depth = 0.0
        for _ in range(12):
            drop.trial.step(FRAME)
            depth = min(depth, drop.trial.positions[:, 2].min())
            assert drop.energy() < (1.0 + (1e-5 if depth > -0.05 else 0.1)) * drop.start
        assert drop.energy() < (1.0 + 1e-5) * drop.start


@pytest.mark.parametrize("stiffness", [1e3, 1e5, 1e7])
@pytest.mark.parametrize("dt", [1.0 / 30.0, 1.0 / 240.0])
def test_blow_gives_no_energy_whatever_the_ground(drop: Drop, dt: float, stiffness: float):
    """The same on soft and hard ground, in long and short steps."""
    drop.throw(height=0.01, speed=3.0, young=1e5, stiffness=stiffness)
    for _ in range(40):
        drop.trial.step(dt)
        assert drop.energy() < (1.0 + 1e-5) * drop.start


@pytest.mark.parametrize("young", [1e5, 1e7])
def test_dropped_body_comes_to_rest_under_its_weight(drop: Drop, young: float):
    """It stops bouncing, and lies as deep in the ground as its weight presses."""
    stiffness = 1e5
    drop.throw(height=0.05, speed=1.0, young=young, stiffness=stiffness, damping=0.01)
    drop.trial.run(300, FRAME)
    assert np.abs(drop.trial.velocities).max() < 1e-3
    body, trial = drop.trial.solver.bodies[0], drop.trial
    surface = trial.state.particle_q.numpy()[body.surface_particles][: body.surface.point_count]
    depth = np.maximum(RADIUS - surface[:, 2], 0.0)
    assert stiffness * depth.sum() == pytest.approx(drop.mass * GRAVITY, rel=1e-3)


def test_resolved_bounce_is_elastic(drop: Drop):
    """On soft ground without damping a stiff cube takes half a period, pi / omega, and leaves as fast as it came.

    A step damps by omega dt / 4 of critical: the rebound's loss is halved with the step.
    """
    stiffness, speed = 2e3, 5.0
    losses = []
    for dt in (2e-3, 1e-3):
        drop.throw(height=1e-4, speed=speed, young=1e7, stiffness=stiffness)
        steps = 0
        while drop.speed < 0.0 or drop.trial.positions[:, 2].min() < RADIUS:
            drop.trial.step(dt)
            steps += 1
            assert steps < 400
        losses.append(1.0 - drop.speed / speed)
    assert 0.0 < losses[1] < 0.05
    assert losses[1] == pytest.approx(0.5 * losses[0], rel=0.15)
