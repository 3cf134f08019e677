# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Steps in stages, each solved by Newton's method from a rigid motion, one linear solve an iteration."""

from __future__ import annotations

import warp as wp

from ..arrays import BodyArrays
from ..implicit_integrator import ImplicitIntegrator, Motion
from ..solve.linear_solver import SolveLimits
from ..solve.point_forces import PointForces
from . import rigid_fit, stage_kernels, start_forces, start_limit
from .line_search import LineSearch
from .scheme import Scheme, courses_of
from .stage_arrays import StageFactors, make_piece_arrays, make_stage_arrays, make_stage_factors
from .step_record import StepRecord


class StageIntegrator(ImplicitIntegrator):
    """Steps a body in stages.

    Args:
        body: The body.
        model: Its constitutive model.
        scheme: The stages of a step.
        newton_iterations: Linear solves in each stage.
        limits: How exactly systems are solved.
        record: Where the steps are recorded.
    """

    def __init__(
        self,
        body: BodyArrays,
        model: str,
        scheme: Scheme,
        *,
        newton_iterations: int,
        limits: SolveLimits,
        record: StepRecord,
    ) -> None:
        super().__init__(body, model, limits=limits, record=record)
        self.stage, self.pieces = make_stage_arrays(body), make_piece_arrays(body)
        self.line_search = LineSearch(self, model, self.stage, self.pieces)
        self._newton_iterations = newton_iterations
        self._not_touching = wp.zeros(1, dtype=int, device=self.device)
        self._record_launches(scheme)

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
        body, arrays, stage = self.body, self.arrays, self.stage
        loads = [gravity, self._no_forces if forces is None else forces]
        touching = self._not_touching if points is None else points.count
        self._begin_record.launch()
        inputs = [wp.float64(dt), *before, *loads, touching, body, arrays, stage, self.record]
        self._launch(stage_kernels.begin_stages, inputs)
        for launch in self._limit_launches:
            launch.launch()
        for launches in self._stage_launches:
            self._make_stage(launches, points)
        self._launch(stage_kernels.end_stages, [before.velocities, body, arrays, stage, self.record])
        self._launch(stage_kernels.accept_step, [*before, stage, self.record, *after])
        self._end_record.launch()

    def _make_stage(self, launches: tuple[wp.Launch, ...], points: PointForces | None) -> None:
        """One stage, from what the last one has reached."""
        for launch in launches:
            launch.launch()
        for iteration in range(self._newton_iterations):
            self._show_moved.launch()
            if iteration > 0:
                self._find_strain()
            self._improve(points)
        self._end_stage.launch()
        if points is not None:
            self._add_point_impulse(points)

    def _improve(self, points: PointForces | None) -> None:
        """One iteration of Newton's method."""
        self._inertial_residual.launch()
        if points is not None:
            self._add_point_residual(points)
        self._add_elastic_residual.launch()
        self._solve(points)
        self._multiply_inertia.launch()
        if points is not None:
            self._add_point_product(points)
        self.line_search.launch()
        self._take_solution.launch()

    def _record_launches(self, scheme: Scheme) -> None:
        """Prepare the launches whose arguments never change."""
        body, step, stage, pieces, system = self.body, self.arrays, self.stage, self.pieces, self.system
        moving, started = [body, stage, pieces], [body, step, stage, pieces]
        find_centers = self._per_vertex(rigid_fit.find_centers, moving)
        self._limit_launches = (
            find_centers,
            self._per_vertex(start_forces.find_spins, moving),
            self._per_vertex(start_limit.fit_spins, moving),
            self._per_vertex(start_limit.find_relative, started),
            self._gather_drift,
            self._per_point(start_limit.find_changes, [body, step]),
            self._per_vertex(start_limit.choose_limits, [body, step, pieces, self.record]),
            self._per_vertex(start_limit.limit_velocities, started),
        )
        add_start_forces = start_forces.make_start_kernel(self.solver.width)
        start_launches = (
            self._per_vertex(start_forces.find_spins, moving),
            self._per_vertex(start_forces.fit_accelerations, started),
            self._per_vertex(add_start_forces, [*started, self.solver.lanes]),
        )
        begin_stage = self._per_vertex(stage_kernels.begin_stage, [body, step, stage])
        guess_launches = (
            self._per_vertex(rigid_fit.find_momenta, moving),
            self._per_vertex(rigid_fit.fit_motions, moving),
            self._per_vertex(rigid_fit.move_rigidly, moving),
            self._per_point(stage_kernels.turn_strain, [body, step, pieces]),
        )
        self._stage_launches = tuple(
            (
                self._once(stage_kernels.set_scales, [*factors, body, step]),
                *self._strain_launches,
                begin_stage,
                find_centers,
                *(start_launches if free.start_share else ()),
                *guess_launches,
            )
            for free, factors in zip(scheme.free, _factors(scheme), strict=True)
        )
        everything = [body, step, stage, system]
        self._add_point_residual = self.solver.adding_residual(stage.moved_single, stage.earlier_velocity)
        self._add_point_product = self.solver.adding_product(system.solution, stage.product)
        self._add_point_impulse = self.solver.adding_impulse(stage.moved_single, stage.end_velocity)
        self._show_moved = self._per_vertex(stage_kernels.show_moved, everything)
        self._inertial_residual = self._per_vertex(stage_kernels.find_inertial_residual, everything)
        self._multiply_inertia = self._per_vertex(stage_kernels.multiply_inertia, everything)
        self._take_solution = self._per_vertex(stage_kernels.take_solution, [body, stage, pieces, system])
        self._end_stage = self._per_vertex(stage_kernels.end_stage, [body, step, stage])


def _factors(scheme: Scheme) -> list[list[StageFactors]]:
    """The factors of each stage where nothing touches the body, and where something does."""
    kinds = [map(make_stage_factors, stages, courses_of(stages)) for stages in scheme]
    return [list(factors) for factors in zip(*kinds, strict=True)]
