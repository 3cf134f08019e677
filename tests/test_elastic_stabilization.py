# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the ties between vertices that the quadrature hardly sees and their neighbours."""

import numpy as np
import pytest
import warp as wp

from elastic_bodies import THICKNESS, Body, as_array, as_vectors, both_dimensions
from newton_cagecut.cage import Cut
from newton_cagecut.elastic import Material, ReducedSystem
from newton_cagecut.elastic.stabilization import stabilize
from newton_cagecut.section import Blade
from plane_shapes import square


def tip_over_a_side(dimension):
    """A vertex whose first and second neighbours lie on one line or plane; vertices, edges and the vertex's index."""
    axes = np.eye(dimension)[:-1]
    near = np.concatenate([axes, -axes])
    corners = 2.0 * near + 3.0 * np.eye(dimension)[-1]
    tip, count = 0.4 * np.eye(dimension)[-1:] + 0.1, len(near)
    first = np.arange(1, count + 1)
    edges = [np.c_[0 * first, first], np.c_[first, first + count], np.c_[first + count, first + 2 * count]]
    return np.concatenate([tip, near, 2.0 * near, corners]), np.concatenate(edges), 0


def sampled(count, dimension, unseen=()):
    """Weights, gradients and volumes that see every vertex well but some."""
    weights = np.eye(count)
    weights[:, list(unseen)] = 0.0
    return weights, weights[:, :, None] * np.ones(dimension), np.full(count, 100.0)


@both_dimensions
def test_ties_vanish_for_affine_motions(dimension):
    """Ties have neither energy nor inertia in an affine motion, and give a lone deviation both."""
    vertices, edges, tip = tip_over_a_side(dimension)
    matrices = stabilize(vertices, edges, *sampled(len(vertices), dimension, [tip]))
    rng = np.random.default_rng(0)
    moved = vertices @ rng.normal(size=(dimension, dimension)) + rng.normal(size=dimension)
    for matrix in matrices:
        np.testing.assert_allclose(matrix @ moved, 0.0, atol=1e-12)
        assert matrix[tip, tip] > 0.0
        assert np.array_equal(matrix, matrix.T)
        assert np.linalg.eigvalsh(matrix).min() > -1e-12


@both_dimensions
def test_ties_reach_past_neighbors_on_a_line(dimension):
    """Where the first neighbours lie on one line or plane apart from the vertex, farther ones hold it."""
    vertices, edges, tip = tip_over_a_side(dimension)
    stiffness, _ = stabilize(vertices, edges, *sampled(len(vertices), dimension, [tip]))
    assert np.abs(stiffness[tip, -(len(vertices) // 3) :]).max() > 0.0
    flat = vertices.copy()
    flat[1:, -1] = 0.0
    stiffness, mass = stabilize(flat, edges, *sampled(len(flat), dimension, [tip]))
    assert not stiffness.any()
    assert not mass.any()


def test_fresh_tip_of_a_plane_cut_is_tied():
    """The tip of a cut that has just entered a straight side is held, though all near it lies on that side."""
    cut = Cut(square(), Blade((0.5, -0.5), (0.0, 1.0)))
    edit = cut.advance(to=0.1)
    cage = edit.cage
    stiffness, _ = stabilize(
        cage.vertices, cage.mesh.edges, *sampled(cage.vertex_count, cage.dimension, edit.created.tolist())
    )
    tip = int(np.argmin(np.linalg.norm(cage.vertices - [0.5, 0.1], axis=1)))
    assert stiffness[tip, tip] > 0.0
    np.testing.assert_allclose(stiffness @ cage.vertices, 0.0, atol=1e-12)


@both_dimensions
def test_well_sampled_vertices_are_left_alone(dimension):
    """Vertices that the quadrature sees have no ties."""
    vertices, edges, _ = tip_over_a_side(dimension)
    stiffness, mass = stabilize(vertices, edges, *sampled(len(vertices), dimension))
    assert not stiffness.any()
    assert not mass.any()


@pytest.mark.parametrize(("dimension", "thickness"), [(2, 0.5), (3, 1.0)], ids=["2d", "3d"])
def test_ties_scale_with_size(dimension, thickness):
    """Ties grow with the cage like the integrals that they stand in for, those of a plane body with its thickness."""
    vertices, edges, tip = tip_over_a_side(dimension)
    unseen = sampled(len(vertices), dimension, [tip])
    unit = stabilize(vertices, edges, *unseen)
    large = stabilize(2.0 * vertices, edges, *unseen, thickness=thickness)
    np.testing.assert_allclose(large[0], thickness * 2.0 ** (dimension - 2) * unit[0], rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(large[1], thickness * 2.0**dimension * unit[1], rtol=1e-9, atol=1e-15)


@both_dimensions
def test_unseen_vertex_follows_the_body(dimension):
    """A vertex that no quadrature point feels goes with its neighbours when the body falls and tumbles."""
    body = Body(dimension, cells=(1, 1, 2), points=3, spare=1)
    vertices = np.concatenate([body.vertices, [0.4 * body.vertices.mean(axis=0) + 0.6 * body.vertices[0]]])
    arrays = [np.pad(values, [(0, 0), (0, 1), (0, 0)][: values.ndim]) for values in (body.weights, body.gradients)]
    system = ReducedSystem(
        as_array(as_vectors(vertices), wp.vec3),
        as_array(arrays[0], float),
        as_array(arrays[1], wp.vec3),
        body.volumes,
        Material(young=1e6),
        as_array([body.count + 1], int),
        thickness=THICKNESS if dimension == 2 else None,
    )
    corners = np.arange(body.count)
    system.stabilize(vertices, np.c_[np.full(body.count, body.count), corners])
    system.refresh()
    spin = np.cross([0.0, 0.0, 3.0], as_vectors(vertices))
    x, v = wp.clone(system.rest), as_array(spin, wp.vec3)
    for _ in range(60):
        system.step(x, v, x, v, 1.0 / 60.0, gravity=as_array([body.gravity], wp.vec3))
    conditions = np.c_[np.ones(body.count), vertices[:-1]].T
    combination = np.linalg.lstsq(conditions, np.r_[1.0, vertices[-1]], rcond=None)[0]
    positions = x.numpy().astype(np.float64)
    np.testing.assert_allclose(positions[-1], combination @ positions[:-1], atol=5e-3)
