# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cuts as model edits: what they carry over, what they report, and that failing ones change nothing."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from solver_scenes import (
    assert_same,
    ball,
    both_dimensions,
    box_cage,
    corners,
    everything,
    make_solver,
    run,
    simulated,
    slanted_blade,
    vertex_rows,
)
from surface_shapes import check_surface


@both_dimensions
def test_cut_keeps_the_deformed_shape(dimension: int):
    """New cage vertices lie on the deformed cage, and the surface's old points stay nearly where they were."""
    top, count = corners(-1, 1.0, dimension), box_cage(dimension).vertex_count
    _, solver, *states = make_solver(gravity=-9.81, fixed=top, walks=256, dimension=dimension)
    states = run(solver, states, 20)
    before, _ = solver.surface(states[0])
    bottom = vertex_rows(solver, states[0])[corners(-1, 0.0, dimension), 2].mean()
    assert bottom < -0.05
    cut = solver.begin_cut(0, slanted_blade(dimension))
    solver.advance_cut(cut, 0.3 * cut.length, states=states)
    after, _ = solver.surface(states[0])
    assert np.abs(after[: len(before)] - before).max() < 0.02
    new = vertex_rows(solver, states[0])[count:]
    old = vertex_rows(solver, states[0])[:count]
    assert len(new) > 2
    assert (new >= old.min(axis=0) - 1e-6).all()
    assert (new <= old.max(axis=0) + 1e-6).all()


@both_dimensions
def test_both_states_are_carried_over(dimension: int):
    """Positions and velocities of new vertices are written in every state that is passed."""
    _, solver, *states = make_solver(gravity=-9.81, dimension=dimension)
    states = run(solver, states, 5)
    cut, count = solver.begin_cut(0, slanted_blade(dimension)), box_cage(dimension).vertex_count
    report = solver.advance_cut(cut, 0.4, states=states)
    assert report.vertices_created > 0
    for state in states:
        velocities = vertex_rows(solver, state, "particle_qd")
        expected = np.broadcast_to(velocities[0], velocities[count:].shape)
        np.testing.assert_allclose(velocities[count:], expected, atol=1.0e-4)


@both_dimensions
def test_rigid_motion_gains_no_energy(dimension: int):
    """A cut of a body that falls without deforming injects almost no energy."""
    _, solver, *states = make_solver(gravity=-9.81, dimension=dimension)
    states = run(solver, states, 20)
    cut = solver.begin_cut(0, slanted_blade(dimension))
    report = solver.advance_cut(cut, 0.5 * cut.length, states=states)
    assert report.energy_before > 100.0
    assert abs(report.energy_injected) < 1.0e-4 * report.energy_before


@both_dimensions
def test_surface_is_cut_and_stays_whole(dimension: int):
    """The embedded surface is split, in space capped, at every step, and its points follow the weights."""
    _, solver, *states = make_solver(dimension=dimension)
    cut, body = solver.begin_cut(0, slanted_blade(dimension)), solver.bodies[0]
    volume = body.surface.volume
    while not cut.complete:
        report = solver.advance_cut(cut, 0.2 * cut.length, states=states)
        surface = body.surface
        points, triangles = solver.surface(states[0], 0)
        check_surface(surface, volume)
        assert len(points) == surface.point_count
        assert triangles.max() < len(points)
        np.testing.assert_allclose(points, body.to_world(surface.points), atol=1.0e-5)
    assert report.separated
    assert report.piece_count == surface.mesh.component_count == 2
    assert (surface.triangle_cap >= 0).any() == (dimension == 3)


