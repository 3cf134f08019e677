# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A cage body in a model: its coordinates, its elastic system and its surface."""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from ..cage import Cage
from ..elastic import Energy, ReducedSystem
from ..harmonic import HarmonicCoordinates
from ..surface import Surface
from .body_quadrature import SPARE_COUNT, Quadrature
from .config import Config
from .contact.contact_term import ContactTerm
from .definition import BodyDefinition
from .embedding import embed
from .rest_frame import RestFrame


class CageBody:
    """One body of a solver.

    Args:
        model: The Newton model.
        definition: What the body is made of.
        vertex_start: The cage's first particle.
        surface_start: The surface's first particle, -1 without contact.
        config: How to solve.
        progress: Called with the finished fraction of the walks.
    """

    def __init__(
        self,
        model: newton.Model,
        definition: BodyDefinition,
        vertex_start: int,
        surface_start: int,
        *,
        config: Config,
        progress=None,
    ) -> None:
        self.model, self.definition, self.device = model, definition, model.device
        self.config = config
        self.label = definition.label
        self.capacity = definition.capacity
        self.surface: Surface = definition.surface
        self.vertices = slice(vertex_start, vertex_start + self.capacity.vertices)
        self.surface_particles = slice(surface_start, surface_start + self.capacity.surface_points)
        self.has_contact = surface_start >= 0
        self._frame = RestFrame.of_particles(definition.cage.vertices, model.particle_q.numpy()[vertex_start:])
        self._quadrature = self._sample()
        self.quadrature_count = len(self._quadrature.points) if self._quadrature else 0
        self.coordinates = self._bake(progress)
        # Counts live on the device and launches cover the capacity, so that a captured graph stays valid across cuts.
        self.point_count = wp.zeros(1, dtype=wp.int32, device=self.device)
        self.vertex_count = wp.array([definition.cage.vertex_count], dtype=wp.int32, device=self.device)
        self.rest = wp.clone(model.particle_q[self.vertices])
        self.fixed = wp.array(self._padded(definition.fixed), dtype=wp.int32, device=self.device)
        world = int(model.particle_world.numpy()[vertex_start])
        world_slot = world if world >= 0 else model.gravity.shape[0] - 1
        self.gravity = model.gravity[world_slot : world_slot + 1]
        self.system = self._make_system() if self.quadrature_count else None
        self.contact = ContactTerm(self) if self.has_contact and self.system else None
        self._surface_buffer = None
        self._triangles = wp.empty(self.capacity.surface_triangles, dtype=wp.vec3i, device=self.device)
        self.set_surface(self.surface)
        self.refresh()

    @property
    def cage(self) -> Cage:
        """The cage as it is now."""
        return self.coordinates.cage

    @property
    def is_plane(self) -> bool:
        """Whether the body is a plane one, in plane strain."""
        return self.cage.dimension == 2

    @property
    def surface_row(self) -> int:
        """Row of the surface's first point among the coordinates' points."""
        return self.quadrature_count

    def step(
        self,
        state_in: newton.State,
        state_out: newton.State,
        contacts: newton.Contacts | None,
        dt: float,
    ) -> None:
        """Advance the cage's vertices, and the surface's particles with them; launches kernels only."""
        q_in, qd_in = state_in.particle_q[self.vertices], state_in.particle_qd[self.vertices]
        q_out, qd_out = state_out.particle_q[self.vertices], state_out.particle_qd[self.vertices]
        if self.system is None:
            wp.copy(q_out, q_in)
            wp.copy(qd_out, qd_in)
        else:
            term = None
            if self.contact is not None and contacts is not None:
                self.contact.collect(state_in, contacts)
                term = self.contact
            forces = state_in.particle_f[self.vertices]
            self.system.step(q_in, qd_in, q_out, qd_out, dt, gravity=self.gravity, forces=forces, term=term)
        if self.has_contact:
            self.embed_particles(state_out)

    def embed_particles(self, state: newton.State) -> None:
        """Move the surface's particles with the cage."""
        self._embed(state.particle_q[self.vertices], state.particle_q[self.surface_particles])
        self._embed(state.particle_qd[self.vertices], state.particle_qd[self.surface_particles])

    def surface_points(self, state: newton.State) -> wp.array:
        """Positions of the surface's points [m], shape (point_count,), a view that the next call overwrites."""
        if self.has_contact:
            points = state.particle_q[self.surface_particles]
        else:
            if self._surface_buffer is None:
                self._surface_buffer = wp.zeros(self.capacity.surface_points, dtype=wp.vec3, device=self.device)
            points = self._surface_buffer
        self._embed(state.particle_q[self.vertices], points)
        return points[: len(self.surface.points)]

    def surface_triangles(self) -> wp.array:
        """Triangles of the surface, shape (triangle_count,) vec3i."""
        return self._triangles[: len(self.surface.triangles)]

    def set_surface(self, surface: Surface) -> None:
        """Take over a surface whose points are in the coordinates already."""
        self.surface = surface
        self.point_count.fill_(surface.point_count)
        _write_rows(self._triangles, 0, np.asarray(surface.triangles, dtype=np.int32))
        if self.has_contact:
            start = self.surface_particles.start
            flags = np.full(len(surface.points), int(newton.ParticleFlags.ACTIVE), dtype=np.int32)
            _write_rows(self.model.particle_flags, start, flags)

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Rest positions in the world [m], shape (n, 3), of points of the cage's rest frame, shape (n, dimension)."""
        return self._frame.to_world(points)

    def distribute_quadrature(self) -> None:
        """Give every piece enough quadrature points and its own volume, after pieces came off."""
        if self._quadrature is not None:
            self._quadrature.distribute(self.cage, self.coordinates)
            self.system.volumes.assign(self._quadrature.volumes.astype(np.float32))

    def refresh(self) -> None:
        """Bring what depends on the weights up to date after an edit."""
        if self.system is not None:
            self.system.stabilize(self.cage.vertices, self.cage.mesh.edges)
            self.system.refresh()
            wp.copy(self.model.particle_mass[self.vertices], self.system.vertex_mass)

    def energy(self, state: newton.State) -> Energy:
        """Elastic and kinetic energy of a state [J], read on the host."""
        if self.system is None:
            return Energy(0.0, 0.0)
        return self.system.energy(state.particle_q[self.vertices], state.particle_qd[self.vertices])

    def _embed(self, vertices: wp.array, points: wp.array) -> None:
        inputs = [
            self.coordinates.weights_array,
            self.surface_row,
            self.point_count,
            self.vertex_count,
            vertices,
            points,
        ]
        wp.launch(embed, dim=self.capacity.surface_points, inputs=inputs, device=self.device)

    def _sample(self) -> Quadrature | None:
        definition = self.definition
        if not definition.quadrature_count:
            return None
        return Quadrature(
            definition.cage,
            definition.quadrature_count,
            spare_count=SPARE_COUNT if definition.cuttable else 0,
            seed=definition.seed,
            thickness=definition.thickness,
        )

    def _bake(self, progress) -> HarmonicCoordinates:
        definition = self.definition
        quadrature = np.zeros((0, definition.cage.dimension))
        if self._quadrature is not None:
            quadrature = self._quadrature.points
        points = np.concatenate([quadrature, definition.surface.points])
        return HarmonicCoordinates(
            definition.cage,
            points,
            definition.walks,
            definition.seed,
            gradients=np.arange(len(points)) < len(quadrature),
            cuttable=definition.cuttable,
            device=self.device,
            point_keys=np.concatenate([np.full(len(quadrature), -1), definition.surface.point_key]),
            point_capacity=len(quadrature) + self.capacity.surface_points,
            vertex_capacity=self.capacity.vertices,
            progress=progress,
            **definition.options,
        )

    def _make_system(self) -> ReducedSystem:
        return ReducedSystem(
            self.rest,
            self.coordinates.weights_array[: self.quadrature_count],
            self.coordinates.gradients_array,
            self._quadrature.volumes,
            self.definition.material,
            self.vertex_count,
            fixed=self.fixed,
            rotation=wp.array([self._frame.rotation], dtype=wp.mat33, device=self.device),
            thickness=self.definition.thickness,
            max_iterations=self.config.max_iterations,
            tolerance=self.config.tolerance,
        )

    def _padded(self, mask: np.ndarray) -> np.ndarray:
        padded = np.zeros(self.capacity.vertices, dtype=np.int32)
        padded[: len(mask)] = mask
        return padded


def _write_rows(array: wp.array, start: int, rows: np.ndarray) -> None:
    """Write rows of a device array in place."""
    if len(rows):
        wp.copy(array[start : start + len(rows)], wp.array(rows, dtype=array.dtype, device=array.device))
