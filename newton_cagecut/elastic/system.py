# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The reduced system of one elastic body: backward Euler with a single Newton step (paper, section 6.1).

(M + dt C + dt^2 K) dv = dt (f + M g + f_ext - C v - dt K v) with C = damping K, K projected to be positive
semidefinite. Nothing is assembled but the small mass matrix: K acts through the quadrature points. The solve starts
from dv = dt g, so that free fall is exact.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
import warp as wp

from . import energy, mass
from . import limit as update
from . import plane_confinement as plane
from . import step_kernels as kernels
from .conjugate_gradient import ConjugateGradient
from .material import Material
from .stabilization import stabilize
from .stiffness import Stiffness


class Energy(NamedTuple):
    """Energies of a state [J]."""

    elastic: float
    kinetic: float


class LinearTerm(Protocol):
    """A term that a step adds to the system, such as contact. Both methods only launch kernels.

    A force f(x) - D v with df/dx = -S adds dt^2 S + dt D to the matrix, and dt f(x) - (dt^2 S + dt D) predicted to the
    residual, with f at the positions before the step. What it adds for fixed vertices is ignored.
    """

    def add_residual(self, dt: float, predicted: wp.array, residual: wp.array, blocks: wp.array) -> None:
        """Add to the residual and to the matrix's 3x3 diagonal blocks; ``predicted`` are velocities with the guess."""

    def add_product(self, direction: wp.array, product: wp.array) -> None:
        """Add the matrix term's product with the direction."""


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
        fixed: Nonzero for vertices that keep their velocity, shape (vertex_capacity,) int; none if not given.
        rotation: Rotation from the gradients' frame to that of the rest positions, shape (1,) mat33; identity if not
            given.
        thickness: Thickness of a plane body [m]; the body is solid if not given.
        max_iterations: Most iterations of a solve.
        tolerance: Factor by which a solve shrinks the preconditioned residual.

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
        thickness: float | None = None,
        max_iterations: int = 150,
        tolerance: float = 1.0e-5,
    ):
        self.device, self.vertex_capacity, self.point_count = rest.device, rest.shape[0], weights.shape[0]
        capacity, points = self.vertex_capacity, self.point_count
        self.thickness = thickness
        with wp.ScopedDevice(self.device):
            self.rest, self.weights, self.gradients, self.vertex_count = rest, weights, gradients, vertex_count
            self.volumes = volumes if isinstance(volumes, wp.array) else wp.array(volumes, dtype=float)
            self.fixed = fixed if fixed is not None else wp.zeros(capacity, dtype=int)
            self.rotation = rotation if rotation is not None else wp.array([np.eye(3)], dtype=wp.mat33)
            self.mass = wp.zeros((capacity, capacity), dtype=float)
            self.vertex_mass = wp.zeros(capacity, dtype=float)
            self.stabilizing_stiffness, self.stabilizing_mass = (
                wp.zeros((capacity, capacity), dtype=float) for _ in range(2)
            )
            self._normal = wp.zeros(1, dtype=wp.vec3d) if self.is_plane else None
            self._anchors = wp.zeros(points, dtype=int)
            self._material = wp.zeros(1, dtype=wp.vec4d)
            self._scales = wp.zeros(2, dtype=wp.float64)
            self._displacement, self._lag, self._predicted, self._no_forces = (
                wp.zeros(capacity, dtype=wp.vec3) for _ in range(4)
            )
            self._stiffnesses = wp.zeros(points, dtype=Stiffness)
            self._tensions = wp.zeros(points, dtype=wp.mat33)
            self._rates = wp.zeros(points, dtype=float)
            self._limit = wp.zeros(1, dtype=wp.vec4)
            self._point_energies = wp.zeros(points, dtype=wp.float64)
            self._vertex_energies = wp.zeros(capacity, dtype=wp.float64)
        self._check_arrays()
        self.material = material
        self._solver = ConjugateGradient(
            self.vertex_count,
            self.fixed,
            normal=self._normal,
            max_iterations=max_iterations,
            tolerance=tolerance,
        )
        self._record_launches()
        self.set_material(material)

    @property
    def is_plane(self) -> bool:
        """Whether the body is in plane strain."""
        return self.thickness is not None

    @property
    def iterations(self) -> wp.array:
        """Iterations of the last solve, shape (1,) int, on the device."""
        return self._solver.iterations

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
        self._material.assign(np.array([[*material.lame, material.damping, material.density]]))
        self.refresh()

    def stabilize(self, vertices: np.ndarray, edges: np.ndarray) -> None:
        """Tie vertices that the quadrature hardly sees to their neighbours; call :meth:`refresh` afterwards.

        Args:
            vertices: The cage's vertices in use in its rest frame, shape (n, 3), or (n, 2) of a plane body [m].
            edges: Pairs of vertices that share an edge of the cage, shape (m, 2).
        """
        count = len(vertices)
        weights, gradients = self.weights.numpy()[:, :count], self.gradients.numpy()[:, :count]
        thickness = self.thickness if self.is_plane else 1.0
        matrices = stabilize(vertices, edges, weights, gradients, self.volumes.numpy(), thickness=thickness)
        for array, matrix in zip((self.stabilizing_stiffness, self.stabilizing_mass), matrices, strict=True):
            padded = np.zeros(array.shape, dtype=np.float32)
            padded[:count, :count] = matrix
            array.assign(padded)

    def refresh(self) -> None:
        """Bring masses and anchors up to date after an edit of weights, volumes or the vertex count."""
        for launch in self._refresh_launches:
            launch.launch()

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
        term: LinearTerm | None = None,
    ) -> None:
        """Advance the vertices by one step; outputs may be the inputs.

        A step that would change F by more than one (Frobenius norm) somewhere is cut to that; see ``limit.py``.

        Args:
            positions: Positions, shape (vertex_capacity,) vec3 [m].
            velocities: Velocities, shape (vertex_capacity,) vec3 [m/s].
            positions_out: New positions, shape (vertex_capacity,) vec3 [m].
            velocities_out: New velocities, shape (vertex_capacity,) vec3 [m/s].
            dt: Time step [s].
            gravity: Gravity, shape (1,) vec3 [m/s^2].
            forces: Further forces on the vertices, shape (vertex_capacity,) vec3 [N].
            term: A further term of the system.
        """
        solver = self._solver
        self._launch(
            kernels.begin_step,
            self.vertex_capacity,
            [dt, positions, velocities, gravity, self.rest, self.fixed, self._material]
            + [self._displacement, solver.solution, self._lag, self._predicted, self._scales],
        )
        if self.is_plane:
            self._launch(plane.confine_start, self.vertex_capacity, [self._normal, solver.solution, self._predicted])
        self._strain.launch()
        self._launch(
            kernels.find_residual,
            self.vertex_capacity,
            [dt, self._no_forces if forces is None else forces, self._displacement, self._predicted]
            + [self.stabilizing_stiffness, self._material, self._scales, self.mass, self._lag, self.gradients]
            + [self._stiffnesses, self._tensions, self.vertex_count, solver.residual, solver.blocks],
        )
        if term is None:
            solver.solve(self._multiply)
        else:
            term.add_residual(dt, self._predicted, solver.residual, solver.blocks)
            solver.solve(lambda: self._multiply_with(term))
        self._launch(update.find_velocities, self.vertex_capacity, [velocities, solver.solution, self._predicted])
        if self.is_plane:
            self._launch(plane.confine_velocities, self.vertex_capacity, [self._normal, self._predicted])
        self._launch(
            update.find_rates,
            self.point_count,
            [dt, self._predicted, self.gradients, self._anchors, self.vertex_count, self._rates],
        )
        self._find_limit.launch()
        self._launch(
            update.finish_step,
            self.vertex_capacity,
            [dt, positions, velocities, self._predicted, self._limit, self.fixed, self.vertex_count]
            + [positions_out, velocities_out],
        )
        if self.is_plane:
            self._launch(
                plane.confine_end,
                self.vertex_capacity,
                [self._normal, self.rest, self.vertex_count, positions_out, velocities_out],
            )

    def energy(self, positions: wp.array, velocities: wp.array) -> Energy:
        """Energies of a state, read on the host: for reports, not for captured code.

        Args:
            positions: Positions, shape (vertex_capacity,) vec3 [m].
            velocities: Velocities, shape (vertex_capacity,) vec3 [m/s].
        """
        self._launch(energy.find_displacement, self.vertex_capacity, [positions, self.rest, self._displacement])
        self._elastic_energy.launch()
        self._launch(
            energy.find_tie_energy,
            self.vertex_capacity,
            [self._displacement, self.stabilizing_stiffness, self._material, self.vertex_count, self._vertex_energies],
        )
        elastic = float(self._point_energies.numpy().sum() + self._vertex_energies.numpy().sum())
        self._launch(
            energy.find_kinetic_energy,
            self.vertex_capacity,
            [velocities, self.mass, self.vertex_count, self._vertex_energies],
        )
        return Energy(elastic, float(self._vertex_energies.numpy().sum()))

    def _multiply(self) -> None:
        """The matrix's product with the solver's direction."""
        self._find_tensions.launch()
        self._multiply_system.launch()

    def _multiply_with(self, term: LinearTerm) -> None:
        """The product of the matrix with a further term."""
        self._multiply()
        term.add_product(self._solver.direction, self._solver.product)

    def _launch(self, kernel: wp.Kernel, dim: int, inputs: list) -> None:
        """One launch on the system's device."""
        wp.launch(kernel, dim=dim, inputs=inputs, device=self.device)

    def _record(self, kernel: wp.Kernel, dim: int | tuple[int, int], inputs: list) -> wp.Launch:
        """A launch that reads and writes the system's own arrays only, ready to be repeated."""
        return wp.launch(kernel, dim=dim, inputs=inputs, device=self.device, record_cmd=True)

    def _record_launches(self) -> None:
        """Prepare the launches whose arguments never change."""
        capacity, points, solver = self.vertex_capacity, self.point_count, self._solver
        count, model = self.vertex_count, self.material.model
        body = [self.gradients, self._anchors, self.volumes, self._material, self.rotation]
        self._strain = self._record(
            kernels.make_strain_kernel(model, self.is_plane),
            points,
            [self._displacement, self._predicted, *body, self._scales, count, self._stiffnesses, self._tensions],
        )
        self._elastic_energy = self._record(
            energy.make_elastic_energy_kernel(model, self.is_plane),
            points,
            [self._displacement, *body, count, self._point_energies],
        )
        self._find_tensions = self._record(
            kernels.find_tensions,
            points,
            [solver.direction, self.gradients, self._anchors, self._stiffnesses, count, self._tensions],
        )
        self._multiply_system = self._record(
            kernels.multiply_system,
            capacity,
            [solver.direction, self.gradients, self._tensions, self.mass, self.stabilizing_stiffness]
            + [self._material, self._scales, self.fixed, count, solver.product],
        )
        block_size = 256 if self.device.is_cuda else 1
        self._find_limit = wp.launch(
            update.find_limit,
            dim=block_size,
            inputs=[self._rates, self._predicted, self.vertex_mass, count, self._limit],
            block_dim=block_size,
            device=self.device,
            record_cmd=True,
        )
        masses = [self.volumes, self._material, count, self.mass]
        self._refresh_launches = (
            self._record(mass.find_anchors, points, [self.weights, count, self._anchors]),
            self._record(mass.assemble_mass, (capacity, capacity), [self.weights, self.stabilizing_mass, *masses]),
            self._record(mass.lump_mass, capacity, [*masses, self.vertex_mass]),
        )
        if self.is_plane:
            self._refresh_launches += (self._record(plane.find_normal, 1, [self.rotation, self._normal]),)

    def _check_arrays(self) -> None:
        """Check types, shapes and devices of the arrays, and the thickness."""
        if self.is_plane and not (np.isfinite(self.thickness) and self.thickness > 0.0):
            raise ValueError(f"ReducedSystem thickness is {self.thickness} m; it must be positive.")
        capacity, points = self.vertex_capacity, self.point_count
        expected = {
            "rest": (wp.vec3, (capacity,)),
            "weights": (wp.float32, (points, capacity)),
            "gradients": (wp.vec3, (points, capacity)),
            "volumes": (wp.float32, (points,)),
            "vertex_count": (wp.int32, (1,)),
            "fixed": (wp.int32, (capacity,)),
            "rotation": (wp.mat33, (1,)),
        }
        for name, (dtype, shape) in expected.items():
            array = getattr(self, name)
            if array.dtype != dtype:
                raise TypeError(
                    f"ReducedSystem {name} has the type {array.dtype.__name__}; it must be {dtype.__name__}."
                )
            if array.shape != shape:
                raise ValueError(f"ReducedSystem {name} has the shape {array.shape}; it must be {shape}.")
            if array.device != self.device:
                raise ValueError(f"ReducedSystem {name} lies on {array.device}; rest lies on {self.device}.")
