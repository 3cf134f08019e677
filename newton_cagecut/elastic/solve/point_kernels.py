# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of forces on points: their residual, and the product of their part of the matrix with a vertex field."""

from __future__ import annotations

import warp as wp

from ..arrays import DAMPING, END_TIME, FORCE, IMPULSE_SHARE, JOINED, STIFFNESS, LinearSystem, StepArrays
from .cholesky import wait
from .conjugate_gradient import Search
from .point_forces import PointForces, as_four, as_three, multiply_points, packed, point_value, pull_back

wp.set_module_options({"enable_backward": False})


@wp.func
def spread(thread: int, count: int, values: wp.array[wp.vec3], fours: wp.array[wp.vec4]):
    """Write a vertex field with zeros after its vectors."""
    for i in range(thread, count, wp.block_dim()):
        fours[i] = as_four(values[i])


@wp.func
def add_pulled(thread: int, count: int, system: LinearSystem, pulled: wp.array[wp.vec4], target: wp.array[wp.vec3]):
    """Add what points pull to the vertices that are not fixed."""
    for i in range(thread, count, wp.block_dim()):
        if system.fixed[i] == 0:
            target[i] += as_three(pulled[i])


@wp.kernel(enable_backward=False)
def add_point_residual(
    guess: wp.array[wp.vec3],
    earlier: wp.array[wp.vec3],
    step: StepArrays,
    system: LinearSystem,
    points: PointForces,
    search: Search,
):
    """Add force f + force D earlier - matrix guess to the residual; one thread block."""
    thread = wp.tid()
    count = system.row_count[0]
    spread(thread, count, guess, search.fours)
    spread(thread, count, earlier, search.pulled)
    wait()
    force_scale = float(step.scales[FORCE])
    stiffness_scale, damping_scale = float(step.scales[STIFFNESS]), float(step.scales[DAMPING])
    if thread == 0 and points.pair_count[0] > 0:
        step.scales[JOINED] = wp.float64(1.0)
    time = float(step.scales[END_TIME])
    for slot in range(thread, points.count[0], wp.block_dim()):
        block = stiffness_scale * points.stiffness[slot] + damping_scale * points.damping[slot]
        passing = points.damping[slot] * (points.drift[slot] + point_value(slot, search.pulled, count, points))
        force = points.force[slot] + time * (points.stiffness[slot] * points.drift[slot]) + passing
        points.system[slot] = packed(block)
        pull = force_scale * force - block * point_value(slot, search.fours, count, points)
        points.product[slot] = as_four(pull)
    wait()
    pull_back(thread, count, points, search.pulled)
    wait()
    add_pulled(thread, count, system, search.pulled, system.residual)


@wp.kernel(enable_backward=False)
def add_point_product(
    values: wp.array[wp.vec3],
    product: wp.array[wp.vec3],
    system: LinearSystem,
    points: PointForces,
    search: Search,
):
    """Add the product of the points' part of the matrix with a vertex field; one thread block."""
    thread = wp.tid()
    count = system.row_count[0]
    spread(thread, count, values, search.fours)
    wait()
    multiply_points(thread, search.fours, count, points)
    wait()
    pull_back(thread, count, points, search.pulled)
    wait()
    add_pulled(thread, count, system, search.pulled, product)


@wp.kernel(enable_backward=False)
def add_point_impulse(
    moved: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    step: StepArrays,
    system: LinearSystem,
    points: PointForces,
    search: Search,
):
    """Add what the forces at the end of a stage give to the body to the impulses of the step; one thread block."""
    thread = wp.tid()
    count = system.row_count[0]
    spread(thread, count, moved, search.fours)
    spread(thread, count, velocities, search.pulled)
    wait()
    share, time = float(step.scales[IMPULSE_SHARE]), float(step.scales[END_TIME])
    for slot in range(thread, points.count[0], wp.block_dim()):
        drift = points.drift[slot]
        shift = point_value(slot, search.fours, count, points) - time * drift
        relative = point_value(slot, search.pulled, count, points) - drift
        force = points.force[slot] - points.stiffness[slot] * shift - points.damping[slot] * relative
        points.impulse[slot] = points.impulse[slot] + share * force