@both_dimensions
def test_pieces_weigh_what_their_volumes_say(dimension: int):
    """Quadrature volumes are those of the pieces, and a thin slice gets quadrature points of its own."""
    _, solver, *states = make_solver(material=cagecut.Material(density=700.0), dimension=dimension)
    vectors = ([0.5, 0.5, 0.96], [1.0, 0.0, 0.0], [0.0, 1.0, 0.01])
    cut = solver.begin_cut(0, cagecut.Blade(*(vectors if dimension == 3 else ([0.5, 0.96], [1.0, 0.01]))))
    solver.advance_cut(cut, to=10.0, states=states)
    body = solver.bodies[0]
    cage = body.cage
    mass = simulated(solver).system.vertex_mass.numpy()[: cage.vertex_count]
    by_piece = np.bincount(cage.vertex_component, mass)
    np.testing.assert_allclose(by_piece, 700.0 * cage.component_volumes, rtol=0.01)


@pytest.mark.parametrize(
    ("dimension", "capacity", "culprit"),
    [
        (3, {"vertices": 13}, "vertices"),
        (3, {"surface_points": 170}, "surface_points"),
        (3, {"surface_triangles": 330}, "surface_triangles"),
        (2, {"vertices": 7}, "vertices"),
        (2, {"surface_points": 205}, "surface_points"),
    ],
)
def test_cut_that_does_not_fit_changes_nothing(dimension: int, capacity: dict[str, int], culprit: str):
    """An edit over capacity names what to raise and leaves model, states, cache and cut as they were."""
    room = {"vertices": 64, "surface_points": 1000, "surface_triangles": 4000, **capacity}
    _, solver, *states = make_solver(capacity=cagecut.Capacity(**room), gravity=-9.81, dimension=dimension)
    states = run(solver, states, 3)
    cut = solver.begin_cut(0, slanted_blade(dimension))
    solver.advance_cut(cut, to=0.05 * cut.length, states=states)
    before, depth = everything(solver, states), cut.depth
    with pytest.raises(ValueError, match=culprit):
        solver.advance_cut(cut, to=2.0 * cut.length, states=states)
    assert cut.depth == depth
    assert_same(before, everything(solver, states))
    run(solver, states, 2)


def test_bad_advances_are_refused():
    """Going back, NaN, no length, two lengths: refused with nothing changed."""
    _, solver, *states = make_solver()
    cut = solver.begin_cut(0, slanted_blade())
    solver.advance_cut(cut, to=0.3, states=states)
    before = everything(solver, states)
    for arguments in ({"to": 0.1}, {"to": float("nan")}, {"by": -0.1}, {}, {"by": 0.1, "to": 0.5}):
        with pytest.raises(ValueError, match=r"advance|back|nan"):
            solver.advance_cut(cut, **arguments, states=states)
    assert_same(before, everything(solver, states))


@both_dimensions
def test_cuts_go_on_side_by_side(dimension: int):
    """A cut goes on after another one has changed the body, and both complete."""
    _, solver, *states = make_solver(dimension=dimension)
    first, volume = solver.begin_cut(0, slanted_blade(dimension)), solver.bodies[0].surface.volume
    vectors = ([0.5, 0.45, 0.5], [1.0, 0.1, 0.15], [0.0, 0.1, -1.0])
    second = solver.begin_cut(0, cagecut.Blade(*(vectors if dimension == 3 else ([0.5, 0.45], [1.0, 0.1]))))
    while not (first.complete and second.complete):
        for cut in (first, second):
            if not cut.complete:
                report = solver.advance_cut(cut, 0.25 * cut.length, states=states)
    assert report.piece_count == 4
    check_surface(solver.bodies[0].surface, volume)


def test_blade_that_misses_changes_nothing():
    """A blade beside the body is complete at once and changes nothing."""
    _, solver, *states = make_solver()
    before = everything(solver, states)
    cut = solver.begin_cut(0, cagecut.Blade([5.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]))
    report = solver.advance_cut(cut, 1.0, states=states)
    assert report.complete
    assert report.vertices_created == 0
    assert_same(before, everything(solver, states))


