# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cuts of surfaces: what must hold after every step."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import box, random_blade
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade, BladePlane
from newton_cagecut.surface import Surface, SurfaceCut
from surface_shapes import (
    EVERY,
    around,
    bumpy_sphere,
    check_caps,
    check_closed,
    check_outward,
    check_sides,
    check_surface,
    disk,
    flower,
    icosphere,
    sphere,
    torus,
)

RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=5, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_random_cuts(name, seed):
    """Random progressive cuts, each crossing the ones before, keep a surface whole and of the same volume or area."""
    rng = np.random.default_rng(seed)
    surface = EVERY[name]()
    cage, volume = around(surface), surface.volume
    for _ in range(2):
        cut = Cut(cage, random_blade(rng, cage))
        progress = SurfaceCut(surface, cut.plane, cut.wall)
        for part in (*np.sort(rng.uniform(0.1, 0.9, 2)), *([1.0] if rng.random() < 0.5 else [])):
            step = progress.advance(cut.advance(to=part * cut.length).front)
            before, now = step.before, step.surface
            check_surface(now, volume)
            check_sides(now, cut.plane, cut.wall)
            if now.dimension == 3:
                check_outward(now, name)
            assert step.created.tolist() == list(range(before.point_count, now.point_count))
            moved = (before.points != now.points[: before.point_count]).any(axis=1)
            np.testing.assert_array_equal(step.moved, np.flatnonzero(moved))
        cage, surface = cut.cage, now


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=3, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_one_step_is_many(name, seed):
    """One advance gives exactly the surface that many give."""
    rng = np.random.default_rng(seed)
    surface = EVERY[name]()
    for wall in (6, 7):
        plane = BladePlane.of(random_blade(rng, around(surface)))
        many, one = SurfaceCut(surface, plane, wall), SurfaceCut(surface, plane, wall)
        last = rng.uniform(-0.1, 0.4)
        for front in np.linspace(-0.6, last, 7):
            many.advance(front)
        one.advance(last)
        for attribute in ("points", "triangles", "triangle_cap", "point_key"):
            np.testing.assert_array_equal(getattr(one.surface, attribute), getattr(many.surface, attribute))
        surface = one.surface


def test_half_a_sphere():
    """A sphere cut through has two closed halves, caps of a disc's area and keys of both sides."""
    surface = sphere(4)
    plane = BladePlane.of(Blade([0.5, 0.5, 0.501], [1, 0, 0], [0, 1, 0]))
    now = SurfaceCut(surface, plane, 6).advance(np.inf).surface
    check_closed(now, surface.volume)
    assert now.mesh.component_count == 2
    np.testing.assert_allclose(now.mesh.component_volumes, 0.5 * surface.volume, rtol=0.01)
    area = np.linalg.norm(now.mesh.face_area_vector, axis=1)
    np.testing.assert_allclose(area[now.triangle_cap == 6].sum(), 2.0 * np.pi * 0.45**2, rtol=0.01)
    above = now.points[now.triangles].mean(axis=1)[:, 2] > 0.501
    assert (now.point_key[now.triangles][above & (now.triangle_cap == 6)] == 13).all()
    assert set(now.point_key[surface.point_count :].tolist()) == {12, 13}
    assert (now.point_key[: surface.point_count] == -1).all()


def test_untouched_triangles_stay_in_place():
    """Triangles that the cut does not cross keep their places."""
    surface = sphere()
    plane = BladePlane.of(Blade([0.5, 0.5, 0.5], [0.1, 0.2, 1], [1, 0, 0.1]))
    now = SurfaceCut(surface, plane, 6).advance(0.1).surface
    positive = plane.distance(surface.points)[surface.triangles] >= 0.0
    untouched = positive.all(axis=1) | ~positive.any(axis=1)
    np.testing.assert_array_equal(now.triangles[: surface.triangle_count][untouched], surface.triangles[untouched])


@pytest.mark.parametrize("make", [bumpy_sphere, flower])
def test_tips_move_and_nothing_else(make):
    """From step to step only tips move, on the plane from front to front; a point in the plane takes its side."""
    surface = make()
    vectors = ([0.1, 0.2, 1], [1, 0, 0.1]) if surface.dimension == 3 else ([1, 0.1],)
    plane = BladePlane.of(Blade(np.full(surface.dimension, 0.5), *vectors))
    cut = SurfaceCut(surface, plane, 6)
    cut.advance(-0.05)
    before = cut.surface
    step = cut.advance(0.0)
    moves = (before.points[step.moved] != step.surface.points[step.moved]).any(axis=1)
    assert moves.any()
    s = plane.coordinates(before.points[step.moved[moves]])[:, 1]
    np.testing.assert_allclose(s, -0.05, atol=1e-12)
    np.testing.assert_allclose(plane.distance(before.points[step.moved[~moves]]), 0.0, atol=1e-12)


def test_torus_sliced_flat():
    """A torus cut in its plane has annular caps and falls into two closed halves."""
    surface = torus()
    cut = SurfaceCut(surface, BladePlane.of(Blade([0.5, 0.5, 0.51], [1, 0.1, 0], [0, 1, 0])), 6)
    for front in (-0.3, -0.1, 0.1, 0.3, 0.6):
        now = cut.advance(front).surface
        check_closed(now, surface.volume)
        check_caps(now, cut.plane, 6)
    assert now.mesh.component_count == 2
    euler = now.point_count - now.mesh.edge_count + now.triangle_count
    assert euler == 0


