# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Weights and gradients from the landings of a point's walks, with harmonic control variates.

For a harmonic polynomial h the landing X satisfies E[h(X)] = h(p) exactly, cut or not. So the boundary functions are
regressed on the harmonic polynomials up to degree 3 over the point's landings, and the fit is read at p: unit sum and
linear precision hold to rounding, and the variance falls (design, section 3). The linear polynomials are taken at
sum_j phi_j v_j, which for a nested walk is the point of the edge where it ended: the identities then hold for what
the weights really are. On a wall all walks of a point end in its face; what few of them leave is spread over the
corners that the point sees. The gradient is that of the fit plus the boundary integral estimator of Sawhney and Crane
2020 (paper, section 6.1) applied to what the fit leaves over.

The sums run over the walks in their order, so the result does not depend on which walks were walked again.
"""

from functools import cache

import numpy as np
import warp as wp

from ..faces.boundary_value import make_landing_value
from ..faces.face_tables import FaceTables
from ..launch import launch
from ..options import WalkOptions
from ..walks.landing import landing_type, point_functions
from ..walks.query_points import QueryPoints
from ..walks.random import make_direction
from ..walks.records import WalkRecords
from .affine import make_affine_correction
from .face_correction import make_face_correction
from .point_weights import PointWeights
from .polynomials import make_polynomials
from .regression import FAR_COUNT, make_regression

wp.set_module_options({"enable_backward": False})

_SHORTEST_RADIUS = wp.constant(4.0)
"""Least first radius that the gradient's estimator divides by, times the number of walks, in the unit frame."""
_ZERO = wp.constant(wp.float64(0.0))
_ONE = wp.constant(wp.float64(1.0))

_BATCH_BYTES = 1 << 26


@cache
def make_resolve_kernel(*, dimension: int, correction: str, gradients: bool) -> wp.Kernel:
    """Make the kernel that turns landings into weights.

    Args:
        dimension: 2 or 3.
        correction: "harmonic" for control variates, "affine" for the paper's equation 5, "none" for plain means.
        gradients: Whether any point of the launch has gradients; without, their code is left out.
    """
    harmonic = correction == "harmonic"
    feature_count, Features, evaluate, count_of_degree = make_polynomials(dimension)
    Gram, Moments, Far, factor_gram, back_substitute, choose_degree, is_flat = make_regression(dimension)
    Landings = landing_type(dimension)
    to_space = point_functions(dimension)[0]
    landing_value = make_landing_value(dimension)
    direction = make_direction(dimension)
    correct_affinely = make_affine_correction(dimension, Moments)
    correct_on_face = make_face_correction(dimension, Moments)

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
        lowest: wp.array[float],
    ):
        slot = offset + wp.tid()
        point = rows[first_row + slot]
        origin = wp.vec3d(points.position[point])
        for j in range(vertex_count):
            moments.value[slot, j] = Features()
            moments.slope[slot, j] = wp.vec3d()
        gram = Gram()
        flux_x = Features()
        flux_y = Features()
        flux_z = Features()
        far = Far()
        far_squared = wp.vec4d()
        squares = _ZERO
        with_gradient = bool(False)
        if wp.static(gradients):
            with_gradient = points.gradient_row[point] >= 0
        first_walk = (point - first_point) * walks
        for number in range(walks):
            walk = first_walk + number
            value = landing_value(tables, landings, walk)
            mean = wp.vec3d()
            for i in range(value.count):
                mean += value.weight[i] * (tables.rest[value.vertex[i]] - origin)
            landed = wp.vec3d(to_space(landings.point[walk])) - origin
            features = evaluate(mean, landed)
            for i in range(value.count):
                squares += value.weight[i] * value.weight[i]
                # Read, add, write: "+=" on an array element would be atomic.
                row = moments.value[slot, value.vertex[i]]
                moments.value[slot, value.vertex[i]] = row + features * value.weight[i]
            if wp.static(harmonic):
                # Whole rows, of which only the lower part is used: compilers turn them into vector instructions.
                for m in range(wp.static(feature_count)):
                    gram[m] += features * features[m]
                candidate = number % wp.static(FAR_COUNT)
                if wp.length_sq(landed) > far_squared[candidate]:
                    far_squared[candidate] = wp.length_sq(landed)
                    far[candidate] = features
            if wp.static(gradients):
                if with_gradient:
                    normal = wp.vec3d(direction(seed, wp.uint32(point), wp.uint32(number), wp.uint32(0)))
                    for i in range(value.count):
                        slope_row = moments.slope[slot, value.vertex[i]]
                        moments.slope[slot, value.vertex[i]] = slope_row + normal * value.weight[i]
                    if wp.static(harmonic):
                        flux_x += features * normal[0]
                        flux_y += features * normal[1]
                        flux_z += features * normal[2]

        scale = _ONE / wp.float64(walks)
        # The estimator's factor d / r has a variance of about (d / r)^2 / N: next to a wall r is held where that is
        # small.
        radius = wp.max(points.first_radius[point], _SHORTEST_RADIUS / float(walks))
        flux_scale = scale * wp.float64(wp.static(float(dimension))) / wp.float64(radius)
        piece = tables.face_piece[landings.face[first_walk]]
        degree = int(0)
        if wp.static(harmonic):
            gram = factor_gram(gram, count_of_degree(max_degree))
            degree = choose_degree(gram, moments, slot, vertex_count, walks, max_degree, squares, far)
            count = count_of_degree(degree)
            for j in range(vertex_count):
                fit = moments.value[slot, j]
                if fit[0] != _ZERO:
                    fit = back_substitute(gram, fit, count)
                    for i in range(count, feature_count):
                        fit[i] = _ZERO
                    moments.value[slot, j] = fit
                    left_over = moments.slope[slot, j]
                    left_over -= wp.vec3d(wp.dot(flux_x, fit), wp.dot(flux_y, fit), wp.dot(flux_z, fit))
                    slope = wp.vec3d()
                    for axis in range(wp.static(dimension)):
                        slope[axis] = fit[axis + 1]
                    moments.slope[slot, j] = slope + left_over * flux_scale
            if points.key[point] < 0 and (degree == 0 or is_flat(gram)):
                degree = 0
                correct_affinely(moments, tables, slot, piece, vertex_count, origin)
        else:
            for j in range(vertex_count):
                moments.value[slot, j] = moments.value[slot, j] * scale
                moments.slope[slot, j] = moments.slope[slot, j] * flux_scale
            if wp.static(correction == "affine"):
                if points.key[point] < 0:
                    correct_affinely(moments, tables, slot, piece, vertex_count, origin)
        if wp.static(correction != "none"):
            if points.key[point] >= 0:
                wall = points.key[point] // 2
                correct_on_face(moments, tables, slot, landings.face[first_walk], wall, vertex_count, origin)
        degrees[point] = degree
        least = float(0.0)
        for j in range(vertex_count):
            weight = float(moments.value[slot, j][0])
            weights[point, j] = weight
            least = wp.min(least, weight)
            if wp.static(gradients):
                if with_gradient:
                    scaled = moments.slope[slot, j] / wp.float64(half_side)
                    weight_gradients[points.gradient_row[point], j] = wp.vec3(scaled)
        lowest[point] = least

    return resolve


