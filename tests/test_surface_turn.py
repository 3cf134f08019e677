# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces under curved cuts and under cuts side by side."""

from __future__ import annotations

import itertools

import newton
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import newton_cagecut as cagecut
from cage_shapes import box, random_blade
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from solver_scenes import simulated
from surface_shapes import (
    EVERY,
    around,
    check_closed,
    check_sides,
    check_surface,
    grid,
    gridded_box,
    icosphere,
    sphere,
)

RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}


def _follow(cut: Cut, surface_cut: SurfaceCut, to: float, volume: float, *, tolerance: float = 1e-12) -> Surface:
    """Advance both and check the surface."""
    edit = cut.advance(to=to)
    before = surface_cut.surface
    surface = surface_cut.advance(edit.front).surface if not edit.is_empty else before
    check_surface(surface, volume)
    base = surface_cut.base
    changed = surface.point_key[: base.point_count] != base.point_key
    in_plane = np.abs(cut.plane.distance(base.points[changed]))
    assert in_plane.max(initial=0.0) < max(tolerance, 1e-9)
    if surface.dimension == 2:
        check_sides(surface, cut.plane, cut.wall, tolerance=tolerance)
        return surface
    for side, sign in ((0, 1.0), (1, -1.0)):
        cap = surface.triangle_key == 2 * cut.wall + side
        facing = sign * surface.mesh.face_area_vector[cap] @ cut.plane.normal
        assert facing.min(initial=0.0) > -1e-12
        height = cut.plane.distance(surface.points[surface.triangles[cap]].reshape(-1, 3))
        assert np.abs(height).max(initial=0.0) < tolerance
        if side == 0:
            area = facing.sum()
    assert facing.sum() == pytest.approx(area, rel=1e-9)
    return surface


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=5, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_random_turns(name, seed):
    """A cut with random turns leaves a surface whole and as large, with its sides on every strip's plane."""
    rng = np.random.default_rng(seed)
    surface = EVERY[name]()
    cage, volume = around(surface), surface.volume
    cut = Cut(cage, random_blade(rng, cage, 0.3))
    surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
    _follow(cut, surface_cut, rng.uniform(0.2, 0.6) * cut.length, volume)
    for _ in range(4):
        across, angle = cut.plane.across, rng.uniform(-1.4, 1.4)
        cut.turn(np.cos(angle) * across + np.sin(angle) * cut.plane.normal)
        surface_cut.go_on(cut.plane, cut.wall)
        for _ in range(2):
            _follow(cut, surface_cut, cut.depth + rng.uniform(0.05, 0.5) * (cut.length - cut.depth), volume)


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=5, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_side_by_side(name, seed):
    """Two cuts that advance in turn leave a surface whole and as large, in two pieces at least."""
    rng = np.random.default_rng(seed)
    surface = EVERY[name]()
    cage, volume = around(surface), surface.volume
    cuts = [Cut(cage, random_blade(rng, cage, 0.3)) for _ in range(2)]
    follow = [SurfaceCut(surface, cut.plane, cut.wall) for cut in cuts]
    for part in (0.3, 0.5, 0.7, 1.05):
        for cut, surface_cut in zip(cuts, follow, strict=True):
            if cut.cage is not cage:
                cut.resume(cage)
                surface_cut.go_on(cut.plane, cut.wall, surface=surface, hinged=cut.hinged)
            surface = _follow(cut, surface_cut, max(cut.depth, part * cut.length), volume)
            cage = cut.cage
    assert surface.mesh.component_count >= 2


