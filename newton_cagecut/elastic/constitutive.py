# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Constitutive models: energy density, first Piola-Kirchhoff stress and stiffness in principal stretches.

Saint Venant-Kirchhoff is the paper's model (section 6.1); the stable neo-Hookean one is that of Smith et al. 2018,
"Stable Neo-Hookean Flesh Simulation", without the logarithmic term, so that stress vanishes exactly at F = I; without
it, the state crushed to a point is an equilibrium too.

With F = U diag(s) V^T, rotations U and V, the second derivative of the energy splits (ibid., section 4) into a 3x3
block on the stretches and, for each pair (i, j), two eigenvalues: of the symmetric mode (Psi_i - Psi_j) / (s_i - s_j)
and of the antisymmetric mode (Psi_i + Psi_j) / (s_i + s_j), both written here without the quotient.

The neo-Hookean stiffness, not its stress, holds the factor (lam + mu) (J - 1) - mu of the second derivative of J at 0
at most. Under more tension the projected stiffness has no resistance to shear left, and the single Newton step of a
nearly incompressible body (Poisson's ratio 0.499, 1 MPa, random velocities of 1 m/s) then shears so far that its energy
grows by orders of magnitude. With the bound it stays that of the energy up to J = 1 + mu / (lam + mu).

All of it is float64: Warp's float32 SVD was measured to miss F by up to 0.02 on random matrices of size 1, and float32
stress of a stiff material is all rounding. It runs once a step and quadrature point, so it costs little.
"""

from __future__ import annotations

from typing import NamedTuple

import warp as wp

wp.set_module_options({"enable_backward": False})


class ConstitutiveModel(NamedTuple):
    """The Warp functions of one model, all float64; ``s`` are the signed stretches.

    Component k of a pair's value belongs to the pair of the two axes other than k.
    """

    energy: wp.Function
    """(F, mu, lam) -> energy density [J/m^3]."""

    stress: wp.Function
    """(F, mu, lam) -> first Piola-Kirchhoff stress [Pa]."""

    stretch_block: wp.Function
    """(s, mu, lam) -> second derivatives of the energy by the stretches [Pa]."""

    symmetric_modes: wp.Function
    """(s, mu, lam) -> eigenvalues of the three symmetric shears [Pa]."""

    antisymmetric_modes: wp.Function
    """(s, mu, lam) -> eigenvalues of the three antisymmetric shears [Pa]."""


@wp.func
def cofactor(F: wp.mat33d) -> wp.mat33d:
    """Cofactor matrix, the derivative of the determinant."""
    a, b, c = wp.transpose(F)[0], wp.transpose(F)[1], wp.transpose(F)[2]
    return wp.matrix_from_cols(wp.cross(b, c), wp.cross(c, a), wp.cross(a, b))


@wp.func
def other_products(s: wp.vec3d) -> wp.vec3d:
    """Products of the two stretches other than each."""
    return wp.vec3d(s[1] * s[2], s[2] * s[0], s[0] * s[1])


@wp.func
def neo_hookean_energy(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """Psi = mu/2 (tr(F^T F) - 3) - mu (J - 1) + (lam + mu)/2 (J - 1)^2."""
    half = wp.float64(0.5)
    change = wp.determinant(F) - wp.float64(1.0)
    return mu * half * (wp.ddot(F, F) - wp.float64(3.0)) - mu * change + half * (lam + mu) * change * change


@wp.func
def neo_hookean_stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """P = mu F + ((lam + mu) (J - 1) - mu) cof F."""
    return mu * F + ((lam + mu) * (wp.determinant(F) - wp.float64(1.0)) - mu) * cofactor(F)


@wp.func
def neo_hookean_factor(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """Factor of the second derivative of J in the stiffness, (lam + mu) (J - 1) - mu, but at most 0."""
    return wp.min((lam + mu) * (s[0] * s[1] * s[2] - wp.float64(1.0)) - mu, wp.float64(0.0))


@wp.func
def neo_hookean_stretch_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Second derivatives of the neo-Hookean energy by the stretches."""
    area = other_products(s)
    block = mu * wp.identity(3, dtype=wp.float64) + (lam + mu) * wp.outer(area, area)
    shear = neo_hookean_factor(s, mu, lam) * s
    return block + wp.mat33d(
        wp.float64(0.0), shear[2], shear[1], shear[2], wp.float64(0.0), shear[0], shear[1], shear[0], wp.float64(0.0)
    )


@wp.func
def neo_hookean_symmetric(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues mu - f s_k with the factor f of J's second derivative."""
    return wp.vec3d(mu, mu, mu) - neo_hookean_factor(s, mu, lam) * s


@wp.func
def neo_hookean_antisymmetric(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues mu + f s_k with the factor f of J's second derivative."""
    return wp.vec3d(mu, mu, mu) + neo_hookean_factor(s, mu, lam) * s


@wp.func
def green_strain(F: wp.mat33d) -> wp.mat33d:
    """E = (F^T F - I) / 2."""
    return wp.float64(0.5) * (wp.transpose(F) * F - wp.identity(3, dtype=wp.float64))


@wp.func
def stretch_strain(s: wp.vec3d) -> wp.float64:
    """Trace of the Green strain of the stretches."""
    return wp.float64(0.5) * (wp.dot(s, s) - wp.float64(3.0))


@wp.func
def stvk_energy(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """Psi = mu E:E + lam/2 (tr E)^2."""
    E = green_strain(F)
    return mu * wp.ddot(E, E) + wp.float64(0.5) * lam * wp.trace(E) * wp.trace(E)


@wp.func
def stvk_stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """P = F (2 mu E + lam tr(E) I)."""
    E = green_strain(F)
    return F * (wp.float64(2.0) * mu * E + lam * wp.trace(E) * wp.identity(3, dtype=wp.float64))


@wp.func
def stvk_stretch_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Second derivatives of the Saint Venant-Kirchhoff energy by the stretches."""
    three = wp.float64(3.0)
    squares = wp.cw_mul(s, s)
    pressure = lam * stretch_strain(s) - mu
    return lam * wp.outer(s, s) + wp.diag(three * mu * squares + wp.vec3d(pressure, pressure, pressure))


@wp.func
def stvk_symmetric(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues mu (s_i^2 + s_i s_j + s_j^2 - 1) + lam tr E."""
    pressure = lam * stretch_strain(s) - mu + mu * wp.dot(s, s)
    return wp.vec3d(pressure, pressure, pressure) + mu * (other_products(s) - wp.cw_mul(s, s))


@wp.func
def stvk_antisymmetric(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues mu (s_i^2 - s_i s_j + s_j^2 - 1) + lam tr E."""
    pressure = lam * stretch_strain(s) - mu + mu * wp.dot(s, s)
    return wp.vec3d(pressure, pressure, pressure) - mu * (other_products(s) + wp.cw_mul(s, s))


CONSTITUTIVE_MODELS = {
    "neo_hookean": ConstitutiveModel(
        neo_hookean_energy,
        neo_hookean_stress,
        neo_hookean_stretch_block,
        neo_hookean_symmetric,
        neo_hookean_antisymmetric,
    ),
    "stvk": ConstitutiveModel(stvk_energy, stvk_stress, stvk_stretch_block, stvk_symmetric, stvk_antisymmetric),
}
"""The models by name."""
