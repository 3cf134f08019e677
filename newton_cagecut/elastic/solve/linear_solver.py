# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The solver of a body's linear systems: which preconditioner it has, what it keeps between solves, its launches."""

from __future__ import annotations

from typing import NamedTuple

import warp as wp

from ..arrays import CPU_WIDTH, BodyArrays, LinearSystem, StepArrays, padded_count
from ..launching import block_later, launch_later
from . import lanes
from .cholesky import make_factor_kernel
from .conjugate_gradient import make_search, make_solve_kernel
from .expansion import expand_stiffness, make_block_kernel
from .point_forces import PointForces, no_point_forces
from .point_kernels import make_point_product_kernel, make_point_residual_kernel
from .stiffness_matrix import COLUMNS, ROWS, make_assembly_kernel, make_dense_matrix, make_point_kernel

DENSE_VERTICES = 600
"""Vertices, spare ones included, up to which a factor pays; measured by ``benchmarks.solve``."""


class SolveLimits(NamedTuple):
    """How exactly systems are solved."""

    max_iterations: int = 150
    """Most iterations of a solve."""
    tolerance: float = 1.0e-5
    """Factor by which a solve shrinks the preconditioned residual."""
    dense_vertices: int = DENSE_VERTICES
    """Most vertices, spare ones included, with which a dense factor conditions the iterations."""


class LinearSolver:
    """Solves the systems of one body's steps; everything is allocated here, and solves only launch kernels.

    Fill ``residual`` and ``solution`` of the system and the step's ``stiffnesses``, then call :meth:`solve`.

    Args:
        body: The body.
        step: What its steps work on.
        system: The system.
        limits: How exactly they are solved.
    """

    def __init__(self, body: BodyArrays, step: StepArrays, system: LinearSystem, limits: SolveLimits) -> None:
        capacity, self.device = body.rest.shape[0], body.rest.device
        self.body, self.step, self.system, self.limits = body, step, system, limits
        self.is_dense = capacity <= limits.dense_vertices
        self.width = width = lanes.lane_width(self.device)
        rows = padded_count(capacity)
        self.lanes, self.search = lanes.make_lanes(body, step, width), make_search(rows, self.device)
        self.matrix = make_dense_matrix(3 * rows if self.is_dense else CPU_WIDTH, self.device)
        self._changes = wp.zeros_like(self.lanes.tensions)
        self._no_points = no_point_forces(capacity, self.device)
        self._points: PointForces | None = None
        self._record_launches()
        self._aim(self._no_points)

    def refresh(self) -> None:
        """Bring the gradients' lanes up to date after an edit."""
        self._pack.launch()

    def add_residual(self, points: PointForces, guess: wp.array, earlier: wp.array) -> None:
        """Add the forces on points to the residual.

        Args:
            points: The forces.
            guess: What the matrix is multiplied with in the first guess, one a vertex: velocities or displacements.
            earlier: What the velocity after the step lacks then of the damping's part, one a vertex [m/s].
        """
        inputs = [guess, earlier, self.step, self.system, points, self.search]
        self._launch_block(make_point_residual_kernel(self.width), inputs)

    def add_product(self, points: PointForces, values: wp.array, product: wp.array) -> None:
        """Add the product of the points' part of the matrix with a vertex field, after :meth:`add_residual`."""
        self._launch_block(make_point_product_kernel(self.width), [values, self.system, points, self.search, product])

    def solve(self, points: PointForces | None) -> None:
        """Improve ``solution`` until the residual is small.

        Args:
            points: The forces on points, whose residual was added.
        """
        self._aim(self._no_points if points is None else points)
        self._expand.launch()
        for launch in self._solve_launches:
            launch.launch()

    def gathering(self, values: wp.array, result: wp.array) -> wp.Launch:
        """The launch that finds the gradients of a vertex field at the points.

        Args:
            values: The field, one a vertex.
            result: Float rows, shape (9, padded point count).
        """
        inputs = [values, self.body, self.lanes, lanes.in_lanes(result, self.width)]
        return launch_later(lanes.make_gather_kernel(self.width), self._block_count, inputs, self.device)

    @property
    def _block_count(self) -> int:
        """Blocks of quadrature points."""
        return self.lanes.tensions.shape[1]

    def _launch_block(self, kernel: wp.Kernel, inputs: list) -> None:
        """One launch of one thread block."""
        block_later(kernel, inputs, self.device).launch()

    def _record_launches(self) -> None:
        """Prepare the launches that do not depend on forces on points."""
        body, device, width, capacity = self.body, self.device, self.width, self.body.rest.shape[0]
        pack, shape = lanes.make_pack_kernel(width), (capacity, self._block_count)
        self._pack = launch_later(pack, shape, [body, self.lanes], device)
        self._expand = launch_later(expand_stiffness, body.volumes.shape[0], [self.step], device)

    def _aim(self, points: PointForces) -> None:
        """Prepare the launches of solves with these forces on points."""
        if points is self._points:
            return
        self._points = points
        body, step, system, device, width = self.body, self.step, self.system, self.device, self.width
        capacity, plane = body.rest.shape[0], body.normal is not None
        matrix_lanes = lanes.in_lanes(self.matrix.values, width)
        row_lanes = lanes.in_lanes(self.search.rows, width)
        inputs = [
            wp.float64(self.limits.tolerance),
            self.limits.max_iterations,
            body,
            step,
            system,
            points,
            self.search,
            self.matrix,
            self.lanes,
            self._changes,
        ]
        solve = block_later(make_solve_kernel(width, self.is_dense, plane), [*inputs, matrix_lanes, row_lanes], device)
        if not self.is_dense:
            blocks = launch_later(make_block_kernel(width), capacity, [body, step, system, points, self.lanes], device)
            self._solve_launches = (blocks, solve)
            return
        tiles = (-(-capacity // ROWS), -(-capacity // COLUMNS), 3)
        self._solve_launches = (
            launch_later(make_assembly_kernel(width), tiles, [body, step, self.lanes, self.matrix], device),
            launch_later(
                make_point_kernel(width), (capacity, -(-capacity // width)), [body, points, self.matrix], device
            ),
            block_later(make_factor_kernel(width), [body.vertex_count, self.matrix, matrix_lanes], device),
            solve,
        )
