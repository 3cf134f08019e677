# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Distances of triangles, and of whole meshes from cages."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cage_shapes import box, star_prism, u_shape
from newton_cagecut.cage import mesh_clearance
from newton_cagecut.geometry import edge_distances, nearest_on_edges, nearest_on_triangles, simplex_distances
from surface_shapes import icosphere
from wrap_shapes import independent_gap

seeds = st.integers(0, 2**32 - 1)


@given(seeds)
@settings(deadline=None, max_examples=50)
def test_nearest_points_of_edges_are_nearest(seed):
    """No pair of points of two segments is closer than the pair that is found, and that has the distance."""
    random = np.random.default_rng(seed)
    one, other = random.normal(size=(2, 20, 2, 3))
    other[:5] = one[:5] + random.normal(size=(5, 1, 3))  # parallel
    s, t = nearest_on_edges(one, other)
    along = np.linspace(0.0, 1.0, 41)
    grid = [ends[:, 0, None] + along[:, None] * (ends[:, 1] - ends[:, 0])[:, None] for ends in (one, other)]
    sampled = np.linalg.norm(grid[0][:, :, None] - grid[1][:, None], axis=3).min(axis=(1, 2))
    places = [ends[:, 0] + u[:, None] * (ends[:, 1] - ends[:, 0]) for ends, u in ((one, s), (other, t))]
    found = np.linalg.norm(places[0] - places[1], axis=1)
    assert (found <= sampled + 1e-12).all()
    np.testing.assert_allclose(edge_distances(one, other), found, atol=1e-12)


@given(seeds)
@settings(deadline=None, max_examples=50)
def test_nearest_points_of_triangles_have_the_known_distance(seed):
    """They are in the triangle, at the distance that is computed without them; also where a triangle has no area."""
    random = np.random.default_rng(seed)
    points, corners = 2.0 * random.normal(size=(30, 3)), random.normal(size=(30, 3, 3))
    corners[:5, 2] = 0.5 * (corners[:5, 0] + corners[:5, 1])
    corners[5:8] = corners[5:8, :1]
    weights = nearest_on_triangles(points, corners)
    assert weights.min() >= 0.0
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-12)
    distance = np.linalg.norm(points - np.einsum("nk,nki->ni", weights, corners), axis=1)
    np.testing.assert_allclose(distance, np.diag(simplex_distances(points, corners)), atol=1e-9)


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_clearance_agrees_with_another_library(seed):
    """Blobs inside concave cages, and across their faces, are as far from them as manifold3d says."""
    random = np.random.default_rng(seed)
    cage = [star_prism, u_shape][seed % 2]()
    points, triangles = icosphere(1)
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    stretch = random.uniform(0.02, 0.25, 3) * (1.0 + 0.5 * random.random((len(points), 1)))
    points = points * stretch + random.uniform(low, high)
    inside = cage.contains(points)
    clearance = mesh_clearance(cage, points, triangles)
    if inside.all():
        assert clearance == pytest.approx(independent_gap(cage, points, triangles), abs=1e-9)
    elif inside.any():
        assert clearance == 0.0


def test_a_triangle_across_a_notch_is_not_clear():
    """Its corners are inside, 0.5 from the cage, but between the arms of a U it is outside."""
    triangle = np.array([[0.5, 2.5, 0.4], [2.5, 2.5, 0.4], [0.5, 0.5, 0.4]])
    assert u_shape().contains(triangle).all()
    assert mesh_clearance(u_shape(), triangle, np.array([[0, 1, 2]])) == 0.0


def test_an_edge_past_a_concave_edge_has_its_distance():
    """The nearest points are inside both edges, where no vertex is near."""
    middle = np.array([1.0, 1.0, 0.4]) - [0.1 / np.sqrt(2), 0.1 / np.sqrt(2), 0.0]
    slope = np.array([0.4, -0.4, 0.1])
    triangle = np.array([middle - slope, middle + slope, [0.2, 0.2, 0.4]])
    assert mesh_clearance(u_shape(), triangle, np.array([[0, 1, 2]])) == pytest.approx(0.1)


def test_clearance_of_triangles_without_area():
    """Lines and points count as what they are."""
    points = np.array([[0.5, 0.5, 0.3], [0.5, 0.5, 0.6], [0.5, 0.5, 0.9], [0.2, 0.5, 0.5]])
    triangles = np.array([[0, 1, 2], [3, 3, 3]])
    assert mesh_clearance(box(), points, triangles) == pytest.approx(0.1)
    assert mesh_clearance(box(), points, triangles[1:]) == pytest.approx(0.2)
