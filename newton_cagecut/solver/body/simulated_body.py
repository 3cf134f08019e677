# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A cage body in a solver: its coordinates, its elastic system, its surface and its particles."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import newton
import numpy as np
import warp as wp

from ...cage import Cage
from ...elastic import Energy, ReducedSystem
from ...harmonic import CoordinatesSnapshot, HarmonicCoordinates, Journal
from ...surface import Surface
from ..config import Config
from ..contact.contact_term import ContactTerm
from ..live.vertex_motion import finish_vertices, place_vertices, prescribe_motion
from .body_quadrature import SPARE_COUNT, BodyQuadrature
from .definition import BodyDefinition
from .edit_stamps import EditStamps, hold_rows, state_edits
from .embedding import Motion, SeamPoints, embed, embed_motion, join_motion, make_surface_rows
from .rest_frame import RestFrame

_NUDGE = 3.0e-7
"""How far points on cuts are moved off the other cuts, in diameters of the cage."""


class SimulatedBody:
    """One body of a solver; users see it as a :class:`CageBody`.

    Args:
        model: The Newton model.
        row: Row of the body in the model's ``cagecut`` attributes.
        stamps: Which edit of each body a state is of.
        config: How to solve.
        progress: Called with the finished fraction of the walks.
    """

    def __init__(
        self,
        model: newton.Model,
        row: int,
        stamps: EditStamps,
        *,
        config: Config,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        self.model, self.row, self.device, self.config = model, row, model.device, config
        self._stamps = stamps
        self.definition: BodyDefinition = model.cagecut.definition[row]
        definition = self.definition
        vertex_start = int(model.cagecut.vertex_start.numpy()[row])
        surface_start = int(model.cagecut.surface_start.numpy()[row])
        self.label = stamps.labels[row]
        self.capacity = definition.capacity
        self.surface: Surface = definition.surface
        self.vertices = slice(vertex_start, vertex_start + self.capacity.vertices)
        self.surface_particles = slice(surface_start, surface_start + self.capacity.surface_points)
        self.has_contact = surface_start >= 0
        self._frame = RestFrame.of_particles(
            definition.cage.vertices, model.particle_q.numpy()[vertex_start:], what=self.label
        )
        self.quadrature = self._sample(definition)
        self.quadrature_count = len(self.quadrature.points) if self.quadrature else 0
        self.coordinates = self._bake(definition, self.quadrature, progress)
        # Counts live on the device and launches cover the capacity, so that a captured graph stays valid across cuts.
        self.point_count = wp.zeros(1, dtype=wp.int32, device=self.device)
        self.vertex_count = wp.array([definition.cage.vertex_count], dtype=wp.int32, device=self.device)
        self.surface_rows = make_surface_rows(
            self.coordinates.weights_array,
            self.surface_row,
            point_count=self.point_count,
            vertex_count=self.vertex_count,
        )
        self.rest = wp.clone(model.particle_q[self.vertices])
        self.fixed = wp.array(self.padded(definition.fixed), dtype=wp.int32, device=self.device)
        self.piece = wp.zeros(self.capacity.vertices, dtype=wp.int32, device=self.device)
        self.world = int(model.particle_world.numpy()[vertex_start])
        """World of the body, -1 for the global one."""
        self.system = self._make_system() if self.quadrature_count else None
        self.contact = ContactTerm(self) if self.has_contact else None
        self._surface_buffer = None
        self.uncut: tuple[BodyQuadrature | None, CoordinatesSnapshot] | None = None
        self._prescribed = wp.zeros(self.capacity.vertices, dtype=wp.vec3, device=self.device)
        self._seams = SeamPoints()
        self._held = tuple(wp.zeros(self.capacity.vertices, dtype=wp.vec3, device=self.device) for _ in range(2))
        self._motion = wp.zeros(self.capacity.vertices if self.has_contact else 0, dtype=Motion, device=self.device)
        self._always = wp.ones(1, dtype=wp.int32, device=self.device)
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
    def gravity(self) -> wp.array:
        """Gravity in the body's world as the model has it now [m/s^2], shape (1,)."""
        gravity = self.model.gravity
        slot = self.world if self.world >= 0 else gravity.shape[0] - 1
        return gravity[slot : slot + 1]

    @property
    def surface_row(self) -> int:
        """Row of the surface's first point among the coordinates' points."""
        return self.quadrature_count

    def step(
        self,
        state_in: newton.State,
        state_out: newton.State,
        dt: float,
        targets: wp.array,
    ) -> None:
        """Advance the cage's vertices, and the surface's particles with them; launches kernels only.

        Forces on surface points are those that ``contact`` has collected.

        A body of which ``state_in`` missed an edit stays where it is there.
        """
        q_in, qd_in = state_in.particle_q[self.vertices], state_in.particle_qd[self.vertices]
        q_out, qd_out = state_out.particle_q[self.vertices], state_out.particle_qd[self.vertices]
        if self.system is None:
            inputs = [dt, q_in, qd_in, targets[self.vertices], self.is_current, q_out, qd_out]
            wp.launch(place_vertices, dim=q_in.size, inputs=inputs, device=self.device)
        else:
            points = None if self.contact is None else self.contact.points
            forces = state_in.particle_f[self.vertices]
            q_old, qd_old = self._before_step(q_in, qd_in) if state_in is state_out else (q_in, qd_in)
            motion = [dt, q_in, qd_in, targets[self.vertices], self.is_current, self.fixed, self._prescribed]
            wp.launch(prescribe_motion, dim=q_in.size, inputs=motion, device=self.device)
            self.system.step(
                q_in, self._prescribed, q_out, qd_out, dt, gravity=self.gravity, forces=forces, points=points
            )
            limits = [dt, self.model.particle_max_velocity, self.is_current, self.fixed]
            rows = [q_old, qd_old, q_out, qd_out]
            wp.launch(finish_vertices, dim=q_in.size, inputs=[*limits, *rows], device=self.device)
        if self.has_contact:
            if state_in is not state_out:
                rows = self.surface_particles
                self._hold([a[rows] for s in (state_in, state_out) for a in (s.particle_q, s.particle_qd)])
            self.embed_particles(state_out, enabled=self.is_current)

    def _before_step(self, positions: wp.array, velocities: wp.array) -> tuple[wp.array, wp.array]:
        """Copies of positions and velocities that a step overwrites."""
        wp.copy(self._held[0], positions)
        wp.copy(self._held[1], velocities)
        return self._held

    def _hold(self, rows: list[wp.array]) -> None:
        """Carry rows over as they were where the state missed an edit: positions and velocities, before and after."""
        wp.launch(hold_rows, dim=rows[0].size, inputs=[self.is_current, *rows], device=self.device)

    @property
    def is_current(self) -> wp.array:
        """Whether the state of the last step was of the body's present edit, shape (1,), int32."""
        return self._stamps.is_current[self.row : self.row + 1]

    @property
    def edits(self) -> wp.array:
        """Number of the body's present edit, shape (1,), int32."""
        return self._stamps.edits[self.row : self.row + 1]

    @property
    def parts(self) -> list[slice]:
        """The body's particles: the cage's vertices and, with contact, the surface's points."""
        return [self.vertices, self.surface_particles] if self.has_contact else [self.vertices]

    def require_current(self, state: newton.State, what: str = "state") -> None:
        """Refuse a state that missed an edit of the body; reads it on the host.

        Args:
            state: The state.
            what: What it is, for the error.
        """
        self._stamps.require(state, self.row, what)

    def require_own_edits(self) -> None:
        """Refuse to edit a body that was edited through another solver of the model."""
        edit = self.model.cagecut.definition[self.row].edit
        if edit != self.definition.edit:
            raise ValueError(
                f"{self.label} was edited through another solver of this model, which holds it at edit {edit}, this "
                f"one at {self.definition.edit}. Make all edits through one solver, or make a new solver."
            )

    def embed_particles(self, state: newton.State, *, enabled: wp.array | None = None) -> None:
        """Move the surface's particles with the cage.

        Args:
            state: The state, or the model with its initial one.
            enabled: Zero where they are to stay, shape (1,), int32; None for always.
        """
        vertices, rows = self.vertices, self.surface_particles
        inputs = [state.particle_q[vertices], state.particle_qd[vertices], self._motion]
        wp.launch(join_motion, dim=self.capacity.vertices, inputs=inputs, device=self.device)
        inputs = [self._always if enabled is None else enabled, self._motion, self.surface_rows]
        inputs += [state.particle_q[rows], state.particle_qd[rows]]
        wp.launch(embed_motion, dim=self.capacity.surface_points, inputs=inputs, device=self.device)

    def surface_points(self, state: newton.State) -> wp.array:
        """Positions of the surface's points [m], shape (point_count,), a view that the next call overwrites."""
        self.require_current(state)
        if self.has_contact:
            points = state.particle_q[self.surface_particles]
        else:
            if self._surface_buffer is None:
                self._surface_buffer = wp.zeros(self.capacity.surface_points, dtype=wp.vec3, device=self.device)
            points = self._surface_buffer
        self._embed(state.particle_q[self.vertices], points)
        sites = points[: self.surface.site_count]
        return sites if self.surface.point_place is None else self._seams.points_of(self.surface, sites)

    def surface_velocities(self, state: newton.State) -> np.ndarray:
        """Velocities of the surface's points [m/s], shape (point_count, 3), on the host."""
        self.require_current(state)
        sites = wp.empty(self.capacity.surface_points, dtype=wp.vec3, device=self.device)
        self._embed(state.particle_qd[self.vertices], sites)
        velocities, site = sites.numpy()[: self.surface.site_count], self.surface.point_place
        return velocities if site is None else velocities[site]

    def surface_triangles(self) -> wp.array:
        """Triangles of the surface, shape (triangle_count,) vec3i."""
        return self._triangles[: len(self.surface.triangles)]

    def set_surface(self, surface: Surface) -> None:
        """Take over a surface whose points are in the coordinates already."""
        self.surface = surface
        self.point_count.fill_(surface.site_count)
        _write_rows(self._triangles, 0, np.asarray(surface.triangles, dtype=np.int32))
        if self.has_contact:
            start = self.surface_particles.start
            flags = np.full(surface.site_count, int(newton.ParticleFlags.ACTIVE), dtype=np.int32)
            _write_rows(self.model.particle_flags, start, flags)

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Rest positions in the world [m], shape (n, 3), of points of the cage's rest frame, shape (n, dimension)."""
        return self._frame.to_world(points)

    def keep(self, journal: Journal, states: Sequence[newton.State]) -> None:
        """Keep what an edit of the body overwrites, but for what its coordinates keep themselves.

        Args:
            journal: The edit's journal.
            states: States that the edit carries over.
        """
        journal.when_taken_back(self.refresh)
        self.keep_definition(journal)
        journal.keep_attributes(self, "surface", "quadrature")
        journal.keep(*self.edited_arrays(states))

    def edited_arrays(self, states: Sequence[newton.State]) -> list[wp.array]:
        """The arrays that edits of the body write to, but for its coordinates' and those that :meth:`refresh` makes.

        Args:
            states: States that are carried over.
        """
        model, row = self.model, slice(self.row, self.row + 1)
        arrays = [self.rest, self.fixed, self.vertex_count, self.point_count, self._triangles]
        arrays += [self._stamps.edits[row], *(state_edits(owner)[row] for owner in (model, *states))]
        owners = (model, *states)
        arrays += [array[part] for o in owners for array in (o.particle_q, o.particle_qd) for part in self.parts]
        if self.has_contact:
            arrays.append(model.particle_flags[self.surface_particles])
        if self.system is not None:
            arrays.append(self.system.volumes)
        return arrays

    def keep_definition(self, journal: Journal) -> None:
        """Keep what the body is made of, its own and the model's.

        Args:
            journal: The edit's journal.
        """
        journal.when_taken_back(partial(self.model.cagecut.definition.__setitem__, self.row, self.definition))
        journal.keep_attributes(self, "definition")

    def define(self, definition: BodyDefinition) -> None:
        """Replace what the body is made of, its own and the model's."""
        self.definition = definition
        self.model.cagecut.definition[self.row] = definition

    def commit_edit(self, number: int, states: Sequence[newton.State]) -> None:
        """Hand an edit on to model and states: what the body is now, and which edit that is.

        Args:
            number: Number of the edit.
            states: States that were carried over.
        """
        before = self.definition
        self.define(
            replace(
                before,
                cage=self.cage,
                surface=self.surface,
                fixed=self.fixed.numpy()[: self.cage.vertex_count] != 0,
                uncut=before.before_cuts if number > 0 else None,
                edit=number,
                last_edit=max(number, before.last_edit),
            )
        )
        for edits in (self._stamps.edits, *(state_edits(owner) for owner in (self.model, *states))):
            edits[self.row : self.row + 1].fill_(number)
        if self.has_contact:
            for owner in (self.model, *states):
                self.embed_particles(owner)

    def distribute_quadrature(self, journal: Journal) -> None:
        """Give every piece enough quadrature points and its own volume, after pieces came off.

        Args:
            journal: The edit's journal, after :meth:`keep`.
        """
        if self.quadrature is None:
            return
        before = self.quadrature
        self.quadrature = before.distributed(self.cage, self.coordinates.domain.distance_to_walls)
        placed = np.arange(before.used_count, self.quadrature.used_count)
        if len(placed):
            self.coordinates.set_points(placed, self.quadrature.points[placed], journal=journal)
        self.system.volumes.assign(self.quadrature.volumes.astype(np.float32))

    def refresh(self) -> None:
        """Bring what depends on the weights up to date after an edit."""
        if self.system is not None:
            self.piece.assign(self.padded(self.cage.vertex_piece))
            self.system.stabilize(self.cage.vertices, self.cage.mesh.edges)
            self.system.refresh()
            self.show_masses()
        if self.contact is not None:
            self.contact.refresh()

    def show_masses(self) -> None:
        """Bring the model's masses up to date with the system's."""
        wp.copy(self.model.particle_mass[self.vertices], self.system.vertex_mass)

    def energy(self, state: newton.State) -> Energy:
        """Elastic and kinetic energy of a state [J], read on the host."""
        self.require_current(state)
        if self.system is None:
            return Energy(0.0, 0.0)
        return self.system.energy(state.particle_q[self.vertices], state.particle_qd[self.vertices])

    def nudged_sites(self, surface: Surface, indices: np.ndarray) -> np.ndarray:
        """Sites of a surface, those on several cuts moved by next to nothing into their own piece.

        Args:
            surface: The surface.
            indices: Which of them, shape (n,).

        Returns:
            Rest positions [m], shape (n, dimension).
        """
        places, step = surface.site_points[indices], _NUDGE * self.definition.cage.diameter
        moved = np.flatnonzero(surface.on_several_cuts(indices))
        places[moved] += step * surface.directions_inward(np.asarray(indices)[moved])
        return places

    def _sample(self, definition: BodyDefinition) -> BodyQuadrature | None:
        if not definition.quadrature_count:
            return None
        return BodyQuadrature.sampled(
            definition.cage,
            definition.quadrature_count,
            spare_count=SPARE_COUNT if definition.cuttable else 0,
            seed=definition.seed,
            thickness=definition.thickness,
        )

    def fresh(self, definition: BodyDefinition) -> tuple[BodyQuadrature | None, HarmonicCoordinates]:
        """Quadrature and coordinates as a new solver would make them; nothing of the body changes.

        Args:
            definition: What the body is made of.
        """
        sample = self._sample(definition)
        return sample, self._bake(definition, sample, None)

    def _bake(
        self,
        definition: BodyDefinition,
        sample: BodyQuadrature | None,
        progress: Callable[[float], None] | None,
    ) -> HarmonicCoordinates:
        surface = definition.surface
        quadrature = np.zeros((0, definition.cage.dimension)) if sample is None else sample.points
        sites = surface.site_points.copy()
        on_cuts = np.flatnonzero(surface.site_key >= 0)
        if len(on_cuts):
            sites[on_cuts] = self.nudged_sites(surface, on_cuts)
        points = np.concatenate([quadrature, sites])
        return HarmonicCoordinates(
            definition.cage,
            points,
            definition.walks,
            definition.seed,
            gradients=np.arange(len(points)) < len(quadrature),
            cuttable=definition.cuttable,
            device=self.device,
            point_keys=np.concatenate([np.full(len(quadrature), -1), surface.site_key]),
            point_capacity=len(quadrature) + self.capacity.surface_points,
            vertex_capacity=self.capacity.vertices,
            progress=progress,
            **definition.options,
        )

    def _embed(self, vertices: wp.array, points: wp.array) -> None:
        inputs = [vertices, self.surface_rows, points]
        wp.launch(embed, dim=self.capacity.surface_points, inputs=inputs, device=self.device)

    def _make_system(self) -> ReducedSystem:
        return ReducedSystem(
            self.rest,
            self.coordinates.weights_array[: self.quadrature_count],
            self.coordinates.gradients_array,
            self.quadrature.volumes,
            self.definition.material,
            self.vertex_count,
            fixed=self.fixed,
            rotation=wp.array([self._frame.rotation], dtype=wp.mat33, device=self.device),
            thickness=self.definition.thickness,
            piece=self.piece,
            **self.config.system_options,
        )

    def padded(self, mask: np.ndarray) -> np.ndarray:
        """A value a vertex of the cage, and zeros for spare ones, shape (vertex_capacity,), int32."""
        padded = np.zeros(self.capacity.vertices, dtype=np.int32)
        padded[: len(mask)] = mask
        return padded


def _write_rows(array: wp.array, start: int, rows: np.ndarray) -> None:
    """Write rows of a device array in place."""
    if len(rows):
        wp.copy(array[start : start + len(rows)], wp.array(rows, dtype=array.dtype, device=array.device))
