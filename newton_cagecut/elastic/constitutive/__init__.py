# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Constitutive models: energy density, first Piola-Kirchhoff stress and stiffness; those shipped and a user's own.

With F = U diag(s) V^T, rotations U and V, the second derivative of an isotropic energy splits (Smith et al. 2018,
"Stable Neo-Hookean Flesh Simulation", section 4) into a 3x3 block on the stretches and, for each pair (i, j), two
eigenvalues: of the symmetric mode (Psi_i - Psi_j) / (s_i - s_j) and of the antisymmetric mode
(Psi_i + Psi_j) / (s_i + s_j). So negative ones can be taken off cheaply.

All of it is float64: Warp's float32 SVD was measured to miss F by up to 0.02 on random matrices of size 1, and float32
stress of a stiff material is all rounding. It runs once a step and quadrature point, so it costs little.
"""

from .model import ConstitutiveModel
from .registry import CONSTITUTIVE_MODELS, register

__all__ = ["CONSTITUTIVE_MODELS", "ConstitutiveModel", "register"]
