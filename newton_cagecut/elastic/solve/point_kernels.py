# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of forces on points: their residual, and the product of their part of the matrix with a vertex field."""

import functools

import warp as wp

from ..arrays import DAMPING, FORCE, STIFFNESS, LinearSystem, StepArrays
from .cholesky import wait
from .conjugate_gradient import Search, make_pull_back
from .point_forces import PointForces, make_point_value

wp.set_module_options({"enable_backward": False})


@wp.func
def spread(thread: int, count: int, values: wp.array[wp.vec3], components: wp.array2d[float]):
    """Write a vertex field by components."""
    for i in range(thread, count, wp.block_dim()):
        value = values[i]
        components[0, i] = value[0]
        components[1, i] = value[1]
        components[2, i] = value[2]


@wp.func
def add_pulled(thread: int, count: int, system: LinearSystem, pulled: wp.array2d[float], target: wp.array[wp.vec3]):
    """Add what points pull to the vertices that are not fixed."""
    for i in range(thread, count, wp.block_dim()):
        if system.fixed[i] == 0:
            target[i] += wp.vec3(pulled[0, i], pulled[1, i], pulled[2, i])


@functools.cache
def make_point_residual_kernel(width: int) -> wp.Kernel:
    """The kernel that adds force f + force D earlier - matrix guess to the residual; one thread block."""
    point_value, pull_back = make_point_value(width), make_pull_back(width)

    @wp.kernel(enable_backward=False, module="unique")
    def add_point_residual(
        guess: wp.array[wp.vec3],
        earlier: wp.array[wp.vec3],
        step: StepArrays,
        system: LinearSystem,
        points: PointForces,
        search: Search,
    ):
        thread = wp.tid()
        count = system.row_count[0]
        spread(thread, count, guess, search.components)
        spread(thread, count, earlier, search.pulled)
        wait()
        force_scale = float(step.scales[FORCE])
        stiffness_scale, damping_scale = float(step.scales[STIFFNESS]), float(step.scales[DAMPING])
        for slot in range(thread, points.count[0], wp.block_dim()):
            i = points.touched[slot]
            block = stiffness_scale * points.stiffness[i] + damping_scale * points.damping[i]
            force = points.force[i] + points.damping[i] * point_value(slot, search.pulled, count, points)
            points.system[slot] = block
            points.product[slot] = force_scale * force - block * point_value(slot, search.components, count, points)
        wait()
        pull_back(thread, count, points, search.pulled)
        wait()
        add_pulled(thread, count, system, search.pulled, system.residual)

    return add_point_residual


@functools.cache
def make_point_product_kernel(width: int) -> wp.Kernel:
    """The kernel that adds the product with a vertex field; one thread block."""
    point_value, pull_back = make_point_value(width), make_pull_back(width)

    @wp.kernel(enable_backward=False, module="unique")
    def add_point_product(
        values: wp.array[wp.vec3],
        system: LinearSystem,
        points: PointForces,
        search: Search,
        product: wp.array[wp.vec3],
    ):
        thread = wp.tid()
        count = system.row_count[0]
        spread(thread, count, values, search.components)
        wait()
        for slot in range(thread, points.count[0], wp.block_dim()):
            value = point_value(slot, search.components, count, points)
            points.product[slot] = points.system[slot] * value
        wait()
        pull_back(thread, count, points, search.pulled)
        wait()
        add_pulled(thread, count, system, search.pulled, product)

    return add_point_product
