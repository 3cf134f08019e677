# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Edits that fail leave everything as it was: turns, steps after turns, surfaces that cannot follow, wrong states."""

from __future__ import annotations

import numpy as np
import pytest

import newton_cagecut as cagecut
from cage_shapes import box
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import SurfaceCut
from solver_scenes import assert_same, everything, make_solver, run, slanted_blade, vertex_rows

BLADE = Blade([0.45, 0.5, 0.5], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0])
BAD_TURNS = {
    "not numbers": ("down", TypeError, "three numbers"),
    "too few numbers": ([1.0, 0.0], ValueError, "shape"),
    "nan": ([np.nan, 0.0, -1.0], ValueError, "not finite"),
    "zero": ([0.0, 0.0, 0.0], ValueError, "is zero"),
    "along the edge": ([0.0, -2.0, 0.0], ValueError, "parallel"),
    "back into the cut": ([0.01, 0.0, 1.0], ValueError, "turn back"),
}


def _cut_body(**options):
    """A body in motion with a cut half-way through it."""
    _, solver, *states = make_solver(gravity=-9.81, **options)
    states = run(solver, states, 2)
    cut = solver.begin_cut(0, BLADE)
    solver.advance_cut(cut, to=0.4, states=states)
    return solver, cut, states


def _progress(cut) -> tuple:
    """Where a cut is."""
    inner, surface = cut.cut, cut._surface_cut
    return inner.depth, inner.front, inner.wall, inner.plane, inner.cage, inner._strips, surface.surface, surface.front


@pytest.fixture(scope="module")
def half_cut():
    """One body for all turns that are refused: they leave it as it was."""
    return _cut_body()


@pytest.mark.parametrize("name", BAD_TURNS)
def test_bad_turns_change_nothing(half_cut, name):
    """A direction that is none, or leads back, is refused with the reason; body, states, weights and cut stay."""
    solver, cut, states = half_cut
    direction, error, text = BAD_TURNS[name]
    before, progress = everything(solver, states), _progress(cut)
    with pytest.raises(error, match=text):
        cut.turn(direction)
    assert all(now is then for now, then in zip(_progress(cut), progress, strict=True))
    assert_same(before, everything(solver, states))


def test_cuts_go_on_after_refused_turns():
    """After refused turns a cut gives what it would have given without."""
    cut, other = Cut(box(), BLADE), Cut(box(), BLADE)
    for one in (cut, other):
        one.advance(to=0.4)
    for direction, error, _ in BAD_TURNS.values():
        with pytest.raises(error):
            cut.turn(direction)
    for one in (cut, other):
        one.turn([0.4, 0.0, -1.0])
        one.advance(to=0.8)
    assert cut.cage.faces == other.cage.faces
    np.testing.assert_array_equal(cut.cage.vertices, other.cage.vertices)


def test_complete_cuts_do_not_turn():
    """A cut that is through has no front; turning it is refused and changes nothing."""
    solver, cut, states = _cut_body()
    solver.advance_cut(cut, to=2.0, states=states)
    before, progress = everything(solver, states), _progress(cut)
    with pytest.raises(ValueError, match="the cut is complete"):
        cut.turn([1.0, 0.0, -1.0])
    assert all(now is then for now, then in zip(_progress(cut), progress, strict=True))
    assert_same(before, everything(solver, states))


def test_step_over_capacity_after_a_turn():
    """A turned cut whose next step does not fit is refused; it stays turned, where it was, and fits when shorter."""
    solver, cut, states = _cut_body(capacity=cagecut.Capacity(vertices=19, surface_points=1000, surface_triangles=4000))
    cut.turn([0.5, 0.0, -1.0])
    before, progress = everything(solver, states), _progress(cut)
    with pytest.raises(ValueError, match="vertices"):
        solver.advance_cut(cut, to=2.0, states=states)
    assert all(now is then for now, then in zip(_progress(cut), progress, strict=True))
    assert_same(before, everything(solver, states))
    assert solver.advance_cut(cut, to=0.5, states=states).vertices_created > 0
    assert cut.depth == 0.5


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("method", ["advance", "go_on"])
def test_surface_that_cannot_follow(monkeypatch, method, turned):
    """A failure of the surface's part, which comes after the cage's, takes the cage's part back."""
    solver, cut, states = _cut_body()
    if turned:
        cut.turn([0.5, 0.0, -1.0])
    other = solver.begin_cut(0, slanted_blade())
    solver.advance_cut(other, to=0.2, states=states)
    before, progress = everything(solver, states), _progress(cut)

    def fail(*_unused, **_options):
        raise ValueError("the surface cannot follow")

    with monkeypatch.context() as patch:
        patch.setattr(SurfaceCut, method, fail)
        with pytest.raises(ValueError, match="cannot follow"):
            solver.advance_cut(cut, to=0.6, states=states)
        if method == "go_on":
            with pytest.raises(ValueError, match="cannot follow"):
                cut.turn([0.2, 0.0, -1.0])
    assert all(now is then for now, then in zip(_progress(cut), progress, strict=True))
    assert_same(before, everything(solver, states))
    solver.advance_cut(cut, to=0.6, states=states)
    assert cut.depth == 0.6
    weights = solver.bodies[0].coordinates.weights
    solver.bodies[0].coordinates.recompute()
    np.testing.assert_array_equal(weights, solver.bodies[0].coordinates.weights)


def test_wrong_states_change_nothing():
    """States that are none, or another model's, are refused before anything has changed."""
    solver, cut, states = _cut_body()
    smaller, _, foreign, _ = make_solver(
        capacity=cagecut.Capacity(vertices=30, surface_points=900, surface_triangles=3000)
    )
    assert smaller.particle_count != solver.model.particle_count
    before = everything(solver, states)
    with pytest.raises(TypeError, match=r"states\[1\] must be a newton.State"):
        solver.advance_cut(cut, to=0.6, states=(states[0], None))
    with pytest.raises(ValueError, match=r"states\[0\].particle_q has the shape"):
        solver.advance_cut(cut, to=0.6, states=(foreign,))
    assert_same(before, everything(solver, states))
    solver.advance_cut(cut, to=0.6, states=states)
    assert np.isfinite(vertex_rows(solver, states[0])).all()
