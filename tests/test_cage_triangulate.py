# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangulation of polygons with slits, bridges and collinear corners."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from newton_cagecut.geometry import triangulate


def _areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _area(points):
    x, y = (points - points[0]).T
    return 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def _check(points):
    """Each polygon edge once, each diagonal once each way, no inverted triangle, areas that add up."""
    points = np.asarray(points, dtype=float)
    triangles = triangulate(points)
    n = len(points)
    assert triangles.shape == (n - 2, 3)
    edges = [tuple(e) for t in triangles.tolist() for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))]
    assert len(set(edges)) == len(edges)
    border = {e for e in edges if e[::-1] not in set(edges)}
    assert border == {(i, (i + 1) % n) for i in range(n)}
    areas = _areas(points, triangles)
    extent = float(np.prod(np.ptp(points, axis=0)))
    assert areas.min() >= -1e-14 * extent
    np.testing.assert_allclose(areas.sum(), _area(points), rtol=1e-12, atol=1e-14 * extent)
    return triangles, areas


SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
CASES = {
    "triangle": [[0, 0], [1, 0], [0, 1]],
    "square": SQUARE,
    "collinear corner": [[0, 0], [1, 0], [2, 0], [4, 0], [0, 3]],
    "collinear on every side": [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]],
    "slit": [[0, 0], [2, 0], [2, 2], [2, 0], [4, 0], [4, 4], [0, 4]],
    "slit with collinear corners": [[0, 0], [2, 0], [2, 1], [2, 2], [2, 1], [2, 0], [4, 0], [4, 4], [0, 4]],
    "slit with corners on one side only": [[0, 0], [2, 0], [2, 1], [2, 2], [2, 0], [4, 0], [4, 4], [0, 4]],
    "two slits from one side": [[0, 0], [1, 0], [1, 3], [1, 0], [3, 0], [3, 3], [3, 0], [4, 0], [4, 4], [0, 4]],
    "slits on one line": [[0, 0], [2, 0], [2, 1], [2, 0], [4, 0], [4, 4], [2, 4], [2, 3], [2, 4], [0, 4]],
    "branched slit": [[0, 0], [2, 0], [2, 2], [1, 3], [2, 2], [3, 3], [2, 2], [2, 0], [4, 0], [4, 4], [0, 4]],
    "bridge to a hole": [[0, 0], [4, 0], [4, 4], [0, 4], [1, 3], [3, 3], [3, 1], [1, 1], [1, 3], [0, 4]],
    "bridge along a diagonal": [[0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1], [0, 0], [4, 0], [4, 4], [0, 4]],
    "u shape": [[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]],
    "slit in a corner": [[0, 0], [4, 0], [2, 2], [4, 0], [4, 4], [0, 4]],
}


@pytest.mark.parametrize("name", CASES)
def test_cases(name):
    """Each kind of polygon that cutting makes is covered exactly, without inverted triangles."""
    points = np.array(CASES[name], dtype=float)
    for k in range(len(points)):
        _check(np.roll(points, k, axis=0))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("scale", [(1.0, 1e-6), (1e-7, 1e3), (1e-9, 1e-9)])
def test_thin_and_tiny(name, scale):
    """Thin, long and tiny polygons are covered as well, rotated off the axes."""
    points = np.array(CASES[name], dtype=float) * scale
    cosine, sine = np.cos(0.7), np.sin(0.7)
    triangles = triangulate(points @ np.array([[cosine, sine], [-sine, cosine]]))
    areas = _areas(points, triangles)
    np.testing.assert_allclose(areas.sum(), _area(points), rtol=1e-9)
    assert areas.min() >= -1e-8 * abs(areas).max()


def test_slits_are_not_crossed():
    """No triangle reaches across a slit."""
    points = np.array(CASES["two slits from one side"], dtype=float)
    corners = points[_check(points)[0]]
    for x in (1.0, 3.0):
        low = corners[corners[:, :, 1].mean(axis=1) < 0.9][:, :, 0]
        assert not ((low.min(axis=1) < x) & (low.max(axis=1) > x)).any()


def test_no_flat_triangles_where_they_can_be_avoided():
    """Collinear corners do not make flat triangles."""
    assert _check(CASES["collinear on every side"])[1].min() > 0.1


def test_corners_left_over_on_a_line():
    """Four corners on a line may be what is left at the end, all of their triangles a rounding error below zero."""
    x = [0.44442984638835364, 0.810804016506635, 1.0282748850499108, 1.5664964925862546, 1.871626794539366]
    x += [1.6295554619874317, 0.9577237188835426, 0.5724909702248657, 0.05310987313629045, 0.13897227340274587]
    y = [0.7749858157308392, 1.0418522084627488, 0.7749858157308392, 0.7749858157308396, 1.3411750113927043]
    y += [1.6382295260257111, 2.4626586323510398, 2.9353917146502058, 1.9716461812821502, 1.8662813147880777]
    x += [-0.0958538030879934, -0.4662712239522847, -0.5917935292487614]
    y += [1.6952343549758195, 1.0079006479140948, 0.7749858157308392]
    _check(np.stack([x, y], axis=1))


@settings(max_examples=60, deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(4, 40),
    st.sampled_from([1.0, 1e-3]),
)
def test_random_stars_with_slits(seed, count, squeeze):
    """Random star-shaped polygons with slits towards their kernel are covered exactly."""
    rng = np.random.default_rng(seed)
    angle = (np.arange(count) + rng.uniform(0.0, 0.9, count)) * 2.0 * np.pi / count
    rim = np.c_[np.cos(angle), np.sin(angle)] * rng.uniform(0.2, 1.0, count)[:, None]
    points = []
    for p in rim:
        points.append(p)
        if rng.random() < 0.4:
            tip = p * rng.uniform(0.05, 0.9)
            middle = 0.5 * (p + tip)
            points += [[middle, tip, middle, p], [tip, p], [middle, tip, p]][rng.integers(3)]
    points = np.array(points) * [1.0, squeeze]
    triangles = triangulate(points)
    areas = _areas(points, triangles)
    np.testing.assert_allclose(areas.sum(), _area(points), rtol=1e-11)
    assert areas.min() >= -1e-13 * squeeze


def test_too_few_corners():
    """Two corners are no polygon."""
    with pytest.raises(ValueError, match="at least 3 corners, got 2"):
        triangulate(np.zeros((2, 2)))
