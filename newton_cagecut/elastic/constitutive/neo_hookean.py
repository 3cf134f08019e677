# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The stable neo-Hookean model of Smith et al. 2018, "Stable Neo-Hookean Flesh Simulation", with its logarithmic term.

Psi = m/2 (I - 3) - m/2 log((I + 1) / 4) - 3/4 m (J - 1) + l/2 (J - 1)^2, with I = tr(F^T F) and J = det F, is the
paper's (14) without a constant. Its m = 4/3 mu and l = lam + 5/6 mu are such that mu and lam are Lame's constants of
small strains, exactly. An F free of stress has equal squared stretches, and of these only rotations and F = 0 are, for
Poisson's ratios above -0.851. F = 0 is no minimum: changes to a small multiple of a rotation lower the energy. In plane
strain it is the same.

The stiffness, not the stress, holds the factor l (J - 1) - mu of the second derivative of J at 0 at most. Under more
tension the projected stiffness has no resistance to shear left, and the single Newton step of a nearly incompressible
body (Poisson's ratio 0.499, 1 MPa, random velocities of 1 m/s) then shears so far that its energy grows by orders of
magnitude. With the bound it stays that of the energy up to J = 1 + mu / l.
"""

from __future__ import annotations

import warp as wp

from .model import ConstitutiveModel, cofactor, other_products

wp.set_module_options({"enable_backward": False})

SHEAR_FACTOR = wp.constant(wp.float64(4.0 / 3.0))
VOLUME_FACTOR = wp.constant(wp.float64(5.0 / 6.0))


@wp.func
def energy(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """The energy density."""
    half, one = wp.float64(0.5), wp.float64(1.0)
    m, bulk = SHEAR_FACTOR * mu, lam + VOLUME_FACTOR * mu
    invariant, change = wp.ddot(F, F), wp.determinant(F) - one
    shape = invariant - wp.float64(3.0) - wp.log((invariant + one) * wp.float64(0.25))
    return half * m * shape - mu * change + half * bulk * change * change


@wp.func
def isochoric_factor(invariant: wp.float64, mu: wp.float64) -> wp.float64:
    """Factor of F in the stress, m I / (I + 1)."""
    return SHEAR_FACTOR * mu * (invariant / (invariant + wp.float64(1.0)))


@wp.func
def stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """P = m I / (I + 1) F + (l (J - 1) - mu) cof F."""
    invariant = wp.ddot(F, F)
    pressure = (lam + VOLUME_FACTOR * mu) * (wp.determinant(F) - wp.float64(1.0)) - mu
    return isochoric_factor(invariant, mu) * F + pressure * cofactor(F)


@wp.func
def held_factor(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """Factor of the second derivative of J in the stiffness, l (J - 1) - mu, but at most 0."""
    bulk = lam + VOLUME_FACTOR * mu
    return wp.min(bulk * (s[0] * s[1] * s[2] - wp.float64(1.0)) - mu, wp.float64(0.0))


@wp.func
def stretch_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Second derivatives of the energy by the stretches."""
    area, one = other_products(s), wp.dot(s, s) + wp.float64(1.0)
    block = isochoric_factor(wp.dot(s, s), mu) * wp.identity(3, dtype=wp.float64)
    block += (wp.float64(2.0) * SHEAR_FACTOR * mu / (one * one)) * wp.outer(s, s)
    block += (lam + VOLUME_FACTOR * mu) * wp.outer(area, area)
    shear = held_factor(s, mu, lam) * s
    zero = wp.float64(0.0)
    return block + wp.mat33d(zero, shear[2], shear[1], shear[2], zero, shear[0], shear[1], shear[0], zero)


@wp.func
def symmetric_modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues m I / (I + 1) - f s_k with the factor f of J's second derivative."""
    shear = isochoric_factor(wp.dot(s, s), mu)
    return wp.vec3d(shear, shear, shear) - held_factor(s, mu, lam) * s


@wp.func
def antisymmetric_modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues m I / (I + 1) + f s_k with the factor f of J's second derivative."""
    shear = isochoric_factor(wp.dot(s, s), mu)
    return wp.vec3d(shear, shear, shear) + held_factor(s, mu, lam) * s


NEO_HOOKEAN = ConstitutiveModel(
    name="neo_hookean",
    energy=energy,
    stress=stress,
    stretch_block=stretch_block,
    symmetric_modes=symmetric_modes,
    antisymmetric_modes=antisymmetric_modes,
)
"""Recovers from inversion and from being crushed."""
