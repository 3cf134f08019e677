# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Plane bodies in the world: their plane, their thickness, their cuts, and what is refused."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from newton_cagecut.section import Blade
from solver_scenes import UPRIGHT, ball, box_cage, corners, make_solver, run, simulated, slanted_blade, vertex_rows
from surface_shapes import check_surface

TILTED = wp.quat_from_axis_angle(wp.normalize(wp.vec3(0.4, 1.0, -0.6)), 1.3)


def _normal(turn: wp.quat) -> np.ndarray:
    return np.array(wp.quat_rotate(turn, wp.vec3(0.0, 0.0, 1.0)), dtype=np.float64)


@pytest.mark.parametrize("turn", [wp.quat_identity(), UPRIGHT, TILTED], ids=["flat", "upright", "tilted"])
def test_nothing_leaves_the_plane(turn: wp.quat):
    """Gravity, velocity, a ball that pushes at an angle, and a cut move nothing out of the plane.

    In a plane normal to an axis of the world not a bit of a vertex; in a tilted one by no more than rounding.
    """
    builder = newton.ModelBuilder(gravity=(1.0, -2.0, -9.81))
    normal, place = _normal(turn), np.array([0.3, 0.7, 0.2])
    center = place + np.array(wp.quat_rotate(turn, wp.vec3(0.5, 0.2, 0.12)))
    builder.add_shape_sphere(-1, xform=wp.transform(center.tolist()), radius=0.25)
    options = {"xform": wp.transform(place.tolist(), turn), "velocity": (0.5, 0.6, -0.7), "contact_radius": 0.02}
    model, solver, *states = make_solver(builder=builder, dimension=2, **options)
    pipeline = newton.CollisionPipeline(model)
    contacts, body = pipeline.contacts(), solver.bodies[0]
    cut, slid, touched = solver.begin_cut(0, slanted_blade(2)), 0.0, 0
    for _ in range(40):
        if not cut.complete:
            solver.advance_cut(cut, 0.05, states=states)
        pipeline.collide(states[0], contacts)
        touched = max(touched, int(contacts.soft_contact_count.numpy()[0]))
        states = run(solver, states, 1, contacts=contacts)
        count = body.cage.vertex_count
        rest = simulated(solver).rest.numpy()[:count].astype(np.float64)
        positions, velocities = vertex_rows(solver, states[0]), vertex_rows(solver, states[0], "particle_qd")
        height, drift = (positions - rest) @ normal, velocities @ normal
        slid = max(slid, float(np.linalg.norm(positions - rest, axis=1).max()))
        if turn is TILTED:
            assert np.abs(height).max() < 4e-7 * np.abs(positions).max()
            assert np.abs(drift).max() < 4e-7 * max(1.0, np.abs(velocities).max())
        else:
            axis = int(np.argmax(np.abs(normal)))
            assert (positions[:, axis] == np.float32(place[axis])).all()
            assert (velocities[:, axis] == 0.0).all()
    points, _ = solver.surface(states[0])
    np.testing.assert_allclose((points - place) @ normal, 0.0, atol=2e-6)
    assert cut.complete
    assert slid > 0.1
    assert touched > 0


def test_surface_of_a_plane_through_the_origin_is_exact():
    """Where the plane's coordinate is zero, that of every surface point stays zero, however the body moves."""
    _, solver, *states = make_solver(dimension=2, gravity=-9.81, fixed=corners(-1, 1.0, 2))
    cut = solver.begin_cut(0, slanted_blade(2))
    for _ in range(10):
        solver.advance_cut(cut, 0.08, states=states)
        states = run(solver, states, 2)
        assert (solver.surface(states[0])[0][:, 1] == 0.0).all()


def test_initial_velocity_is_taken_into_the_plane():
    """Of the velocity that a body is added with, what sticks out of its plane is left out."""
    _, solver, state, _ = make_solver(dimension=2, velocity=(1.0, 2.0, 3.0))
    np.testing.assert_array_equal(vertex_rows(solver, state, "particle_qd"), [[1.0, 0.0, 3.0]] * 4)


def test_thickness_scales_the_mass_alone():
    """A thicker body weighs more and is as much stiffer: it hangs as a thin one does."""
    sags = []
    for thickness in (None, 0.02):
        options = {"thickness": thickness, "material": cagecut.Material(young=3e4, density=500.0, damping=0.1)}
        _, solver, *states = make_solver(dimension=2, gravity=-9.81, fixed=corners(-1, 1.0, 2), **options)
        (piece,) = solver.pieces(0)
        assert piece.volume == pytest.approx(thickness or 1.0)
        assert piece.mass == pytest.approx(500.0 * (thickness or 1.0))
        mass = simulated(solver).system.vertex_mass.numpy().sum()
        assert mass == pytest.approx(piece.mass, rel=1e-5)
        states = run(solver, states, 30)
        sags.append(vertex_rows(solver, states[0]))
    assert sags[0][:, 2].min() < -0.03
    np.testing.assert_allclose(sags[0], sags[1], atol=2e-5)


