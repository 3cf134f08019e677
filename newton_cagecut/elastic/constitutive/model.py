# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a constitutive model is made of, and what several of them use."""

from __future__ import annotations

from dataclasses import dataclass

import warp as wp

from ...geometry import as_instance

wp.set_module_options({"enable_backward": False})

NEARLY_EQUAL = wp.constant(wp.float64(1.0e-5))
"""Stretches nearer than this, relative to their size, count as equal in a quotient of their differences."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ConstitutiveModel:
    """An isotropic hyperelastic model as Warp functions, all float64.

    ``mu`` and ``lam`` are Lame's constants of small strains [Pa] and ``s`` the stretches of F, of which an odd number
    is negative where F is inverted. Component k of a pair's value belongs to the pair of the two axes other than k.

    Args:
        name: Its name, unlike those of other models.
        energy: (F: mat33d, mu, lam) -> energy density [J/m^3].
        stress: (F: mat33d, mu, lam) -> first Piola-Kirchhoff stress [Pa], mat33d.
        stretch_block: (s: vec3d, mu, lam) -> second derivatives of the energy by the stretches [Pa], mat33d.
        symmetric_modes: (s: vec3d, mu, lam) -> stiffness of the three symmetric shears [Pa], vec3d; made from stress
            and block if not given.
        antisymmetric_modes: (s: vec3d, mu, lam) -> stiffness of the three antisymmetric shears [Pa], vec3d; made from
            stress and block if not given.

    Raises:
        TypeError: If the name is not text or a function none of Warp's.
        ValueError: If the name is empty.
    """

    name: str
    energy: wp.Function
    stress: wp.Function
    stretch_block: wp.Function
    symmetric_modes: wp.Function | None = None
    antisymmetric_modes: wp.Function | None = None

    def __post_init__(self) -> None:
        if not as_instance(self.name, str, "ConstitutiveModel name"):
            raise ValueError("ConstitutiveModel name is empty; give it one that no other model has")
        for name in ("energy", "stress", "stretch_block", "symmetric_modes", "antisymmetric_modes"):
            if getattr(self, name) is not None or name in ("energy", "stress", "stretch_block"):
                as_instance(getattr(self, name), wp.Function, f"ConstitutiveModel {name}", hint="@wp.func makes one")
        for name, sign in (("symmetric_modes", -1.0), ("antisymmetric_modes", 1.0)):
            if getattr(self, name) is None:
                object.__setattr__(self, name, _make_modes(self.stress, self.stretch_block, sign))


@wp.func
def cofactor(F: wp.mat33d) -> wp.mat33d:
    """Cofactor matrix, the derivative of the determinant."""
    a, b, c = wp.transpose(F)[0], wp.transpose(F)[1], wp.transpose(F)[2]
    return wp.matrix_from_cols(wp.cross(b, c), wp.cross(c, a), wp.cross(a, b))


@wp.func
def other_products(s: wp.vec3d) -> wp.vec3d:
    """Products of the two stretches other than each."""
    return wp.vec3d(s[1] * s[2], s[2] * s[0], s[0] * s[1])


def _make_modes(stress: wp.Function, stretch_block: wp.Function, sign: float) -> wp.Function:
    """The function (s, mu, lam) -> (Psi_i + sign Psi_j) / (s_i + sign s_j) of the three pairs (i, j)."""

    @wp.func
    def modes(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.vec3d:
        P = stress(wp.diag(s), mu, lam)
        block = stretch_block(s, mu, lam)
        factor, half = wp.float64(wp.static(sign)), wp.float64(0.5)
        result = wp.vec3d()
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            difference = s[i] + factor * s[j]
            if wp.abs(difference) > NEARLY_EQUAL * (wp.float64(1.0) + wp.abs(s[i])):
                result[k] = (P[i, i] + factor * P[j, j]) / difference
            else:
                result[k] = half * (block[i, i] + block[j, j]) + factor * block[i, j]
        return result

    return modes
