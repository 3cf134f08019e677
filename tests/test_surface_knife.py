# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces under knives of finite width and cuts that begin inside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from assets.bunny import bunny_mesh
from cage_shapes import box
from cut_sequences import ASSETS
from newton_cagecut.cage import Cage, Cut, check_inside
from newton_cagecut.geometry import simplex_distances
from newton_cagecut.section import Blade, BladePlane
from newton_cagecut.surface import Surface, SurfaceCut
from newton_cagecut.usd import read_cage, read_surface
from surface_shapes import SURFACES, check_caps, check_closed, check_outward, icosphere, sphere

RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}


def random_knife(rng: np.random.Generator, cage: Cage) -> Blade:
    """A knife with a heel, a tip or both, and often a start, near the middle of a cage."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    reach = rng.choice([0.06, 0.12, 0.3]) * cage.diameter
    heel, tip = np.sort(rng.uniform(-reach, reach, 2))
    window = {"width": [(heel, tip), (heel, tip), (heel, np.inf), (-np.inf, tip)][rng.integers(4)]}
    if rng.random() < 0.6:
        window["start"] = rng.uniform(-reach, 0.06 * cage.diameter)
    return Blade(low + (high - low) * rng.uniform(0.2, 0.8, 3), rng.normal(size=3), rng.normal(size=3), **window)


def follow(cut: Cut, surface: Surface) -> SurfaceCut:
    """The surface's part of a cut."""
    return SurfaceCut(surface, cut.plane, cut.wall, window=cut.window)


def check_on_opened_wall(surface: Surface, cut: Cut) -> None:
    """Assert that the surface's new points lie in the knife's window, on faces of the cage's wall on their own side."""
    cage, tolerance = cut.cage, 1e-9 * cut.cage.diameter
    heel, tip, start = cut.window
    for key in (2 * cut.wall, 2 * cut.wall + 1):
        points = surface.points[surface.point_key == key]
        a, s = cut.plane.coordinates(points).T
        assert a.min(initial=heel) >= heel - tolerance
        assert a.max(initial=tip) <= tip + tolerance
        assert s.min(initial=start) >= start - tolerance
        assert s.max(initial=cut.front) <= cut.front + tolerance
        corners = cage.vertices[cage.triangles[cage.face_key[cage.triangle_face] == key]]
        if len(points):
            assert simplex_distances(points, corners).min(axis=1).max() < tolerance


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=5, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_random_knives(name, seed):
    """Knives that cross each other keep a closed surface of the same volume, on the cage's walls; one step is many."""
    rng = np.random.default_rng(seed)
    surface, cage = SURFACES[name](), box()
    volume = surface.volume
    for _ in range(3):
        cut = Cut(cage, random_knife(rng, cage))
        progress, one = follow(cut, surface), follow(cut, surface)
        for part in np.sort(rng.uniform(0.0, 1.1, 3)):
            edit = cut.advance(to=part * cut.length)
            step = progress.advance(edit.front)
            now = step.surface
            check_closed(now, volume)
            check_caps(now, cut.plane, cut.wall)
            check_outward(now, name)
            check_on_opened_wall(now, cut)
            assert step.created.tolist() == list(range(step.before.point_count, now.point_count))
        one.advance(edit.front)
        for attribute in ("points", "triangles", "triangle_cap", "point_key"):
            np.testing.assert_array_equal(getattr(one.surface, attribute), getattr(now, attribute))
        cage, surface = cut.cage, now


def _bunny() -> tuple[Cage, Surface]:
    return read_cage(ASSETS / "bunny_cage.usda"), Surface(*bunny_mesh())


def _starfish() -> tuple[Cage, Surface]:
    return read_cage(ASSETS / "starfish_cage.usda"), read_surface(ASSETS / "starfish.usdc")


