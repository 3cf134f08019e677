# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Harmonic polynomials up to degree 3, the control variates of the weights.

Their value at a query point is the mean of their values at the landings of its walks, cut or not (paper, equation 2).
"""

from functools import cache
from typing import NamedTuple

import warp as wp

wp.set_module_options({"enable_backward": False})

_ONE = wp.constant(wp.float64(1.0))


class Polynomials(NamedTuple):
    """The harmonic polynomials of one dimension.

    Args:
        count: How many there are up to degree 3.
        Features: Vector type of their values.
        evaluate: Warp function (y, x) -> values: the linear ones of y, the higher ones of x, relative to the point.
        count_of_degree: Warp function degree -> how many there are up to that degree.
    """

    count: int
    Features: type
    evaluate: wp.Function
    count_of_degree: wp.Function


@cache
def make_polynomials(dimension: int) -> Polynomials:
    """Make the polynomials of a dimension.

    Args:
        dimension: 3 for 1 + 3 + 5 + 7 polynomials, 2 for 1 + 2 + 2 + 2: the real and imaginary parts of powers.
    """
    return _make_spatial() if dimension == 3 else _make_planar()


def _make_spatial() -> Polynomials:
    Features = wp.types.vector(length=16, dtype=wp.float64)

    @wp.func
    def evaluate(y: wp.vec3d, x: wp.vec3d) -> Features:
        a = x[0]
        b = x[1]
        c = x[2]
        aa = a * a
        bb = b * b
        cc = c * c
        two = wp.float64(2.0)
        three = wp.float64(3.0)
        four = wp.float64(4.0)
        f = Features()
        f[0] = _ONE
        f[1] = y[0]
        f[2] = y[1]
        f[3] = y[2]
        f[4] = a * b
        f[5] = b * c
        f[6] = a * c
        f[7] = aa - bb
        f[8] = two * cc - aa - bb
        f[9] = a * b * c
        f[10] = (aa - bb) * c
        f[11] = a * (aa - three * bb)
        f[12] = b * (three * aa - bb)
        f[13] = a * (four * cc - aa - bb)
        f[14] = b * (four * cc - aa - bb)
        f[15] = c * (two * cc - three * aa - three * bb)
        return f

    @wp.func
    def count_of_degree(degree: int) -> int:
        return (degree + 1) * (degree + 1)

    return Polynomials(16, Features, evaluate, count_of_degree)


def _make_planar() -> Polynomials:
    Features = wp.types.vector(length=7, dtype=wp.float64)

    @wp.func
    def evaluate(y: wp.vec3d, x: wp.vec3d) -> Features:
        real = x[0] * x[0] - x[1] * x[1]
        imaginary = wp.float64(2.0) * x[0] * x[1]
        f = Features()
        f[0] = _ONE
        f[1] = y[0]
        f[2] = y[1]
        f[3] = real
        f[4] = imaginary
        f[5] = real * x[0] - imaginary * x[1]
        f[6] = real * x[1] + imaginary * x[0]
        return f

    @wp.func
    def count_of_degree(degree: int) -> int:
        return 2 * degree + 1

    return Polynomials(7, Features, evaluate, count_of_degree)