def test_plan_says_what_is_left_out():
    """A plane body has no third dimension and no nested walks, which take no bytes; a solid one is said to be solid."""
    _, solver, *_ = make_solver(dimension=2, thickness=0.02)
    plan = {entry.feature: entry for entry in solver.plan()}
    for feature, text in (("third dimension", "plane strain, 0.02 m thick"), ("nested walks", "segments")):
        assert not plan[feature].on
        assert plan[feature].byte_count == 0
        assert text in plan[feature].reason
    _, solid, *_ = make_solver()
    assert {entry.feature: entry for entry in solid.plan()}["third dimension"].on


def test_bent_cuts_side_by_side():
    """A cut that follows a bow while another crosses it: the body stays at rest, pieces come off, weights are exact."""
    _, solver, *states = make_solver(dimension=2)
    body, volume = solver.bodies[0], ball(2).volume
    bow, other = (
        solver.begin_cut(0, Blade([0.2, 0.0], [0.0, 1.0])),
        solver.begin_cut(0, Blade([1.0, 0.55], [-1.0, 0.1])),
    )
    for angle in np.radians([75.0, 45.0, 15.0, -15.0, -45.0, -75.0, -90.0]):
        solver.advance_cut(bow, 0.13, states=states)
        bow.turn([np.cos(angle), np.sin(angle)])
        solver.advance_cut(other, 0.1, states=states)
        check_surface(body.surface, volume)
        for state in states:
            np.testing.assert_allclose(vertex_rows(solver, state), body.to_world(body.cage.vertices), atol=1e-6)
    report = solver.advance_cut(bow, to=5.0, states=states)
    check_surface(body.surface, volume)
    pieces = solver.pieces(0)
    assert report.piece_count == len(pieces) == body.surface.mesh.component_count >= 2
    assert sum(piece.volume for piece in pieces) == pytest.approx(1.0)
    weights = body.coordinates.weights
    np.testing.assert_allclose(body.surface_weights @ body.cage.vertices, body.surface.points, atol=2e-5)
    body.coordinates.recompute()
    np.testing.assert_array_equal(weights, body.coordinates.weights)


def test_start_between_parts_waits_for_other_cuts():
    """A blade that starts outside cuts the same after another cut has changed the body before it opened."""
    areas = []
    for crossed in (False, True):
        _, solver, *states = make_solver(dimension=2)
        cut = solver.begin_cut(0, Blade([-0.1, 0.5], [1.0, 0.05], start=0.0))
        if crossed:
            other = solver.begin_cut(0, Blade([0.77, 0.0], [0.0, 1.0]))
            solver.advance_cut(other, to=0.2, states=states)
        solver.advance_cut(cut, to=0.7, states=states)
        solver.advance_cut(cut, to=2.0, states=states)
        check_surface(solver.bodies[0].surface, ball(2).volume)
        areas.append(sorted(piece.volume for piece in solver.pieces(0)))
    assert areas[0] == pytest.approx(areas[1])


def test_plane_body_is_shown_from_both_sides_without_caps():
    """The viewer gets one mesh, which is not culled from behind."""
    _, solver, state, other = make_solver(dimension=2)
    calls = []

    class Recorder:
        def log_mesh(self, name, points, indices, **options):
            calls.append((name, indices.size, options["backface_culling"]))

    cut = solver.begin_cut(0, slanted_blade(2))
    solver.advance_cut(cut, to=0.7, states=(state, other))
    solver.log(Recorder(), state)
    assert calls == [("/cagecut/cage_body_0/skin", 3 * solver.bodies[0].surface.triangle_count, False)]


def test_bad_plane_bodies_are_refused():
    """Meshes and blades of another dimension, knives with a width, and thicknesses that are none are refused."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cage, mesh = box_cage(2), ball(2)
    for wrong in (ball(3), newton.Mesh(ball(3).points.astype(np.float32), ball(3).triangles.reshape(-1))):
        with pytest.raises(ValueError, match="the cage is of dimension 2 and the mesh of dimension 3"):
            cagecut.add_cage_body(builder, cage, wrong)
    with pytest.raises(ValueError, match="the cage is of dimension 3 and the mesh of dimension 2"):
        cagecut.add_cage_body(builder, box_cage(3), mesh)
    with pytest.raises(ValueError, match="only a plane body has a thickness"):
        cagecut.add_cage_body(builder, box_cage(3), ball(3), thickness=0.1)
    for thickness in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="thickness of a plane body must be positive"):
            cagecut.add_cage_body(builder, cage, mesh, thickness=thickness)
    with pytest.raises(ValueError, match="outside the cage"):
        cagecut.add_cage_body(builder, cage, (mesh.points + 0.5, mesh.triangles))
    with pytest.raises(ValueError, match="triangle 0 of the flat surface is clockwise"):
        cagecut.add_cage_body(builder, cage, (mesh.points, mesh.triangles[:, ::-1]))
    assert builder.particle_count == 0
    _, solver, *_ = make_solver(dimension=2)
    with pytest.raises(ValueError, match="the cage is of dimension 2 and the blade of dimension 3"):
        solver.begin_cut(0, slanted_blade(3))
    with pytest.raises(ValueError, match="has no width"):
        solver.begin_cut(0, Blade([0.5, 0.5], [1.0, 0.0], width=0.1))