@pytest.mark.parametrize("make", [_bunny, _starfish])
def test_assets(make):
    """The scenes' meshes in their cages stay closed, within the cage and on its walls under knives of many kinds."""
    base, surface = make()
    volume = surface.volume
    for seed in range(4):
        rng = np.random.default_rng(seed)
        cut = Cut(base, random_knife(rng, base))
        progress = follow(cut, surface)
        for part in (0.3, 0.8, 1.1):
            now = progress.advance(cut.advance(to=part * cut.length).front).surface
            assert now.closed
            np.testing.assert_allclose(now.volume, volume, rtol=1e-11)
            check_on_opened_wall(now, cut)
        check_caps(now, cut.plane, cut.wall)
        check_inside(cut.base, now.points, which=np.flatnonzero(now.point_key >= 0))


@pytest.mark.parametrize("tilt", [0.0, 0.37])
@pytest.mark.parametrize("axis", range(3))
def test_borders_and_fronts_at_points(axis, tilt):
    """Knives whose plane, heel, tip, start and front all pass through points and along edges leave no crack."""
    points, triangles = icosphere(2)
    surface = Surface(points, triangles)
    axes = np.roll(np.eye(3), axis, axis=0)
    plane = BladePlane.of(Blade(np.zeros(3), axes[0] + tilt * axes[1], axes[1]))
    along, ahead = plane.coordinates(points[np.abs(plane.distance(points)) < 1e-15]).T
    rng = np.random.default_rng(axis)
    for _ in range(15):
        heel, tip = np.sort(rng.choice(np.unique(np.round(along, 12)), 2, replace=False))
        heel, tip = (along[np.argmin(np.abs(along - value))] for value in (heel, tip))
        cut = SurfaceCut(surface, plane, 6, window=(heel, tip, rng.choice([-np.inf, *np.sort(ahead)[:-2]])))
        for front in [*np.sort(rng.choice(ahead, 3)), 5.0]:
            now = cut.advance(front).surface
            check_closed(now, surface.volume)
            check_caps(now, plane, 6)
            facing = np.einsum("ij,ij->i", now.mesh.face_area_vector, now.points[now.triangles].mean(axis=1))
            assert facing[now.triangle_cap < 0].min() > -1e-13


def _block() -> Surface:
    """A box of twelve triangles in the unit box."""
    cage = box((0.8, 0.8, 0.8))
    return Surface(cage.vertices + 0.1, cage.triangles)


def test_slit_that_meets_no_edge():
    """A knife narrower than a triangle slits it from within: both ends pinned, a vertex on each side to open at."""
    surface = _block()
    cut = Cut(box(), Blade([0.38, 0.31, 0.5], [0, 1, 0], [0, 0, -1], width=0.1))
    progress = follow(cut, surface)
    now = progress.advance(cut.advance(to=0.4).front).surface
    check_closed(now, surface.volume)
    check_caps(now, cut.plane, cut.wall)
    euler = now.point_count - now.mesh.edge_count + now.triangle_count
    assert euler == 2
    keys = now.point_key[surface.point_count :]
    assert sorted(keys.tolist()).count(2 * cut.wall) == 1
    assert len(keys) == 6
    new = now.points[surface.point_count :]
    assert np.count_nonzero(np.abs(new[:, 2] - 0.9) < 1e-12) == 4
    assert sorted(np.round(new[:, 1], 9)) == [0.26, 0.26, 0.31, 0.31, 0.36, 0.36]
    slit = (now.triangle_cap < 0) & (now.triangles >= surface.point_count).any(axis=1)
    assert np.count_nonzero(slit) == 7
    area = np.linalg.norm(now.mesh.face_area_vector, axis=1)
    assert area[slit].sum() == pytest.approx(0.32, rel=1e-12)
    assert area[now.triangle_cap == cut.wall].sum() == pytest.approx(2 * 0.1 * 0.3, rel=1e-9)
    through = progress.advance(cut.advance(to=2.0).front).surface
    check_closed(through, surface.volume)
    assert through.mesh.component_count == 1
    assert through.point_count - through.mesh.edge_count + through.triangle_count == 0


