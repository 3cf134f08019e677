# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Preconditioned conjugate gradients in a single launch, from the first to the last iteration.

One thread block does the whole solve, on a CPU one thread: a cage has some hundred vertices at most, and launches cost
more than their work. So nothing is decided on the host, and a captured solve is the eager one. It is conditioned by a
dense factor, of this system's matrix or of that of an earlier one in the same step, or for large systems by the
inverses of the diagonal blocks. The matrix's products are found from the quadrature points, not from the assembled
matrix: a translation then costs exactly nothing, however stiff the body, and a factor need not be exact.

Why not ``warp.optim.linear.CG`` (Warp 1.19): it reads the residual on the host, or runs all iterations on a CPU.

Vectors are float32; dot products and step lengths are float64. The order of every sum is fixed.
"""

import functools

import warp as wp

from ..arrays import ELASTIC_STIFFNESS, BodyArrays, LinearSystem, StepArrays
from ..plane_confinement import in_plane, inverse_in_plane
from ..step_kernels import add_inertia, tie
from .cholesky import make_factor_solve, wait
from .lanes import entry, lane_struct, lane_type, make_gather, make_scatter
from .point_forces import PointForces, as_four, as_three, multiply_points, pull_back
from .stiffness_matrix import DenseMatrix

wp.set_module_options({"enable_backward": False})


@wp.struct
class Search:
    """What the iterations work on."""

    direction: wp.array[wp.vec3]
    """The search direction, one a row."""
    fours: wp.array[wp.vec4]
    """The same with zeros after the vectors, one a row."""
    product: wp.array[wp.vec3]
    """The matrix's product with the direction, one a row."""
    pulled: wp.array[wp.vec4]
    """What points pull, one a row."""
    conditioned: wp.array[wp.vec3]
    """The preconditioned residual, one a row."""
    rows: wp.array[float]
    """The residual's components, for the factor."""
    solved: wp.array[float]
    """What the factor makes of them."""
    energy: wp.array[wp.float64]
    """Squared preconditioned norm of the residual now and at the start, shape (2,)."""
    iterations: wp.array[int]
    """Iterations of the last solve, shape (1,)."""


def make_search(row_count: int, device: wp.Device) -> Search:
    """Scratch for solves with as many rows, which fill whole lane vectors."""
    search = Search()
    with wp.ScopedDevice(device):
        search.direction, search.product, search.conditioned = (wp.zeros(row_count, dtype=wp.vec3) for _ in range(3))
        search.fours, search.pulled = (wp.zeros(row_count, dtype=wp.vec4) for _ in range(2))
        search.rows, search.solved = (wp.zeros(3 * row_count, dtype=float) for _ in range(2))
        search.energy = wp.zeros(2, dtype=wp.float64)
        search.iterations = wp.zeros(1, dtype=int)
    return search


@functools.cache
def make_product(width: int) -> wp.Function:
    """The function that multiplies the search direction with the system's matrix; all threads of the block call it."""
    lane, Lanes = lane_type(width), lane_struct(width)
    gather_block, scatter = make_gather(width), make_scatter(width)

    @wp.func
    def stress_block(k: int, lanes: Lanes, changes: wp.array2d(dtype=lane)):
        for m in range(9):
            total = lane()
            for n in range(9):
                total += wp.cw_mul(lanes.stiffness[entry(m, n), k], changes[n, k])
            lanes.tensions[m, k] = total

    @wp.func
    def multiply(
        thread: int,
        body: BodyArrays,
        step: StepArrays,
        system: LinearSystem,
        points: PointForces,
        search: Search,
        lanes: Lanes,
        changes: wp.array2d(dtype=lane),
    ):
        count = system.row_count[0]
        for k in range(thread, lanes.tensions.shape[1], wp.block_dim()):
            gather_block(k, search.direction, body, lanes, changes)
            stress_block(k, lanes, changes)
        multiply_points(thread, search.fours, count, points)
        wait()
        pull_back(thread, count, points, search.pulled)
        wait()
        for i in range(thread, count, wp.block_dim()):
            result = wp.vec3()
            if system.fixed[i] == 0:
                result = add_inertia(result, i, search.direction, body) + scatter(i, lanes)
                result += as_three(search.pulled[i])
                if body.stabilizing_stiffness[i, i] > 0.0:
                    result += float(body.material[0][0] * step.scales[ELASTIC_STIFFNESS]) * tie(
                        i, search.direction, body
                    )
            search.product[i] = result

    return multiply


