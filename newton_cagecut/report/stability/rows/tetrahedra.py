# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on the same bodies as tetrahedra, stepped by Newton's own solvers."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import newton
import numpy as np
import warp as wp

from ....elastic import Material
from ..outcome import Outcome
from ..workbench import CUBE, Workbench
from .starts import FRAME

_ITERATIONS = 10
"""Iterations of a step: SolverVBD's default."""
SOLVERS = {"SolverVBD": newton.solvers.SolverVBD, "SolverXPBD": newton.solvers.SolverXPBD}


class Grid:
    """A box of tetrahedra.

    Args:
        cells: Cells along each axis; five tetrahedra a cell.
        size: Lengths [m].
        material: Its Lame constants are those of the tetrahedra.
        clamped: Whether the vertices at x = 0 are held.
        iterations: Iterations of a step.
        solver: Newton's solver, one of ``SOLVERS``.
    """

    def __init__(
        self,
        cells: tuple[int, int, int],
        size: tuple[float, float, float],
        material: Material,
        *,
        clamped: bool = False,
        iterations: int = _ITERATIONS,
        solver: str = "SolverVBD",
    ) -> None:
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
        spacing = dict(zip(("cell_x", "cell_y", "cell_z"), np.divide(size, cells).tolist(), strict=True))
        counts = dict(zip(("dim_x", "dim_y", "dim_z"), cells, strict=True))
        place = {"pos": wp.vec3(0.0, -0.5 * size[1], -0.5 * size[2]), "rot": wp.quat_identity(), "vel": wp.vec3()}
        constants = {"k_mu": material.lame[0], "k_lambda": material.lame[1], "k_damp": 0.0}
        builder.add_soft_grid(**place, **counts, **spacing, **constants, density=material.density, fix_left=clamped)
        builder.color()
        self.model = builder.finalize()
        self.solver = SOLVERS[solver](self.model, iterations=iterations)
        self.state, self._other = self.model.state(), self.model.state()
        self.masses, self.iterations = self.model.particle_mass.numpy().astype(float), iterations
        self._seconds, self._steps = 0.0, 0

    @property
    def positions(self) -> np.ndarray:
        """Positions [m]."""
        return self.state.particle_q.numpy().astype(float)

    @property
    def velocities(self) -> np.ndarray:
        """Velocities [m/s]."""
        return self.state.particle_qd.numpy().astype(float)

    def angular_momentum(self) -> np.ndarray:
        """Angular momentum about the centre of mass [kg m^2/s]."""
        arms = self.positions - self.masses @ self.positions / self.masses.sum()
        return np.cross(arms, self.masses[:, None] * self.velocities).sum(axis=0)

    def run(self, steps: int, dt: float, force: np.ndarray | None = None) -> None:
        """Take steps under forces [N]."""
        for _ in range(steps):
            self.state.clear_forces()
            if force is not None:
                self.state.particle_f.assign(force)
            start = time.perf_counter()
            self.solver.step(self.state, self._other, None, None, dt)
            wp.synchronize_device(self.model.device)
            self._seconds += time.perf_counter() - start
            self._steps += 1
            self.state, self._other = self._other, self.state

    def outcome(self, error: float, against: str, note: str) -> Outcome:
        """What has come out."""
        return Outcome(
            finite=bool(np.isfinite(self.positions).all()),
            iterations=self.iterations,
            step_count=self._steps,
            error=error,
            against=against,
            milliseconds=1.0e3 * self._seconds / max(self._steps, 1),
            note=f"{note}; {len(self.masses)} vertices",
        )


def spin(bench: Workbench, solver: str, young: float) -> Outcome:
    """The spinning cube of the motion rows."""
    grid = Grid((4, 4, 4), CUBE, Material(young=young), solver=solver)
    rest = grid.positions
    spun = np.cross((0.0, 0.0, 2.0 * np.pi), rest - grid.masses @ rest / grid.masses.sum())
    grid.state.particle_qd.assign(spun.astype(np.float32))
    start = grid.angular_momentum()
    grid.run(60, FRAME)
    kept = float(grid.angular_momentum() @ start / (start @ start))
    return grid.outcome(abs(kept - 1.0), "angular momentum at the start", f"{100.0 * kept:.1f} % kept")


ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = tuple(
    (f"{solver}: spin, {young:.0e} Pa", partial(spin, solver=solver, young=young), young == 1.0e6)
    for solver in SOLVERS
    for young in (1.0e4, 1.0e6, 1.0e8)
)
