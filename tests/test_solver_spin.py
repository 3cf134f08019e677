# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Spin of pieces and bodies that fly on their own, and of a body that draws in."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from newton_cagecut.report.stability.shapes import bar, surface_in
from newton_cagecut.report.stability.trial import Trial
from newton_cagecut.report.stability.workbench import Workbench

FRAME = 1.0 / 60.0
SPINS = np.array([[3.0, -8.0, 5.0], [0.5, 0.5, -0.7]])
FLIGHTS = np.array([[1.0, 2.0, 3.0], [-2.0, 0.0, 0.5]])
SLANTED = cagecut.Blade((0.6, 0.0, 1.0), (0.0, 1.0, 0.0), (0.2, 0.0, -1.0))


def make_trial(cages: list[cagecut.Cage], materials: list[cagecut.Material]) -> Trial:
    """Free bodies beside each other."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    for number, (cage, material) in enumerate(zip(cages, materials, strict=True)):
        pose = wp.transform((0.0, 2.0 * number, 0.0), wp.quat_identity())
        cagecut.add_cage_body(builder, cage, surface_in(cage), xform=pose, material=material, walks=64, quadrature=80)
    return Trial(builder)


def thrown(places: np.ndarray, spin: np.ndarray, flight: np.ndarray) -> np.ndarray:
    """Velocities of a rigid motion about the mean place."""
    return np.cross(spin, places - places.mean(axis=0)) + flight


@pytest.fixture(scope="module")
def halves() -> Trial:
    """A bar that is cut through."""
    trial = Workbench(quick=True).bar(cagecut.Material(young=1e6), cuttable=True, quadrature=120)
    cut = trial.solver.begin_cut(0, SLANTED)
    trial.solver.advance_cut(cut, to=cut.length, states=trial.states)
    return trial


@pytest.mark.parametrize("young", [1e4, 1e6, 1e8, 1e9])
def test_pieces_tumble_on_their_own(halves: Trial, young: float):
    """Two pieces, of which one tumbles fast and one slowly, keep their own angular momenta within 2 %, and energy."""
    halves.set_material(cagecut.Material(young=young))
    pieces = [piece.vertices for piece in halves.solver.pieces()]
    velocities = np.zeros_like(halves.rest)
    for vertices, spin, flight in zip(pieces, SPINS, FLIGHTS, strict=True):
        velocities[vertices] = thrown(halves.rest[vertices], spin, flight)
    halves.place(halves.rest, velocities)
    start, energy = [halves.angular_momentum(vertices) for vertices in pieces], sum(halves.energy())
    momentum = halves.momentum()
    for _ in range(60):
        halves.step(FRAME)
        assert sum(halves.energy()) < 1.001 * energy
    for vertices, before in zip(pieces, start, strict=True):
        off = np.linalg.norm(halves.angular_momentum(vertices) - before)
        assert off < 0.02 * np.linalg.norm(before)
    np.testing.assert_allclose(halves.momentum(), momentum, atol=1e-4 * np.linalg.norm(momentum))


def test_bodies_move_as_each_alone():
    """Two bodies of one model, soft and stiff, move bit for bit as either does alone, and keep their spin."""
    cages = [bar(1, (0.4, 0.3, 0.2)).cage(), bar(2, (0.6, 0.2, 0.2)).cage()]
    materials = [cagecut.Material(young=1e4), cagecut.Material(young=1e9)]
    together = make_trial(cages, materials)
    rows = np.split(np.arange(len(together.rest)), [cages[0].vertex_count])
    velocities = np.concatenate([thrown(together.rest[r], SPINS[n], FLIGHTS[n]) for n, r in enumerate(rows)])
    together.place(together.rest, velocities)
    start = [together.angular_momentum(r) for r in rows]
    together.run(60, FRAME)
    for n, r in enumerate(rows):
        off = np.linalg.norm(together.angular_momentum(r) - start[n])
        assert off < 0.02 * np.linalg.norm(start[n])
    alone = make_trial(cages[:1], materials[:1])
    alone.place(alone.rest, velocities[rows[0]])
    alone.run(60, FRAME)
    np.testing.assert_array_equal(alone.positions, together.positions[rows[0]])


@pytest.mark.parametrize(("young", "dt"), [(1e4, FRAME), (1e5, FRAME / 8.0)])
def test_two_lobed_body_that_draws_in_turns_faster(young: float, dt: float):
    """Two spinning lobes, pulled apart by 40 %, draw in: L stays within 2 %, the spin grows by a fifth at least.

    The steps resolve the drawing in: the trapezoidal rule's forces at the start do not turn with the body.
    """
    straight = bar(4, (1.0, 0.2, 0.2)).cage()
    waist = np.where(np.abs(straight.vertices[:, :1] - straight.vertices[:, 0].mean()) < 0.1, 0.4, 1.0)
    cage = cagecut.Cage(straight.vertices * np.where([False, True, True], waist, 1.0), straight.faces)
    trial = make_trial([cage], [cagecut.Material(young=young, damping=0.02)])
    center = trial.center()
    apart = center + (trial.rest - center) * (1.4, 1.0, 1.0)
    trial.place(apart, np.cross((0.0, 0.0, 3.0), apart - center))
    start, energy, rates = trial.angular_momentum(), sum(trial.energy()), [spin_rate(trial)]
    for _ in range(round(0.5 / dt)):
        trial.step(dt)
        assert sum(trial.energy()) < 1.001 * energy
        rates.append(spin_rate(trial))
    assert np.linalg.norm(trial.angular_momentum() - start) < 0.02 * np.linalg.norm(start)
    assert max(rates) > 1.2 * rates[0]


def spin_rate(trial: Trial) -> float:
    """Angular momentum over the moment of inertia, about z [rad/s]."""
    arms, mass = (trial.positions - trial.center())[:, :2], trial.masses()[0]
    return trial.angular_momentum()[2] / np.einsum("ij,ia,ja->", mass, arms, arms)
