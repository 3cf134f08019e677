# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Least squares of boundary functions on harmonic polynomials, in registers: one point, one thread.

The Gram matrix of the polynomials over a point's landings is factored once; since its leading blocks are those of the
lower degrees, one factor serves all degrees.
"""

from functools import cache
from typing import NamedTuple

import warp as wp

from .polynomials import make_polynomials

wp.set_module_options({"enable_backward": False})

_PIVOT = wp.constant(wp.float64(1.0e-9))
_MOST_INFLATION = wp.constant(wp.float64(4.0))
"""Variance of a fit at p, relative to that of a mean, above which the landings do not determine it."""
_MOST_LEVERAGE = wp.constant(wp.float64(0.999))
_ZERO = wp.constant(wp.float64(0.0))
_ONE = wp.constant(wp.float64(1.0))

FAR_COUNT = 4
"""Walks of a point that are kept as the candidates for the greatest leverage: the farthest of every fourth."""


class Regression(NamedTuple):
    """Types and Warp functions of the regression in one dimension.

    Args:
        Gram: Matrix type of the sums of products of polynomials.
        Moments: Struct of a batch's sums, shape (slots, vertices).
        Far: Matrix type of the polynomials at the farthest landings, a row each.
        factor: (gram, count) -> LDL^T: L below the diagonal, 1 / D on it, 0 there where a polynomial depends on others.
        back_substitute: (factor, z, count) -> solution of L^T x = D^-1 z for the leading polynomials.
        choose_degree: Forward-substitutes all boundary functions and chooses the degree; see the function.
        is_flat: factor -> whether a linear polynomial carries nothing of its own.
    """

    Gram: type
    Moments: object
    Far: type
    factor: wp.Function
    back_substitute: wp.Function
    choose_degree: wp.Function
    is_flat: wp.Function


@cache
def make_regression(dimension: int) -> Regression:
    """Make the regression of a dimension.

    Args:
        dimension: 2 or 3.
    """
    size, Features, _, count_of_degree = make_polynomials(dimension)
    Gram = wp.types.matrix(shape=(size, size), dtype=wp.float64)
    Far = wp.types.matrix(shape=(FAR_COUNT, size), dtype=wp.float64)

    @wp.struct
    class Moments:
        """Sums over a point's walks, a row for each point of a batch, shape (slots, vertices).

        ``value``: polynomials times a vertex's boundary function; then its forward substitution, then the fit.
        ``slope``: the first step's direction times that function; then the weight's gradient in the unit frame.
        """

        value: wp.array2d[Features]
        slope: wp.array2d[wp.vec3d]

    @wp.func
    def factor_gram(gram: Gram, count: int) -> Gram:
        for i in range(count):
            for k in range(i):
                value = gram[i, k]
                for m in range(k):
                    value -= gram[i, m] * gram[k, m]
                gram[i, k] = value
            diagonal = gram[i, i]
            pivot = diagonal
            for k in range(i):
                scaled = gram[i, k] * gram[k, k]
                pivot -= gram[i, k] * scaled
                gram[i, k] = scaled
            gram[i, i] = _ZERO
            if pivot > _PIVOT * diagonal:
                gram[i, i] = _ONE / pivot
        return gram

    @wp.func
    def forward_substitute(factor: Gram, right: Features, count: int) -> Features:
        for i in range(count):
            z = right[i]
            for k in range(i):
                z -= factor[i, k] * right[k]
            right[i] = z
        return right

    @wp.func
    def back_substitute(factor: Gram, z: Features, count: int) -> Features:
        for reverse in range(count):
            i = count - 1 - reverse
            x = z[i] * factor[i, i]
            for k in range(i + 1, count):
                x -= factor[k, i] * z[k]
            z[i] = x
        return z

    @wp.func
    def explain(factor: Gram, moments: Moments, slot: int, vertex_count: int, count: int) -> Features:
        """Forward-substitute the boundary functions; what each polynomial explains of all of them together."""
        explained = Features()
        for j in range(vertex_count):
            right = moments.value[slot, j]
            if right[0] != _ZERO:  # else no walk reached the vertex
                z = forward_substitute(factor, right, count)
                moments.value[slot, j] = z
                explained += wp.cw_mul(z, z)
        return explained

    @wp.func
    def choose_degree(
        factor: Gram,
        moments: Moments,
        slot: int,
        vertex_count: int,
        walks: int,
        max_degree: int,
        squares: wp.float64,
        far: Far,
    ) -> int:
        """Forward-substitute the boundary functions and choose the degree of least estimated squared error.

        With the factor of the highest degree, the residual of every lower one is a partial sum. The estimate is
        residual variance times the sum of the squared walk weights a_k, both for the polynomials used, with a_k^2
        divided by (1 - h_k)^3 where a far landing has the leverage h_k: a fit that goes after few landings looks better
        than it is (as in the jackknife, which divides by the square). The degree is 0 where not even a linear fit is
        determined: next to a wall, when a few landings off it, and hardly off it, would be extrapolated to p.
        """
        count = count_of_degree(max_degree)
        explained = explain(factor, moments, slot, vertex_count, count)
        unit = Features()
        unit[0] = _ONE
        unit = forward_substitute(factor, unit, count)
        for c in range(wp.static(FAR_COUNT)):
            far[c] = forward_substitute(factor, far[c], count)
        leverage = wp.vec4d()
        weight = wp.vec4d()
        residual = squares
        inflation = _ZERO
        best_degree = int(0)
        best_error = wp.float64(1.0e300)
        first = int(0)
        for degree in range(max_degree + 1):
            last = count_of_degree(degree)
            for i in range(first, last):
                residual -= explained[i] * factor[i, i]
                inflation += unit[i] * unit[i] * factor[i, i]
                for c in range(wp.static(FAR_COUNT)):
                    leverage[c] = leverage[c] + far[c, i] * far[c, i] * factor[i, i]
                    weight[c] = weight[c] + far[c, i] * unit[i] * factor[i, i]
            first = last
            freedom = walks - last
            spread = inflation
            for c in range(wp.static(FAR_COUNT)):
                rest = _ONE - wp.min(leverage[c], _MOST_LEVERAGE)
                spread += weight[c] * weight[c] * (_ONE / (rest * rest * rest) - _ONE)
            error = wp.max(residual, _ZERO) * spread / wp.float64(wp.max(freedom, 1))
            determined = inflation * wp.float64(walks) <= _MOST_INFLATION
            if determined and (degree == 1 or (degree > 1 and freedom > 2 * last and error < best_error)):
                best_error = error
                best_degree = degree
        return best_degree

    @wp.func
    def is_flat(factor: Gram) -> bool:
        flat = bool(False)
        for axis in range(wp.static(dimension)):
            if factor[axis + 1, axis + 1] == _ZERO:
                flat = True
        return flat

    return Regression(Gram, Moments, Far, factor_gram, back_substitute, choose_degree, is_flat)
