# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Flat surfaces under cuts of plane cages: what lies where, on which side, in which piece."""

from __future__ import annotations

import numpy as np
import pytest

from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from plane_shapes import comb, square
from surface_shapes import annulus, check_sides, check_surface, disk, grid

UP = Blade([0.513, 0.0], [0.0, 1.0])


def _begin(surface: Surface, blade: Blade = UP, cage=None) -> tuple[Cut, SurfaceCut]:
    """Both parts of a cut."""
    cut = Cut(square() if cage is None else cage, blade)
    return cut, SurfaceCut(surface, cut.plane, cut.wall, window=cut.window)


def test_flat_surface_is_a_mesh_in_space():
    """The mesh lies in the plane z = 0, its volume is its area, it is open and faces +z."""
    surface = grid()
    assert (surface.dimension, surface.closed) == (2, False)
    assert surface.volume == pytest.approx(0.64)
    assert surface.points.shape == (49, 2)
    np.testing.assert_array_equal(surface.mesh.vertices, np.c_[surface.points, np.zeros(49)])
    np.testing.assert_array_equal(surface.corner_normals(()), np.broadcast_to([0.0, 0.0, 1.0], (72, 3, 3)))


def test_disk_in_two_halves():
    """A disk cut through has two halves of the right areas, and new points on both sides with the key of theirs."""
    surface = disk(80, 8)
    cut, surface_cut = _begin(surface)
    now = surface_cut.advance(cut.advance(to=2.0).front).surface
    check_surface(now, surface.volume)
    assert now.mesh.component_count == 2
    left = now.points[now.triangles].mean(axis=1)[:, 0] < 0.513
    area = now.mesh.face_area_vector[:, 2]
    segment = 0.45**2 * np.arccos(0.013 / 0.45) - 0.013 * np.sqrt(0.45**2 - 0.013**2)
    assert area[~left].sum() == pytest.approx(segment, rel=2e-3)
    key = now.point_key
    assert set(key[surface.point_count :].tolist()) == {2 * cut.wall, 2 * cut.wall + 1}
    for side, triangles in ((1, now.triangles[left]), (0, now.triangles[~left])):
        used = np.unique(triangles)
        assert set(key[used].tolist()) == {-1, 2 * cut.wall + side}
    assert (key[: surface.point_count] == -1).all()


def test_tip_lies_on_the_front():
    """A partial cut has one tip inside the mesh, on the blade, around which the surface stays together."""
    surface = grid()
    cut, surface_cut = _begin(surface)
    now = surface_cut.advance(cut.advance(to=0.43).front).surface
    assert now.mesh.component_count == 1
    tip = surface.point_count + np.flatnonzero(now.points[surface.point_count :, 1] == 0.43)
    assert len(tip) == 1
    assert now.points[tip[0]].tolist() == [0.513, 0.43]
    assert (now.points[now.point_key >= 0, 0] == 0.513).all()
    np.testing.assert_array_equal(now.directions_inward(tip), [[0.0, 0.0]])
    sides = now.directions_inward(np.flatnonzero((now.point_key >= 0) & (now.points[:, 1] > 0.11)))
    assert set(map(tuple, np.round(sides, 12).tolist())) == {(-1.0, 0.0), (1.0, 0.0), (0.0, 0.0)}


def test_points_at_crossings_lean_into_their_pieces():
    """Where two cuts cross, each of the four corners points into the piece that it belongs to."""
    surface, cage = grid(), square()
    for blade in (UP, Blade([0.0, 0.483], [1.0, 0.0])):
        cut, surface_cut = _begin(surface, blade, cage)
        surface = surface_cut.advance(cut.advance(to=2.0).front).surface
        cage = cut.cage
    assert surface.mesh.component_count == 4
    (corners,) = np.nonzero(np.linalg.norm(surface.points - [0.513, 0.483], axis=1) < 1e-12)
    assert len(corners) == 4
    inward = surface.directions_inward(corners)
    for corner, direction in zip(corners, inward, strict=True):
        piece = surface.points[surface.mesh.vertex_component == surface.mesh.vertex_component[corner]]
        np.testing.assert_allclose(direction, np.sign(piece.mean(axis=0) - [0.513, 0.483]) / np.sqrt(2.0))


def test_ring_is_cut_open():
    """A ring cut from outside to its hole stays in one part; cut on to the other side it falls in two."""
    surface = annulus()
    cut, surface_cut = _begin(surface)
    for depth, count in ((0.4, 1), (0.6, 1), (2.0, 2)):
        now = surface_cut.advance(cut.advance(to=depth).front).surface
        check_surface(now, surface.volume)
        check_sides(now, cut.plane, cut.wall)
        assert now.mesh.component_count == count


def test_start_leaves_what_lies_behind():
    """Teeth of a comb behind the blade's start stay whole in the mesh as in the cage."""
    points = np.array([[x + dx, y] for x in (0, 2, 4, 6) for y in (1.1, 2.9) for dx in (0.1, 0.9)])
    corners = 4 * np.arange(4)[:, None]
    surface = Surface(points, np.concatenate([corners + [0, 1, 3], corners + [0, 3, 2]]))
    cut, surface_cut = _begin(surface, Blade([3.5, 2.0], [1.0, 0.01], start=0.0), comb())
    now = surface_cut.advance(cut.advance(to=9.0).front).surface
    check_surface(now, surface.volume)
    assert (surface.mesh.component_count, now.mesh.component_count) == (4, 6)
    assert now.points[surface.point_count :, 0].min() > 4.0
