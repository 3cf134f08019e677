# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Bodies under knives of finite width and cuts that begin inside."""

from __future__ import annotations

import numpy as np
import pytest

import newton_cagecut as cagecut
from solver_scenes import assert_same, ball, corners, everything, make_solver, run, vertex_rows
from surface_shapes import check_caps, check_closed

KNIVES = {
    "from above": cagecut.Blade([0.5, 0.5, 0.5], [0, 1, 0.1], [0.1, 0, -1], width=(-0.2, 0.15)),
    "from one side": cagecut.Blade([0.5, 0.5, 0.5], [0, 1, 0.1], [0.1, 0, -1], width=(-2.0, 0.1)),
    "ahead of a start": cagecut.Blade([0.5, 0.5, 0.55], [1, 0.1, 0], [0, 0.1, -1], start=0.0),
    "wholly inside": cagecut.Blade([0.5, 0.5, 0.65], [1, 0.1, 0], [0, 0.1, -1], width=0.3, start=0.0),
}


def _shared(cut) -> np.ndarray:
    """Points of the surface that both sides of a cut share: at its front and along the knife's borders."""
    surface, wall = cut._body.surface, cut.cut.wall
    sides = [np.unique(surface.triangles[surface.triangle_key == 2 * wall + side]) for side in (0, 1)]
    return np.intersect1d(*sides)


@pytest.mark.parametrize("name", KNIVES)
def test_body_at_rest_stays_at_rest(name):
    """Steps of a knife keep the surface closed and in one piece, move nothing, and update equals recompute."""
    _, solver, *states = make_solver(walks=128)
    body, cut = solver.bodies[0], solver.begin_cut(0, KNIVES[name])
    for part in (0.15, 0.4, 0.7, 1.1):
        report = solver.advance_cut(cut, to=part * cut.length, states=states)
        check_closed(body.surface, ball().volume)
        check_caps(body.surface, cut.cut.plane, cut.cut.wall)
        for state in states:
            rest = body.to_world(body.cage.vertices)
            np.testing.assert_allclose(vertex_rows(solver, state), rest, atol=1e-6)
        assert abs(report.energy_after) < 1e-6
        weights = body.coordinates.weights
        np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-5)
        body.coordinates.recompute()
        np.testing.assert_array_equal(weights, body.coordinates.weights)
    assert report.complete
    assert not report.separated
    (piece,) = solver.pieces(0)
    assert piece.volume == pytest.approx(1.0)
    assert len(piece.surface_triangles) == body.surface.triangle_count


@pytest.mark.parametrize("name", KNIVES)
def test_weights_where_both_sides_meet(name):
    """At the front and along a knife's borders a point has one value: its weights from either side are the same."""
    _, solver, *states = make_solver()
    body, cut = solver.bodies[0], solver.begin_cut(0, KNIVES[name])
    for part in (0.2, 0.6):
        solver.advance_cut(cut, to=part * cut.length, states=states)
        shared = _shared(cut)
        assert len(shared) >= 2
        points, keys = body.surface.points[shared], body.surface.point_key[shared]
        mine, other = (body.coordinates.boundary_weights(points, key, walks=64) for key in (keys, keys ^ 1))
        np.testing.assert_allclose(mine, other, atol=2e-4)
        np.testing.assert_allclose(mine @ body.cage.vertices, points, atol=2e-5)
        border = np.isin(np.arange(body.cage.vertex_count), _border_vertices(cut))
        assert mine[:, ~border].sum(axis=1).max() < 2e-4
        np.testing.assert_allclose(body.surface_weights[shared], mine, atol=2e-4)


def _border_vertices(cut) -> np.ndarray:
    """Cage vertices that faces of both sides of a cut share."""
    cage, wall = cut.cut.cage, cut.cut.wall
    mesh, key = cage.mesh, cage.face_key[cage.mesh.face]
    return np.intersect1d(*(mesh.face_vertex[key == 2 * wall + side] for side in (0, 1)))