@pytest.mark.parametrize("make", [grid, gridded_box])
@pytest.mark.parametrize("start", [[1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]])
def test_turns_on_a_regular_mesh(make, start):
    """Cuts along edges of a regular mesh stop and turn at its points, on its edges and just where they leave it."""
    surface = make()
    cage, side = around(surface), 0.8 / (6 if surface.dimension == 2 else 4)
    edges = np.eye(3)[2 : surface.dimension]

    def vector(values):
        return np.pad(values, (0, surface.dimension - 2))

    directions = [vector(v) for v in ([1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [-1.0, 1.0], [0.3, 1.0], [0.0, -1.0])]
    for depth, first, step in itertools.product((0.1 + side, 0.1 + 1.5 * side), directions, (side, 0.5 * side)):
        cut = Cut(cage, Blade(vector([0.1 + side, 0.1 + side]), *edges, vector(start)))
        surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
        _follow(cut, surface_cut, depth * np.hypot(*start), surface.volume)
        for direction in (first, first[[1, 0, *range(2, surface.dimension)]] * [1.0, -1.0, 1.0][: surface.dimension]):
            if direction @ cut.plane.across > -0.98 * np.linalg.norm(direction):
                cut.turn(direction)
                surface_cut.go_on(cut.plane, cut.wall)
                _follow(cut, surface_cut, cut.depth + step, surface.volume, tolerance=2e-10)


def test_open_surface_goes_on_without_caps():
    """An open surface is slit on in the new direction: no caps, the same area, two parts in the end."""
    points, triangles = icosphere(3)
    bowl = Surface(0.4 * points + 0.5, triangles[points[triangles].mean(axis=1)[:, 2] < 0.3])
    area = np.linalg.norm(bowl.mesh.face_area_vector, axis=1).sum()
    cut = Cut(box(), Blade([0.51, 0.5, 0.5], [0, 1, 0.1], [0, 0.1, 1]))
    surface_cut = SurfaceCut(bowl, cut.plane, cut.wall)
    surface_cut.advance(cut.advance(to=0.3).front)
    cut.turn([0.4, 0.0, 1.0])
    surface_cut.go_on(cut.plane, cut.wall)
    for depth in (0.4, 0.6, 5.0):
        now = surface_cut.advance(cut.advance(to=depth).front).surface
        assert (now.triangle_cap == -1).all()
        np.testing.assert_allclose(np.linalg.norm(now.mesh.face_area_vector, axis=1).sum(), area, rtol=1e-12)
    assert len(np.unique(now.mesh.vertex_component[np.unique(now.triangles)])) == 2


def test_rewinding_a_turned_surface_cut():
    """A snapshot from before a turn brings the very surface back, and the turn can be taken again."""
    cut = Cut(box(), Blade([0.51, 0.5, 0.5], [0, 1, 0.1], [0, 0.1, 1]))
    surface_cut = SurfaceCut(sphere(2), cut.plane, cut.wall)
    first = surface_cut.advance(cut.advance(to=0.4).front).surface
    here, there = cut.snapshot(), surface_cut.snapshot()
    results = []
    for _ in range(2):
        cut.turn([1.0, 0.0, 0.5])
        surface_cut.go_on(cut.plane, cut.wall)
        results.append(surface_cut.advance(cut.advance(to=0.7).front).surface)
        cut.rewind(here)
        assert surface_cut.rewind(there) is first
    np.testing.assert_array_equal(results[0].points, results[1].points)
    np.testing.assert_array_equal(results[0].triangles, results[1].triangles)


def test_curved_cuts_side_by_side_in_the_solver():
    """A body's cut turns, another one crosses it, and both go on until pieces come off; nothing is lost."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cagecut.add_cage_body(builder, box(), sphere(2, 0.4), walks=32, quadrature=60)
    model = builder.finalize(device="cpu")
    solver, state = cagecut.SolverCageCut(model), model.state()
    rest = state.particle_q.numpy()[:8].copy()
    one = solver.begin_cut(0, Blade([0.37, 0.5, 0.5], [0, 1, 0], [0, 0, -1]))
    two = solver.begin_cut(0, Blade([0.5, 0.5, 0.23], [0, 1, 0.1], [1, 0, 0]))
    body, volume = solver.bodies[0], solver.bodies[0].surface.volume
    solver.advance_cut(one, 0.5, states=(state,))
    one.turn([0.3, 0.0, -1.0])
    for cut, depth in ((one, 0.6), (two, 0.6), (one, 0.8), (two, 2.0), (one, 3.0)):
        report = solver.advance_cut(cut, to=depth, states=(state,))
        check_closed(body.surface, volume)
        count = body.cage.vertex_count
        positions = state.particle_q.numpy()[body.vertices][:count]
        np.testing.assert_allclose(positions, simulated(solver).rest.numpy()[:count], atol=1e-6)
    np.testing.assert_array_equal(state.particle_q.numpy()[:8], rest)
    assert report.complete
    assert report.piece_count == len(solver.pieces(0)) >= 3
    weights = body.coordinates.weights
    body.coordinates.recompute()
    np.testing.assert_array_equal(weights, body.coordinates.weights)


def test_turning_twice_in_place():
    """A cut that turns again before it went on, or after another cut, follows its last direction alone."""
    across = Blade([0.5, 0.5, 0.8], [1, 0.1, 0], [0, 1, 0.1])
    surfaces = []
    for turns in ([[0.3, 0.0, -1.0]], [[-0.8, 0.1, -0.2], [0.5, 0.0, -1.0], [0.3, 0.0, -1.0]]):
        surface = sphere()
        cut = Cut(box(), Blade([0.45, 0.5, 0.5], [0, 1, 0], [0, 0, -1]))
        surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
        _follow(cut, surface_cut, 0.4, surface.volume)
        for direction in turns:
            cut.turn(direction)
            surface_cut.go_on(cut.plane, cut.wall)
        other = Cut(cut.cage, across)
        other_surface = SurfaceCut(surface_cut.surface, other.plane, other.wall)
        _follow(other, other_surface, 0.6, surface.volume)
        cut.resume(other.cage)
        surface_cut.go_on(cut.plane, cut.wall, surface=other_surface.surface)
        surfaces.append(_follow(cut, surface_cut, 0.7, surface.volume))
    np.testing.assert_array_equal(surfaces[0].points, surfaces[1].points)
    np.testing.assert_array_equal(surfaces[0].triangles, surfaces[1].triangles)