def test_points_on_the_line():
    """A line through points and along edges of a flat mesh, with tips at points, is no trouble."""
    surface = disk(40, 5)
    plane = BladePlane.of(Blade([0.5, 0.5], [1, 0]))
    assert (plane.distance(surface.points) == 0.0).sum() > 4
    cut = SurfaceCut(surface, plane, 4)
    for front in (*np.sort(plane.coordinates(surface.points[plane.distance(surface.points) == 0.0])[:, 1]), 2.0):
        now = cut.advance(front).surface
        check_surface(now, surface.volume)
        check_sides(now, plane, 4)
    assert now.mesh.component_count == 2


def test_points_on_the_plane():
    """A plane through points of the surface is no trouble: it stays closed and keeps its volume."""
    points, triangles = icosphere(2)
    surface = Surface(points, triangles)
    for normal_axis in range(3):
        axes = np.roll(np.eye(3), normal_axis, axis=0)
        plane = BladePlane.of(Blade(np.zeros(3), axes[0], axes[1]))
        assert (plane.distance(points) == 0.0).sum() > 4
        cut = SurfaceCut(surface, plane, 6)
        for front in (-0.5, 0.0, 0.5, 2.0):
            now = cut.advance(front).surface
            assert now.closed
            np.testing.assert_allclose(now.volume, surface.volume, rtol=1e-12)


def test_open_surface_is_split_without_caps():
    """An open chain is split; its new border has no cap."""
    points, triangles = icosphere(3)
    keep = points[triangles].mean(axis=1)[:, 2] < 0.3
    bowl = Surface(points, triangles[keep])
    area = np.linalg.norm(bowl.mesh.face_area_vector, axis=1).sum()
    cut = SurfaceCut(bowl, BladePlane.of(Blade([0.01, 0.0, 0.0], [0, 1, 0.1], [0, 0.1, 1])), 6)
    for front in (-0.5, 0.0, 2.0):
        now = cut.advance(front).surface
        assert (now.triangle_cap == -1).all()
        np.testing.assert_allclose(np.linalg.norm(now.mesh.face_area_vector, axis=1).sum(), area, rtol=1e-12)
    used = np.unique(now.triangles)
    assert len(np.unique(now.mesh.vertex_component[used])) == 2
    assert np.isin(np.arange(len(points), now.point_count), used).all()


def test_overlapping_and_nested_bodies():
    """Overlapping bodies and cavities are each capped on their own."""
    points, triangles = icosphere(3)
    n = len(points)
    overlapping = Surface(
        np.concatenate([points, points + [0.9, 0.1, 0.05]]), np.concatenate([triangles, triangles + n])
    )
    hollow = Surface(np.concatenate([points, 0.6 * points]), np.concatenate([triangles, triangles[:, ::-1] + n]))
    blade = Blade([0.03, 0.02, 0.01], [0.1, 0.2, 1.0], [1.0, 0.1, 0.0])
    for surface, pieces in ((overlapping, 4), (hollow, 2)):
        cut = SurfaceCut(surface, BladePlane.of(blade), 6)
        for front in (-0.8, -0.3, 0.2, 0.9, 3.0):
            now = cut.advance(front).surface
            check_closed(now, surface.volume)
        assert now.mesh.component_count == pieces


def test_texture_coordinates_follow():
    """New points have the coordinates that lie between those of their edges' ends."""
    points, triangles = icosphere(3)
    matrix = np.array([[0.3, 0.1], [-0.2, 0.7], [0.5, -0.4]])
    surface = Surface(points, triangles, uvs=points @ matrix)
    cut = SurfaceCut(surface, BladePlane.of(Blade([0.1, 0.0, 0.0], [0.1, 0.2, 1.0], [0, 1, 0.1])), 6)
    for front in (-0.2, 0.3, 2.0):
        now = cut.advance(front).surface
        np.testing.assert_allclose(now.uvs, now.points @ matrix, atol=1e-12)


def test_texture_coordinates_follow_in_the_plane():
    """The same in a flat mesh, where each side of the cut has the coordinates of its own triangles."""
    surface = flower()
    matrix = np.linalg.lstsq(surface.points, surface.uvs, rcond=None)[0]
    cut = SurfaceCut(surface, BladePlane.of(Blade([0.45, 0.5], [0.1, 1])), 4)
    for front in (-0.2, 0.1, 2.0):
        now = cut.advance(front).surface
        np.testing.assert_allclose(now.uvs, now.points @ matrix, atol=1e-12)


def test_a_miss_and_empty_steps():
    """A plane beside the surface, and a front that has not reached it, change nothing."""
    surface = sphere()
    beside = SurfaceCut(surface, BladePlane.of(Blade([5, 0, 0], [0, 1, 0], [0, 0, 1])), 6)
    assert beside.advance(10.0).is_empty
    cut = SurfaceCut(surface, BladePlane.of(Blade([0.5, 0.5, 0.5], [0, 1, 0], [0, 0, 1])), 6)
    assert cut.advance(-3.0).is_empty
    assert not cut.advance(0.0).is_empty
    assert cut.advance(0.0).is_empty
    assert not cut.advance(3.0).is_empty
    assert cut.advance(4.0).is_empty


def test_refusals():
    """A cut wants a surface and a front that is a number and does not go back."""
    plane = BladePlane.of(Blade([0.5, 0.5, 0.5], [0, 1, 0], [0, 0, 1]))
    with pytest.raises(TypeError, match="surface must be a Surface, got Cage"):
        SurfaceCut(box(), plane, 6)
    with pytest.raises(ValueError, match="the surface is of dimension 2 and the cut's plane of dimension 3"):
        SurfaceCut(disk(), plane, 6)
    cut = SurfaceCut(sphere(), plane, 6)
    cut.advance(0.1)
    with pytest.raises(ValueError, match="never goes back: it has reached 0.1, asked for 0"):
        cut.advance(0.0)
    with pytest.raises(ValueError, match="got nan"):
        cut.advance(np.nan)
