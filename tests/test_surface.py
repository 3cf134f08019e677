# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces: what is accepted, refused, and known of them."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box, u_shape
from newton_cagecut.cage import boundary_distances, check_inside
from newton_cagecut.surface import Surface
from surface_shapes import SURFACES, check_closed, icosphere, sphere


@pytest.mark.parametrize("name", SURFACES)
def test_shapes_are_closed(name):
    """The shapes of the tests are closed manifolds of positive volume without caps."""
    surface = SURFACES[name]()
    assert surface.volume > 0.05
    check_closed(surface, surface.volume)
    assert (surface.triangle_cap == -1).all()
    assert (surface.point_key == -1).all()
    assert surface.triangles.dtype == np.int32


def test_open_surface_is_recorded():
    """A surface with a hole is accepted and known to be open."""
    points, triangles = icosphere(1)
    assert not Surface(points, triangles[1:]).closed
    assert Surface(points, triangles).closed


def test_solids():
    """Separate bodies are solids of their own; a cavity belongs to the body around it."""
    points, triangles = icosphere(1)
    n = len(points)
    both = np.concatenate([triangles, triangles[:, ::-1] + n, triangles + 2 * n])
    surface = Surface(np.concatenate([points, 0.5 * points, 0.2 * points]), both)
    m = len(triangles)
    solids = surface.triangle_solid
    assert (solids[:m] == solids[m : 2 * m]).all()
    assert solids[0] != solids[2 * m]
    assert len(np.unique(solids)) == 2


@pytest.mark.parametrize(
    ("points", "triangles", "options", "error", "match"),
    [
        (
            np.zeros((4, 4)),
            [[0, 1, 2]],
            {},
            ValueError,
            r"shape \(point_count, 3\), or \(point_count, 2\), got \(4, 4\)",
        ),
        (
            [[0, 0], [1, 0], [1, 1]],
            [[0, 1, 2], [0, 2, 1]],
            {},
            ValueError,
            "triangle 1 of the flat surface is clockwise",
        ),
        ([[0, 0], [1, 0], [1, 1]], [[0, 1, 2]], {"normals": np.zeros((3, 3))}, ValueError, "has no normals of its own"),
        ("abc", [[0, 1, 2]], {}, TypeError, "points of the surface must be numbers"),
        (np.full((4, 3), np.nan), [[0, 1, 2]], {}, ValueError, "points of the surface: row 0 is not finite"),
        (np.zeros((4, 3)), [[0.0, 1.0, 2.0]], {}, TypeError, "triangles of the surface must be integers"),
        (np.zeros((4, 3)), [[0, 1, 2, 3]], {}, ValueError, r"shape \(triangle_count, 3\)"),
        (np.zeros((4, 3)), [[0, 1, 2], [1, 2, 4]], {}, ValueError, r"triangle 1 .* \[1, 2, 4\], .* only 4 points"),
        (np.zeros((4, 3)), [[0, 1, 0], [1, 2, 1]], {}, ValueError, "no triangle .* has three different points"),
        (np.zeros((4, 3)), [[0, 1, 2]], {"uvs": np.zeros((3, 2))}, ValueError, "4 points but 3 uvs"),
        (np.zeros((4, 3)), [[0, 1, 2]], {"point_key": [0]}, ValueError, r"point_key .* shape \(4,\)"),
        (np.zeros((4, 3)), [[0, 1, 2]], {"triangle_cap": [0.5]}, TypeError, "triangle_cap .* integers"),
    ],
)
def test_bad_surfaces_are_refused(points, triangles, options, error, match):
    """Wrong shapes, types, values and indices are refused by name."""
    with pytest.raises(error, match=match):
        Surface(points, triangles, **options)


def test_embedding():
    """Points inside or on a cage pass; points outside are counted and the farthest is named with its distance."""
    cage = box()
    check_inside(cage, sphere().points)
    check_inside(cage, np.array([[0.0, 0.0, 0.0], [1.0, 0.5, 0.5], [0.5, 0.5, 0.5]]))
    points = np.array([[0.5, 0.5, 0.5], [1.25, 0.5, 0.5], [1.3, 1.4, 0.5]])
    with pytest.raises(ValueError, match=r"2 of 3 points lie outside the cage, the farthest \(point 2\) by 0\.5 m"):
        check_inside(cage, points)


def test_boundary_distances_of_a_concave_cage():
    """Distances to a concave cage are those to its nearest face, edge or vertex."""
    points = np.array([[1.5, 2.0, 0.4], [1.5, 1.2, 0.4], [4.0, 4.0, 1.8], [0.5, 2.0, -2.0]])
    expected = [0.5, 0.2, np.sqrt(3.0), 2.0]
    np.testing.assert_allclose(boundary_distances(u_shape(), points), expected, rtol=1e-12)
