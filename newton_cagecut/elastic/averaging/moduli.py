# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The softer material that acts at the points, beyond the mean strain of the clusters.

A cage's vertices lie on its surface: they bend a bar, but cannot make its sections contract on one side and swell on
the other, nor warp. So a fibre must resist as it does in a body that is free to: with Young's modulus in a beam, and
with the modulus of a plate, E / (1 - nu^2), where it cannot contract along one axis. The mean of both is taken. A shear
must resist as in a bar that warps: the torsional stiffness of a square bar is 0.844 of what it is without warping. The
mean of that and of both bendings, which need no warping, is taken. In the plane a fibre has the plate's modulus, and
nothing warps.
"""

from __future__ import annotations

_SHEAR_SHARE = (0.8436 + 2.0) / 3.0
"""Shear modulus at the points, in shear moduli of the material; of solid bodies."""


def softened_moduli(mu: float, lam: float, *, plane: bool = False) -> tuple[float, float]:
    """Lame's constants of the softer material [Pa]; neither its shear nor its bulk modulus is greater.

    Args:
        mu: Shear modulus [Pa].
        lam: Lame's first constant [Pa].
        plane: Whether the body is in plane strain.
    """
    poisson = 0.5 * lam / (lam + mu)
    plate = 2.0 * mu / (1.0 - poisson)
    if plane:
        return mu, lam if poisson <= 0.0 else min(plate - 2.0 * mu, lam)
    shear = _SHEAR_SHARE * mu
    greatest = lam + 2.0 / 3.0 * (mu - shear)
    if poisson <= 0.0:
        return shear, greatest
    beam = 2.0 * mu * (1.0 + poisson)
    return shear, min(0.5 * (beam + plate) - 2.0 * shear, greatest)
