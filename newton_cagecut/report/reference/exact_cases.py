# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cages whose harmonic coordinates are known exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...cage import Cage


@dataclass(frozen=True)
class ExactCase:
    """A cage, points in it and their weights.

    Attributes:
        name: What it is.
        cage: The cage.
        points: Points [m], shape (n, 3).
        weights: Their weights, shape (n, v).
        options: Options of the coordinates for which these are the weights.
    """

    name: str
    cage: Cage
    points: np.ndarray
    weights: np.ndarray
    options: dict[str, str]


def tetrahedron(count: int) -> ExactCase:
    """Return a tetrahedron, whose coordinates are barycentric.

    Args:
        count: Number of points.
    """
    vertices = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 0.9, 0.0], [0.3, 0.2, 0.8]])
    weights = np.random.default_rng(5).dirichlet(np.ones(4), count)
    cage = Cage(vertices, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    return ExactCase("tetrahedron", cage, weights @ vertices, weights, {})


def box(count: int) -> ExactCase:
    """Return a box, whose coordinates are trilinear where its quads are harmonic.

    Args:
        count: Number of points.
    """
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
    size = np.array([1.0, 0.7, 0.5])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    place = np.random.default_rng(6).random((count, 3))
    weights = np.where(corners == 1.0, place[:, None], 1.0 - place[:, None]).prod(axis=2)
    return ExactCase("box", Cage(size * corners, faces), size * place, weights, {"quads": "harmonic"})


CASES = {"tetrahedron": tetrahedron, "box": box}
"""What makes each case, by its name, from a number of points."""
