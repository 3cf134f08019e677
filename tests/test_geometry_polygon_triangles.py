# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Polygons of meshes in space, cut into triangles."""

import numpy as np

from newton_cagecut.geometry import polygon_triangles, triangulate
from newton_cagecut.geometry.triangulate import convex_quad_triangles

KITE = [[0, 0], [4, -1], [5, 0], [4, 1]]


def test_convex_quads_are_cut_as_others_are():
    """Cut all at once they get the triangles of ear clipping, corner by corner; the others are told."""
    rng = np.random.default_rng(3)
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    quads = square + rng.normal(size=(2000, 4, 2)) * np.geomspace(1e-9, 1.0, 2000)[:, None, None]
    slim = quads * rng.uniform(1e-4, 1.0, (2000, 1, 2)) + rng.normal(size=(2000, 1, 2))
    quads = np.concatenate([square[None], np.array([KITE], dtype=float), np.zeros((1, 4, 2)), quads, slim])
    triangles, convex = convex_quad_triangles(quads)
    assert convex[:2].all()
    assert not convex[2]
    assert 2500 < convex.sum() < 3990
    np.testing.assert_array_equal(triangles, [triangulate(quad) for quad in quads[convex]])


def test_polygons_keep_their_order():
    """Triangles, quads, convex or not, and a concave hexagon stand where their polygons do, facing as they do."""
    outline = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 3], [0, 3]]
    polygons = [[[0, 0], [1, 0], [0, 1]], KITE, outline, [[0, 0], [2, 1], [0, 2], [1, 1]], [[0, 0], [1, 0], [1, 1]]]
    counts = np.array([len(polygon) for polygon in polygons])
    flat = np.concatenate(polygons).astype(float)
    owner = np.repeat(np.arange(5), counts - 2)
    areas = [0.5, 5.0, 4.0, 1.0, 0.5]
    for turn in range(3):
        for sign in (1.0, -1.0):
            points = np.roll(np.column_stack([flat[:, 0], sign * flat[:, 1], np.zeros(len(flat))]), turn, axis=1)
            triangles = polygon_triangles(points, counts, np.arange(len(points)))
            assert triangles.dtype == np.int32
            np.testing.assert_array_equal(
                np.searchsorted(np.cumsum(counts), triangles, side="right"), owner[:, None] + np.zeros(3)
            )
            a, b, c = np.moveaxis(points[triangles], 1, 0)
            area = 0.5 * np.cross(b - a, c - a)[:, (2 + turn) % 3]
            np.testing.assert_allclose(np.bincount(owner, weights=sign * area), areas)


def test_no_polygons_give_no_triangles():
    """The result of nothing has its shape all the same."""
    assert polygon_triangles(np.zeros((3, 3)), np.zeros(0, int), np.zeros(0, int)).shape == (0, 3)
