# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A model with cage bodies that is stepped and watched: energies, momenta, iterations and limited steps."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import newton
import numpy as np
import warp as wp

from ...elastic import Material
from ...solver import SolverCageCut
from .outcome import Outcome

_RECOVERED = 1.0e-3
"""Elastic energy that a body may keep when it has come back to its shape, of that of the start."""

_NOTHING = 1.0e-6
"""Energy of a start that has none but for rounding, of the highest seen."""


class Trial:
    """Bodies of a model, one state of them, and what has been seen since the last :meth:`begin`.

    Args:
        builder: The builder, with cage bodies.
        collide: Whether bodies touch shapes.
        options: Options of the solver.
    """

    def __init__(self, builder: newton.ModelBuilder, *, collide: bool = False, **options: object) -> None:
        self.model = builder.finalize()
        self.solver = SolverCageCut(self.model, **options)
        # Masses, gradients and iterations are no part of a body's face; only measurements look behind it.
        self.bodies = tuple(body._simulated for body in self.solver.bodies)
        self.state, self._other = self.model.state(), self.model.state()
        self._pipeline = newton.CollisionPipeline(self.model) if collide else None
        self._contacts = self._pipeline.contacts() if collide else None
        self._start = self.positions, self.velocities
        self._mass: tuple[object, list[np.ndarray]] = (None, [])
        self.begin()

    @property
    def positions(self) -> np.ndarray:
        """Positions of the vertices in use of all bodies [m], shape (n, 3)."""
        return self._rows(self.state.particle_q)

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of the vertices in use of all bodies [m/s], shape (n, 3)."""
        return self._rows(self.state.particle_qd)

    @property
    def rest(self) -> np.ndarray:
        """Rest positions of the vertices in use of all bodies, in the world [m], shape (n, 3)."""
        return np.concatenate([body.rest.numpy()[: body.cage.vertex_count] for body in self.bodies]).astype(float)

    @property
    def gravity(self) -> np.ndarray:
        """Gravity [m/s^2], shape (3,)."""
        return self.model.gravity.numpy()[0].astype(float)

    @property
    def held(self) -> np.ndarray:
        """Vertices in use that are fixed, as a mask, shape (n,)."""
        return np.concatenate([body.fixed.numpy()[: body.cage.vertex_count] for body in self.bodies]) != 0

    def set_material(self, material: Material) -> None:
        """Give all bodies another material of the same model."""
        for body in self.bodies:
            body.system.set_material(material)
        self._mass = (None, [])

    def place(self, positions: np.ndarray | None = None, velocities: np.ndarray | None = None) -> None:
        """Set positions [m] and velocities [m/s] of the vertices in use, shape (n, 3), and begin to watch anew."""
        for field, values in (("particle_q", positions), ("particle_qd", velocities)):
            if values is not None:
                for state in (self.state, self._other):
                    self._write(getattr(state, field), np.broadcast_to(values, self.positions.shape))
        self.begin()

    def reset(self) -> None:
        """Back to how the model was built."""
        self.place(*self._start)

    def masses(self) -> list[np.ndarray]:
        """The consistent mass matrix of each body [kg], shape (n, n)."""
        cages = tuple(body.cage for body in self.bodies)
        if self._mass[0] != cages:
            matrices = [body.system.mass.numpy() for body in self.bodies]
            matrices = [m[: c.vertex_count, : c.vertex_count].astype(float) for m, c in zip(matrices, cages)]
            self._mass = (cages, matrices)
        return self._mass[1]

    def vertex_masses(self) -> np.ndarray:
        """Mass of each vertex [kg], shape (n,)."""
        return np.concatenate([matrix.sum(axis=1) for matrix in self.masses()])

    def center(self) -> np.ndarray:
        """Centre of mass [m]."""
        masses = self.vertex_masses()
        return masses @ self.positions / masses.sum()

    def momentum(self) -> np.ndarray:
        """Linear momentum [kg m/s]."""
        return self.vertex_masses() @ self.velocities

    def angular_momentum(self, vertices: np.ndarray | None = None) -> np.ndarray:
        """Angular momentum of some vertices, all by default, about their centre of mass [kg m^2/s]."""
        positions, velocities, masses = self.positions, self.velocities, self.vertex_masses()
        momenta = np.concatenate(
            [m @ rows for m, rows in zip(self.masses(), np.split(velocities, self._splits()), strict=True)]
        )
        rows = np.arange(len(positions)) if vertices is None else vertices
        center = masses[rows] @ positions[rows] / masses[rows].sum()
        mean = momenta[rows].sum(axis=0) / masses[rows].sum()
        return np.cross(positions[rows] - center, momenta[rows] - masses[rows, None] * mean).sum(axis=0)

    def energy(self) -> tuple[float, float]:
        """Elastic and kinetic energy of all bodies [J]."""
        energies = [body.energy(self.state) for body in self.bodies]
        return sum(float(e.elastic) for e in energies), sum(float(e.kinetic) for e in energies)

    def deformations(self, change: np.ndarray) -> np.ndarray:
        """Gradients at the quadrature points of a field on the vertices, shape (n, 3), as (points, 3, 3)."""
        found = []
        for body, rows in zip(self.bodies, np.split(change, self._splits()), strict=True):
            gradients = body.system.gradients.numpy()[: body.system.point_count, : len(rows)]
            used = body.system.volumes.numpy() > 0.0
            found.append(np.einsum("ja,qjb->qab", rows, gradients[used].astype(float)))
        return np.concatenate(found)

    def upright(self) -> bool:
        """Whether no quadrature point is inside out."""
        return bool((np.linalg.det(self.deformations(self.positions)) > 0.0).all())

    def begin(self) -> None:
        """Watch from here on."""
        self.finite, self.step_count, self.iterations, self._seconds = True, 0, 0, 0.0
        self._counted = self._counts()
        elastic, kinetic = self.energy()
        self._start_energy, self._start_elastic = elastic + kinetic, elastic
        self._start_total = self._highest_total = elastic + kinetic + self._potential()
        self._highest_energy = elastic + kinetic
        self._start_momentum = self.momentum()
        self._duration = 0.0

    def run(
        self,
        steps: int,
        dt: float,
        *,
        force: np.ndarray | None = None,
        watch: Callable[[], bool | None] | None = None,
    ) -> Trial:
        """Take steps, or fewer if a state is not finite any more or ``watch``, called after each, returns True."""
        for _ in range(steps):
            self.step(dt, force=force)
            self._observe()
            if not self.finite or (watch is not None and watch()):
                break
        return self

    def step(self, dt: float, *, force: np.ndarray | None = None) -> None:
        """One step, timed; ``force`` acts on the vertices, shape (n, 3) [N]."""
        self.state.clear_forces()
        if force is not None:
            self._write(self.state.particle_f, force)
        start = time.perf_counter()
        if self._pipeline is not None:
            self._pipeline.collide(self.state, self._contacts)
        self.solver.step(self.state, self._other, None, self._contacts, dt)
        wp.synchronize_device(self.model.device)
        self._seconds += time.perf_counter() - start
        self.state, self._other = self._other, self.state
        self.step_count += 1
        self._duration += dt

    @property
    def states(self) -> tuple[newton.State, newton.State]:
        """Both states, for cuts; the present one first."""
        return self.state, self._other

    def elastic_left(self) -> float:
        """Elastic energy now, of that of the start."""
        return self.energy()[0] / max(self._start_elastic, 1.0e-30)

    def recovered(self) -> bool:
        """Whether next to no elastic energy of that of the start is left, and nothing is inside out."""
        return bool(self.finite and self.elastic_left() <= _RECOVERED and self.upright())

    def outcome(self, *, free: bool = False, **columns: object) -> Outcome:
        """What has been seen.

        Args:
            free: Whether nothing holds or touches the bodies, so that momentum is kept.
            columns: Further columns, or others in their place.
        """
        start, highest = self._start_energy, self._highest_energy
        gain = 0.0
        if self._highest_total > self._start_total:
            gain = (self._highest_total - self._start_total) / (start if start > _NOTHING * highest else highest)
        drift = None
        if free and self.finite:
            mass = self.vertex_masses().sum()
            change = self.momentum() - self._start_momentum - mass * self._duration * self.gravity
            drift = float(np.linalg.norm(change)) / math.sqrt(2.0 * mass * max(highest, 1.0e-30))
        values = {
            "finite": self.finite,
            "energy_gain": float(gain) if self.finite else math.inf,
            "momentum_drift": drift,
            "iterations": self.iterations,
            **{f"{name}_steps": count - self._counted[name] for name, count in self._counts().items()},
            "step_count": self.step_count,
            "milliseconds": 1.0e3 * self._seconds / max(self.step_count, 1),
        }
        return Outcome(**{**values, **columns})

    def _observe(self) -> None:
        self.finite = bool(np.isfinite(self.positions).all() and np.isfinite(self.velocities).all())
        self.iterations = max(self.iterations, *(record.get("iterations", 0) for record in self.solver.statistics()))
        if not self.finite:
            return
        total = sum(self.energy())
        self._highest_energy = max(self._highest_energy, total)
        self._highest_total = max(self._highest_total, total + self._potential())

    def _counts(self) -> dict[str, int]:
        """How many steps of all bodies were missed, and limited, since the solver was made."""
        records = self.solver.statistics()
        return {name: sum(record.get(name, 0) for record in records) for name in ("missed", "limited")}

    def _potential(self) -> float:
        return -float(self.gravity @ (self.vertex_masses() @ self.positions))

    def _splits(self) -> np.ndarray:
        return np.cumsum([body.cage.vertex_count for body in self.bodies])[:-1]

    def _rows(self, array: wp.array) -> np.ndarray:
        rows = array.numpy()
        return np.concatenate([rows[body.vertices][: body.cage.vertex_count] for body in self.bodies]).astype(float)

    def _write(self, array: wp.array, values: np.ndarray) -> None:
        rows = array.numpy()
        for body, part in zip(self.bodies, np.split(values, self._splits()), strict=True):
            rows[body.vertices][: len(part)] = part
        array.assign(rows)
