# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Fitted weights whose walks are evaluated in closed form: slow, unbiased, and with errors that are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ..cage import Cage
from .coordinates import HarmonicCoordinates
from .resolve.closed_form import landing_residuals

_BATCH_WALKS = 1 << 16


@dataclass(frozen=True, eq=False)
class ClosedFormWeights:
    """Weights and gradients, and how well they are known.

    Attributes:
        weights: Weights, shape (n, vertex_count).
        gradients: Gradients [1/m] of the points that have them, shape (m, vertex_count, dimension).
        squared_errors: Squared standard errors of the weights, shape (n, vertex_count).
        squared_slope_errors: The same of the gradients, summed over vertices and axes, shape (m,).
        table_bias: What tables in place of the closed form change of the weights, shape (n, vertex_count).
    """

    weights: np.ndarray
    gradients: np.ndarray
    squared_errors: np.ndarray
    squared_slope_errors: np.ndarray
    table_bias: np.ndarray


def closed_form_weights(
    cage: Cage,
    points: np.ndarray,
    walks: int,
    seed: int,
    *,
    gradients: np.ndarray | None = None,
    device: wp.context.Devicelike = None,
    **options: object,
) -> ClosedFormWeights:
    """Find weights by a fit and the mean of what it leaves over where walks land, evaluated at every landing.

    Nothing is held back of what walks say of the gradients.

    Args:
        cage: The cage, cut or not.
        points: Points inside [m], shape (n, dimension).
        walks: Walks a point, two or more.
        seed: Seed of the walks.
        gradients: Which points have gradients, as a mask; by default none.
        device: Where to walk.
        options: Further options of ``HarmonicCoordinates``.
    """
    coordinates = HarmonicCoordinates(cage, points, walks, seed, device=device, correction="fitted", **options)
    state, rest = coordinates._state, np.asarray(points, dtype=np.float64)
    fit, piece = state.fit, state.pieces_of(rest)
    radius = coordinates._cache.points.first_radius.numpy()
    landings = {name: coordinates.landings[name] for name in ("point", "face")}
    mask = np.zeros(len(rest), dtype=bool) if gradients is None else np.asarray(gradients)
    batch = max(1, _BATCH_WALKS // walks)
    found = []
    for first in range(0, len(rest), batch):
        some = np.arange(first, min(first + batch, len(rest)))
        own = slice(first * walks, (some[-1] + 1) * walks)
        rows = {name: array[own] for name, array in landings.items()}
        sums = {"indices": some, "walks": walks, "seed": seed, "radius": radius[some]}
        found.append(landing_residuals(fit, state.frame, rows, **sums))
    values, slopes, errors, slope_errors = (
        np.concatenate([getattr(each, name) for each in found])
        for name in ("values", "slopes", "squared_errors", "squared_slope_errors")
    )
    weights = fit.exact(rest, piece, fit.weights(rest, piece) + values)
    return ClosedFormWeights(
        weights=weights,
        gradients=fit.exact_slopes(piece[mask], fit.slopes(rest[mask], piece[mask]) + slopes[mask]),
        squared_errors=errors,
        squared_slope_errors=slope_errors[mask],
        table_bias=coordinates.weights - weights,
    )