def test_pointers_never_change():
    """Cuts write in place, so captured graphs, viewers and contact buffers keep their arrays."""
    model, solver, *states = make_solver(contact_radius=0.01)
    body = simulated(solver)
    arrays = (body.rest, body.coordinates.weights_array, body.coordinates.gradients_array, model.particle_flags)
    arrays += (body.system.mass, states[0].particle_q, body.system.volumes)
    before = [array.ptr for array in arrays]
    cut = solver.begin_cut(0, slanted_blade())
    solver.advance_cut(cut, to=10.0, states=states)
    after = (body.rest, body.coordinates.weights_array, body.coordinates.gradients_array, model.particle_flags)
    after += (body.system.mass, states[0].particle_q, body.system.volumes)
    assert [array.ptr for array in after] == before
    active = model.particle_flags.numpy()[body.surface_particles]
    assert np.count_nonzero(active) == body.surface.point_count


def test_scene_pays_only_for_what_it_uses():
    """What is left out takes no bytes, and the plan says why."""
    _, solver, *_ = make_solver(cuttable=False, quadrature=0)
    plan = {entry.feature: entry for entry in solver.plan()}
    for feature in ("walk cache", "elasticity", "contact", "nested walks"):
        assert not plan[feature].on
        assert plan[feature].byte_count == 0
        assert plan[feature].reason
    with pytest.raises(ValueError, match="cuttable=False"):
        solver.begin_cut(0, slanted_blade())


@both_dimensions
def test_body_with_fitted_weights(dimension: int):
    """Without any walk a body is cut, and stays at rest: the weights' gradients leave no strain there."""
    _, solver, *states = make_solver(dimension=dimension, walks=0, correction="fitted", quads="harmonic")
    plan = {entry.feature: entry for entry in solver.plan()}
    assert plan["walk cache"].byte_count == 0
    assert not plan["nested walks"].on
    report = solver.advance_cut(solver.begin_cut(0, slanted_blade(dimension)), 0.4, states=states)
    assert report.stats.walk_count == 0
    before = vertex_rows(solver, states[0])
    states = run(solver, states, 3)
    np.testing.assert_allclose(vertex_rows(solver, states[0]), before, atol=1e-5)


def test_keyframed_cage_moves_the_surface():
    """Without quadrature the cage's particles are keyframes that the surface follows."""
    _, solver, state, other = make_solver(quadrature=0)
    positions = state.particle_q.numpy()
    positions[:8] = positions[:8] * [1.0, 1.0, 2.0]
    state.particle_q.assign(positions)
    state, _ = run(solver, (state, other), 1)
    points, _ = solver.surface(state)
    np.testing.assert_allclose(points, ball().points * [1.0, 1.0, 2.0], atol=1.0e-5)


def test_bad_bodies_are_refused():
    """Missing registration, points outside, unknown bodies and bad masks name the culprit."""
    builder = newton.ModelBuilder()
    with pytest.raises(ValueError, match="register_custom_attributes"):
        cagecut.add_cage_body(builder, box_cage(), ball())
    cagecut.SolverCageCut.register_custom_attributes(builder)
    with pytest.raises(ValueError, match="outside the cage"):
        cagecut.add_cage_body(builder, box_cage(), (ball().points + 0.5, ball().triangles))
    with pytest.raises(ValueError, match="vertex 12"):
        cagecut.add_cage_body(builder, box_cage(), ball(), fixed=[12])
    with pytest.raises(TypeError, match="Cage"):
        cagecut.add_cage_body(builder, "box", ball())
    with pytest.raises(ValueError, match="no cage bodies"):
        cagecut.SolverCageCut(builder.finalize(device="cpu"))
    _, solver, *_ = make_solver(label="heart")
    assert solver.body("heart") is solver.bodies[0]
    with pytest.raises(ValueError, match="heart"):
        solver.begin_cut("liver", slanted_blade())


