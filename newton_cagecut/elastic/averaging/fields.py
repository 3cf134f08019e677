# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Energies of quadratic displacements of a cluster, those that the vertices see and those that they do not.

A cage's vertices lie on its surface. Those of a bar's section bend it, but cannot make it contract on one side and
swell on the other: fields like y^2 are the same at all of them. The body is free to do so, as finite elements are by
incompatible modes (Wilson et al. 1973, Taylor et al. 1976). Nor can they warp it as torsion does, by
y z (y^2 / b^2 - z^2 / c^2). A cluster is taken for a box with its moments. Energies are of what is beyond the mean.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss

from .quadratics import quadratic_gradients

_ORDER = 4
"""Gauss points an axis: exact for the squares of gradients of fourth degree."""

_FLATTEST = 1e-4
"""Least moment of a cluster along an axis, in the greatest."""


class ClusterFields(NamedTuple):
    """Energies of displacements, for the shear modulus 1 and for Lame's first constant 1, each a pair."""

    seen: np.ndarray
    """Of those that the vertices see, shape (2, s, s)."""
    hidden: np.ndarray
    """Of the others, shape (2, h, h)."""
    across: np.ndarray
    """Between both, shape (2, s, h)."""
    sizes: np.ndarray
    """Root mean squares at the vertices of those that they see, shape (s,)."""


def cluster_fields(moments: np.ndarray, seen: np.ndarray, squares: np.ndarray) -> ClusterFields | None:
    """Fields of a cluster; None if its points are one.

    Args:
        moments: Mean products of the points' coordinates around their mean, shape (dimension, dimension) [m^2].
        seen: Mean projector on the quadratics that its points' vertices see, shape (k, k).
        squares: Their mean squares at the vertices, shape (k, k).
    """
    dimension, trace = len(moments), np.trace(moments)
    share, fields = np.linalg.eigh(seen)
    kept = share > 0.5
    if not trace > 0.0 or not kept.any():
        return None
    sizes, turned = np.linalg.eigh(fields[:, kept].T @ squares @ fields[:, kept])
    fields = np.concatenate([fields[:, kept] @ turned, fields[:, ~kept]], axis=1)
    values, axes = np.linalg.eigh(moments / trace)
    half = np.sqrt(3.0 * np.maximum(values, _FLATTEST * values[-1]))
    nodes, shares = leggauss(_ORDER)
    grid = np.stack(np.meshgrid(*[nodes] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension)
    volume = np.prod(np.stack(np.meshgrid(*[shares / 2.0] * dimension, indexing="ij"), axis=-1), axis=-1).ravel()
    scalars = np.einsum("pqa,qf->pfa", quadratic_gradients((grid * half) @ axes.T), fields)
    count = kept.sum()
    visible, hidden = (_vectors(part) for part in (scalars[:, :count], scalars[:, count:]))
    if dimension == 3:
        hidden = np.concatenate([hidden, _warping(grid, half, axes)], axis=1)
    visible, hidden = (part - np.einsum("p,pfia->fia", volume, part) for part in (visible, hidden))
    return ClusterFields(
        _energies(volume, visible, visible),
        _energies(volume, hidden, hidden),
        _energies(volume, visible, hidden),
        np.sqrt(np.maximum(np.tile(sizes, dimension), 0.0)),
    )


def _vectors(scalars: np.ndarray) -> np.ndarray:
    """Gradients of vector fields that are a scalar one along one axis, shape (p, dimension f, dimension, dimension)."""
    points, count, dimension = scalars.shape
    return np.einsum("ij,pfa->pjfia", np.eye(dimension), scalars).reshape(points, -1, dimension, dimension)


def _warping(grid: np.ndarray, half: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Gradients of the warping by torsion about each axis of the box, shape (p, 3, 3, 3)."""
    result = []
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        y, z, gradient = grid[:, j], grid[:, k], np.zeros_like(grid)
        gradient[:, j] = (3.0 * y * y * z - z**3) / half[j]
        gradient[:, k] = (y**3 - 3.0 * y * z * z) / half[k]
        result.append(np.einsum("i,pa->pia", axes[:, axis], gradient @ axes.T))
    return np.stack(result, axis=1)


def _energies(volume: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Twice the energies of pairs of fields, for each constant, shape (2, f, g)."""
    weighted = volume[:, None, None, None] * (first + first.swapaxes(2, 3))
    shear = np.tensordot(weighted, second, axes=((0, 2, 3), (0, 2, 3)))
    dilatations = [np.trace(part, axis1=2, axis2=3) for part in (first, second)]
    return np.stack([shear, (volume[:, None] * dilatations[0]).T @ dilatations[1]])
