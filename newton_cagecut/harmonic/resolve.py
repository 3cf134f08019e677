# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Weights and gradients from the landings of a point's walks, with harmonic control variates.

For a harmonic polynomial h the landing X satisfies E[h(X)] = h(p) exactly, cut or not. So the boundary functions are
regressed on the harmonic polynomials up to degree 3 over the point's landings, and the fit is read at p: unit sum and
linear precision hold to rounding, and the variance falls (design, section 3). The linear polynomials are taken at
sum_j phi_j v_j, which for a nested walk is the point of the edge where it ended: the identities then hold for what
the weights really are. The gradient is that of the fit plus the boundary integral estimator of Sawhney and Crane 2020
(paper, section 6.1) applied to what the fit leaves over.

The sums run over the walks in their order, so the result does not depend on which walks were walked again.
"""

from __future__ import annotations

from functools import cache

import warp as wp

from .faces import FaceTables
from .landing import KEY_MASK, Landings, boundary_value, plane_point
from .points import QueryPoints
from .random import direction_on_sphere

wp.set_module_options({"enable_backward": False})

FEATURE_COUNT = 16
"""1 constant, 3 linear, 5 quadratic, 7 cubic harmonic polynomials."""

Features = wp.types.vector(length=FEATURE_COUNT, dtype=wp.float64)
Gram = wp.types.matrix(shape=(FEATURE_COUNT, FEATURE_COUNT), dtype=wp.float64)
Flux = wp.types.matrix(shape=(FEATURE_COUNT, 3), dtype=wp.float64)

_PIVOT = wp.constant(wp.float64(1.0e-9))
_MOST_INFLATION = wp.constant(wp.float64(4.0))
"""Variance of a fit at p, relative to that of a mean, above which the landings do not determine it."""
_SHORTEST_RADIUS = wp.constant(4.0)
"""Least first radius that the gradient's estimator divides by, times the number of walks, in the unit frame."""
_ZERO = wp.constant(wp.float64(0.0))
_ONE = wp.constant(wp.float64(1.0))


@wp.func
def harmonic_polynomials(y: wp.vec3d, x: wp.vec3d) -> Features:
    """Harmonic polynomials about the query point: the linear ones of y, the higher ones of x."""
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
def feature_count_of_degree(degree: int) -> int:
    """How many features the polynomials up to a degree are."""
    return (degree + 1) * (degree + 1)


@wp.struct
class Moments:
    """Sums over a point's walks, a row for each point of a batch, shape (slots, vertices).

    ``value``: features times a vertex's boundary function; then its forward substitution, then the fit's coefficients.
    ``slope``: the first step's direction times that function; then the weight's gradient in the unit frame.
    """

    value: wp.array2d[Features]
    slope: wp.array2d[wp.vec3d]


@wp.func
def factor_gram(gram: Gram, count: int) -> Gram:
    """LDL^T: L below the diagonal, 1 / D on it, and 0 there where a feature depends on earlier ones."""
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
    """Solve L z = right."""
    for i in range(count):
        z = right[i]
        for k in range(i):
            z -= factor[i, k] * right[k]
        right[i] = z
    return right


@wp.func
def back_substitute(factor: Gram, z: Features, count: int) -> Features:
    """Solve L^T x = D^-1 z for the leading features; the others are not used."""
    for reverse in range(count):
        i = count - 1 - reverse
        x = z[i] * factor[i, i]
        for k in range(i + 1, count):
            x -= factor[k, i] * z[k]
        z[i] = x
    return z


