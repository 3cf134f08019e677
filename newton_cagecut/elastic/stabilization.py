# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Stabilisation of cage vertices that the quadrature hardly sees.

A cut makes vertices whose shape functions live where few quadrature points are, at a fresh tip above all. The reduced
system leaves such a vertex with almost no mass and no stiffness, and noise throws it about. Here it is tied to its
neighbours: with c_i = e_i - b_i, where the affine combination b_i of the neighbours gives vertex i at rest, the
energy mu k_i / 2 |c_i . x|^2 and the inertia rho m_i |c_i . v|^2 / 2 vanish for every affine motion. So neither resists
a rigid motion, and forces and torques sum to zero. They top up what the quadrature gives to a share of what a shape
function of the vertex's size should have, and are zero for well sampled vertices.

A further thousandth of the mass, lumped onto the vertices, keeps the mass matrix positive definite where a piece has
more vertices than points. What it would do in those affine motions that the points see is taken out, so that every
piece has the mass, the centre of mass and the inertia that its points say.
"""

from __future__ import annotations

import numpy as np

_STIFFNESS_SHARE = 0.1
"""Least integral of |grad w_i|^2, in sizes of the vertex's neighbourhood, of a plane body in thicknesses."""

_MASS_SHARE = 0.01
"""Least integral of w_i^2, in cubes of that size, of a plane body in its squares times thicknesses."""

_LUMPED = 1.0e-3
"""Share of the mass that is lumped; also the least lumped mass of a vertex, in mean masses of its piece's."""

_FLAT = 1.0e-6
"""Extent of a piece along an axis, in its size, below which it has none."""

_SEEN = 0.01
"""Share of its lumped mass that the points have to see of an affine motion."""

_MISFIT = 1.0e-6
"""Error of an affine combination, in sizes, above which there is none: the neighbours lie in a plane or on a line."""


def stabilize(
    vertices: np.ndarray,
    edges: np.ndarray,
    weights: np.ndarray,
    gradients: np.ndarray,
    volumes: np.ndarray,
    *,
    thickness: float = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Matrices that tie undersampled vertices to their neighbours.

    Args:
        vertices: Rest positions of the cage's vertices, shape (n, dimension) [m].
        edges: Pairs of vertices that share an edge, shape (m, 2).
        weights: Weights at the quadrature points, shape (q, n).
        gradients: Gradients of the weights, shape (q, n, 3) [1/m].
        volumes: Volumes of the quadrature points, shape (q,) [m^3].
        thickness: Thickness of a plane body [m]; 1 of a solid one, which has none.

    Returns:
        Stiffness over the shear modulus, shape (n, n) [m], and mass over the density, shape (n, n) [m^3].
    """
    count, dimension = vertices.shape
    length = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    ends = edges.reshape(-1)
    size = np.bincount(ends, np.repeat(length, 2), count) / np.maximum(np.bincount(ends, minlength=count), 1)
    seen_stiffness = np.einsum("q,qjk,qjk->j", volumes, gradients, gradients)
    seen_mass = np.einsum("q,qj,qj->j", volumes, weights, weights)
    missing_stiffness = np.maximum(_STIFFNESS_SHARE * thickness * size ** (dimension - 2) - seen_stiffness, 0.0)
    missing_mass = np.maximum(_MASS_SHARE * thickness * size**dimension - seen_mass, 0.0)
    stiffness, mass = np.zeros((count, count)), np.zeros((count, count))
    adjacent = np.zeros((count, count), dtype=bool)
    adjacent[edges[:, 0], edges[:, 1]] = adjacent[edges[:, 1], edges[:, 0]] = True
    for i in np.flatnonzero((missing_stiffness > 0.0) | (missing_mass > 0.0)):
        deviation = _deviation(i, vertices, adjacent, size[i])
        outer = np.outer(deviation, deviation)
        stiffness += missing_stiffness[i] * outer
        mass += missing_mass[i] * outer
    return stiffness, mass


def lumped_mass(vertices: np.ndarray, piece: np.ndarray, weights: np.ndarray, volumes: np.ndarray) -> np.ndarray:
    """A share of the mass lumped onto the vertices, without what it does in affine motions of a piece that points see.

    Args:
        vertices: Rest positions of the cage's vertices, shape (n, dimension) [m].
        piece: The piece that each vertex belongs to, shape (n,).
        weights: Weights at the quadrature points, shape (q, n).
        volumes: Volumes of the quadrature points, shape (q,) [m^3].

    Returns:
        Mass over the density, positive semidefinite, zero for those affine motions, shape (n, n) [m^3].
    """
    volumes = volumes.astype(float)
    rows, result = volumes @ weights, np.zeros((len(vertices), len(vertices)))
    for number in np.unique(piece):
        own = np.flatnonzero(piece == number)
        root = np.sqrt(np.maximum(rows[own], _LUMPED * rows[own].mean()))
        if not (root > 0.0).all():
            continue
        offset = vertices[own] - vertices[own].mean(axis=0)
        affine = root[:, None] * np.c_[np.ones(len(own)), offset / np.abs(offset).max()]
        axes, extents, _ = np.linalg.svd(affine, full_matrices=False)
        axes = axes[:, extents > _FLAT * extents.max()]
        felt = np.sqrt(volumes)[:, None] * (weights[:, own] @ (axes / root[:, None]))
        seen, mixed = np.linalg.eigh(felt.T @ felt)
        axes = axes @ mixed[:, seen > _SEEN]
        result[np.ix_(own, own)] = _LUMPED * root[:, None] * (np.eye(len(own)) - axes @ axes.T) * root
    return result


def _deviation(i: int, vertices: np.ndarray, adjacent: np.ndarray, size: float) -> np.ndarray:
    """c_i: vertex i minus the affine combination of the nearest vertices along edges that gives it; 0 if none does.

    It takes those up to two edges away, and farther ones where they lie in a plane, or on a line, apart from it.
    """
    offset = vertices - vertices[i]
    distance = np.linalg.norm(offset, axis=1)
    # The vertex itself and its twin on the other side of the cut, if any, are at distance zero.
    apart = distance > 1.0e-9 * size
    target = np.eye(1, 1 + vertices.shape[1])[0]
    row, near, grown = np.zeros(len(vertices)), adjacent[i], _grow(adjacent[i], adjacent)
    while (grown != near).any():
        near, grown = grown, _grow(grown, adjacent)
        neighbors = np.flatnonzero(near & apart)
        reach = size / distance[neighbors]
        conditions = np.vstack([np.ones(len(neighbors)), offset[neighbors].T / size])
        combination = np.linalg.lstsq(conditions * reach, target, rcond=1.0e-9)[0] * reach
        if np.abs(conditions @ combination - target).max() < _MISFIT:
            row[neighbors] = -combination
            row[i] = 1.0
            break
    return row


def _grow(near: np.ndarray, adjacent: np.ndarray) -> np.ndarray:
    """Vertices, as a mask, and those that share an edge with one of them."""
    return near | adjacent[near].any(axis=0)
