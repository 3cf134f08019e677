# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A scene of cage bodies that are cut, in the form of Newton's examples."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from argparse import ArgumentParser, Namespace

import newton
import newton.examples
import numpy as np
import warp as wp

from examples.cutting import CutSchedule, PlannedCut
from examples.options import CPU_WALKS, add_options
from examples.picture import Camera, Color
from examples.progress import frame_bar
from examples.recording import Recording, StaticMesh
from examples.timings import Timings
from newton_cagecut import SolverCageCut
from newton_cagecut.solver import CageBody

_NO_DISPLAY = ("NoSuchDisplayException", "NoSuchConfigException", "NoSuchScreenModeException")


class CutScene(ABC):
    """What the scenes have in common: a scene says what is in it, this does the rest.

    Args:
        viewer: One of Newton's viewers.
        args: Options, those of ``create_parser()``.
    """

    name: str
    fps = 30
    substep_count = 2
    frame_count: int
    camera: Camera
    skin_color: Color
    cap_color: Color
    paint_color: Color | None = None
    static_meshes: tuple[StaticMesh, ...] = ()

    def __init__(self, viewer: newton.viewer.ViewerBase, args: Namespace):
        self.viewer, self.args = viewer, args
        self.walks = CPU_WALKS if args.walks is None and not wp.get_device().is_cuda else args.walks
        self.frame = 0
        builder = newton.ModelBuilder()
        SolverCageCut.register_custom_attributes(builder)
        self.add_bodies(builder)
        builder.add_ground_plane()
        self.recording = Recording(self, usd=args.usd, picture=args.picture, picture_frame=args.picture_frame)
        self.model = builder.finalize()
        self.solver = SolverCageCut(self.model)
        self.solver.warm_up()
        self.state_0, self.state_1 = self.model.state(), self.model.state()
        self.control = self.model.control()
        self.pipeline = newton.CollisionPipeline(self.model)
        self.contacts = self.pipeline.contacts()
        self.plan = self.cuts()
        self.schedule = CutSchedule(self.solver, self.plan, pace=args.pace)
        self.timings = Timings(self.solver, self.plan) if args.timings else None
        unwatched = args.headless or args.viewer in ("null", "usd")
        self._bar = frame_bar(args.num_frames) if unwatched else None
        viewer.set_model(self.model)
        self._aim_viewer()

    @abstractmethod
    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        """Add what is in the scene, but for the ground."""

    @abstractmethod
    def cuts(self) -> list[PlannedCut]:
        """Return the cuts that will be made."""

    def painted(self, body: CageBody) -> np.ndarray:
        """Return which triangles of a body's surface have the colour of the paint, as a mask."""
        return np.zeros(body.surface.triangle_count, dtype=bool)

    def step(self) -> None:
        """Advance the blade and the time by a frame."""
        number = self.schedule.current
        report = self.schedule.advance((self.state_0, self.state_1))
        if report is not None and self.timings is not None:
            self.timings.add_cut_step(number, report)
        start = time.perf_counter()
        for _ in range(self.substep_count):
            self.state_0.clear_forces()
            self.viewer.apply_forces(self.state_0)
            self.pipeline.collide(self.state_0, self.contacts)
            dt = 1.0 / (self.fps * self.substep_count)
            self.solver.step(self.state_0, self.state_1, self.control, self.contacts, dt)
            self.state_0, self.state_1 = self.state_1, self.state_0
        if self.timings is not None:
            wp.synchronize_device(self.model.device)
            self.timings.add_simulation(self.substep_count, time.perf_counter() - start)
        self.frame += 1

    def render(self) -> None:
        """Show the frame, and record it."""
        self.viewer.begin_frame(self.frame / self.fps)
        self.viewer.log_state(self.state_0)
        self.solver.log(self.viewer, self.state_0)
        self.viewer.end_frame()
        self.recording.add_frame(self.frame)
        if self._bar is not None:
            self._bar.update()

    def close(self) -> None:
        """Write the files and the timings; also after an error, with what there is."""
        if self._bar is not None:
            self._bar.close()
        self.recording.close()
        if self.timings is not None:
            print(self.timings.table())

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
            points, _ = self.solver.surface(self.state_0, body.label)
            require(np.isfinite(points).all(), f"{body.label}: the surface is finite")
            require(points[:, 2].min() > -0.02, f"{body.label}: the surface is above the ground")
            require(np.abs(points).max() < 2.0, f"{body.label}: the surface is within 2 m of the middle")
            require(body.surface.closed or body.is_plane, f"{body.label}: the surface is closed")
            sums = body.coordinates.weights.sum(axis=1)
            require(np.abs(sums - 1.0).max() < 1e-4, f"{body.label}: the weights of each point sum to 1")
            require(_moves_as_pieces(body), f"{body.label}: each piece of the surface moves with one piece of the cage")
            pieces += body.surface.mesh.component_count
        done = self.schedule.current
        if not self.schedule.active:
            expected = self.plan[done - 1].pieces if done else len(self.solver.bodies)
            require(pieces == expected, f"{expected} pieces after {done} cuts, {pieces} found")

    @classmethod
    def create_parser(cls) -> ArgumentParser:
        """Return the parser of the scene's options: Newton's and a few more."""
        parser = newton.examples.create_parser()
        parser.prog = f"python -m examples {cls.name}"
        parser.description = cls.__doc__
        parser.set_defaults(num_frames=cls.frame_count)
        add_options(parser, cls.name)
        return parser

    @classmethod
    def main(cls) -> CutScene:
        """Run the scene with the options of the command line, and return it as it is at the end."""
        try:
            viewer, args = newton.examples.init(cls.create_parser())
        except Exception as error:
            if type(error).__name__ not in _NO_DISPLAY:  # classes of pyglet, which other viewers do without
                raise
            raise SystemExit(
                f"{cls.name}: a window needs a display, and there is none ({error}); --headless draws without one, "
                "--viewer null shows nothing, and --usd and --picture write files"
            ) from None
        scene = cls(viewer, args)
        try:
            newton.examples.run(scene, args)
        finally:
            scene.close()
        return scene

    def _aim_viewer(self) -> None:
        """Point an interactive viewer's camera to where the picture is taken from."""
        ahead = np.subtract(self.camera.target, self.camera.eye)
        yaw = np.degrees(np.arctan2(ahead[1], ahead[0]))
        pitch = np.degrees(np.arctan2(ahead[2], np.hypot(ahead[0], ahead[1])))
        self.viewer.set_camera(wp.vec3(*self.camera.eye), float(pitch), float(yaw))


def require(true: bool, text: str) -> None:
    """Raise if something is not true that should be at the end of a scene."""
    if not true:
        raise ValueError(f"the scene's test failed: {text}")


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
