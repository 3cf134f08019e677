# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Strain averaged over clusters in the solver: an option that costs nothing where it is not taken."""

import newton
import numpy as np
import pytest

import newton_cagecut as cagecut
from newton_cagecut.report.stability import shapes

BLADE = cagecut.Blade((0.52, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0))


def bar(strain, *, poisson=0.499, held=True, segments=8, quadrature=300, size=(1.0, 0.1, 0.1)):
    """A solver with a bar, and two states."""
    cage = shapes.bar(segments, size).cage()
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    left = cage.vertices[:, 0] < cage.vertices[:, 0].min() + 1e-6
    material = cagecut.Material(young=1e6, poisson=poisson, damping=0.02)
    fixed = np.flatnonzero(left) if held else None
    options = {"walks": 64, "quadrature": quadrature, "fixed": fixed, "material": material}
    cagecut.add_cage_body(builder, cage, shapes.surface_in(cage), cuttable=not held, **options)
    model = builder.finalize(device="cpu")
    return cagecut.SolverCageCut(model, strain=strain), [model.state(), model.state()]


def test_bar_bends_as_the_elastica_does():
    """F L^2 = 5 E I bends the tip down by 0.714 of the length; the same bar bends less than half as far by points."""
    tips = {}
    for strain in ("points", "averaged"):
        solver, states = bar(strain)
        body = solver.bodies[0]
        start = states[0].particle_q[body.vertices].numpy().copy()
        tip = np.flatnonzero(start[:, 0] > start[:, 0].max() - 1e-6)
        forces = np.zeros_like(states[0].particle_f.numpy())
        forces[np.arange(len(forces))[body.vertices][tip], 2] = -5.0 * 1e6 * 0.1**4 / 12.0 / len(tip)
        for _ in range(100):
            states[0].particle_f.assign(forces)
            solver.step(*states, None, None, 0.2)
            states.reverse()
        tips[strain] = (start - states[0].particle_q[body.vertices].numpy())[tip, 2].mean() / 0.714
    assert abs(tips["averaged"] - 1.0) < 0.1
    assert tips["points"] < 0.5


def test_option_is_named_and_costs_nothing_where_it_is_not_taken():
    """Without it there are no rows beside the points, and gradients are those of the points themselves."""
    with pytest.raises(ValueError, match="strain"):
        cagecut.SolverCageCut.Config(strain="means")
    arrays = bar("points", segments=2, quadrature=40)[0].bodies[0]._simulated.system.arrays
    assert arrays.gradients.ptr == arrays.point_gradients.ptr
    assert arrays.clusters is None
    assert arrays.softened is None


def test_cut_gives_no_energy_and_rows_are_those_made_anew():
    """Over a whole cut of a bent bar no advance adds energy, and clusters keep to what the weights say alone."""
    solver, states = bar("averaged", held=False, segments=4, quadrature=150, size=(1.0, 0.2, 0.2))
    body = solver.bodies[0]
    system = body._simulated.system
    for state in states:
        rows = state.particle_q.numpy()
        rows[body.vertices] += 0.3 * np.outer(rows[body.vertices][:, 0] ** 2, (0.0, 0.0, 1.0))
        state.particle_q.assign(rows)
    made = (system.arrays.gradients, system.arrays.volumes, system.arrays.softened)
    cut = solver.begin_cut(0, BLADE)
    for k in range(6):
        report = solver.advance_cut(cut, to=cut.length * (k + 1) / 6, states=states)
        assert report.energy_injected < 1e-6 * report.energy_before
        kept = [array.numpy().copy() for array in made]
        system._average(body.cage.vertices)
        assert all(np.array_equal(a, b.numpy()) for a, b in zip(kept, made, strict=True))
    assert report.separated
    pieces = system.piece.numpy()[: body.cage.vertex_count]
    means = np.abs(system.arrays.gradients.numpy()[system.point_count :, : len(pieces)]).max(axis=2)
    assert not (means[:, pieces == 0].max(axis=1) * means[:, pieces == 1].max(axis=1)).any()
