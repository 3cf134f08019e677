# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the linear solve: the paper's step against NumPy, preconditioners and widths of lanes against each other."""

import numpy as np
import pytest

from elastic_bodies import DT, Body, Spring, both_dimensions
from newton_cagecut.elastic import SolveLimits
from newton_cagecut.elastic.solve import lanes

TIGHT = SolveLimits(tolerance=1e-7)


def paper_step(body, forces):
    """Velocities after the paper's single Newton step of backward Euler, in float64 NumPy (St. Venant-Kirchhoff)."""
    mu, lam = body.material.lame
    x, v = body.positions, body.velocities
    F, eye = body.deformation(x - body.rest), np.eye(3)
    E = 0.5 * (np.einsum("qki,qkj->qij", F, F) - eye)
    S = 2.0 * mu * E + lam * np.trace(E, axis1=1, axis2=2)[:, None, None] * eye
    stiffness = np.zeros((len(F), 9, 9))
    for k, dF in enumerate(np.eye(9).reshape(9, 3, 3)):
        dE = 0.5 * (np.einsum("ki,qkj->qij", dF, F) + np.einsum("qki,kj->qij", F, dF))
        dS = 2.0 * mu * dE + lam * np.trace(dE, axis1=1, axis2=2)[:, None, None] * eye
        stiffness[:, :, k] = (np.einsum("ij,qjk->qik", dF, S) + F @ dS).reshape(-1, 9)
    values, vectors = np.linalg.eigh(stiffness)
    projected = np.einsum("qik,qk,qjk->qij", vectors, np.maximum(values, 0.0), vectors).reshape(-1, 3, 3, 3, 3)
    K = np.einsum("q,qic,qacbd,qjd->iajb", body.volumes, body.gradients, projected, body.gradients)
    internal = -np.einsum("q,qab,qib->ia", body.volumes, F @ S, body.gradients)
    mass = body.system.mass.numpy()[: body.count, : body.count].astype(np.float64)
    weight = mass @ np.broadcast_to(body.gravity, (body.count, 3))
    damping = body.material.damping
    matrix = np.einsum("ij,ab->iajb", mass, eye) + DT * (DT + damping) * K
    right = DT * (internal + weight + forces - (DT + damping) * np.einsum("iajb,jb->ia", K, v))
    free = np.flatnonzero(np.repeat(~body.fixed, 3))
    change = np.zeros(3 * body.count)
    change[free] = np.linalg.solve(matrix.reshape(3 * body.count, -1)[np.ix_(free, free)], right.reshape(-1)[free])
    return v + change.reshape(-1, 3)


@pytest.mark.parametrize("damping", [0.0, 0.02])
@pytest.mark.parametrize("dense_vertices", [None, 0])
def test_paper_step_is_one_newton_step(damping, dense_vertices):
    """With integrator="paper" a step is one linearised step of backward Euler from the start, and nothing else."""
    limits = TIGHT._replace(dense_vertices=dense_vertices)
    options = {"integrator": "paper", "limits": limits, "model": "stvk", "damping": damping}
    body = Body(cells=(1, 1, 2), points=3, fix_top=True, young=2e4, **options)
    free = ~body.fixed[:, None]
    body.place(body.rest + body.random(0, 0.02) * free, body.random(1, 0.5) * free)
    start, expected = body.positions, paper_step(body, np.zeros((body.count, 3)))
    assert np.abs(expected - body.velocities).max() > 0.3
    body.run(1, body.gravity)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(body.velocities, expected, atol=2e-5 * scale)
    np.testing.assert_allclose(body.positions, start + DT * expected, atol=DT * 2e-5 * scale)
    assert body.system.step_statistics()["limited"] == 0


@both_dimensions
@pytest.mark.parametrize("integrator", ["tr_bdf2", "paper"])
def test_preconditioners_and_lanes_agree(dimension, integrator, monkeypatch):
    """A factor, diagonal blocks and lanes of one point, as on CUDA, give the same motion but for rounding."""
    found = []
    for dense_vertices, width in ((100, 8), (0, 8), (100, 1), (0, 1)):
        monkeypatch.setattr(lanes, "lane_width", lambda device, width=width: width)
        limits = TIGHT._replace(dense_vertices=dense_vertices)
        body = Body(dimension, cells=(1, 1, 2), points=3, fix_top=True, young=5e4, limits=limits, integrator=integrator)
        spring = Spring(body, 1e4, body.rest[0] + 0.05 * body.up)
        body.place(velocities=body.random(3, 0.3)).run(5, body.gravity, spring=spring)
        found.append(body.positions)
        assert body.system.step_statistics()["missed"] == 0
    for positions in found[1:]:
        np.testing.assert_allclose(positions, found[0], atol=2e-6)
    assert np.abs(found[0] - body.rest).max() > 1e-2


@both_dimensions
@pytest.mark.parametrize("young", [1e2, 1e6, 1e10])
def test_nearly_incompressible_solves_reach_the_tolerance(dimension, young):
    """At Poisson's ratio 0.499 every solve of a wild start ends within the tolerance, after some tens of iterations."""
    body = Body(dimension, cells=(1, 2, 3), points=3, young=young, poisson=0.499)
    body.place(velocities=body.random(1, 0.3)).run(15, body.gravity)
    found = body.system.step_statistics()
    assert (found["steps"], found["missed"], found["refused"]) == (15, 0, 0)
    assert found["worst_residual"] <= 1e-5
    assert found["most_iterations"] <= 60


def test_factor_is_made_up_to_the_limit():
    """Whether there is a factor follows from the vertices in use, the limit and Poisson's ratio."""
    assert Body().system._integrator.solver.is_dense
    assert not Body(limits=SolveLimits(dense_vertices=7)).system._integrator.solver.is_dense
    assert SolveLimits().measured(0.4).dense_vertices < SolveLimits().measured(0.499).dense_vertices
    assert Body(limits=SolveLimits(dense_vertices=7)).system._integrator.solver.matrix.values.size <= 64
