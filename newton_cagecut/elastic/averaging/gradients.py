# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Gradients of weights, corrected until they reproduce quadratic fields.

The values of a field at the cage's vertices have a quadratic part near each point: a least-squares fit, weighted by the
weights there. Its gradient at the point is known exactly, and takes the place of what the weights make of it; the rest
of the field keeps the gradient of the weights. (Meshfree integration is made consistent to second order in the same
way: Duan et al. 2012, "Second-order accurate derivatives and integration schemes for meshfree methods".) Quadratic
fields that the vertices hardly see are left alone. Affine fields stay as they are, exactly.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .quadratics import quadratics

_SEEN = 0.03
"""Least share of a quadratic field's square, in that of the best seen, that counts as seen by the vertices."""

_AFFINE = 1e-9


class CorrectedGradients(NamedTuple):
    """Gradients, and what the vertices see of the quadratic fields around each point."""

    gradients: np.ndarray
    """Shape (q, n, dimension) [1/m]."""
    seen: np.ndarray
    """Projectors on the quadratic fields that are seen, shape (q, k, k)."""
    squares: np.ndarray
    """Their mean squares at the vertices, by weight and beyond affine fields, shape (q, k, k)."""


def corrected_gradients(
    vertices: np.ndarray, points: np.ndarray, weights: np.ndarray, gradients: np.ndarray
) -> CorrectedGradients:
    """Corrected gradients; no correction is greater than the gradients themselves.

    Args:
        vertices: Rest positions of the cage's vertices, shape (n, dimension) [m].
        points: Quadrature points, shape (q, dimension) [m].
        weights: Weights there, shape (q, n).
        gradients: Gradients of the weights, shape (q, n, dimension) [1/m].
    """
    offset = vertices[None] - points[:, None]
    weights = np.maximum(weights, 0.0)
    mean_square = np.einsum("qj,qjk,qjk->q", weights, offset, offset)
    offset = offset / np.sqrt(np.maximum(mean_square, np.finfo(float).tiny))[:, None, None]
    affine = np.concatenate([np.ones((*weights.shape, 1)), offset], axis=2)
    quadratic = quadratics(offset)
    weighted = affine.transpose(0, 2, 1) * weights[:, None]
    across = weighted @ quadratic
    affine_part = np.linalg.pinv(weighted @ affine, rcond=_AFFINE, hermitian=True) @ across
    own = (quadratic.transpose(0, 2, 1) * weights[:, None]) @ quadratic - across.transpose(0, 2, 1) @ affine_part
    values, fields = np.linalg.eigh(own)
    kept = (values > _SEEN * values[:, -1:]) & (values > 0.0)
    transposed = fields.transpose(0, 2, 1)
    seen = (fields * kept[:, None]) @ transposed
    squares = (fields * np.where(kept, values, 0.0)[:, None]) @ transposed
    inverse = (fields * np.where(kept, 1.0 / np.where(kept, values, 1.0), 0.0)[:, None]) @ transposed
    factor = inverse @ (quadratic.transpose(0, 2, 1) @ gradients)
    change = weights[:, :, None] * (quadratic @ factor - affine @ (affine_part @ factor))
    misfit = np.abs(affine.transpose(0, 2, 1) @ change).max(axis=(1, 2))
    length, limit = np.linalg.norm(change, axis=(1, 2)), np.linalg.norm(gradients, axis=(1, 2))
    share = np.where(misfit < 1e-6 * np.maximum(limit, np.finfo(float).tiny), 1.0, 0.0)
    share *= np.minimum(1.0, limit / np.maximum(length, np.finfo(float).tiny))
    return CorrectedGradients(gradients - share[:, None, None] * change, seen, squares)
