# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Gradients of weights, corrected until they reproduce quadratic fields.

The values of a field at the cage's vertices have a quadratic part near each point: a least-squares fit, weighted by the
weights there. Its gradient at the point is known exactly, and takes the place of what the weights make of it; the rest
of the field keeps the gradient of the weights. (Meshfree integration is made consistent to second order in the same
way: Duan et al. 2012, "Second-order accurate derivatives and integration schemes for meshfree methods".) Of the
quadratic fields that the vertices cannot tell apart, the least is taken. Affine fields stay as they are, exactly.
"""

from __future__ import annotations

import numpy as np

_RESOLVED = 1e-3
"""Least share of a quadratic field's square, in the greatest, that counts as seen by the vertices."""

_AFFINE = 1e-9


def corrected_gradients(
    vertices: np.ndarray, points: np.ndarray, weights: np.ndarray, gradients: np.ndarray
) -> np.ndarray:
    """Corrected gradients.

    Args:
        vertices: Rest positions of the cage's vertices, shape (n, dimension) [m].
        points: Quadrature points, shape (q, dimension) [m].
        weights: Weights there, shape (q, n).
        gradients: Gradients of the weights, shape (q, n, dimension) [1/m].

    Returns:
        Gradients, shape (q, n, dimension) [1/m]; no correction is greater than the gradients themselves.
    """
    offset = vertices[None] - points[:, None]
    weights = np.maximum(weights, 0.0)
    squares = np.einsum("qj,qjk,qjk->q", weights, offset, offset)
    size = np.sqrt(np.maximum(squares, np.finfo(float).tiny))
    offset = offset / size[:, None, None]
    pairs = np.triu_indices(vertices.shape[1])
    affine = np.concatenate([np.ones((*weights.shape, 1)), offset], axis=2)
    quadratic = offset[:, :, pairs[0]] * offset[:, :, pairs[1]]
    weighted = affine.transpose(0, 2, 1) * weights[:, None]
    among, across = weighted @ affine, weighted @ quadratic
    affine_part = np.linalg.pinv(among, rcond=_AFFINE, hermitian=True) @ across
    own = (quadratic.transpose(0, 2, 1) * weights[:, None]) @ quadratic - across.transpose(0, 2, 1) @ affine_part
    made = quadratic.transpose(0, 2, 1) @ gradients
    quadratic_factor = np.linalg.pinv(own, rcond=_RESOLVED, hermitian=True) @ made
    change = weights[:, :, None] * (quadratic @ quadratic_factor - affine @ (affine_part @ quadratic_factor))
    misfit = np.abs(affine.transpose(0, 2, 1) @ change).max(axis=(1, 2))
    length, limit = np.linalg.norm(change, axis=(1, 2)), np.linalg.norm(gradients, axis=(1, 2))
    share = np.where(misfit < 1e-6 * np.maximum(limit, np.finfo(float).tiny), 1.0, 0.0)
    share *= np.minimum(1.0, limit / np.maximum(length, np.finfo(float).tiny))
    return gradients - share[:, None, None] * change
