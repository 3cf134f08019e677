# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Backward Euler with a single Newton step (paper, section 6.1).

(M + dt C + dt^2 K) dv = dt (f + M g + f_ext - C v - dt K v) with C = damping K, K projected to be positive
semidefinite. The solve starts from dv = dt g, so that free fall is exact.
"""

from __future__ import annotations

import warp as wp

from . import limit, plane_confinement, step_kernels
from .arrays import BodyArrays
from .implicit_integrator import ImplicitIntegrator, Motion
from .launching import block_later
from .solve.linear_solver import SolveLimits
from .solve.point_forces import PointForces
from .stages.step_record import StepRecord


class BackwardEuler(ImplicitIntegrator):
    """Steps a body as the paper does."""

    def __init__(self, body: BodyArrays, model: str, *, limits: SolveLimits, record: StepRecord) -> None:
        super().__init__(body, model, limits=limits, record=record)
        self._add_point_residual = self.solver.adding_residual(self.arrays.predicted, self._no_forces)
        self._add_point_impulse = self.solver.adding_impulse(self.arrays.displacement, self.arrays.predicted)
        self._find_rates = self._per_point(limit.find_rates, [self.arrays])
        self._find_limit = block_later(limit.find_limit, [body, self.arrays, record], self.device)

    def step(
        self,
        before: Motion,
        after: Motion,
        dt: float,
        *,
        gravity: wp.array,
        forces: wp.array | None,
        points: PointForces | None,
    ) -> None:
        """Advance the vertices by one step; see ``ReducedSystem.step``."""
        body, step, system = self.body, self.arrays, self.system
        forces = self._no_forces if forces is None else forces
        self._begin_record.launch()
        self._launch(step_kernels.begin_step, [dt, *before, gravity, body, step, system])
        if self.is_plane:
            self._launch(plane_confinement.confine_start, [body, step, system])
        self._find_strain()
        self._launch(step_kernels.find_residual, [forces, body, step, system])
        self._add_elastic_residual.launch()
        if points is not None:
            self._add_point_residual(points)
        self._solve(points)
        self._launch(limit.find_velocities, [before.velocities, step, system])
        if self.is_plane:
            self._launch(plane_confinement.confine_velocities, [body, step])
        self._gather_drift.launch()
        self._find_rates.launch()
        self._find_limit.launch()
        self._launch(limit.finish_step, [*before, body, step, *after])
        if points is not None:
            self._add_point_impulse(points)
        if self.is_plane:
            self._launch(plane_confinement.confine_end, [body, *after])
        self._end_record.launch()
