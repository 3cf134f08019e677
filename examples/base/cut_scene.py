# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A scene of cage bodies that are simulated and cut on a schedule."""

from __future__ import annotations

import time
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace

import newton
import numpy as np
import warp as wp

from newton_cagecut import Capacity, Material, SolverCageCut, add_cage_body
from newton_cagecut.solver import CageBody
from newton_cagecut.usd import BodyFrame, SceneFrame

from .assets import asset
from .cutting import CutSchedule, PlannedCut
from .picture import Color
from .progress import say
from .scene import Scene, require
from .timings import Timings


class CutScene(Scene):
    """A scene of cage bodies: it says what is in it and how it is cut."""

    substep_count = 2
    skin_color: Color
    cap_color: Color
    paint_color: Color | None = None
    shape_color: Color = (0.16, 0.18, 0.21)
    has_ground = True
    parted_at = 0
    """Frame in which the last cut went through."""

    def build(self) -> None:
        builder = newton.ModelBuilder()
        SolverCageCut.register_custom_attributes(builder)
        self.add_bodies(builder)
        if self.has_ground:
            builder.add_ground_plane()
        self.model = builder.finalize()
        if self.args.demo:
            say(1, "weights, by random walks from each point; the first time their kernels are compiled, for a minute")
        self.solver = SolverCageCut(self.model)
        if self.args.demo:
            say(2, "compiling the kernels of steps, contacts and cuts; the next time they are found in Warp's cache")
        self.solver.warm_up(progress=True if self.args.demo else None)
        if self.args.demo:
            say(3, f"{self.args.num_frames} frames, in which {len(self.cuts())} cuts are made, and the files")
        self.state_0, self.state_1 = self.model.state(), self.model.state()
        self.control = self.model.control()
        self.pipeline = newton.CollisionPipeline(self.model)
        self.contacts = self.pipeline.contacts()
        self.plan = self.cuts()
        self.schedules = self.schedule_cuts()
        self.timings = Timings(self.solver, self.plan) if self.args.timings else None
        self.viewer.set_model(self.model)

    @abstractmethod
    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        """Add what is in the scene, but for the ground."""

    @abstractmethod
    def cuts(self) -> Sequence[PlannedCut]:
        """Return the cuts that will be made."""

    def schedule_cuts(self) -> list[CutSchedule]:
        """Return schedules that run at once; one after the other is one schedule."""
        return [CutSchedule(self.solver, self.plan, pace=self.args.pace)]

    @property
    def schedule(self) -> CutSchedule:
        """The first schedule, in most scenes the only one."""
        return self.schedules[0]

    def act(self) -> None:
        """Set forces and targets of the next step; called in each substep."""

    def painted(self, body: CageBody) -> np.ndarray:
        """Return which triangles of a body's surface have the colour of the paint, as a mask."""
        return np.zeros(body.surface.triangle_count, dtype=bool)

    def add_asset(
        self,
        builder: newton.ModelBuilder,
        name: str,
        *,
        material: Material,
        cuts: int | None = None,
        crossing: bool = False,
        **options: object,
    ) -> int:
        """Add a body of the shapes in ``assets``, which collides, and return its index.

        Args:
            builder: The builder.
            name: Name of the shape, and of the body.
            material: Its material.
            cuts: Cuts that there is to be room for; ``None`` for the default.
            crossing: Whether they go through one another.
            options: Further options of ``add_cage_body``.
        """
        cage, surface = asset(name)
        room = Capacity.for_cuts(cage, surface, **({} if cuts is None else {"cuts": cuts}), crossing=crossing)
        options = {"capacity": room, "contact_radius": 0.004, "walks": self.walks, "label": name} | options
        return add_cage_body(builder, cage, surface, material=material, **options)

    @staticmethod
    def add_stand(builder: newton.ModelBuilder, *, radius: float, height: float) -> None:
        """Add a cylinder that stands on the ground at the origin.

        Args:
            builder: The builder.
            radius: Its radius [m].
            height: Its height [m].
        """
        place = wp.transform((0.0, 0.0, 0.5 * height), wp.quat_identity())
        builder.add_shape_cylinder(-1, xform=place, radius=radius, half_height=0.5 * height)

    def advance(self) -> None:
        """Advance the blade and the time by a frame."""
        for schedule in self.schedules:
            number = schedule.current
            report = schedule.advance((self.state_0, self.state_1))
            if report is not None and report.complete:
                self.parted_at = self.frame
            if report is not None and self.timings is not None:
                self.timings.add_cut_step(number, report)
        start = time.perf_counter()
        for _ in range(self.substep_count):
            self.state_0.clear_forces()
            self.viewer.apply_forces(self.state_0)
            self.act()
            self.pipeline.collide(self.state_0, self.contacts)
            self.solver.step(self.state_0, self.state_1, self.control, self.contacts, self.dt)
            self.state_0, self.state_1 = self.state_1, self.state_0
        if self.timings is not None:
            wp.synchronize_device(self.model.device)
            self.timings.add_simulation(self.substep_count, time.perf_counter() - start)

    @property
    def dt(self) -> float:
        """The time step [s]."""
        return 1.0 / (self.fps * self.substep_count)

    def show(self) -> None:
        self.viewer.log_state(self.state_0)
        self.solver.log(self.viewer, self.state_0)

    def scene_frame(self) -> SceneFrame:
        """Return the scene in its colours, with paint as bodies of their own."""
        whole = self.solver.scene_frame(self.state_0)
        frames = []
        for body, frame in zip(self.solver.bodies, whole.bodies):
            frame, paint = self.colored(body, frame), self.painted(body)
            frames.append(_part(frame, ~paint) if paint.any() else frame)
            if paint.any():
                name = f"{frame.name}_paint"
                frames.append(replace(_part(frame, paint), name=name, skin_color=self.paint_color, cage_points=None))
        shapes = tuple(replace(shape, color=self.shape_color) for shape in whole.shapes)
        return replace(whole, bodies=tuple(frames), shapes=shapes)

    def colored(self, body: CageBody, frame: BodyFrame) -> BodyFrame:
        """Return a body's frame in its colours."""
        return replace(frame, skin_color=self.skin_color, cap_color=self.cap_color)

    def close(self) -> None:
        """Write the files and the timings; also after an error, with what there is."""
        super().close()
        if self.timings is not None:
            print(self.timings.table())

    def points(self, body: int | str = 0) -> np.ndarray:
        """Return where the points of a body's surface are now [m]."""
        return self.solver.surface(self.state_0, body)[0]

    def test_post_step(self) -> None:
        """Check that the state is finite."""
        for body in self.solver.bodies:
            count = body.cage.vertex_count
            for field in (self.state_0.particle_q, self.state_0.particle_qd):
                values = field[body.vertices].numpy()[:count]
                if not np.isfinite(values).all():
                    raise ValueError(
                        f"frame {self.frame}: cage vertex {_first_bad(values)} of {body.label} is not finite"
                    )

    def test_final(self) -> None:
        """Check pieces, weights, surface and where it lies."""
        pieces = 0
        for body in self.solver.bodies:
            points = self.points(body.label)
            require(np.isfinite(points).all(), f"{body.label}: the surface is finite")
            require(not self.has_ground or points[:, 2].min() > -0.02, f"{body.label}: the surface is above the ground")
            require(np.abs(points).max() < 5.0, f"{body.label}: the surface is within 5 m of the middle")
            require(body.surface.closed or body.is_plane, f"{body.label}: the surface is closed")
            sums = body.coordinates.weights.sum(axis=1)
            require(np.abs(sums - 1.0).max() < 1e-4, f"{body.label}: the weights of each point sum to 1")
            require(_moves_as_pieces(body), f"{body.label}: each piece of the surface moves with one piece of the cage")
            pieces += body.surface.mesh.component_count
        done = self.schedule.current
        if not self.schedule.active:
            expected = self.plan[done - 1].pieces if done else len(self.solver.bodies)
            require(pieces == expected, f"{expected} pieces after {done} cuts, {pieces} found")


def _part(frame: BodyFrame, triangles: np.ndarray) -> BodyFrame:
    """Return a body with some of its triangles, given as a mask."""
    uvs = None if frame.uvs is None else frame.uvs[triangles]
    return replace(frame, triangles=frame.triangles[triangles], triangle_cap=frame.triangle_cap[triangles], uvs=uvs)


def _moves_as_pieces(body: CageBody) -> bool:
    """Whether all points of a piece of the surface have their weights on one and the same piece of the cage."""
    weights = body.surface_weights
    owned = np.arange(body.cage.component_count) == np.asarray(body.cage.vertex_component)[:, None]
    shares = weights @ owned.astype(np.float32)
    owner, piece = shares.argmax(axis=1), body.surface.mesh.vertex_component
    first_owner = owner[np.unique(piece, return_index=True)[1]]
    return bool((shares.max(axis=1) > 1.0 - 1e-4).all() and (owner == first_owner[piece]).all())


def _first_bad(values: np.ndarray) -> int:
    return int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
