# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Edits of bodies are all or nothing, wherever they fail."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from failure_injection import FailingCalls, InjectedFailure
from solver_scenes import assert_same, both_dimensions, everything, make_solver, run, simulated
from surface_shapes import disk, sphere

ROOM = cagecut.Capacity(vertices=24, surface_points=160, surface_triangles=320)
BLADES = {
    2: cagecut.Blade([0.53, 0.5], [0.1, -1.0]),
    3: cagecut.Blade([0.53, 0.5, 0.5], [0.05, 1.0, 0.1], [0.1, -0.1, -1.0]),
}


def every_byte(solver: cagecut.SolverCageCut, states) -> dict[str, object]:
    """All arrays of model, states and body, with their unused rows, and what is referred to, by name."""
    body, model = simulated(solver), solver.model
    found = {name: array for name, array in vars(model).items() if name.startswith("particle_")}
    found |= {f"state {i} {name}": a for i, state in enumerate(states) for name, a in vars(state).items()}
    found |= {f"state {i} edit": state.cagecut.edit for i, state in enumerate(states)} | {"edit": model.cagecut.edit}
    found |= {"rest": body.rest, "fixed": body.fixed, "vertices": body.vertex_count, "points": body.point_count}
    found |= {"triangles": body._triangles, "edits": body._stamps.edits, "volumes": body.system.volumes}
    found |= {"mass": body.system.mass, "vertex mass": body.system.vertex_mass}
    found |= {"stabilizing": body.system.stabilizing_stiffness, "ties": body.system.stabilizing_mass}
    found |= {f"coordinates {name}": array for name, array in body.coordinates._cache.arrays.items()}
    values = {name: array.numpy().tobytes() for name, array in found.items() if isinstance(array, wp.array)}
    values |= {f"pointer of {name}": array.ptr for name, array in found.items() if isinstance(array, wp.array)}
    kept = (body.cage, body.surface, body.definition, body.quadrature, model.cagecut.definition[0])
    return values | {"references": [id(one) for one in kept], "count": body.coordinates.point_count}


def tiny(dimension: int):
    """A body of few points in motion, with contact and a cut that has begun."""
    surface = sphere(level=1, radius=0.4) if dimension == 3 else disk(12, 2, 0.4)
    options = {"walks": 4, "quadrature": 12, "contact_radius": 0.01, "capacity": ROOM, "fixed": [0]}
    _, solver, *states = make_solver(gravity=-9.81, dimension=dimension, surface=surface, **options)
    states = run(solver, states, 2)
    cut = solver.begin_cut(0, BLADES[dimension])
    solver.advance_cut(cut, to=0.3 * cut.length, states=states)
    return solver, states, cut


def going_on(solver, states, cut) -> Callable[[], object]:
    """A step of the cut that does not get through."""
    return lambda: solver.advance_cut(cut, to=0.6 * cut.length, states=states)


def cutting_through(solver, states, cut) -> Callable[[], object]:
    """A step after which there are two pieces, which share the quadrature points."""
    return lambda: solver.advance_cut(cut, to=2.0, states=states)


def turning(solver, states, cut) -> Callable[[], object]:
    """The first step after a turn."""
    cut.turn([0.4, -1.0] if simulated(solver).cage.dimension == 2 else [0.4, 0.0, -1.0])
    return lambda: solver.advance_cut(cut, to=cut.depth + 0.2, states=states)


def restoring(solver, states, cut) -> Callable[[], object]:
    """Back from two pieces to before the cut went on."""
    snapshot = solver.snapshot(0, states=states, cuts=(cut,))
    solver.advance_cut(cut, to=2.0, states=states)
    return lambda: solver.restore(snapshot)


ACTIONS = (going_on, cutting_through, turning, restoring)


@both_dimensions
@pytest.mark.parametrize("make", ACTIONS)
def test_failed_edits_of_bodies_change_nothing(monkeypatch: pytest.MonkeyPatch, make, dimension: int):
    """Stopped at any Warp call, an edit leaves every byte as it was; then it does what it would have done."""
    monkeypatch.setattr("newton_cagecut.solver.cut.transfer._TRANSFER_WALKS", 16)
    solver, states, cut = tiny(dimension)
    make(solver, states, cut)()
    expected = everything(solver, states)
    solver, states, cut = tiny(dimension)
    act = make(solver, states, cut)
    before, depth, failures = every_byte(solver, states), cut.depth, 0
    while True:
        with FailingCalls(failures) as calls, contextlib.suppress(InjectedFailure):
            act()
        if not calls.raised:
            break
        after = every_byte(solver, states)
        changed = [name for name in before if before[name] != after[name]]
        assert not changed, f"stopped at call {failures}"
        assert cut.depth == depth
        failures += 1
    assert failures == calls.count > 30
    assert_same(expected, everything(solver, states))
    run(solver, states, 2)
    assert np.isfinite(states[0].particle_q.numpy()).all()
