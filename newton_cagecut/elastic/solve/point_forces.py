# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Forces on embedded points, such as contact, as a part of the system that is solved.

A point's force is f - S s - D v, with s its displacement and v its velocity after a step, and f that at the position
before it. Through the weights it reaches the vertices: w^T f, and w^T S w in the matrix.
"""

import functools

import warp as wp

from .lanes import lane_type, make_lane_sum

wp.set_module_options({"enable_backward": False})


@wp.struct
class PointForces:
    """Forces on points of a body; those of fixed vertices are left out."""

    weights: wp.array2d[float]
    """Weights, one a row and vertex."""
    first_row: int
    """Row of point 0 in ``weights``."""
    touched: wp.array[int]
    """The points that a force acts on."""
    count: wp.array[int]
    """Number of them, shape (1,)."""
    force: wp.array[wp.vec3]
    """Force at the position before the step, one a point [N]."""
    stiffness: wp.array[wp.mat33]
    """Symmetric stiffness, one a point [N/m]."""
    damping: wp.array[wp.mat33]
    """Symmetric damping, one a point [N s/m]."""
    system: wp.array[wp.mat33]
    """Block of the system's matrix, one a touched point."""
    product: wp.array[wp.vec3]
    """Residual, or the block's product with a direction, one a touched point."""


def no_point_forces(vertex_capacity: int, device: wp.Device) -> PointForces:
    """Forces on no point."""
    points = PointForces()
    with wp.ScopedDevice(device):
        points.weights = wp.zeros((1, vertex_capacity), dtype=float)
        points.touched, points.count = (wp.zeros(1, dtype=int) for _ in range(2))
        points.force, points.product = (wp.zeros(1, dtype=wp.vec3) for _ in range(2))
        points.stiffness, points.damping, points.system = (wp.zeros(1, dtype=wp.mat33) for _ in range(3))
    return points


@functools.cache
def make_point_value(width: int) -> wp.Function:
    """The function that finds a vertex field at a touched point."""
    lane = lane_type(width)
    lane_sum = make_lane_sum(width)

    @wp.func
    def point_value(slot: int, values: wp.array2d(dtype=float), vertex_count: int, points: PointForces) -> wp.vec3:
        row = points.first_row + points.touched[slot]
        x, y, z = lane(), lane(), lane()
        whole = vertex_count / wp.static(width)
        for block in range(whole):
            weight, vx, vy, vz = lane(), lane(), lane(), lane()
            for s in range(wp.static(width)):
                j = wp.static(width) * block + s
                weight[s] = points.weights[row, j]
                vx[s] = values[0, j]
                vy[s] = values[1, j]
                vz[s] = values[2, j]
            x += wp.cw_mul(weight, vx)
            y += wp.cw_mul(weight, vy)
            z += wp.cw_mul(weight, vz)
        total = wp.vec3(lane_sum(x), lane_sum(y), lane_sum(z))
        for j in range(wp.static(width) * whole, vertex_count):
            total += points.weights[row, j] * wp.vec3(values[0, j], values[1, j], values[2, j])
        return total

    return point_value
