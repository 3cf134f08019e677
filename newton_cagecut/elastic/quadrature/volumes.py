# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Volumes of quadrature points that integrate polynomials exactly: mass, centre of mass and inertia are right.

Of all volumes that integrate the polynomials of a degree exactly, those are taken that differ least from given shares,
relative to these, and stay positive. The degree is 2 where the points allow it, as they do unless they are few, then 1,
then 0.
"""

from __future__ import annotations

import numpy as np

from ...geometry import cone_moments, monomials

_LEAST = 0.1
"""Least volume, in shares."""

_ROUNDING = 1e-12
_TRIES = 20


def exact_volumes(points: np.ndarray, shares: np.ndarray, boundary: np.ndarray) -> np.ndarray:
    """Volumes of points that integrate polynomials over a body exactly.

    Args:
        points: Points, shape (n, dimension) [m].
        shares: How much of the body each stands for, in any unit, positive, shape (n,).
        boundary: Corners of the triangles, or segments, around the body, counterclockwise seen from outside, shape
            (m, dimension, dimension) [m].

    Returns:
        Volumes, shape (n,) [m^3, in 2D m^2]; proportional to the shares where the points allow no more.
    """
    origin = points.mean(axis=0)
    size = np.ptp(boundary.reshape(-1, points.shape[1]), axis=0).max()
    wanted = cone_moments((boundary - origin) / size).sum(axis=0)
    shares = shares * (wanted[0] / shares.sum())
    volumes = shares
    for degree in (2, 1):
        values = monomials((points - origin) / size, degree)
        found = _nearest(values, shares, wanted[: values.shape[1]])
        if found is not None:
            volumes = found
            break
    return volumes * size ** points.shape[1]


def _nearest(values: np.ndarray, shares: np.ndarray, wanted: np.ndarray) -> np.ndarray | None:
    """Volumes of given sums of values that are nearest to the shares; None if none of these are positive enough."""
    volumes, is_free = shares.copy(), np.ones(len(shares), dtype=bool)
    for _ in range(_TRIES):
        rows = values[is_free] * shares[is_free, None]
        for _ in range(2):  # the second time takes the first one's rounding off
            change = np.linalg.lstsq(rows.T @ values[is_free], wanted - volumes @ values, rcond=_ROUNDING)[0]
            volumes[is_free] += rows @ change
        if np.abs(wanted - volumes @ values).max() > 1e2 * _ROUNDING * np.abs(wanted).max():
            return None
        small = volumes < _LEAST * shares * (1.0 - _ROUNDING)
        if not small.any():
            return volumes
        is_free &= ~small
        volumes = np.where(is_free, shares, _LEAST * shares)
        if is_free.sum() < values.shape[1]:
            return None
    return None
