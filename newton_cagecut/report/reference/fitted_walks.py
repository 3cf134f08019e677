# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A reference by a fit and walks that evaluate it at every landing, checked against plain Monte Carlo.

The mean of what the fit leaves over is unbiased whatever the fit is, and its noise is that of a small residual: so few
walks know the weights better than long runs of other corrections can. Seeds and shell are not those of what is
measured, and no table is read. Its own squared error follows from its walks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ...cage import Cage
from ...harmonic import HarmonicCoordinates, closed_form_weights
from .long_walks import Reference, bent

_SEED, _PLAIN_SEED = 1000, 2000
_PLAIN_RUNS = 4
_EPSILON = 1e-5


@dataclass(frozen=True)
class FittedReference:
    """A reference, and what was found on the way.

    Attributes:
        reference: The reference.
        table_bias: Root mean square over the points of what tables change of a point's weights.
    """

    reference: Reference
    table_bias: float


def fitted_walks(
    cage: Cage, points: np.ndarray, has_gradient: np.ndarray, *, walks: int, device: wp.context.Device
) -> FittedReference:
    """Find the weights and gradients of points.

    Args:
        cage: The cage, cut or not.
        points: Points inside [m], shape (n, dimension).
        has_gradient: Which of them have gradients, as a mask.
        walks: Walks a point; the plain ones of the check are as many in all.
        device: The device.
    """
    options = {"device": device, "epsilon": _EPSILON}
    found = closed_form_weights(cage, points, walks, _SEED, gradients=has_gradient, **options)
    plain = []
    for run in range(_PLAIN_RUNS):
        made = HarmonicCoordinates(
            cage,
            points,
            walks // _PLAIN_RUNS,
            _PLAIN_SEED + run,
            gradients=has_gradient,
            cuttable=False,
            correction="none",
            **options,
        )
        plain.append((made.weights.astype(np.float64), made.gradients.astype(np.float64)))
    owns = (_mean(found.squared_errors), float(found.squared_slope_errors.mean()))
    checks = []
    for value, own, each in zip((found.weights, found.gradients), owns, zip(*plain)):
        variance = _mean(np.var(each, axis=0, ddof=1)) / _PLAIN_RUNS
        checks.append(_mean((value - np.mean(each, axis=0)) ** 2) / (own + variance))
    size = np.linalg.norm(np.ptp(cage.vertices, axis=0))
    motion = (bent(cage.vertices) ** 2).sum(axis=1) / size**2
    reference = Reference(
        vertices=cage.vertices,
        weights=found.weights,
        gradients=found.gradients,
        own_weights=owns[0],
        own_gradients=owns[1] / _mean(found.gradients**2),
        own_surface=float((found.squared_errors @ motion).mean()),
        check=np.array(checks),
    )
    return FittedReference(reference, float(np.sqrt(_mean(found.table_bias**2))))


def _mean(squares: np.ndarray) -> float:
    """Mean over the first axis of the sum over all others."""
    return float(squares.reshape(len(squares), -1).sum(axis=1).mean())
