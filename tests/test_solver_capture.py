# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Captured steps are the eager ones, and no step touches the host."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from failure_injection import FailingCalls
from solver_scenes import corners, make_solver, simulated, slanted_blade

DT = 1.0 / 60.0


class HungBody:
    """A stretched body that hangs from its top and touches the ground, with two states and contacts."""

    def __init__(self, dimension: int, **options) -> None:
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
        builder.add_ground_plane()
        self.model, solver, *self.states = make_solver(
            builder=builder,
            contact_radius=0.15,
            fixed=corners(-1, 1.0, dimension),
            material=cagecut.Material(young=3.0e4, damping=0.02),
            dimension=dimension,
        )
        self.solver = cagecut.SolverCageCut(self.model, **options) if options else solver
        self.pipeline = newton.CollisionPipeline(self.model)
        self.contacts = self.pipeline.contacts()
        self.stretch()

    def stretch(self) -> None:
        """Pull the lower half down by a third, onto the ground."""
        positions = self.states[0].particle_q.numpy()
        rows = simulated(self.solver).vertices
        positions[rows][:, 2] -= 0.3 * (1.0 - positions[rows][:, 2])
        self.states[0].particle_q.assign(positions)
        self.states[1].assign(self.states[0])

    def step_twice(self) -> None:
        """Two steps, so that the states end where they were."""
        for state_in, state_out in (self.states, self.states[::-1]):
            self.pipeline.collide(state_in, self.contacts)
            self.solver.step(state_in, state_out, None, self.contacts, DT)

    def cut(self) -> None:
        """Cut the body half through."""
        cut = self.solver.begin_cut(0, slanted_blade(self.solver.bodies[0].cage.dimension))
        self.solver.advance_cut(cut, to=0.5 * cut.length, states=self.states)

    def arrays(self) -> dict[str, np.ndarray]:
        """What steps change, statistics included."""
        record = simulated(self.solver).system.record
        arrays = {f"state {i} {name}": getattr(s, name) for i, s in enumerate(self.states) for name in _STATE}
        arrays |= {"counts": record.counts, "residuals": record.residuals}
        return {name: array.numpy().copy() for name, array in arrays.items()}


_STATE = ("particle_q", "particle_qd")


@pytest.mark.parametrize(
    "options", [{}, {"dense_vertices": 0}, {"integrator": "paper"}], ids=["dense", "blocks", "paper"]
)
@pytest.mark.parametrize("dimension", [2, 3])
def test_captured_steps_are_the_eager_ones(dimension: int, options: dict):
    """A graph of two steps, replayed before and after a cut, gives the states and statistics of eager steps."""
    eager, captured = HungBody(dimension, **options), HungBody(dimension, **options)
    for body in (eager, captured):
        body.step_twice()
    before = captured.arrays()
    with wp.ScopedCapture(device=captured.model.device) as capture:
        captured.step_twice()
    for name, values in captured.arrays().items():
        np.testing.assert_array_equal(values, before[name], err_msg=f"{name} while recording")
    for edit in range(2):
        for body in (eager, captured) if edit else ():
            body.cut()
        for _ in range(5):
            eager.step_twice()
            wp.capture_launch(capture.graph)
        found = captured.arrays()
        for name, values in eager.arrays().items():
            np.testing.assert_array_equal(found[name], values, err_msg=name)
        assert int(simulated(captured.solver).contact.points.count.numpy()[0]) > 0
    assert found["counts"][0] == 22
    assert np.abs(found["state 0 particle_qd"]).max() > 1.0e-3


@pytest.mark.parametrize(
    "options", [{}, {"dense_vertices": 0}, {"integrator": "paper"}], ids=["dense", "blocks", "paper"]
)
def test_step_allocates_nothing_and_reads_nothing(options: dict, monkeypatch: pytest.MonkeyPatch):
    """Of all that a step calls of Warp none allocates, reads an array back or waits for the device."""
    body = HungBody(3, **options)
    body.step_twice()
    calls = []
    names = [(wp, name) for name in ("zeros", "empty", "full", "clone", "zeros_like", "empty_like", "array")]
    names += [(wp, name) for name in ("synchronize", "synchronize_device", "synchronize_stream", "capture_while")]
    names += [(wp.array, name) for name in ("numpy", "assign", "list", "__array__")]
    for owner, name in names:
        monkeypatch.setattr(owner, name, lambda *_, called=name, **__: calls.append(called))
    for state_in, state_out in (body.states, body.states[::-1], body.states[:1] * 2):
        body.solver.step(state_in, state_out, None, body.contacts, DT)
    monkeypatch.undo()
    assert calls == []
    with FailingCalls() as counted:
        body.solver.step(*body.states, None, body.contacts, DT)
    first = counted.count
    with FailingCalls() as counted:
        body.solver.step(*body.states, None, body.contacts, DT)
    assert counted.count == first < 150
