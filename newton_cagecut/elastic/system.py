# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The reduced system of one elastic body: the vertices of its cage are its degrees of freedom (paper, section 6.1)."""

from __future__ import annotations

import numpy as np
import warp as wp

from .arrays import make_body_arrays
from .averaging import ClusterFields, softened_moduli, strain_rows
from .backward_euler import BackwardEuler
from .energy import Energy, EnergyMeter
from .implicit_integrator import Motion
from .launching import launch_later
from .mass import record_masses
from .material import Material
from .plane_confinement import find_normal
from .solve.linear_solver import SolveLimits
from .solve.point_forces import PointForces
from .stabilization import lumped_mass, stabilize
from .stages.scheme import SCHEMES
from .stages.stage_integrator import StageIntegrator
from .stages.step_record import make_step_record, read_counts

INTEGRATORS = (*SCHEMES, "paper")
"""Names of the time integrators."""


class ReducedSystem:
    """An elastic body whose degrees of freedom are the vertices of its cage.

    A plane body is in plane strain: it moves in the plane through its rest positions that is normal to the third axis
    of its rest frame, and takes nothing along that axis: not of gravity, forces, further terms or initial velocities.

    Arrays are used in place: assign to them, then call :meth:`refresh`. :meth:`step` only launches kernels and can be
    captured in a CUDA graph, which stays valid across edits.

    Args:
        rest: Rest positions of the cage's vertices, shape (vertex_capacity,) vec3 [m].
        weights: Weights at the quadrature points, shape (point_count, vertex_capacity) float.
        gradients: Gradients of the weights, shape (point_count, vertex_capacity) vec3 [1/m]; those of a plane body have
            the third component 0.
        volumes: Volumes of the quadrature points, shape (point_count,) float or NumPy [m^3]; those of a plane body are
            areas times its thickness.
        material: The material.
        vertex_count: Number of vertices in use, shape (1,) int.
        fixed: 0 for free vertices, ``HELD`` for those that a step does not move, ``DRIVEN`` for those that it moves at
            their given velocity, shape (vertex_capacity,) int; all free if not given.
        rotation: Rotation from the gradients' frame to that of the rest positions, shape (1,) mat33; identity if not
            given.
        piece: The piece that a vertex belongs to, counted from 0, shape (vertex_capacity,) int; all one if not given.
        thickness: Thickness of a plane body [m]; the body is solid if not given.
        averaged: Whether strain is averaged over clusters of points, against locking, by :meth:`stabilize`.
        integrator: One of ``INTEGRATORS``: ``"tr_bdf2"`` or ``"backward_euler"`` (see ``stages/scheme.py``), or
            ``"paper"`` for the paper's single step.
        newton_iterations: Linear solves in each stage; the paper's has one.
        limits: How exactly systems are solved.

    Raises:
        TypeError: If an array has the wrong type.
        ValueError: If an array has the wrong shape or lies on another device, or the thickness is not positive.
    """

    def __init__(
        self,
        rest: wp.array,
        weights: wp.array,
        gradients: wp.array,
        volumes: wp.array | np.ndarray,
        material: Material,
        vertex_count: wp.array,
        *,
        fixed: wp.array | None = None,
        rotation: wp.array | None = None,
        piece: wp.array | None = None,
        thickness: float | None = None,
        averaged: bool = False,
        integrator: str = "tr_bdf2",
        newton_iterations: int = 1,
        limits: SolveLimits | None = None,
    ):
        if thickness is not None and not (np.isfinite(thickness) and thickness > 0.0):
            raise ValueError(f"ReducedSystem thickness is {thickness} m; it must be positive.")
        self.device, self.vertex_capacity, self.point_count = rest.device, rest.shape[0], weights.shape[0]
        self.thickness, self.material = thickness, material
        body = self.arrays = make_body_arrays(
            rest,
            weights,
            gradients,
            volumes,
            vertex_count,
            fixed=fixed,
            rotation=rotation,
            piece=piece,
            plane=self.is_plane,
            averaged=averaged,
        )
        self.is_averaged = averaged
        self.rest, self.weights = body.rest, body.weights
        self.gradients, self.volumes = body.point_gradients, body.point_volumes
        self.vertex_count, self.fixed, self.rotation, self.piece = (
            body.vertex_count,
            body.fixed,
            body.rotation,
            body.piece,
        )
        self.mass, self.vertex_mass = body.mass, body.vertex_mass
        self.stabilizing_stiffness, self.stabilizing_mass = body.stabilizing_stiffness, body.stabilizing_mass
        self._fields: list[ClusterFields | None] = []
        self.record = make_step_record(self.device, None, None)
        options = {"limits": (limits or SolveLimits()).measured(material.poisson), "record": self.record}
        if integrator == "paper":
            self._integrator = BackwardEuler(body, material.model, **options)
        else:
            self._integrator = StageIntegrator(
                body, material.model, SCHEMES[integrator], newton_iterations=newton_iterations, **options
            )
        self._energy = EnergyMeter(body, material.model)
        self._refresh_launches = record_masses(body)
        if self.is_plane:
            self._refresh_launches += (launch_later(find_normal, 1, [body], self.device),)
        self._tied_mass = np.zeros((0, 0))
        self.set_material(material)

    @property
    def is_plane(self) -> bool:
        """Whether the body is in plane strain."""
        return self.thickness is not None

    @property
    def iterations(self) -> wp.array:
        """Iterations of the last solve, shape (1,) int, on the device."""
        return self._integrator.solver.search.iterations

    def set_material(self, material: Material) -> None:
        """Change the constants of the material, not its model, and refresh the masses.

        Raises:
            ValueError: If the model is another one.
        """
        if material.model != self.material.model:
            raise ValueError(
                f"The system was built for the model {self.material.model!r}, not {material.model!r}. Build a new one."
            )
        self.material = material
        self.arrays.material.assign(np.array([[*material.lame, material.damping, material.density]]))
        self._soften()
        self.refresh()

    def _average(self, vertices: np.ndarray) -> None:
        """Average strain over clusters of points; see ``averaging``."""
        body, count = self.arrays, len(vertices)
        inputs = [array.numpy()[:, :count] for array in (self.weights, self.gradients)]
        rows = strain_rows(vertices, *inputs, self.volumes.numpy(), self.piece.numpy()[:count], body.volumes.shape[0])
        gradients = np.zeros((*body.gradients.shape, 3), dtype=np.float32)
        gradients[:, :count] = rows.gradients
        body.gradients.assign(gradients)
        body.volumes.assign(rows.volumes.astype(np.float32))
        body.anchors[self.point_count :].assign(rows.anchors.astype(np.int32))
        body.clusters.assign(rows.clusters.astype(np.int32))
        self._fields = rows.fields
        self._soften()

    def _soften(self) -> None:
        """Set the constants of the material at the points."""
        lame = self.material.lame
        if not self.is_averaged:
            return
        softened = np.tile(lame, (self.arrays.softened.shape[0], 1))
        for row, fields in zip(softened, self._fields, strict=False):
            row[:] = softened_moduli(*lame, fields)
        self.arrays.softened.assign(softened)

    def stabilize(self, vertices: np.ndarray, edges: np.ndarray) -> None:
        """Tie vertices that the quadrature hardly sees to their neighbours, and average strain; then :meth:`refresh`.

        To be called anew after each edit. Strain is averaged if the system was made so.

        Args:
            vertices: The cage's vertices in use in its rest frame, shape (n, 3), or (n, 2) of a plane body [m].
            edges: Pairs of vertices that share an edge of the cage, shape (m, 2).
        """
        count = len(vertices)
        weights, gradients = self.weights.numpy()[:, :count], self.gradients.numpy()[:, :count]
        thickness = self.thickness if self.is_plane else 1.0
        volumes = self.volumes.numpy()
        stiffness, mass = stabilize(vertices, edges, weights, gradients, volumes, thickness=thickness)
        _assign_block(self.stabilizing_stiffness, stiffness)
        self._tied_mass = mass
        if self.is_averaged:
            self._average(vertices)

    def refresh(self) -> None:
        """Bring masses, anchors and lanes up to date after an edit of weights, gradients, volumes or the count."""
        self._lump_mass()
        for launch in self._refresh_launches:
            launch.launch()
        self._integrator.solver.refresh()

    def _lump_mass(self) -> None:
        """Bring the stabilising mass up to date."""
        count = int(self.vertex_count.numpy()[0])
        rest = self.rest.numpy()[:count].astype(float) @ self.rotation.numpy()[0].astype(float)
        piece, weights = self.piece.numpy()[:count], self.weights.numpy()[:, :count]
        mass = lumped_mass(rest[:, :2] if self.is_plane else rest, piece, weights, self.volumes.numpy())
        tied = len(self._tied_mass)
        mass[:tied, :tied] += self._tied_mass
        _assign_block(self.stabilizing_mass, mass)

    def step(
        self,
        positions: wp.array,
        velocities: wp.array,
        positions_out: wp.array,
        velocities_out: wp.array,
        dt: float,
        *,
        gravity: wp.array,
        forces: wp.array | None = None,
        points: PointForces | None = None,
    ) -> None:
        """Advance the vertices by one step; outputs may be the inputs.

        A stage's solution is taken as far as the incremental potential of each piece does not rise. A step whose result
        is not finite is not made: the outputs are the inputs, and ``record`` counts it. The paper's single step is cut
        instead where it would change F by more than one (Frobenius norm); see ``limit.py``.

        Args:
            positions: Positions, shape (vertex_capacity,) vec3 [m].
            velocities: Velocities, shape (vertex_capacity,) vec3 [m/s].
            positions_out: New positions, shape (vertex_capacity,) vec3 [m].
            velocities_out: New velocities, shape (vertex_capacity,) vec3 [m/s].
            dt: Time step [s].
            gravity: Gravity, shape (1,) vec3 [m/s^2].
            forces: Further forces on the vertices, shape (vertex_capacity,) vec3 [N].
            points: Forces on embedded points, such as contact.
        """
        before, after = Motion(positions, velocities), Motion(positions_out, velocities_out)
        self._integrator.step(before, after, dt, gravity=gravity, forces=forces, points=points)

    def step_statistics(self) -> dict[str, object]:
        """What the steps were like, read on the host.

        ``steps`` in all, of which ``refused``: their result was not finite (``reason``), so they were not made;
        ``limited``: a solution was not taken whole, or velocities were too wild for the step; ``stalled``: a solution
        was not taken at all; ``missed``: a solve ended short of the tolerance. ``iterations`` of the last step's
        solves and ``most_iterations`` of any; ``residual`` and ``worst_residual``: factors by which solves shrank it.
        """
        return read_counts(self.record.counts.numpy(), self.record.residuals.numpy())

    def energy(self, positions: wp.array, velocities: wp.array) -> Energy:
        """Energies of a state, read on the host: for reports, not for captured code.

        Args:
            positions: Positions, shape (vertex_capacity,) vec3 [m].
            velocities: Velocities, shape (vertex_capacity,) vec3 [m/s].
        """
        return self._energy.of(positions, velocities)


def _assign_block(array: wp.array, block: np.ndarray) -> None:
    """Write a square matrix into the upper left corner of an array, zeros into the rest."""
    rows = np.zeros(array.shape, dtype=np.float32)
    rows[: len(block), : len(block)] = block
    array.assign(rows)