def test_cut_that_begins_inside():
    """A cut that touches no triangle yet is a closed body without volume of its own, which joins the skin it meets."""
    surface = _block()
    cut = Cut(box(), Blade([0.38, 0.31, 0.6], [0, 1, 0], [0, 0, -1], width=0.1, start=0.0))
    progress = follow(cut, surface)
    for depth, components in ((0.2, 2), (0.4, 2), (0.7, 1)):
        now = progress.advance(cut.advance(to=depth).front).surface
        check_closed(now, surface.volume)
        check_caps(now, cut.plane, cut.wall)
        assert now.mesh.component_count == components
        assert (now.triangle_solid == now.triangle_solid[0]).all()
        area = np.linalg.norm(now.mesh.face_area_vector, axis=1)[now.triangle_cap == cut.wall].sum()
        assert area == pytest.approx(2 * 0.1 * min(depth, 0.5), rel=1e-4)
        hubs = now.points[now.point_key == 2 * cut.wall]
        np.testing.assert_allclose(hubs[0], [0.38, 0.31, 0.6 - 0.5 * min(depth, 0.5)], atol=1e-5)


def test_open_surface_is_slit_without_caps():
    """An open surface keeps its area, gets no caps and stays in one part, however deep a narrow knife goes."""
    points, triangles = icosphere(3)
    bowl = Surface(0.4 * points + 0.5, triangles[points[triangles].mean(axis=1)[:, 2] < 0.3])
    area = np.linalg.norm(bowl.mesh.face_area_vector, axis=1).sum()
    cut = Cut(box(), Blade([0.51, 0.5, 0.5], [0, 1, 0.1], [0, 0.1, 1], width=(-0.15, 0.2)))
    progress = follow(cut, bowl)
    for depth in (0.2, 0.4, 0.7, 5.0):
        now = progress.advance(cut.advance(to=depth).front).surface
        assert (now.triangle_cap == -1).all()
        np.testing.assert_allclose(np.linalg.norm(now.mesh.face_area_vector, axis=1).sum(), area, rtol=1e-12)
    assert now.point_count > bowl.point_count
    assert len(np.unique(now.mesh.vertex_component[np.unique(now.triangles)])) == 1


def test_texture_coordinates_reach_the_ends_of_slits():
    """Pinned points and those beside them on the skin have the coordinates of where they lie."""
    points, triangles = icosphere(3)
    matrix = np.array([[0.3, 0.1], [-0.2, 0.7], [0.5, -0.4]])
    surface = Surface(points, triangles, uvs=points @ matrix, normals=points)
    plane = BladePlane.of(Blade([0.1, 0.0, 0.0], [0.1, 0.2, 1.0], [0, 1, 0.1]))
    cut = SurfaceCut(surface, plane, 6, window=(-0.4, 0.3, -np.inf))
    for front in (-0.2, 0.3, 2.0):
        now = cut.advance(front).surface
        on_skin = np.zeros(now.point_count, dtype=bool)
        on_skin[now.triangles[now.triangle_cap < 0]] = True
        np.testing.assert_allclose(now.uvs[on_skin], (now.points @ matrix)[on_skin], atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(now.normals, axis=1), 1.0, atol=1e-12)


def test_rewinding_a_knife():
    """A snapshot brings the very surface back, and the knife goes on from there as it did."""
    surface = sphere(2)
    cut = Cut(box(), Blade([0.5, 0.5, 0.55], [0, 1, 0], [0.1, 0, -1], width=0.2, start=0.0))
    progress = follow(cut, surface)
    first = progress.advance(cut.advance(to=0.2).front).surface
    here, front = progress.snapshot(), cut.advance(to=0.6).front
    last = progress.advance(front).surface
    assert progress.rewind(here) is first
    again = progress.advance(front).surface
    for name in ("points", "triangles", "triangle_cap", "cap_side", "point_key"):
        np.testing.assert_array_equal(getattr(again, name), getattr(last, name))
    assert progress.rewind() is surface
