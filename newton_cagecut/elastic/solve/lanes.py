# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Quadrature points side by side in short vectors, so that one instruction of a CPU serves eight of them.

A lane vector holds one number of eight points on a CPU and of a single one on CUDA, where threads take the place of
lanes. The 3x3 matrices of the points lie in nine rows, row 3 b + c for entry (b, c); their stiffness, a symmetric 9x9
matrix, in 45. Each row is a float array too, for kernels that work on single points.
"""

import functools

import warp as wp

from .. import arrays
from ..arrays import BodyArrays, StepArrays

wp.set_module_options({"enable_backward": False})


def lane_width(device: wp.Device) -> int:
    """Lanes of a vector on a device."""
    return arrays.CPU_WIDTH if device.is_cpu else 1


@functools.cache
def lane_type(width: int) -> type:
    """A vector of as many floats."""
    return wp.types.vector(length=width, dtype=wp.float32)


@functools.cache
def lane_struct(width: int) -> type:
    """The struct ``QuadratureLanes`` of one width: views in lanes of what the quadrature points have.

    ``gradients``: gradients of the weights, shape (vertex_capacity, 3, block_count); ``stiffness``: 45 entries, shape
    (45, block_count); ``tensions``: stress times volume and time scale, or its change, shape (9, block_count).
    """
    lane = lane_type(width)
    fields = {
        "gradients": wp.array3d(dtype=lane),
        "stiffness": wp.array2d(dtype=lane),
        "tensions": wp.array2d(dtype=lane),
    }
    return wp.struct(type("QuadratureLanes", (), {"__annotations__": fields, "__module__": __name__}))


def in_lanes(values: wp.array, width: int) -> wp.array:
    """A view of float rows in lanes; their length is a multiple of the width."""
    shape = (*values.shape[:-1], values.shape[-1] // width)
    return wp.array(ptr=values.ptr, dtype=lane_type(width), shape=shape, device=values.device)


def make_lanes(body: BodyArrays, step: StepArrays, width: int) -> object:
    """The lanes of a body; stiffness and tensions are views of the step's."""
    lanes = lane_struct(width)()
    lanes.stiffness, lanes.tensions = in_lanes(step.moduli, width), in_lanes(step.tensions, width)
    shape = (body.rest.shape[0], 3, lanes.tensions.shape[1])
    lanes.gradients = wp.zeros(shape, dtype=lane_type(width), device=body.rest.device)
    return lanes


@wp.func
def entry(m: int, n: int) -> int:
    """Row of the entry (m, n) of a symmetric 9x9 matrix."""
    low, high = wp.min(m, n), wp.max(m, n)
    return 9 * low - (low * (low - 1)) / 2 + high - low


@functools.cache
def make_pack_kernel(width: int) -> wp.Kernel:
    """The kernel that lays the gradients out in lanes, after an edit; one thread a vertex and block of points."""
    lane, Lanes = lane_type(width), lane_struct(width)

    @wp.kernel(enable_backward=False, module="unique")
    def pack_gradients(body: BodyArrays, lanes: Lanes):
        j, k = wp.tid()
        x, y, z = lane(), lane(), lane()
        for s in range(wp.static(width)):
            q = wp.static(width) * k + s
            if j < body.vertex_count[0] and q < body.volumes.shape[0]:
                gradient = body.gradients[q, j]
                x[s] = gradient[0]
                y[s] = gradient[1]
                z[s] = gradient[2]
        lanes.gradients[j, 0, k] = x
        lanes.gradients[j, 1, k] = y
        lanes.gradients[j, 2, k] = z

    return pack_gradients


@functools.cache
def make_lane_sum(width: int) -> wp.Function:
    """The function that sums the lanes of a vector, in a fixed order."""
    lane = lane_type(width)

    @wp.func
    def lane_sum(v: lane) -> float:
        if wp.static(width == 1):
            return v[0]
        else:
            return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]))

    return lane_sum


@functools.cache
def make_gather(width: int) -> wp.Function:
    """The function that finds the gradients of a vertex field at one block of points, in the cage's rest frame.

    Differences to the field at a point's anchor are taken, so that any translation drops out exactly.
    """
    lane, Lanes = lane_type(width), lane_struct(width)

    @wp.func
    def gather_block(
        k: int, values: wp.array(dtype=wp.vec3), body: BodyArrays, lanes: Lanes, result: wp.array2d(dtype=lane)
    ):
        ox, oy, oz = lane(), lane(), lane()
        for s in range(wp.static(width)):
            q = wp.static(width) * k + s
            if q < body.anchors.shape[0]:
                origin = values[body.anchors[q]]
                ox[s] = origin[0]
                oy[s] = origin[1]
                oz[s] = origin[2]
        xx, xy, xz = lane(), lane(), lane()
        yx, yy, yz = lane(), lane(), lane()
        zx, zy, zz = lane(), lane(), lane()
        for j in range(body.vertex_count[0]):
            value = values[j]
            x, y, z = lane(value[0]) - ox, lane(value[1]) - oy, lane(value[2]) - oz
            first, second, third = lanes.gradients[j, 0, k], lanes.gradients[j, 1, k], lanes.gradients[j, 2, k]
            xx += wp.cw_mul(x, first)
            xy += wp.cw_mul(x, second)
            xz += wp.cw_mul(x, third)
            yx += wp.cw_mul(y, first)
            yy += wp.cw_mul(y, second)
            yz += wp.cw_mul(y, third)
            zx += wp.cw_mul(z, first)
            zy += wp.cw_mul(z, second)
            zz += wp.cw_mul(z, third)
        result[0, k] = xx
        result[1, k] = xy
        result[2, k] = xz
        result[3, k] = yx
        result[4, k] = yy
        result[5, k] = yz
        result[6, k] = zx
        result[7, k] = zy
        result[8, k] = zz

    return gather_block


@functools.cache
def make_gather_kernel(width: int) -> wp.Kernel:
    """The kernel that finds the gradients of a vertex field; one thread a block of points."""
    lane, Lanes = lane_type(width), lane_struct(width)
    gather_block = make_gather(width)

    @wp.kernel(enable_backward=False, module="unique")
    def gather_changes(values: wp.array(dtype=wp.vec3), body: BodyArrays, lanes: Lanes, result: wp.array2d(dtype=lane)):
        gather_block(wp.tid(), values, body, lanes, result)

    return gather_changes


@functools.cache
def make_scatter(width: int) -> wp.Function:
    """The function that sums what the points' tensions do to one vertex."""
    lane, Lanes = lane_type(width), lane_struct(width)
    lane_sum = make_lane_sum(width)

    @wp.func
    def scatter(j: int, lanes: Lanes) -> wp.vec3:
        x, y, z = lane(), lane(), lane()
        for k in range(lanes.tensions.shape[1]):
            first, second, third = lanes.gradients[j, 0, k], lanes.gradients[j, 1, k], lanes.gradients[j, 2, k]
            x += wp.cw_mul(lanes.tensions[0, k], first)
            x += wp.cw_mul(lanes.tensions[1, k], second)
            x += wp.cw_mul(lanes.tensions[2, k], third)
            y += wp.cw_mul(lanes.tensions[3, k], first)
            y += wp.cw_mul(lanes.tensions[4, k], second)
            y += wp.cw_mul(lanes.tensions[5, k], third)
            z += wp.cw_mul(lanes.tensions[6, k], first)
            z += wp.cw_mul(lanes.tensions[7, k], second)
            z += wp.cw_mul(lanes.tensions[8, k], third)
        return wp.vec3(lane_sum(x), lane_sum(y), lane_sum(z))

    return scatter
