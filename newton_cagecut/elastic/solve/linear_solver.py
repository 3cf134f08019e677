# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The solver of a body's linear systems: which preconditioner it has, what it keeps between solves, its launches."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import warp as wp

from ..arrays import CPU_WIDTH, BodyArrays, LinearSystem, StepArrays, padded_count
from ..launching import block_later, launch_later
from . import lanes
from .cholesky import make_factor_kernel
from .conjugate_gradient import make_search, make_solve_kernel
from .expansion import expand_stiffness, make_block_kernel
from .point_forces import PointForces, make_point_forces
from .point_kernels import add_point_impulse, add_point_product, add_point_residual
from .stiffness_matrix import ROWS, add_points, make_assembly_kernel, make_column_kernel, make_dense_matrix

_NEARLY_INCOMPRESSIBLE = 0.45
"""Poisson's ratio from which on the iterations without a factor are many."""


class SolveLimits(NamedTuple):
    """How exactly systems are solved."""

    max_iterations: int = 150
    """Most iterations of a solve."""
    tolerance: float = 1.0e-5
    """Factor by which a solve shrinks the preconditioned residual."""
    dense_vertices: int | None = None
    """Most vertices in use, when the system is made, with which a dense factor conditions the iterations; None for what
    ``benchmarks.solve`` has measured to pay."""

    def measured(self, poisson: float) -> SolveLimits:
        """The same with the number of vertices up to which a factor pays at a Poisson's ratio, unless it is given."""
        if self.dense_vertices is not None:
            return self
        return self._replace(dense_vertices=300 if poisson >= _NEARLY_INCOMPRESSIBLE else 110)


class LinearSolver:
    """Solves the systems of one body's steps; everything is allocated here, and solves only launch kernels.

    Fill ``residual`` and ``solution`` of the system and the step's ``stiffnesses``, then call :meth:`solve`.

    Args:
        body: The body.
        step: What its steps work on.
        system: The system.
        limits: How exactly they are solved, measured.
    """

    def __init__(self, body: BodyArrays, step: StepArrays, system: LinearSystem, limits: SolveLimits) -> None:
        capacity, self.device = body.rest.shape[0], body.rest.device
        self.body, self.step, self.system, self.limits = body, step, system, limits
        self.is_dense = int(body.vertex_count.numpy()[0]) <= limits.dense_vertices
        self.width = width = lanes.lane_width(self.device)
        rows = padded_count(capacity)
        self.lanes, self.search = lanes.make_lanes(body, step, width), make_search(rows, self.device)
        self.matrix = make_dense_matrix(3 * rows if self.is_dense else CPU_WIDTH, self.device)
        if self.is_dense:
            shape = (body.volumes.shape[0], 3, rows)
            self._rows = wp.zeros(shape, dtype=float, device=self.device)
            self._columns = lanes.in_lanes(self._rows, width)
            step.blocks = wp.zeros((shape[0], 9), dtype=wp.mat33, device=self.device)
        self._changes = wp.zeros_like(self.lanes.tensions)
        self._no_points = make_point_forces(wp.zeros((1, capacity), dtype=float, device=self.device), 0, 1)
        self._points: PointForces | None = None
        self._record_launches()
        self._aim(self._no_points)

    def refresh(self) -> None:
        """Bring the gradients' lanes up to date after an edit."""
        for launch in self._refresh_launches:
            launch.launch()

    def adding_residual(self, guess: wp.array, earlier: wp.array) -> Callable[[PointForces], None]:
        """The function that adds forces on points to the residual; it only launches a kernel.

        Args:
            guess: What the matrix is multiplied with in the first guess, one a vertex: velocities or displacements.
            earlier: What the velocity after the step lacks then of the damping's part, one a vertex [m/s].
        """
        return self._with_points(add_point_residual, lambda points: [guess, earlier, self.step, self.system, points])

    def adding_product(self, values: wp.array, product: wp.array) -> Callable[[PointForces], None]:
        """The function that adds the product of the points' matrix with a field, once the residual was added.

        Args:
            values: The field, one a vertex.
            product: Where the product is added.
        """
        return self._with_points(add_point_product, lambda points: [values, product, self.system, points])

    def adding_impulse(self, moved: wp.array, velocities: wp.array) -> Callable[[PointForces], None]:
        """The function that adds what forces on points give to the body to their impulses.

        Args:
            moved: Displacements since the start of the step, one a vertex [m].
            velocities: Velocities, one a vertex [m/s].
        """
        return self._with_points(add_point_impulse, lambda points: [moved, velocities, self.step, self.system, points])

    def _with_points(self, kernel: wp.Kernel, inputs: Callable[[PointForces], list]) -> Callable[[PointForces], None]:
        """The function that launches a kernel of one thread block with forces on points; the launch is kept."""
        kept: list = [None, None]

        def launch(points: PointForces) -> None:
            if kept[0] is not points:
                kept[:] = points, block_later(kernel, [*inputs(points), self.search], self.device)
            kept[1].launch()

        return launch

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

    def _record_launches(self) -> None:
        """Prepare the launches that do not depend on forces on points."""
        body, device, width, capacity = self.body, self.device, self.width, self.body.rest.shape[0]
        pack, shape = lanes.make_pack_kernel(width), (capacity, self._block_count)
        self._refresh_launches = [launch_later(pack, shape, [body, self.lanes], device)]
        if self.is_dense:
            kernel, shape = make_column_kernel(width), (body.volumes.shape[0], self._columns.shape[2])
            self._refresh_launches.append(launch_later(kernel, shape, [body, self._columns], device))
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
        tiles = (-(-capacity // ROWS), self._columns.shape[2], 9)
        assembly = [body, step, self._columns, self._rows, self.matrix]
        self._solve_launches = (
            launch_later(make_assembly_kernel(width), tiles, assembly, device),
            launch_later(add_points, (capacity, -(-capacity // ROWS)), [body, points, self.matrix], device),
            block_later(make_factor_kernel(width), [body.vertex_count, self.matrix, matrix_lanes], device),
            solve,
        )
