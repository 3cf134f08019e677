# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Conjugate gradients with a 3x3 block-Jacobi preconditioner, on the device from the first to the last iteration.

Why not ``warp.optim.linear.CG`` (Warp 1.19), which can be preallocated too: with ``check_every > 0`` it reads the
residual on the host; with ``check_every = 0`` it runs all iterations on the CPU, and captures a graph of its own in
every call on CUDA unless the caller captures; and it takes about ten launches an iteration. A cage has some hundred
vertices, so one thread block does all vector work of an iteration in one launch here: both dot products, the vector
updates, the preconditioner and the test for convergence. On the CPU that test is read in place; a CUDA graph that is
being captured loops on it; otherwise CUDA launches all iterations, and those past convergence change nothing.

Vectors are float32; dot products and step lengths are float64. The order of every sum is fixed.

A solution that is confined to a plane costs nothing in the iterations: the preconditioner lets no direction out of it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import warp as wp

from .plane_confinement import inverse_in_plane

wp.set_module_options({"enable_backward": False})

_BLOCK_SIZE = 256


@functools.cache
def make_begin_kernel(plane: bool) -> wp.Kernel:
    """The kernel that inverts the diagonal blocks and takes the first search direction; one thread block."""

    @wp.kernel(enable_backward=False, module="unique")
    def begin_solve(
        count: wp.array[int],
        fixed: wp.array[int],
        normal: wp.array[wp.vec3d],
        blocks: wp.array[wp.mat33],
        residual: wp.array[wp.vec3],
        inverses: wp.array[wp.mat33],
        conditioned: wp.array[wp.vec3],
        direction: wp.array[wp.vec3],
        energy: wp.array[wp.float64],
        running: wp.array[int],
        iterations: wp.array[int],
    ):
        thread = wp.tid()
        energy_sum = wp.float64(0.0)
        for i in range(thread, residual.shape[0], wp.block_dim()):
            inverse = wp.mat33()
            if i < count[0] and fixed[i] == 0:
                if wp.static(plane):
                    inverse = wp.mat33(inverse_in_plane(wp.mat33d(blocks[i]), normal[0]))
                else:
                    inverse = wp.mat33(wp.inverse(wp.mat33d(blocks[i])))
            z = inverse * residual[i]
            inverses[i] = inverse
            conditioned[i] = z
            direction[i] = z
            energy_sum += wp.float64(wp.dot(residual[i], z))
        total = wp.tile_sum(wp.tile(energy_sum))[0]
        if thread == 0:
            energy[0] = total
            energy[1] = total
            iterations[0] = 0
            running[0] = wp.where(total > wp.float64(0.0), 1, 0)

    return begin_solve


@wp.kernel(enable_backward=False)
def iterate(
    count: wp.array[int],
    tolerance: wp.float64,
    maximum: int,
    inverses: wp.array[wp.mat33],
    product: wp.array[wp.vec3],
    residual: wp.array[wp.vec3],
    direction: wp.array[wp.vec3],
    conditioned: wp.array[wp.vec3],
    solution: wp.array[wp.vec3],
    energy: wp.array[wp.float64],
    running: wp.array[int],
    iterations: wp.array[int],
):
    """One iteration, given the matrix's product with the direction; one thread block."""
    thread = wp.tid()
    end = count[0] * running[0]
    old = energy[0]
    curvature_sum = wp.float64(0.0)
    for i in range(thread, end, wp.block_dim()):
        curvature_sum += wp.float64(wp.dot(direction[i], product[i]))
    curvature = wp.tile_sum(wp.tile(curvature_sum))[0]
    alpha = wp.float64(0.0)
    if curvature > wp.float64(0.0):
        alpha = old / curvature
    energy_sum = wp.float64(0.0)
    for i in range(thread, end, wp.block_dim()):
        solution[i] += float(alpha) * direction[i]
        r = residual[i] - float(alpha) * product[i]
        z = inverses[i] * r
        residual[i] = r
        conditioned[i] = z
        energy_sum += wp.float64(wp.dot(r, z))
    new = wp.tile_sum(wp.tile(energy_sum))[0]
    beta = float(0.0)
    if old > wp.float64(0.0):
        beta = float(new / old)
    for i in range(thread, end, wp.block_dim()):
        direction[i] = conditioned[i] + beta * direction[i]
    if thread == 0 and end > 0:
        energy[0] = new
        iterations[0] += 1
        if not (new > tolerance * tolerance * energy[1] and alpha > wp.float64(0.0) and iterations[0] < maximum):
            running[0] = 0


class ConjugateGradient:
    """A preallocated solver of one symmetric positive definite system of 3-vectors.

    Fill ``residual`` (right-hand side minus matrix times ``solution``), ``blocks`` and ``solution``, then call
    :meth:`solve`. Rows from the count on, and fixed ones, keep their part of ``solution``.

    Args:
        count: Number of rows in use, shape (1,).
        fixed: Nonzero for rows that keep their value, shape (capacity,).
        normal: Unit normal of the plane that changes of the solution stay in, shape (1,) vec3d; none by default.
        max_iterations: Iterations after which it stops.
        tolerance: Stops when the preconditioned norm of the residual has shrunk by this factor.
    """

    def __init__(
        self,
        count: wp.array,
        fixed: wp.array,
        *,
        normal: wp.array | None = None,
        max_iterations: int,
        tolerance: float,
    ):
        capacity, self.device = fixed.shape[0], fixed.device
        self.max_iterations = max_iterations
        with wp.ScopedDevice(self.device):
            self.residual, self.solution, self.direction, self.product, self._conditioned = (
                wp.zeros(capacity, dtype=wp.vec3) for _ in range(5)
            )
            self.blocks, self._inverses = (wp.zeros(capacity, dtype=wp.mat33) for _ in range(2))
            self._energy = wp.zeros(2, dtype=wp.float64)
            self._running, self.iterations = (wp.zeros(1, dtype=int) for _ in range(2))
        self._running_view = self._running.numpy() if self.device.is_cpu else None
        self._begin = self._record(
            make_begin_kernel(normal is not None),
            [count, fixed, normal, self.blocks, self.residual, self._inverses, self._conditioned, self.direction],
        )
        self._iterate = self._record(
            iterate,
            [count, wp.float64(tolerance), max_iterations, self._inverses, self.product, self.residual]
            + [self.direction, self._conditioned, self.solution],
        )

    def solve(self, multiply: Callable[[], None]) -> None:
        """Improve ``solution`` until the residual is small.

        Args:
            multiply: Launches the matrix's product with ``direction`` into ``product``.
        """
        self._begin.launch()
        if self.device.is_cuda and self.device.is_capturing and wp.is_conditional_graph_supported():
            wp.capture_while(self._running, self._advance, multiply=multiply)
            return
        for _ in range(self.max_iterations):
            if self._running_view is not None and not self._running_view[0]:
                return
            self._advance(multiply)

    def _advance(self, multiply: Callable[[], None]) -> None:
        """One iteration."""
        multiply()
        self._iterate.launch()

    def _record(self, kernel: wp.Kernel, inputs: list) -> wp.Launch:
        """A launch of one thread block, ready to be repeated."""
        size = _BLOCK_SIZE if self.device.is_cuda else 1
        return wp.launch(
            kernel,
            dim=size,
            inputs=[*inputs, self._energy, self._running, self.iterations],
            block_dim=size,
            device=self.device,
            record_cmd=True,
        )