def test_surface_is_logged_with_the_topology_of_now():
    """The viewer gets the points and triangles of the frame, and caps as a mesh of their own once there are any."""
    _, solver, *states = make_solver()
    calls = {}

    class Recorder:
        def log_mesh(self, name, points, indices, **options):
            calls[name.rsplit("/", 1)[-1]] = (
                points.size,
                wp.clone(indices).numpy(),
                options.get("hidden", False),
            )

    solver.log(Recorder(), states[0])
    assert calls["caps"][2]
    cut = solver.begin_cut(0, slanted_blade())
    solver.advance_cut(cut, to=0.7 * cut.length, states=states)
    solver.log(Recorder(), states[0])
    surface = solver.bodies[0].surface
    assert not calls["caps"][2]
    assert calls["skin"][0] == surface.point_count
    assert len(calls["skin"][1]) + len(calls["caps"][1]) == 3 * surface.triangle_count


@both_dimensions
@pytest.mark.parametrize("share", [0.6, 1.0])
def test_crossing_cuts_keep_surface_points_with_their_piece(share: float, dimension: int):
    """Where two cuts cross, every surface point gets its weights from the piece of cage that its own piece lies in."""
    _, solver, *states = make_solver(dimension=dimension)
    in_space = (([0.503, 0, 0], [0, 1, 0], [0, 0, -1]), ([0, 0.507, 0], [1, 0, 0], [0, 0, -1]))
    blades = in_space if dimension == 3 else (([0.503, 0], [0, 1]), ([0, 0.507], [1, 0]))
    for vectors, until in zip(blades, (1.0, share), strict=True):
        cut = solver.begin_cut(0, cagecut.Blade(*vectors))
        for k in range(1, 6):
            solver.advance_cut(cut, to=until * cut.length * k / 5, states=states)
    body = solver.bodies[0]
    weights = body.surface_weights
    pieces = body.cage.component_count
    assert pieces == (4 if share == 1.0 else 3 if dimension == 2 else 2)
    shares = np.stack([weights[:, body.cage.vertex_component == k].sum(axis=1) for k in range(pieces)], axis=1)
    for piece in range(body.surface.mesh.component_count):
        rows = shares[body.surface.mesh.vertex_component == piece]
        home = rows.sum(axis=0).argmax()
        assert (np.delete(rows, home, axis=1) == 0.0).all()


@pytest.mark.parametrize("angle", [0.0, 25.0, 45.0, 90.0])
def test_points_in_the_blades_plane_go_with_their_piece(angle: float):
    """A ball whose own points lie in the blade's plane comes apart clean, step by step too."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    vertices = [(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = newton.Mesh.create_sphere(0.9, num_latitudes=8, num_longitudes=8)
    edge = (np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0)
    normal = np.array([-edge[1], edge[0], 0.0])
    mesh.vertices[:] = mesh.vertices @ [edge, normal, (0.0, 0.0, 1.0)]  # in single precision: in the plane but for that
    cagecut.add_cage_body(builder, cagecut.Cage(vertices, faces), mesh, walks=32, quadrature=0)
    model = builder.finalize()
    solver, state = cagecut.SolverCageCut(model), model.state()
    cut, body = solver.begin_cut(0, cagecut.Blade((0.0, 0.0, 0.0), edge, (0.0, 0.0, -1.0))), solver.body(0)
    for depth in (0.3, 1.01, 1.6, cut.length):
        solver.advance_cut(cut, to=depth, states=(state,))
    assert (np.abs(mesh.vertices @ normal) < 1e-6).sum() > 8
    component, owner = body.surface.mesh.vertex_component, np.asarray(body.cage.vertex_component)
    shares = body.surface_weights @ (np.arange(2) == owner[:, None]).astype(np.float32)
    np.testing.assert_allclose(shares.max(axis=1), 1.0, atol=1e-5)
    assert len(np.unique(np.stack([shares.argmax(axis=1), component]), axis=1).T) == 2
