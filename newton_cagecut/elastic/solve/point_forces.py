# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Forces on embedded points, such as contact, as a part of the system that is solved.

A force is f - S (s - u t) - D (v - u), with s the displacement and v the velocity of its point at the end of a step or
stage, t the time since the start of the step, u the velocity of what it touches, and f that at the start. Through the
weights it reaches the vertices: w^T f, and w^T S w in the matrix. What touches itself has rows of its own: the weights
of one place less those of the other.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})


Symmetric = wp.types.vector(length=8, dtype=wp.float32)
"""A symmetric 3x3 matrix: xx, yy, zz, xy, yz, zx, and two zeros that fill a vector of a CPU."""


@wp.func
def packed(matrix: wp.mat33) -> Symmetric:
    """The six entries of a symmetric matrix."""
    return Symmetric(matrix[0, 0], matrix[1, 1], matrix[2, 2], matrix[0, 1], matrix[1, 2], matrix[2, 0], 0.0, 0.0)


@wp.func
def unpacked(entries: Symmetric) -> wp.mat33:
    """The symmetric matrix of six entries."""
    xy, yz, zx = entries[3], entries[4], entries[5]
    return wp.mat33(entries[0], xy, zx, xy, entries[1], yz, zx, yz, entries[2])


@wp.struct
class PointForces:
    """Forces on points of a body, one a slot; those of fixed vertices are left out."""

    weights: wp.array2d[float]
    """Weights, one a row and vertex."""
    first_row: int
    """Row of point 0 in ``weights``."""
    pair_weights: wp.array2d[float]
    """Weights of places that touch the body itself, less those of the place touched, one a row and vertex."""
    pair_count: wp.array[int]
    """Number of these rows in use, shape (1,)."""
    touched: wp.array[int]
    """The point that a force acts on; or -1 - r for row r of ``pair_weights``."""
    count: wp.array[int]
    """Number of slots in use, shape (1,)."""
    force: wp.array[wp.vec3]
    """Force at the start of the step [N]."""
    stiffness: wp.array[wp.mat33]
    """Symmetric stiffness [N/m]."""
    damping: wp.array[wp.mat33]
    """Symmetric damping [N s/m]."""
    drift: wp.array[wp.vec3]
    """Velocity of what the point touches [m/s]."""
    impulse: wp.array[wp.vec3]
    """What the force gave to the body in the step [N s]."""
    system: wp.array[Symmetric]
    """Block of the system's matrix."""
    product: wp.array[wp.vec4]
    """Residual, or the block's product with a direction; the last component is 0."""


def make_point_forces(weights: wp.array, first_row: int, capacity: int, *, pairs: int = 0) -> PointForces:
    """Forces on no point yet.

    Args:
        weights: Weights, one a row and vertex.
        first_row: Row of point 0.
        capacity: Number of slots.
        pairs: Number of rows for what touches the body itself.
    """
    points = PointForces()
    points.weights, points.first_row = weights, first_row
    with wp.ScopedDevice(weights.device):
        points.pair_weights = wp.zeros((pairs, weights.shape[1]), dtype=float)
        points.touched = wp.zeros(capacity, dtype=int)
        points.count, points.pair_count = (wp.zeros(1, dtype=int) for _ in range(2))
        points.force, points.drift, points.impulse = (wp.zeros(capacity, dtype=wp.vec3) for _ in range(3))
        points.stiffness, points.damping = (wp.zeros(capacity, dtype=wp.mat33) for _ in range(2))
        points.system, points.product = wp.zeros(capacity, dtype=Symmetric), wp.zeros(capacity, dtype=wp.vec4)
    return points


@wp.func
def row_value(row: int, weights: wp.array2d[float], values: wp.array[wp.vec4], vertex_count: int) -> wp.vec3:
    """The sum of a vertex field with a row of weights, in four sums that do not wait for each other."""
    v0, v1, v2, v3 = wp.vec4(), wp.vec4(), wp.vec4(), wp.vec4()
    fours = vertex_count / 4
    for four in range(fours):
        j = 4 * four
        v0 += weights[row, j] * values[j]
        v1 += weights[row, j + 1] * values[j + 1]
        v2 += weights[row, j + 2] * values[j + 2]
        v3 += weights[row, j + 3] * values[j + 3]
    for j in range(4 * fours, vertex_count):
        v0 += weights[row, j] * values[j]
    total = (v0 + v1) + (v2 + v3)
    return wp.vec3(total[0], total[1], total[2])


@wp.func
def point_value(slot: int, values: wp.array[wp.vec4], vertex_count: int, points: PointForces) -> wp.vec3:
    """A vertex field at the point of a slot, relative to what it touches of the body itself."""
    touched = points.touched[slot]
    if touched < 0:
        return row_value(-1 - touched, points.pair_weights, values, vertex_count)
    return row_value(points.first_row + touched, points.weights, values, vertex_count)


@wp.func
def slot_weight(slot: int, vertex: int, points: PointForces) -> float:
    """The weight of a vertex at the point of a slot."""
    touched = points.touched[slot]
    if touched < 0:
        return points.pair_weights[-1 - touched, vertex]
    return points.weights[points.first_row + touched, vertex]


@wp.func
def multiply_points(thread: int, values: wp.array[wp.vec4], vertex_count: int, points: PointForces):
    """Multiply a vertex field at the touched points with their blocks; all threads of the block call it."""
    for slot in range(thread, points.count[0], wp.block_dim()):
        value = point_value(slot, values, vertex_count, points)
        points.product[slot] = as_four(unpacked(points.system[slot]) * value)


@wp.func
def pull_back(thread: int, vertex_count: int, points: PointForces, pulled: wp.array[wp.vec4]):
    """Sum what the touched points pull; all threads of the block call it."""
    last = points.weights.shape[1] - 1
    for four in range(thread, (vertex_count + 3) / 4, wp.block_dim()):
        j = 4 * four
        second, third, fourth = wp.min(j + 1, last), wp.min(j + 2, last), wp.min(j + 3, last)
        v0, v1, v2, v3 = wp.vec4(), wp.vec4(), wp.vec4(), wp.vec4()
        for slot in range(points.count[0]):
            pull = points.product[slot]
            v0 += slot_weight(slot, j, points) * pull
            v1 += slot_weight(slot, second, points) * pull
            v2 += slot_weight(slot, third, points) * pull
            v3 += slot_weight(slot, fourth, points) * pull
        pulled[j] = v0
        pulled[j + 1] = v1
        pulled[j + 2] = v2
        pulled[j + 3] = v3


@wp.func
def as_four(v: wp.vec3) -> wp.vec4:
    """A vector with a zero after it."""
    return wp.vec4(v[0], v[1], v[2], 0.0)


@wp.func
def as_three(v: wp.vec4) -> wp.vec3:
    """The first three components."""
    return wp.vec3(v[0], v[1], v[2])
