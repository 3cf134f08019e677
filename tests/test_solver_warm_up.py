# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""After warm_up nothing is compiled or loaded any more, whatever a scene does."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from solver_scenes import both_dimensions, everything, make_solver, run

SCENE = """
import sys
sys.path[:0] = ["tests", "."]
import newton
import newton_cagecut as cagecut
from solver_scenes import make_solver, run, slanted_blade

dimension = {dimension}
builder = newton.ModelBuilder()
builder.add_ground_plane()
model, solver, *states = make_solver(
    builder=builder, dimension=dimension, walks=8, quadrature=30, contact_radius={radius}, cuttable={cuttable}
)
solver.warm_up(progress=False)
print("WARM", flush=True)
pipeline = newton.CollisionPipeline(model)
contacts = pipeline.contacts()
pipeline.collide(states[0], contacts)
states = run(solver, states, 2, contacts=contacts)
if {cuttable}:
    snapshot = solver.snapshot(0, states=states)
    cut = solver.begin_cut(0, slanted_blade(dimension))
    solver.advance_cut(cut, to=0.3 * cut.length, states=states)
    cut.turn([0.1, -1.0] if dimension == 2 else [0.1, 0.1, -1.0])
    solver.advance_cut(cut, to=3.0, states=states)
    pipeline.collide(states[0], contacts)
    states = run(solver, states, 2, contacts=contacts)
    solver.restore(snapshot)
solver.surface(states[0])
solver.bodies[0].energy(states[0])
states = run(solver, states, 2)
print("DONE", flush=True)
"""


@pytest.mark.parametrize(
    ("dimension", "radius", "cuttable"), [(3, 0.01, True), (2, 0.01, True), (3, None, False)], ids=str
)
def test_nothing_is_loaded_after_warm_up(dimension: int, radius: float | None, cuttable: bool):
    """In a fresh process, steps, contacts, cuts that turn and go through, undo and surfaces load no kernel anew."""
    code = SCENE.format(dimension=dimension, radius=radius, cuttable=cuttable)
    root = Path(__file__).parents[1]
    result = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True)
    assert "DONE" in result.stdout, result.stderr
    before, after = result.stdout.split("WARM")
    assert "load on device" in before
    assert "load on device" not in after, after


@both_dimensions
def test_warm_up_changes_nothing(dimension: int):
    """Bodies, model and states are the same after it, before and amid a cut, and steps go on as without."""
    results = []
    for warm in (False, True):
        _, solver, *states = make_solver(gravity=-9.81, dimension=dimension, contact_radius=0.01)
        states = run(solver, states, 2)
        before = everything(solver, states)
        if warm:
            solver.warm_up(progress=False)
        for name, values in everything(solver, states).items():
            np.testing.assert_array_equal(values, before[name], err_msg=name)
        states = run(solver, states, 2)
        results.append(everything(solver, states))
    for name, values in results[0].items():
        np.testing.assert_array_equal(values, results[1][name], err_msg=name)