@wp.func
def choose_degree(
    factor: Gram, moments: Moments, slot: int, vertex_count: int, walks: int, max_degree: int, squares: wp.float64
) -> int:
    """Forward-substitute the boundary functions and choose the degree of least estimated squared error.

    With the factor of the highest degree, the residual of every lower one is a partial sum. The estimate is residual
    variance times the estimator's inflation (the sum of its squared walk weights), both for the features used. The
    degree is 0 where not even a linear fit is determined: next to a wall, when a few landings off it, and hardly off
    it, would be extrapolated to p.
    """
    count = feature_count_of_degree(max_degree)
    explained = Features()
    for j in range(vertex_count):
        right = moments.value[slot, j]
        if right[0] != _ZERO:  # else no walk reached the vertex
            z = forward_substitute(factor, right, count)
            moments.value[slot, j] = z
            explained += wp.cw_mul(z, z)
    unit = Features()
    unit[0] = _ONE
    unit = forward_substitute(factor, unit, count)
    residual = squares
    inflation = _ZERO
    best_degree = int(0)
    best_error = wp.float64(1.0e300)
    for degree in range(max_degree + 1):
        last = feature_count_of_degree(degree)
        for i in range(degree * degree, last):
            residual -= explained[i] * factor[i, i]
            inflation += unit[i] * unit[i] * factor[i, i]
        freedom = walks - last
        error = wp.max(residual, _ZERO) * inflation / wp.float64(wp.max(freedom, 1))
        determined = inflation * wp.float64(walks) <= _MOST_INFLATION
        if determined and (degree == 1 or (degree > 1 and freedom > 2 * last and error < best_error)):
            best_error = error
            best_degree = degree
    return best_degree


@wp.func
def is_flat(factor: Gram) -> bool:
    """Whether a linear feature carries nothing of its own: all landings lie in one plane, on a line or at a point."""
    return factor[1, 1] == _ZERO or factor[2, 2] == _ZERO or factor[3, 3] == _ZERO


@wp.func
def correct_affinely(moments: Moments, tables: FaceTables, slot: int, piece: int, vertex_count: int, origin: wp.vec3d):
    """Add the least change that restores unit sum and linear precision (paper, equation 5), gradients likewise.

    It is spread over the vertices of the point's own piece.
    """
    normal = wp.mat44d()
    missing = wp.vec4d(_ZERO, _ZERO, _ZERO, _ONE)
    slopes = wp.matrix(dtype=wp.float64, shape=(4, 3))
    for axis in range(3):
        slopes[axis, axis] = _ONE
    for j in range(vertex_count):
        if tables.vertex_piece[j] == piece:
            v = tables.rest[j] - origin
            a = wp.vec4d(v[0], v[1], v[2], _ONE)
            normal += wp.outer(a, a)
            missing -= a * moments.value[slot, j][0]
            slopes -= wp.outer(a, moments.slope[slot, j])
    inverse = wp.inverse(normal)
    missing = inverse * missing
    slopes = inverse * slopes
    for j in range(vertex_count):
        if tables.vertex_piece[j] == piece:
            v = tables.rest[j] - origin
            a = wp.vec4d(v[0], v[1], v[2], _ONE)
            value = moments.value[slot, j]
            value[0] = value[0] + wp.dot(a, missing)
            moments.value[slot, j] = value
            moments.slope[slot, j] = moments.slope[slot, j] + wp.transpose(slopes) * a