@functools.cache
def make_conditioning(width: int, dense: bool, plane: bool) -> wp.Function:
    """The function that preconditions the residual; all threads of the block call it."""
    lane = lane_type(width)
    factor_solve = make_factor_solve(width)

    @wp.func
    def condition(
        thread: int,
        system: LinearSystem,
        search: Search,
        matrix: DenseMatrix,
        matrix_lanes: wp.array2d(dtype=lane),
        row_lanes: wp.array(dtype=lane),
    ):
        count = system.row_count[0]
        if wp.static(dense):
            for r in range(thread, (3 * count + 7) / 8 * 8, wp.block_dim()):
                value = wp.vec3()
                if r < 3 * count:
                    value = wp.vec3(system.residual[r / 3])
                    if wp.static(plane):
                        value = in_plane(value, system.normal[0])
                search.rows[r] = value[r % 3]
            wait()
            factor_solve(thread, 3 * count, matrix, matrix_lanes, search.rows, row_lanes, search.solved)
            for i in range(thread, count, wp.block_dim()):
                z = wp.vec3(search.solved[3 * i], search.solved[3 * i + 1], search.solved[3 * i + 2])
                if wp.static(plane):
                    z = in_plane(z, system.normal[0])
                search.conditioned[i] = z
        else:
            for i in range(thread, count, wp.block_dim()):
                search.conditioned[i] = system.blocks[i] * system.residual[i]

    return condition


@wp.func
def residual_energy(thread: int, system: LinearSystem, search: Search) -> wp.float64:
    """The residual times the preconditioned residual."""
    total = wp.float64(0.0)
    for i in range(thread, system.row_count[0], wp.block_dim()):
        total += wp.float64(wp.dot(system.residual[i], search.conditioned[i]))
    return wp.tile_sum(wp.tile(total))[0]


@wp.func
def turn_direction(thread: int, count: int, beta: float, search: Search):
    """The next search direction."""
    for i in range(thread, count, wp.block_dim()):
        d = search.conditioned[i] + beta * search.direction[i]
        search.direction[i] = d
        search.fours[i] = as_four(d)


@wp.func
def invert_blocks(thread: int, plane: bool, system: LinearSystem):
    """Replace the diagonal blocks by their inverses, those of fixed rows by zero."""
    for i in range(thread, system.row_count[0], wp.block_dim()):
        inverse = wp.mat33()
        if system.fixed[i] == 0:
            if plane:
                inverse = wp.mat33(inverse_in_plane(wp.mat33d(system.blocks[i]), system.normal[0]))
            else:
                inverse = wp.mat33(wp.inverse(wp.mat33d(system.blocks[i])))
        system.blocks[i] = inverse


@functools.cache
def make_solve_kernel(width: int, dense: bool, plane: bool) -> wp.Kernel:
    """The kernel that solves a system; one thread block.

    Args:
        width: Lanes of a vector.
        dense: Whether a factor conditions it; otherwise the diagonal blocks do.
        plane: Whether the solution stays in a plane.
    """
    lane, Lanes = lane_type(width), lane_struct(width)
    multiply, condition = make_product(width), make_conditioning(width, dense, plane)

    @wp.kernel(enable_backward=False, module="unique")
    def solve_system(
        tolerance: wp.float64,
        max_iterations: int,
        body: BodyArrays,
        step: StepArrays,
        system: LinearSystem,
        points: PointForces,
        search: Search,
        matrix: DenseMatrix,
        lanes: Lanes,
        changes: wp.array2d(dtype=lane),
        matrix_lanes: wp.array2d(dtype=lane),
        row_lanes: wp.array(dtype=lane),
    ):
        thread = wp.tid()
        count = system.row_count[0]
        for i in range(thread, count, wp.block_dim()):
            if system.fixed[i] != 0:
                system.residual[i] = wp.vec3()
        if not wp.static(dense):
            invert_blocks(thread, wp.static(plane), system)
        wait()
        condition(thread, system, search, matrix, matrix_lanes, row_lanes)
        wait()
        energy = residual_energy(thread, system, search)
        first, iterations = wp.float64(energy), int(0)
        turn_direction(thread, count, 0.0, search)
        running = energy > wp.float64(0.0)
        while running:
            wait()
            multiply(thread, body, step, system, points, search, lanes, changes)
            wait()
            part = wp.float64(0.0)
            for i in range(thread, count, wp.block_dim()):
                part += wp.float64(wp.dot(search.direction[i], search.product[i]))
            curvature = wp.tile_sum(wp.tile(part))[0]
            alpha = wp.float64(0.0)
            if curvature > wp.float64(0.0):
                alpha = energy / curvature
            for i in range(thread, count, wp.block_dim()):
                system.solution[i] += float(alpha) * search.direction[i]
                system.residual[i] -= float(alpha) * search.product[i]
            wait()
            condition(thread, system, search, matrix, matrix_lanes, row_lanes)
            wait()
            old = energy
            energy = residual_energy(thread, system, search)
            iterations += 1
            turn_direction(thread, count, float(energy / old), search)
            improvable = energy > tolerance * tolerance * first and alpha > wp.float64(0.0)
            running = improvable and iterations < max_iterations
        if thread == 0:
            search.energy[0] = energy
            search.energy[1] = first
            search.iterations[0] = iterations

    return solve_system
