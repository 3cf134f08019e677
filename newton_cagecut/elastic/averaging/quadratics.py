# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Quadratic fields around a point, in a basis that turns orthogonally with the axes."""

from __future__ import annotations

import numpy as np


def quadratics(offset: np.ndarray) -> np.ndarray:
    """The products x_j x_k, those of two axes times the root of 2.

    Args:
        offset: Positions, shape (..., dimension).

    Returns:
        Shape (..., dimension (dimension + 1) / 2).
    """
    first, second, factor = _pairs(offset.shape[-1])
    return factor * offset[..., first] * offset[..., second]


def quadratic_gradients(offset: np.ndarray) -> np.ndarray:
    """Gradients of :func:`quadratics`, shape (..., dimension (dimension + 1) / 2, dimension)."""
    dimension = offset.shape[-1]
    first, second, factor = _pairs(dimension)
    axes = np.eye(dimension)
    ones = offset[..., second, None] * axes[first] + offset[..., first, None] * axes[second]
    return factor[:, None] * ones


def _pairs(dimension: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    first, second = np.triu_indices(dimension)
    return first, second, np.where(first == second, 1.0, np.sqrt(2.0))