@cache
def make_resolve_kernel(*, correction: str, gradients: bool) -> wp.Kernel:
    """Make the kernel that turns landings into weights.

    Args:
        correction: "harmonic" for control variates, "affine" for the paper's equation 5, "none" for plain means.
        gradients: Whether any point of the launch has gradients; without, their code is left out.
    """

    @wp.kernel(enable_backward=False, module="unique")
    def resolve(
        offset: int,
        first_row: int,
        rows: wp.array[wp.int32],
        moments: Moments,
        walks: int,
        first_point: int,
        seed: wp.uint32,
        max_degree: int,
        half_side: float,
        vertex_count: int,
        points: QueryPoints,
        tables: FaceTables,
        landings: Landings,
        weights: wp.array2d[float],
        weight_gradients: wp.array2d[wp.vec3],
        degrees: wp.array[wp.int32],
    ):
        slot = offset + wp.tid()
        point = rows[first_row + slot]
        origin = wp.vec3d(points.position[point])
        for j in range(vertex_count):
            moments.value[slot, j] = Features()
            moments.slope[slot, j] = wp.vec3d()
        gram = Gram()
        flux = Flux()
        squares = _ZERO
        with_gradient = bool(False)
        if wp.static(gradients):
            with_gradient = points.gradient_row[point] >= 0
        first_walk = (point - first_point) * walks
        for number in range(walks):
            walk = first_walk + number
            landed = landings.point[walk]
            local = plane_point(tables, (landings.key[walk] & KEY_MASK) // 2, landed)
            value = boundary_value(tables, landings.face[walk], landings.edge[walk], landings.param[walk], local)
            mean = wp.vec3d()
            for i in range(value.count):
                mean += value.weight[i] * (tables.rest[value.vertex[i]] - origin)
            features = harmonic_polynomials(mean, wp.vec3d(landed) - origin)
            for i in range(value.count):
                squares += value.weight[i] * value.weight[i]
                # Read, add, write: "+=" on an array element would be atomic.
                row = moments.value[slot, value.vertex[i]]
                moments.value[slot, value.vertex[i]] = row + features * value.weight[i]
            if wp.static(correction == "harmonic"):
                # Unrolled element by element: several times faster than the sum of outer products.
                for m in range(wp.static(FEATURE_COUNT)):
                    for k in range(m + 1):
                        gram[m, k] += features[m] * features[k]
            if wp.static(gradients):
                if with_gradient:
                    normal = wp.vec3d(direction_on_sphere(seed, wp.uint32(point), wp.uint32(number), wp.uint32(0)))
                    for i in range(value.count):
                        slope_row = moments.slope[slot, value.vertex[i]]
                        moments.slope[slot, value.vertex[i]] = slope_row + normal * value.weight[i]
                    if wp.static(correction == "harmonic"):
                        for m in range(wp.static(FEATURE_COUNT)):
                            for axis in range(3):
                                flux[m, axis] += features[m] * normal[axis]

        scale = _ONE / wp.float64(walks)
        # The estimator's factor 3 / r has a variance of about 9 / (r N): next to a wall r is held where that is small.
        radius = wp.max(points.first_radius[point], _SHORTEST_RADIUS / float(walks))
        flux_scale = scale * wp.float64(3.0) / wp.float64(radius)
        piece = tables.piece[landings.face[first_walk]]
        degree = int(0)
        if wp.static(correction == "harmonic"):
            gram = factor_gram(gram, feature_count_of_degree(max_degree))
            degree = choose_degree(gram, moments, slot, vertex_count, walks, max_degree, squares)
            if points.key[point] >= 0:
                degree = wp.max(degree, 1)
            count = feature_count_of_degree(degree)
            for j in range(vertex_count):
                fit = moments.value[slot, j]
                if fit[0] != _ZERO:
                    fit = back_substitute(gram, fit, count)
                    for i in range(count, FEATURE_COUNT):
                        fit[i] = _ZERO
                    moments.value[slot, j] = fit
                    left_over = moments.slope[slot, j] - wp.transpose(flux) * fit
                    moments.slope[slot, j] = wp.vec3d(fit[1], fit[2], fit[3]) + left_over * flux_scale
            if points.key[point] < 0 and (degree == 0 or is_flat(gram)):
                degree = 0
                correct_affinely(moments, tables, slot, piece, vertex_count, origin)
        else:
            for j in range(vertex_count):
                moments.value[slot, j] = moments.value[slot, j] * scale
                moments.slope[slot, j] = moments.slope[slot, j] * flux_scale
            if wp.static(correction == "affine"):
                correct_affinely(moments, tables, slot, piece, vertex_count, origin)
        degrees[point] = degree
        for j in range(vertex_count):
            weights[point, j] = float(moments.value[slot, j][0])
            if wp.static(gradients):
                if with_gradient:
                    slope = moments.slope[slot, j] / wp.float64(half_side)
                    weight_gradients[points.gradient_row[point], j] = wp.vec3(slope)

    return resolve
