# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a cut surface carries with it."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from surface_shapes import icosphere

BLADE = Blade([0.55, 0.5, 0.5], [0.1, 1.0, 0.2], [0.2, 0.0, 1.0])


def _ball() -> Surface:
    points, triangles = icosphere(3)
    return Surface(0.4 * points + 0.5, triangles, uvs=points[:, :2], normals=points)


def test_normals_follow():
    """New points have the unit normals of the place where they are, on all strips of a bent cut."""
    cut = Cut(box(), BLADE)
    surface_cut = SurfaceCut(_ball(), cut.plane, cut.wall)
    surface_cut.advance(cut.advance(to=0.5).front)
    cut.turn([1.0, 0.0, 1.0])
    surface_cut.go_on(cut.plane, cut.wall)
    for depth in (0.7, 5.0):
        now = surface_cut.advance(cut.advance(to=depth).front).surface
        np.testing.assert_allclose(np.linalg.norm(now.normals, axis=1), 1.0, atol=1e-12)
        outward = (now.points - 0.5) / np.linalg.norm(now.points - 0.5, axis=1, keepdims=True)
        assert (now.normals * outward).sum(axis=1).min() > 0.999
        np.testing.assert_allclose(now.uvs * 0.4 + 0.5, now.points[:, :2], atol=1e-12)


def test_caps_have_their_own_corners():
    """A cap's corners have lengths in its plane as texture coordinates, and its side's normal."""
    cut = Cut(box(), BLADE)
    surface_cut = SurfaceCut(_ball(), cut.plane, cut.wall)
    now = surface_cut.advance(cut.advance(to=0.6).front).surface
    walls, cap = cut.cage.walls, now.triangle_cap == cut.wall
    uvs, normals = now.corner_uvs(walls, scale=3.0), now.corner_normals(walls)
    np.testing.assert_array_equal(uvs[~cap], now.uvs[now.triangles[~cap]])
    np.testing.assert_array_equal(normals[~cap], now.normals[now.triangles[~cap]])
    edge = np.diff(now.points[now.triangles[cap]], axis=1)
    lengths = np.linalg.norm(np.diff(uvs[cap], axis=1), axis=2)
    np.testing.assert_allclose(lengths, 3.0 * np.linalg.norm(edge, axis=2), atol=1e-12)
    facing = np.einsum("ij,ij->i", normals[cap][:, 0], now.mesh.face_area_vector[cap])
    assert facing.min() > -1e-15
    assert facing.max() > 1e-4
    bare = Surface(now.points, now.triangles)
    np.testing.assert_array_equal(bare.corner_uvs(walls), 0.0)
    np.testing.assert_allclose(np.linalg.norm(bare.corner_normals(walls)[~cap], axis=2), 1.0, atol=1e-12)


def test_normals_are_checked():
    """Normals must be as many as the points."""
    points, triangles = icosphere(0)
    with pytest.raises(ValueError, match="12 points but 11 normals"):
        Surface(points, triangles, normals=points[:11])
