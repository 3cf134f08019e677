# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What all time integrators have: a body, what its steps work on, the linear system of them and its solver."""

from __future__ import annotations

from typing import NamedTuple

import warp as wp

from .arrays import BodyArrays, make_linear_system, make_step_arrays
from .launching import launch_later
from .solve.elastic_residual import make_residual_kernel
from .solve.linear_solver import LinearSolver, SolveLimits
from .solve.point_forces import PointForces
from .stages import step_record
from .step_kernels import make_strain_kernel


class Motion(NamedTuple):
    """Where a body's vertices are and how fast; shapes (vertex_capacity,) vec3."""

    positions: wp.array
    """Positions [m]."""
    velocities: wp.array
    """Velocities [m/s]."""


class ImplicitIntegrator:
    """Steps a body; a step only launches kernels.

    Args:
        body: The body.
        model: Its constitutive model.
        limits: How exactly systems are solved.
        record: Where the steps are recorded.
    """

    def __init__(self, body: BodyArrays, model: str, *, limits: SolveLimits, record: step_record.StepRecord) -> None:
        self.device, self.is_plane = body.rest.device, body.normal is not None
        self.body, self.arrays, self.system = body, make_step_arrays(body), make_linear_system(body)
        self.solver, self.record = LinearSolver(body, self.arrays, self.system, limits), record
        self._vertex_capacity, self._point_count = body.rest.shape[0], body.volumes.shape[0]
        self._no_forces = wp.zeros(self._vertex_capacity, dtype=wp.vec3, device=self.device)
        arrays, solver = self.arrays, self.solver
        self._gather_drift = solver.gathering(arrays.predicted, arrays.drift)
        self._strain_launches = (
            solver.gathering(arrays.displacement, arrays.strain),
            self._gather_drift,
            launch_later(make_strain_kernel(model, self.is_plane), self._point_count, [body, arrays], self.device),
        )
        residual = make_residual_kernel(solver.width)
        self._add_elastic_residual = self._per_vertex(residual, [body, self.system, solver.lanes])
        search, tolerance = solver.search, wp.float64(limits.tolerance)
        self._begin_record = self._once(step_record.begin_record, [record, solver.matrix])
        self._note_solve = self._once(step_record.note_solve, [search.iterations, search.energy, record])
        self._end_record = self._once(step_record.end_record, [tolerance, record])

    def _solve(self, points: PointForces | None) -> None:
        """Solve the system, and record how that went."""
        self.solver.solve(points)
        self._note_solve.launch()

    def _find_strain(self) -> None:
        """Stress and stiffness at the points, for ``displacement`` and ``predicted``."""
        for launch in self._strain_launches:
            launch.launch()

    def _launch(self, kernel: wp.Kernel, inputs: list) -> None:
        """One launch over the vertices, whose arguments change."""
        wp.launch(kernel, dim=self._vertex_capacity, inputs=inputs, device=self.device)

    def _once(self, kernel: wp.Kernel, inputs: list) -> wp.Launch:
        """A launch of one thread that is not made yet."""
        return launch_later(kernel, 1, inputs, self.device)

    def _per_vertex(self, kernel: wp.Kernel, inputs: list) -> wp.Launch:
        """A launch over the vertices that is not made yet."""
        return launch_later(kernel, self._vertex_capacity, inputs, self.device)

    def _per_point(self, kernel: wp.Kernel, inputs: list) -> wp.Launch:
        """A launch over the quadrature points that is not made yet."""
        return launch_later(kernel, self._point_count, inputs, self.device)
