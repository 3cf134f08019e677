# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The stiffness of one quadrature point, projected to be positive semidefinite and kept in factors.

The projection of Teran et al. 2005 and Smith et al. 2018, section 4: in the frame of the singular vectors, negative
eigenvalues of the 3x3 stretch block and of the six shear modes are set to zero. A stiffness that is positive
semidefinite already is left as it is. 33 numbers stand for the 81 of the full matrix.

Of a plane body's stiffness only the plane's part counts, and only that is projected: the whole may be indefinite where
that part is not. (A neo-Hookean square squeezed to 0.6 of its sides: projecting the whole changes the part by 14 %.)
"""

from __future__ import annotations

import functools

import warp as wp

from .constitutive import CONSTITUTIVE_MODELS
from .constitutive.decomposition import decompose, decompose_plane

wp.set_module_options({"enable_backward": False})


@wp.struct
class Stiffness:
    """Second derivative of an energy by F, in the frame of F's singular vectors.

    With D = left^T dF right, the stress changes by left T right^T: T_ii = sum_k stretch_ik D_kk and
    T_ij = straight_k D_ij + crossed_k D_ji for the pair (i, j) other than k.
    """

    left: wp.mat33
    right: wp.mat33
    stretch: wp.mat33
    straight: wp.vec3
    crossed: wp.vec3


@wp.func
def project_block(block: wp.mat33d) -> wp.mat33d:
    """Nearest positive semidefinite matrix; the matrix itself where it is one."""
    zero = wp.float64(0.0)
    minor = block[0, 0] * block[1, 1] - block[0, 1] * block[1, 0]
    if block[0, 0] > zero and minor > zero and wp.determinant(block) > zero:
        return block
    vectors, values = wp.eig3(block)
    result = block
    for k in range(3):
        if values[k] < wp.float64(0.0):
            axis = wp.vec3d(vectors[0, k], vectors[1, k], vectors[2, k])
            result -= values[k] * wp.outer(axis, axis)
    return result


@wp.func
def clamp_modes(modes: wp.vec3d) -> wp.vec3d:
    """Modes with the negative ones set to zero."""
    zero = wp.float64(0.0)
    return wp.vec3d(wp.max(modes[0], zero), wp.max(modes[1], zero), wp.max(modes[2], zero))


@functools.cache
def make_stiffness_function(model: str, plane: bool, *, difference: bool = False) -> wp.Function:
    """The function (F, lame, less, scale) -> projected stiffness times scale, of one constitutive model.

    ``lame`` and ``less`` are pairs of Lame's constants.

    Args:
        model: The model.
        plane: Whether F and all its changes are plane: third row and column are the identity's.
        difference: Whether the stiffness with the constants ``less`` is taken off; if not, they are not used.
    """
    chosen = CONSTITUTIVE_MODELS[model]
    stretch_block = chosen.stretch_block
    symmetric_modes, antisymmetric_modes = chosen.symmetric_modes, chosen.antisymmetric_modes

    @wp.func
    def stiffness(F: wp.mat33d, lame: wp.vec2d, less: wp.vec2d, scale: wp.float64) -> Stiffness:
        if wp.static(plane):
            left, stretches, right = decompose_plane(F)
        else:
            left, stretches, right = decompose(F)
        symmetric = symmetric_modes(stretches, lame[0], lame[1])
        antisymmetric = antisymmetric_modes(stretches, lame[0], lame[1])
        block = stretch_block(stretches, lame[0], lame[1])
        if wp.static(difference):
            symmetric -= symmetric_modes(stretches, less[0], less[1])
            antisymmetric -= antisymmetric_modes(stretches, less[0], less[1])
            block -= stretch_block(stretches, less[0], less[1])
        symmetric, antisymmetric = clamp_modes(symmetric), clamp_modes(antisymmetric)
        if wp.static(plane):
            third = wp.vec3d(wp.float64(0.0), wp.float64(0.0), wp.float64(1.0))
            symmetric, antisymmetric = symmetric[2] * third, antisymmetric[2] * third
            upper = wp.identity(3, dtype=wp.float64) - wp.outer(third, third)
            block = upper * block * upper
        half = wp.float64(0.5) * scale
        result = Stiffness()
        result.left = wp.mat33(left)
        result.right = wp.mat33(right)
        result.stretch = wp.mat33(scale * project_block(block))
        result.straight = wp.vec3(half * (symmetric + antisymmetric))
        result.crossed = wp.vec3(half * (symmetric - antisymmetric))
        return result

    return stiffness


@wp.func
def apply_stiffness(stiffness: Stiffness, dF: wp.mat33) -> wp.mat33:
    """Change of the stress with a change of F."""
    D = wp.transpose(stiffness.left) * dF * stiffness.right
    diagonal = stiffness.stretch * wp.get_diag(D)
    T = wp.mat33()
    for i in range(3):
        T[i, i] = diagonal[i]
        for j in range(i):
            T[i, j] = stiffness.straight[3 - i - j] * D[i, j] + stiffness.crossed[3 - i - j] * D[j, i]
            T[j, i] = stiffness.straight[3 - i - j] * D[j, i] + stiffness.crossed[3 - i - j] * D[i, j]
    return stiffness.left * T * wp.transpose(stiffness.right)
