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

from .arrays import LinearSystem
from .launching import record_block
from .plane_confinement import inverse_in_plane

wp.set_module_options({"enable_backward": False})


@wp.struct
class Search:
    """What the iterations work on."""

    direction: wp.array[wp.vec3]
    """The search direction, one a row."""
    product: wp.array[wp.vec3]
    """The matrix's product with the direction, one a row."""
    conditioned: wp.array[wp.vec3]
    """The preconditioned residual, one a row."""
    inverses: wp.array[wp.mat33]
    """Inverses of the diagonal blocks, one a row."""
    energy: wp.array[wp.float64]
    """Squared preconditioned norm of the residual now and at the start, shape (2,)."""
    running: wp.array[int]
    """Whether the solve has not ended, shape (1,)."""
    iterations: wp.array[int]
    """Iterations so far, shape (1,)."""


@functools.cache
def make_begin_kernel(plane: bool) -> wp.Kernel:
    """The kernel that inverts the diagonal blocks and takes the first search direction; one thread block."""

    @wp.kernel(enable_backward=False, module="unique")
    def begin_solve(system: LinearSystem, search: Search):
        thread = wp.tid()
        energy_sum = wp.float64(0.0)
        for i in range(thread, system.residual.shape[0], wp.block_dim()):
            inverse = wp.mat33()
            if i < system.row_count[0] and system.fixed[i] == 0:
                if wp.static(plane):
                    inverse = wp.mat33(inverse_in_plane(wp.mat33d(system.blocks[i]), system.normal[0]))
                else:
                    inverse = wp.mat33(wp.inverse(wp.mat33d(system.blocks[i])))
            r = system.residual[i]
            z = inverse * r
            search.inverses[i] = inverse
            search.conditioned[i] = z
            search.direction[i] = z
            energy_sum += wp.float64(wp.dot(r, z))
        total = wp.tile_sum(wp.tile(energy_sum))[0]
        if thread == 0:
            search.energy[0] = total
            search.energy[1] = total
            search.iterations[0] = 0
            search.running[0] = wp.where(total > wp.float64(0.0), 1, 0)

    return begin_solve


@wp.kernel(enable_backward=False)
def iterate(system: LinearSystem, search: Search, tolerance: wp.float64, max_iterations: int):
    """One iteration, given the matrix's product with the direction; one thread block."""
    thread = wp.tid()
    end = system.row_count[0] * search.running[0]
    old = search.energy[0]
    curvature_sum = wp.float64(0.0)
    for i in range(thread, end, wp.block_dim()):
        curvature_sum += wp.float64(wp.dot(search.direction[i], search.product[i]))
    curvature = wp.tile_sum(wp.tile(curvature_sum))[0]
    alpha = wp.float64(0.0)
    if curvature > wp.float64(0.0):
        alpha = old / curvature
    energy_sum = wp.float64(0.0)
    for i in range(thread, end, wp.block_dim()):
        system.solution[i] += float(alpha) * search.direction[i]
        r = system.residual[i] - float(alpha) * search.product[i]
        z = search.inverses[i] * r
        system.residual[i] = r
        search.conditioned[i] = z
        energy_sum += wp.float64(wp.dot(r, z))
    new = wp.tile_sum(wp.tile(energy_sum))[0]
    beta = float(0.0)
    if old > wp.float64(0.0):
        beta = float(new / old)
    for i in range(thread, end, wp.block_dim()):
        search.direction[i] = search.conditioned[i] + beta * search.direction[i]
    if thread == 0 and end > 0:
        search.energy[0] = new
        search.iterations[0] += 1
        improvable = new > tolerance * tolerance * search.energy[1] and alpha > wp.float64(0.0)
        if not (improvable and search.iterations[0] < max_iterations):
            search.running[0] = 0


class ConjugateGradient:
    """A preallocated solver of one symmetric positive definite system of 3-vectors.

    Fill ``residual``, ``blocks`` and ``solution`` of the system, then call :meth:`solve`.

    Args:
        system: The system; solutions that are confined to a plane cost nothing more.
        max_iterations: Iterations after which it stops.
        tolerance: Stops when the preconditioned norm of the residual has shrunk by this factor.
    """

    def __init__(self, system: LinearSystem, *, max_iterations: int, tolerance: float):
        capacity, self.device = system.residual.shape[0], system.residual.device
        self.system, self.search = system, Search()
        self.max_iterations = max_iterations
        search = self.search
        with wp.ScopedDevice(self.device):
            search.direction, search.product, search.conditioned = (wp.zeros(capacity, dtype=wp.vec3) for _ in range(3))
            search.inverses = wp.zeros(capacity, dtype=wp.mat33)
            search.energy = wp.zeros(2, dtype=wp.float64)
            search.running, search.iterations = (wp.zeros(1, dtype=int) for _ in range(2))
        self._running_view = search.running.numpy() if self.device.is_cpu else None
        begin = make_begin_kernel(system.normal is not None)
        self._begin = record_block(begin, [system, search], self.device)
        self._iterate = record_block(iterate, [system, search, wp.float64(tolerance), max_iterations], self.device)

    def solve(self, multiply: Callable[[], None]) -> None:
        """Improve ``solution`` until the residual is small.

        Args:
            multiply: Launches the matrix's product with the search's ``direction`` into its ``product``.
        """
        self._begin.launch()
        if self.device.is_cuda and self.device.is_capturing and wp.is_conditional_graph_supported():
            wp.capture_while(self.search.running, self._advance, multiply=multiply)
            return
        for _ in range(self.max_iterations):
            if self._running_view is not None and not self._running_view[0]:
                return
            self._advance(multiply)

    def _advance(self, multiply: Callable[[], None]) -> None:
        """One iteration."""
        multiply()
        self._iterate.launch()
