# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes whose points are split at seams are cut as what they are, and keep points and attributes."""

import newton
import numpy as np
import pytest

from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface
from solver_scenes import make_solver, run
from surface_shapes import bumpy_sphere, check_closed, cut_through, grid, gridded_box

BLADES = (
    Blade([0.45, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0]),
    Blade([0.5, 0.55, 0.5], [1.0, 0.1, -0.05], [0.0, 0.2, -1.0]),
)


def split_everywhere(surface: Surface, **options) -> Surface:
    """The surface with points of its own for each triangle."""
    return Surface(
        surface.points[surface.triangles.reshape(-1)], np.arange(3 * surface.triangle_count).reshape(-1, 3), **options
    )


def split_box() -> Surface:
    """Newton's box of 24 points, 0.6 m wide, in the unit box, with its texture coordinates and normals."""
    mesh = newton.Mesh.create_box(0.3, 0.3, 0.3)
    return Surface(mesh.vertices + 0.5, mesh.indices.reshape(-1, 3), uvs=mesh.uvs, normals=mesh.normals)


def corner_normals_of(surface: Surface) -> np.ndarray:
    """Normals of the triangles, shape (triangle_count, 3)."""
    area = surface.mesh.face_area_vector
    return area / np.linalg.norm(area, axis=1, keepdims=True)


def test_box_of_24_points_is_cut_as_a_solid():
    """It has 8 sites, falls into two closed halves with caps, and each part keeps its side's normal and texture."""
    surface = split_box()
    assert (surface.point_count, surface.site_count, surface.closed) == (24, 8, True)
    plain = Surface(surface.site_points, surface.site_triangles)
    for now, simple in zip(cut_through(surface, BLADES), cut_through(plain, BLADES), strict=True):
        check_closed(now, surface.volume)
        np.testing.assert_array_equal(now.points[:24], surface.points)
        np.testing.assert_array_equal(now.points, now.site_points[now.point_site])
        np.testing.assert_array_equal(now.site_points, simple.points)
        np.testing.assert_array_equal(now.site_triangles, simple.triangles)
        skin = now.triangle_cap < 0
        np.testing.assert_allclose(
            now.normals[now.triangles[skin]], np.repeat(corner_normals_of(now)[skin, None], 3, axis=1), atol=1e-6
        )
    assert now.mesh.component_count == 4


@pytest.mark.parametrize("shape", [bumpy_sphere, gridded_box])
def test_triangles_apart_are_cut_like_the_whole(shape):
    """A mesh in which every triangle has points of its own gives the sites and caps of the mesh that shares them."""
    whole, apart = shape(), split_everywhere(shape())
    assert apart.site_count == whole.point_count
    for now, simple in zip(cut_through(apart, BLADES), cut_through(whole, BLADES), strict=True):
        assert now.closed
        assert (now.site_count, now.triangle_count) == (simple.point_count, simple.triangle_count)
        assert now.volume == pytest.approx(whole.volume)
        np.testing.assert_array_equal(now.triangle_cap, simple.triangle_cap)
    assert now.mesh.component_count == simple.mesh.component_count


@pytest.mark.parametrize("dimension", [2, 3])
def test_numbers_stay_while_the_cut_goes_on(dimension):
    """Points that were there keep their numbers; new ones have one each at its site, in the order of the sites."""
    surface = split_everywhere(grid(4) if dimension == 2 else gridded_box(3))
    blades = (Blade([0.45, 0.5], [0.2, -1.0]),) if dimension == 2 else BLADES[:1]
    for now in cut_through(surface, blades):
        created = now.site_count - surface.site_count
        first = surface.point_count
        np.testing.assert_array_equal(now.point_site[:first], surface.point_site)
        np.testing.assert_array_equal(now.point_site[first : first + created], surface.site_count + np.arange(created))
        np.testing.assert_array_equal(now.site_triangles, now.point_site[now.triangles])


def test_tolerance_joins_what_is_near_and_nothing_else():
    """Ends of open edges are joined up to the tolerance; edges that are closed, and points on walls, are not."""
    whole = gridded_box(2)
    points = whole.points[whole.triangles.reshape(-1)]
    points = points + np.random.default_rng(0).uniform(-2e-7, 2e-7, points.shape)
    triangles = np.arange(len(points)).reshape(-1, 3)
    assert Surface(points, triangles).closed
    assert not Surface(points, triangles, weld=1e-9).closed
    assert Surface(points, triangles, weld=-1.0).site_count == len(points)
    on_wall = Surface(points, triangles, point_key=np.zeros(len(points), dtype=int))
    assert on_wall.site_count == len(points)
    two = Surface(
        np.concatenate([whole.points] * 2), np.concatenate([whole.triangles, whole.triangles + whole.point_count])
    )
    assert (two.site_count, two.mesh.component_count) == (2 * whole.point_count, 2)
    with pytest.raises(TypeError, match="weld of the surface must be a number, got 'yes'"):
        Surface(points, triangles, weld="yes")


def test_poles_of_a_sphere_with_a_seam():
    """A sphere of a grid of longitudes and latitudes, with a point a meridian at its poles, is closed."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, 13), np.linspace(0.0, 1.0, 7), indexing="ij")
    theta, phi = 2.0 * np.pi * (u % 1.0), np.pi * v
    points = 0.5 + 0.4 * np.stack([np.sin(phi) * np.cos(theta), np.sin(phi) * np.sin(theta), np.cos(phi)], axis=-1)
    a = (np.arange(12)[:, None] * 7 + np.arange(6)).reshape(-1)
    triangles = np.concatenate([np.stack([a, a + 1, a + 8], axis=1), np.stack([a, a + 8, a + 7], axis=1)])
    surface = Surface(points.reshape(-1, 3), triangles, uvs=np.stack([u, v], axis=-1).reshape(-1, 2))
    assert (surface.site_count, surface.triangle_count, surface.closed) == (12 * 5 + 2, 2 * 12 * 5, True)
    for now in cut_through(surface, BLADES):
        check_closed(now, surface.volume)
        seam = now.uvs[now.triangles[now.triangle_cap < 0]]
        assert np.ptp(seam[..., 0], axis=1).max() < 1.0 / 12.0 + 1e-12


def test_body_with_seams_moves_as_one():
    """Coincident points stay together bit for bit while a body falls apart; pieces, contact and undo follow."""
    model, solver, *states = make_solver(surface=split_box(), gravity=-9.81, fixed=[0, 1], contact_radius=0.01)
    body = solver.bodies[0]
    assert body.surface_weights.shape == (8, 8)
    snapshot = solver.snapshot(0, states=states)
    cut = solver.begin_cut(0, BLADES[0])
    while not cut.complete:
        solver.advance_cut(cut, 0.3, states=states)
        states = list(run(solver, states, 3))
        points, triangles = solver.surface(states[0])
        surface = body.surface
        np.testing.assert_array_equal(triangles, surface.triangles)
        np.testing.assert_array_equal(points, points[surface.site_point][surface.point_site])
    assert np.abs(points - surface.points).max() > 0.01
    pieces = solver.pieces(0)
    assert sorted(np.concatenate([piece.surface_points for piece in pieces])) == list(range(len(points)))
    solver.restore(snapshot)
    assert len(solver.surface(states[0])[0]) == 24
