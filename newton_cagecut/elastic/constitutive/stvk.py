# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Saint Venant-Kirchhoff, the paper's model (section 6.1); under strong compression it inverts."""

from __future__ import annotations

import warp as wp

from .model import ConstitutiveModel, other_products

wp.set_module_options({"enable_backward": False})


@wp.func
def green_strain(F: wp.mat33d) -> wp.mat33d:
    """E = (F^T F - I) / 2."""
    return wp.float64(0.5) * (wp.transpose(F) * F - wp.identity(3, dtype=wp.float64))


@wp.func
def stretch_strain(s: wp.vec3d) -> wp.float64:
    """Trace of the Green strain of the stretches."""
    return wp.float64(0.5) * (wp.dot(s, s) - wp.float64(3.0))


@wp.func
def energy(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """Psi = mu E:E + lam/2 (tr E)^2."""
    E = green_strain(F)
    return mu * wp.ddot(E, E) + wp.float64(0.5) * lam * wp.trace(E) * wp.trace(E)


@wp.func
def stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """P = F (2 mu E + lam tr(E) I)."""
    E = green_strain(F)
    return F * (wp.float64(2.0) * mu * E + lam * wp.trace(E) * wp.identity(3, dtype=wp.float64))


@wp.func
def stretch_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Second derivatives of the energy by the stretches."""
    three = wp.float64(3.0)
    squares = wp.cw_mul(s, s)
    pressure = lam * stretch_strain(s) - mu
    return lam * wp.outer(s, s) + wp.diag(three * mu * squares + wp.vec3d(pressure, pressure, pressure))


@wp.func
def symmetric_modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues mu (s_i^2 + s_i s_j + s_j^2 - 1) + lam tr E."""
    pressure = lam * stretch_strain(s) - mu + mu * wp.dot(s, s)
    return wp.vec3d(pressure, pressure, pressure) + mu * (other_products(s) - wp.cw_mul(s, s))


@wp.func
def antisymmetric_modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues mu (s_i^2 - s_i s_j + s_j^2 - 1) + lam tr E."""
    pressure = lam * stretch_strain(s) - mu + mu * wp.dot(s, s)
    return wp.vec3d(pressure, pressure, pressure) - mu * (other_products(s) + wp.cw_mul(s, s))


STVK = ConstitutiveModel(
    name="stvk",
    energy=energy,
    stress=stress,
    stretch_block=stretch_block,
    symmetric_modes=symmetric_modes,
    antisymmetric_modes=antisymmetric_modes,
)
"""The paper's."""
