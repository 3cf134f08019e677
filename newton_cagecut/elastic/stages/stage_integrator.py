# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Steps in stages, each solved by Newton's method from a rigid motion, one linear solve an iteration."""

from __future__ import annotations

import warp as wp

from .. import step_kernels
from ..arrays import BodyArrays, make_linear_system, make_step_arrays
from ..backward_euler import LinearTerm, Motion, TermScales
from ..conjugate_gradient import ConjugateGradient
from ..launching import record
from . import rigid_fit, stage_kernels, start_forces, start_limit, step_record
from .line_search import LineSearch
from .scheme import Stage
from .stage_arrays import make_piece_arrays, make_stage_arrays
from .step_record import StepRecord


class StageIntegrator:
    """Steps a body in stages; a step only launches kernels.

    Args:
        body: The body.
        model: Its constitutive model.
        scheme: The stages of a step.
        newton_iterations: Linear solves in each stage.
        max_iterations: Most iterations of a solve.
        tolerance: Factor by which a solve shrinks the preconditioned residual.
        step_record: Where the steps are recorded.
    """

    def __init__(
        self,
        body: BodyArrays,
        model: str,
        scheme: tuple[Stage, ...],
        *,
        newton_iterations: int,
        max_iterations: int,
        tolerance: float,
        step_record: StepRecord,
    ):
        self.device, self.body, self.scheme = body.rest.device, body, scheme
        self.arrays, self.stage, self.pieces = make_step_arrays(body), make_stage_arrays(body), make_piece_arrays(body)
        self.system = make_linear_system(body.vertex_count, body.fixed, body.normal)
        self.solver = ConjugateGradient(self.system, max_iterations=max_iterations, tolerance=tolerance)
        self.record = step_record
        self.line_search = LineSearch(
            model, body, self.arrays, self.stage, self.pieces, self.system, step_record=self.record
        )
        self._newton_iterations, self._tolerance = newton_iterations, tolerance
        self._vertex_capacity, self._point_count = body.rest.shape[0], body.volumes.shape[0]
        self._no_forces = wp.zeros(self._vertex_capacity, dtype=wp.vec3, device=self.device)
        self._record_launches(model)

    def step(
        self,
        before: Motion,
        after: Motion,
        dt: float,
        *,
        gravity: wp.array,
        forces: wp.array | None,
        term: LinearTerm | None,
    ) -> None:
        """Advance the vertices by one step; see ``ReducedSystem.step``."""
        body, arrays, stage = self.body, self.arrays, self.stage
        loads = [gravity, self._no_forces if forces is None else forces]
        self._begin_record.launch()
        self._launch(stage_kernels.begin_stages, [*before, *loads, body, arrays, stage, self.record])
        for launch in self._spin_launches:
            launch.launch()
        wp.launch(start_limit.find_changes, dim=self._point_count, inputs=[dt, body, arrays], device=self.device)
        self._choose_limits.launch()
        self._limit_velocities.launch()
        for factors in self.scheme:
            self._make_stage(factors, dt, loads, term)
        scale = wp.float64(self.scheme[-1].scale * dt)
        self._launch(stage_kernels.end_stages, [scale, before.velocities, body, stage, self.record])
        self._launch(stage_kernels.accept_step, [*before, stage, self.record, *after])
        self._end_record.launch()

    def _make_stage(self, factors: Stage, dt: float, loads: list[wp.array], term: LinearTerm | None) -> None:
        """One stage, from what the last one has reached."""
        body, arrays, stage = self.body, self.arrays, self.stage
        scale = factors.scale * dt
        scales = [scale, factors.damping_share, factors.start_share]
        wp.launch(stage_kernels.set_scales, dim=1, inputs=[*map(wp.float64, scales), body, arrays], device=self.device)
        self._strain.launch()
        targets = [factors.target_velocity * dt, factors.target_reached, factors.velocity_kept]
        targets += [factors.velocity_reached / dt, factors.force_share * scale * scale]
        self._launch(stage_kernels.begin_stage, [*map(wp.float64, targets), *loads, body, stage])
        self._find_centers.launch()
        if factors.start_share:
            for launch in self._start_launches:
                launch.launch()
        for launch in self._guess_launches:
            launch.launch()
        for iteration in range(self._newton_iterations):
            self._show_moved.launch()
            if iteration > 0:
                self._strain.launch()
            self._improve(factors, scale, term)
        self._end_stage.launch()

    def _improve(self, factors: Stage, scale: float, term: LinearTerm | None) -> None:
        """One iteration of Newton's method."""
        system, stage = self.system, self.stage
        self._inertial_residual.launch()
        if term is not None:
            force = factors.force_share * scale * scale
            scales = TermScales(force, force, factors.force_share * scale)
            term.add_residual(scales, stage.moved_single, stage.earlier_velocity, system.residual, system.blocks)
        self._elastic_residual.launch()
        self.solver.solve(self._multiply if term is None else lambda: self._multiply_with(term))
        self._note_solve.launch()
        self._multiply_inertia.launch()
        if term is not None:
            term.add_product(system.solution, stage.product)
        self.line_search.launch()
        self._take_solution.launch()

    def _multiply(self) -> None:
        """The matrix's product with the solver's direction."""
        self._find_tensions.launch()
        self._multiply_system.launch()

    def _multiply_with(self, term: LinearTerm) -> None:
        """The product of the matrix with a further term."""
        self._multiply()
        term.add_product(self.solver.search.direction, self.solver.search.product)

    def _launch(self, kernel: wp.Kernel, inputs: list) -> None:
        """One launch over the vertices."""
        wp.launch(kernel, dim=self._vertex_capacity, inputs=inputs, device=self.device)

    def _record_launches(self, model: str) -> None:
        """Prepare the launches whose arguments never change."""
        body, step, stage, pieces, system = self.body, self.arrays, self.stage, self.pieces, self.system
        search, device, count = self.solver.search, self.device, self._vertex_capacity
        points = self._point_count
        strain = step_kernels.make_strain_kernel(model, body.normal is not None)
        self._strain = record(strain, points, [body, step], device)
        moving = [body, stage, pieces]
        started = [body, step, stage, pieces]
        self._find_centers = record(rigid_fit.find_centers, count, moving, device)
        self._spin_launches = (
            self._find_centers,
            record(start_forces.find_spins, count, moving, device),
            record(start_limit.fit_spins, count, moving, device),
            record(start_limit.find_relative, count, started, device),
        )
        limits = [body, step, pieces, self.record]
        self._choose_limits = record(start_limit.choose_limits, count, limits, device)
        self._limit_velocities = record(start_limit.limit_velocities, count, started, device)
        self._start_launches = (
            record(start_forces.find_spins, count, moving, device),
            record(start_forces.fit_accelerations, count, started, device),
            record(start_forces.add_start_forces, count, started, device),
        )
        self._guess_launches = (
            record(rigid_fit.find_momenta, count, moving, device),
            record(rigid_fit.fit_motions, count, moving, device),
            record(rigid_fit.move_rigidly, count, moving, device),
            record(stage_kernels.turn_strain, points, [body, step, pieces], device),
        )
        everything = [body, step, stage, system]
        self._show_moved = record(stage_kernels.show_moved, count, everything, device)
        self._inertial_residual = record(stage_kernels.find_inertial_residual, count, everything, device)
        self._elastic_residual = record(stage_kernels.add_elastic_residual, count, everything, device)
        self._multiply_inertia = record(stage_kernels.multiply_inertia, count, everything, device)
        self._take_solution = record(stage_kernels.take_solution, count, [body, stage, pieces, system], device)
        self._end_stage = record(stage_kernels.end_stage, count, [body, step, stage], device)
        tensions = [search.direction, body, step]
        self._find_tensions = record(step_kernels.find_tensions, points, tensions, device)
        self._multiply_system = record(step_kernels.multiply_system, count, [*tensions, search.product], device)
        self._begin_record = record(step_record.begin_record, 1, [self.record], device)
        self._note_solve = record(step_record.note_solve, 1, [search.iterations, search.energy, self.record], device)
        self._end_record = record(step_record.end_record, 1, [wp.float64(self._tolerance), self.record], device)
