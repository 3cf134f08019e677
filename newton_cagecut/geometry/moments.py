# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Integrals of polynomials over the inside of a closed boundary, exact to rounding."""

from __future__ import annotations

import math

import numpy as np


def monomials(points: np.ndarray, degree: int) -> np.ndarray:
    """Monomials of a degree of 2 at most: 1, the coordinates, then their products in the order of ``np.triu_indices``.

    Args:
        points: Points, shape (n, dimension).
        degree: Greatest degree, 0 to 2.

    Returns:
        Their values, shape (n, monomial_count).
    """
    columns = [np.ones((len(points), 1))]
    if degree > 0:
        columns.append(points)
    if degree > 1:
        first, second = np.triu_indices(points.shape[1])
        columns.append(points[:, first] * points[:, second])
    return np.concatenate(columns, axis=1)


def cone_moments(corners: np.ndarray) -> np.ndarray:
    """Integrals of the monomials of a degree of 2 at most over the cones from the origin to simplices.

    Over the boundary of a body, counterclockwise seen from outside, they sum to the integrals over the body.

    Args:
        corners: Corners of triangles, or of segments with the inside to their left, shape (n, dimension, dimension).

    Returns:
        Integrals in the order of :func:`monomials`, shape (n, monomial_count); signed.
    """
    dimension = corners.shape[2]
    volume = np.linalg.det(corners) / math.factorial(dimension)
    total = corners.sum(axis=1)
    second = np.einsum("nki,nkj->nij", corners, corners) + total[:, :, None] * total[:, None, :]
    first, last = np.triu_indices(dimension)
    means = [np.ones((len(corners), 1)), total / (dimension + 1)]
    means.append(second[:, first, last] / ((dimension + 1) * (dimension + 2)))
    return volume[:, None] * np.concatenate(means, axis=1)
