# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The softer material that acts at the points, beyond the mean strain of a cluster.

A quadratic displacement that the vertices see has, in the body, the energy that is least over the displacements that
they do not see (``fields.py``). The softer material is the isotropic one that makes of it the nearest: where unit
forces on the vertices move it, the difference is least squares. So a fibre resists about as in a bar or in a plate,
whichever the cluster is of, and torsion as if sections warped.
"""

from __future__ import annotations

import numpy as np

from .fields import ClusterFields

_GREATEST = 16.0
"""Greatest first constant at the points, in shear moduli: more locks what the clusters do not."""

_LEAST = 0.5
"""Least shear modulus, in that of the material, and bulk modulus, in that of the material at Poisson's ratio 0."""

_PASSES = 30


def softened_moduli(mu: float, lam: float, fields: ClusterFields | None) -> tuple[float, float]:
    """Lame's constants of the softer material [Pa]; neither its shear nor its bulk modulus is greater.

    Args:
        mu: Shear modulus [Pa].
        lam: Lame's first constant [Pa].
        fields: Displacements of the cluster; none if they are not known.
    """
    # In shear moduli; the unknowns are the logarithms of shear and bulk modulus.
    greatest = np.log([1.0, min(lam / mu, _GREATEST) + 2.0 / 3.0])
    least = np.log([_LEAST, _LEAST * min(np.exp(greatest[1]), 2.0 / 3.0)])
    if fields is None:
        return mu, min(lam, _GREATEST * mu)
    ones = np.stack([fields.seen[0] - 2.0 / 3.0 * fields.seen[1], fields.seen[1]])
    aim = _compliance(_relaxed(fields, lam / mu), fields.sizes)
    found = greatest
    for _ in range(_PASSES):
        parts = np.exp(found)[:, None, None] * ones
        inverse = np.linalg.inv(parts.sum(axis=0))
        error = (fields.sizes[:, None] * inverse * fields.sizes - aim).ravel()
        slopes = np.stack(
            [-(fields.sizes[:, None] * (inverse @ part @ inverse) * fields.sizes).ravel() for part in parts]
        )
        push = slopes @ error
        free = ~(((found >= greatest) & (push < 0.0)) | ((found <= least) & (push > 0.0)))
        change = np.zeros(2)
        if free.any():
            change[free] = -np.linalg.lstsq(slopes[free].T, error, rcond=1e-9)[0]
        before, found = found, np.clip(found + np.clip(change, -0.5, 0.5), least, greatest)
        if np.abs(found - before).max() < 1e-9:
            break
    shear, bulk = np.exp(found)
    return float(mu * shear), float(mu * (bulk - 2.0 / 3.0 * shear))


def _relaxed(fields: ClusterFields, lam: float) -> np.ndarray:
    """Energies of what the vertices see, least over what they do not see."""
    seen, hidden, across = (part[0] + lam * part[1] for part in (fields.seen, fields.hidden, fields.across))
    return seen - across @ np.linalg.solve(hidden, across.T) if len(hidden) else seen


def _compliance(energies: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    return sizes[:, None] * np.linalg.inv(energies) * sizes