def resolve_points(
    indices: np.ndarray,
    weights: PointWeights,
    records: WalkRecords,
    points: QueryPoints,
    faces: FaceTables,
    options: WalkOptions,
    *,
    half_side: float,
    first_point: int = 0,
) -> None:
    """Reduce the landings of points to weights and gradients, in batches.

    Args:
        indices: The points, shape (n,).
        weights: Where their rows are written.
        records: Landings of their walks, evaluated on the faces.
        points: Where the walks started.
        faces: The faces.
        options: Options of the walks and of the resolve.
        half_side: Half of the longest side of the box around the cage before any cut [m].
        first_point: The point whose walks are the first of the records.
    """
    device, dimension, vertex_count = records.device, records.dimension, faces.rest.size
    polynomials = make_polynomials(dimension)
    kernel = make_resolve_kernel(
        dimension=dimension, correction=options.correction, gradients=weights.gradients.shape[0] > 0
    )
    batch = max(1, min(len(indices), _BATCH_BYTES // (8 * (polynomials.count + 3) * vertex_count)))
    moments = make_regression(dimension).Moments()
    moments.value = wp.empty((batch, vertex_count), dtype=polynomials.Features, device=device)
    moments.slope = wp.empty((batch, vertex_count), dtype=wp.vec3d, device=device)
    rows = wp.array(indices.astype(np.int32), dtype=wp.int32, device=device)
    for first in range(0, len(indices), batch):
        inputs = [first, rows, moments, options.walks, first_point, wp.uint32(options.seed), options.degree]
        inputs += [half_side, vertex_count, points, faces, records.landings]
        inputs += [weights.weights, weights.gradients, weights.degrees, weights.lowest]
        launch(kernel, min(batch, len(indices) - first), inputs, device=device, smallest_chunk=16)
