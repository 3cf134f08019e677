# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Backward Euler with a single Newton step (paper, section 6.1).

(M + dt C + dt^2 K) dv = dt (f + M g + f_ext - C v - dt K v) with C = damping K, K projected to be positive
semidefinite. Nothing is assembled but the small mass matrix: K acts through the quadrature points. The solve starts
from dv = dt g, so that free fall is exact.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import warp as wp

from . import limit, plane_confinement, step_kernels
from .arrays import BodyArrays, make_linear_system, make_step_arrays
from .conjugate_gradient import ConjugateGradient
from .launching import record, record_block
from .stages.step_record import StepRecord


class Motion(NamedTuple):
    """Where a body's vertices are and how fast; shapes (vertex_capacity,) vec3."""

    positions: wp.array
    """Positions [m]."""
    velocities: wp.array
    """Velocities [m/s]."""


class TermScales(NamedTuple):
    """Factors of a further term in the system that is solved."""

    force: float
    """Of forces."""
    stiffness: float
    """Of stiffness."""
    damping: float
    """Of damping."""


class LinearTerm(Protocol):
    """A term that a step adds to the system, such as contact. Both methods only launch kernels.

    A force f - S s - D v, with s the displacement and v the velocity after a step, and f at the positions before it,
    adds the matrix stiffness S + damping D, with the factors of ``TermScales``. The solution changes s and v together.
    What it adds for fixed vertices is ignored.
    """

    def add_residual(
        self, scales: TermScales, guess: wp.array, earlier: wp.array, residual: wp.array, blocks: wp.array
    ) -> None:
        """Add to the residual and to the matrix's 3x3 diagonal blocks.

        Args:
            scales: The factors.
            guess: What the matrix is multiplied with in the first guess, one a vertex: velocities or displacements.
            earlier: What the velocity after the step lacks then of the damping's part, one a vertex [m/s].
            residual: The residual: force f + force D earlier - matrix guess is added.
            blocks: The diagonal blocks.
        """

    def add_product(self, direction: wp.array, product: wp.array) -> None:
        """Add the matrix term's product with the direction."""


class BackwardEuler:
    """Steps a body; a step only launches kernels.

    Args:
        body: The body.
        model: Its constitutive model.
        max_iterations: Most iterations of a solve.
        tolerance: Factor by which a solve shrinks the preconditioned residual.
    """

    def __init__(self, body: BodyArrays, model: str, *, max_iterations: int, tolerance: float, step_record: StepRecord):
        self.device, self.is_plane = body.rest.device, body.normal is not None
        self.body, self.arrays = body, make_step_arrays(body)
        self.system = make_linear_system(body.vertex_count, body.fixed, body.normal)
        self.solver = ConjugateGradient(self.system, max_iterations=max_iterations, tolerance=tolerance)
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
        body, step, system = self.body, self.arrays, self.system
        self._launch(step_kernels.begin_step, [dt, *before, gravity, body, step, system])
        if self.is_plane:
            self._launch(plane_confinement.confine_start, [body, step, system])
        self._strain.launch()
        forces = self._no_forces if forces is None else forces
        self._launch(step_kernels.find_residual, [dt, forces, body, step, system])
        self._solve(dt, term)
        self._launch(limit.find_velocities, [before.velocities, step, system])
        if self.is_plane:
            self._launch(plane_confinement.confine_velocities, [body, step])
        wp.launch(limit.find_rates, dim=self._point_count, inputs=[dt, body, step], device=self.device)
        self._find_limit.launch()
        self._launch(limit.finish_step, [dt, *before, body, step, *after])
        if self.is_plane:
            self._launch(plane_confinement.confine_end, [body, *after])

    def _solve(self, dt: float, term: LinearTerm | None) -> None:
        """Solve for the change of the velocities."""
        if term is None:
            self.solver.solve(self._multiply)
            return
        scales = TermScales(dt, dt * dt, dt)
        term.add_residual(scales, self.arrays.predicted, self._no_forces, self.system.residual, self.system.blocks)
        self.solver.solve(lambda: self._multiply_with(term))

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
        body, step, search, device = self.body, self.arrays, self.solver.search, self.device
        strain = step_kernels.make_strain_kernel(model, self.is_plane)
        tensions = [search.direction, body, step]
        self._strain = record(strain, self._point_count, [body, step], device)
        self._find_tensions = record(step_kernels.find_tensions, self._point_count, tensions, device)
        self._multiply_system = record(
            step_kernels.multiply_system, self._vertex_capacity, [*tensions, search.product], device
        )
        self._find_limit = record_block(limit.find_limit, [body, step], device)