@pytest.mark.parametrize("name", KNIVES)
def test_motion_is_carried_into_the_body(name):
    """In a stretched body that spins, vertices made inside it lie and move where the body's inside does."""
    _, solver, *states = make_solver(walks=256)
    body = solver.bodies[0]
    stretch, spin = np.diag([1.3, 0.8, 1.1]), np.array([[0.0, -2.0, 0.5], [2.0, 0.0, 1.0], [-0.5, -1.0, 0.0]])
    for state in states:
        for field, matrix in (("particle_q", stretch), ("particle_qd", spin @ stretch)):
            array = getattr(state, field)[body.vertices]
            rows = array.numpy()
            rows[:8] = body.cage.vertices @ matrix.T
            array.assign(rows)
    cut = solver.begin_cut(0, KNIVES[name])
    for part in (0.15, 0.5, 1.1):
        edit_source = solver.advance_cut(cut, to=part * cut.length, states=states)
        assert edit_source.energy_injected == pytest.approx(0.0, abs=2e-3 * edit_source.energy_before)
        rest = body.cage.vertices
        for state in states:
            np.testing.assert_allclose(vertex_rows(solver, state), rest @ stretch.T, atol=1e-4)
            velocity = vertex_rows(solver, state, "particle_qd")
            np.testing.assert_allclose(velocity, rest @ (spin @ stretch).T, atol=1e-3)


def test_cut_inside_opens():
    """A body that is pulled apart opens at a cut wholly inside it, where it has no skin to open."""
    _, solver, *states = make_solver(fixed=[*corners(0, 0.0), *corners(0, 1.0)], quadrature=300, walks=128)
    body = solver.bodies[0]
    blade = cagecut.Blade([0.5, 0.5, 0.75], [0, 1, 0.05], [0, 0.05, -1], width=0.5, start=0.0)
    cut = solver.begin_cut(0, blade)
    for depth in (0.2, 0.5):
        solver.advance_cut(cut, to=depth, states=states)
    assert body.surface.mesh.component_count == 2
    for state in states:
        array = state.particle_q[body.vertices]
        rows = array.numpy()
        rows[corners(0, 1.0), 0] += 0.2
        array.assign(rows)
    states = run(solver, states, 60)
    points, _ = solver.surface(states[0])
    wall = cut.cut.wall
    hub = [points[body.surface.point_key == 2 * wall + side] for side in (0, 1)]
    only = np.setdiff1d(np.flatnonzero(body.surface.point_key == 2 * wall + 1), _shared(cut))
    gap = points[only].mean(axis=0) - hub[0].mean(axis=0)
    assert np.linalg.norm(gap) > 0.02
    assert abs(gap @ cut.cut.plane.normal) > 0.9 * np.linalg.norm(gap)


def test_knives_side_by_side_before_they_open():
    """A knife that waits while another cut changes the body begins anew in the body as it is."""
    _, solver, *states = make_solver()
    body = solver.bodies[0]
    waiting = solver.begin_cut(0, KNIVES["from above"])
    other = solver.begin_cut(0, cagecut.Blade([0.5, 0.45, 0.5], [1, 0.1, 0.15], [0, 0.1, -1]))
    solver.advance_cut(other, to=0.5 * other.length, states=states)
    for part in (0.3, 1.1):
        solver.advance_cut(waiting, to=part * waiting.length, states=states)
        check_closed(body.surface, ball().volume)
        check_caps(body.surface, waiting.cut.plane, waiting.cut.wall)
    assert waiting.complete


def test_knife_snapshot():
    """A body restored from amid a knife's cut is what it was, and the knife goes on as it did."""
    _, solver, *states = make_solver(gravity=-9.81)
    cut = solver.begin_cut(0, KNIVES["wholly inside"])
    solver.advance_cut(cut, to=0.2, states=states)
    snapshot, before = solver.snapshot(0, states=states, cuts=(cut,)), everything(solver, states)
    results = []
    for _ in range(2):
        solver.advance_cut(cut, to=2.0, states=states)
        results.append(everything(solver, states))
        solver.restore(snapshot)
        assert_same(before, everything(solver, states))
        assert cut.depth == 0.2
    assert_same(*results)
