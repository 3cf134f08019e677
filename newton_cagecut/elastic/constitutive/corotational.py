# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Corotational elasticity: linear elasticity in the frame of the rotation that is nearest to F.

Psi = mu |F - R|^2 + lam/2 (tr(R^T F) - 3)^2. The stress grows linearly with the stretches, also through inversion.

Of an F that is plane, third row and column being the identity's, R is the nearest rotation in the plane: the nearest of
all would turn an inverted F about an axis of the plane, and call its mirror image rest.
"""

from __future__ import annotations

import warp as wp

from .decomposition import decompose, decompose_plane
from .model import ConstitutiveModel

wp.set_module_options({"enable_backward": False})

LEAST_SUM = wp.constant(wp.float64(1.0e-6))
"""Least sum of two stretches in the stiffness, which grows without bound where R jumps."""


@wp.func
def decompose_any(F: wp.mat33d):
    """Rotations and signed stretches of F, in the plane if F is plane."""
    zero, one = wp.float64(0.0), wp.float64(1.0)
    leaving = wp.abs(F[0, 2]) + wp.abs(F[1, 2]) + wp.abs(F[2, 0]) + wp.abs(F[2, 1]) + wp.abs(F[2, 2] - one)
    left, stretches, right = decompose(F)
    if leaving == zero:
        left, stretches, right = decompose_plane(F)
    return left, stretches, right


@wp.func
def stretch_change(s: wp.vec3d) -> wp.float64:
    """Sum of the changes of the stretches."""
    return s[0] + s[1] + s[2] - wp.float64(3.0)


@wp.func
def energy(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """The energy density."""
    left, s, right = decompose_any(F)
    change = s - wp.vec3d(wp.float64(1.0), wp.float64(1.0), wp.float64(1.0))
    return mu * wp.dot(change, change) + wp.float64(0.5) * lam * stretch_change(s) * stretch_change(s)


@wp.func
def stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """P = 2 mu (F - R) + lam tr(R^T F - I) R."""
    left, s, right = decompose_any(F)
    R = left * wp.transpose(right)
    return wp.float64(2.0) * mu * (F - R) + lam * stretch_change(s) * R


@wp.func
def stretch_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Second derivatives of the energy by the stretches."""
    ones = wp.vec3d(wp.float64(1.0), wp.float64(1.0), wp.float64(1.0))
    return wp.float64(2.0) * mu * wp.identity(3, dtype=wp.float64) + lam * wp.outer(ones, ones)


@wp.func
def symmetric_modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues 2 mu."""
    double = wp.float64(2.0) * mu
    return wp.vec3d(double, double, double)


@wp.func
def antisymmetric_modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
    """Eigenvalues 2 mu + 2 (lam tr(R^T F - I) - 2 mu) / (s_i + s_j)."""
    double = wp.float64(2.0) * mu
    excess = wp.float64(2.0) * (lam * stretch_change(s) - double)
    result = wp.vec3d()
    for k in range(3):
        total = s[(k + 1) % 3] + s[(k + 2) % 3]
        if wp.abs(total) < LEAST_SUM:
            total = LEAST_SUM
        result[k] = double + excess / total
    return result


COROTATIONAL = ConstitutiveModel(
    name="corotational",
    energy=energy,
    stress=stress,
    stretch_block=stretch_block,
    symmetric_modes=symmetric_modes,
    antisymmetric_modes=antisymmetric_modes,
)
"""Linear in the stretches."""
