# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Sequences in which bodies move and are cut, with their surfaces, particles and animations."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut
from benchmarks.fingerprint_record import Record
from benchmarks.fingerprint_shapes import SQUARE, across, ball, cage_on, down, star
from newton_cagecut.usd import AnimationWriter, BodyFrame

_UPRIGHT = wp.quat_from_axis_angle(wp.vec3(1.0, 0.0, 0.0), 0.5 * np.pi)
_DT = 1.0 / 60.0


class Scene:
    """A body above the ground.

    Where integers are all that is wanted it does not move, and its coordinates are of one walk a point.

    Args:
        record: The record.
        cage: The cage of the body.
        surface: Its surface.
        height: Height of the rest frame's origin [m].
        options: Options of ``add_cage_body``.
    """

    def __init__(self, record: Record, cage: cagecut.Cage, surface: cagecut.Surface, height: float = 0.0, **options):
        turn = _UPRIGHT if cage.dimension == 2 else wp.quat_identity()
        defaults = {"walks": 32, "quadrature": 60, "xform": wp.transform((0.1, 0.2, height), turn)}
        options = {**defaults, "material": cagecut.Material(young=1.0e4, damping=0.02), **options}
        if record.integers:
            options |= {"walks": 1, "quadrature": 0}
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
        cagecut.SolverCageCut.register_custom_attributes(builder)
        cagecut.add_cage_body(builder, cage, surface, label="body", **options)
        builder.add_ground_plane()
        self.record, self.model = record, builder.finalize(device="cpu")
        self.model.soft_contact_ke = 2.0e5
        self.solver, self.pipeline = cagecut.SolverCageCut(self.model), newton.CollisionPipeline(self.model)
        self.states, self.contacts = [self.model.state(), self.model.state()], self.pipeline.contacts()
        self.note("start")

    @property
    def body(self):
        """The body."""
        return self.solver.body("body")

    def run(self, count: int) -> None:
        """Step so many times.

        Args:
            count: How many times.
        """
        for _ in range(0 if self.record.integers else count):
            self.states[0].clear_forces()
            self.pipeline.collide(self.states[0], self.contacts)
            self.solver.step(*self.states, None, self.contacts, _DT)
            self.states.reverse()

    def advance(self, step: str, cut, share: float, count: int = 0) -> None:
        """Advance a cut, step so many times, and record all of it.

        Args:
            step: Name of the step.
            cut: The cut.
            share: Depth, as a share of the cut's length.
            count: How many times to step.
        """
        report = self.solver.advance_cut(cut, to=share * cut.length, states=self.states)
        self.run(count)
        self.note(step, report)

    def note(self, step: str, report: cagecut.CutReport | None = None) -> None:
        """Record the body as it is.

        Args:
            step: Name of the step.
            report: What a cut has done in it.
        """
        record, body = self.record, self.body
        record.begin(step)
        if report is not None:
            record.add(report=(report.complete, report.components, report.separated))
            record.add(created=(report.vertices_created, report.points_created))
            record.add(depth=report.depth, energy=(report.energy_before, report.energy_after))
        record.add_cage(body.cage)
        record.add_surface(body.surface, body.cage)
        if record.integers:
            return
        if report is not None:
            record.add_stats(report.stats)
        record.add_coordinates(body.coordinates)
        state, pieces = self.states[0], self.solver.pieces("body")
        points, triangles = self.solver.surface(state, "body")
        record.add(
            particle_q=state.particle_q.numpy(),
            particle_qd=state.particle_qd.numpy(),
            particle_mass=self.model.particle_mass.numpy(),
            particle_flags=self.model.particle_flags.numpy(),
            contacts=self.contacts.soft_contact_count.numpy(),
            world_surface=(points, triangles),
            piece_members=tuple(part for piece in pieces for part in (piece.vertices, piece.faces)),
            piece_points=tuple(part for piece in pieces for part in (piece.surface_points, piece.surface_triangles)),
            piece_masses=np.array([(piece.volume, piece.mass) for piece in pieces]),
        )

    def frame(self) -> BodyFrame:
        """Return what the body looks like now."""
        body, (points, triangles) = self.body, self.solver.surface(self.states[0], "body")
        missing = np.zeros((body.surface.point_count, 3 - body.surface.dimension))
        return BodyFrame(
            name="body",
            points=points,
            triangles=triangles,
            triangle_cap=body.surface.triangle_cap,
            rest_points=np.concatenate([body.surface.points, missing], axis=1),
            cage_points=self.states[0].particle_q.numpy()[body.vertices][: body.cage.vertex_count],
            cage_faces=body.cage.faces,
        )


def dropped(record: Record, dimension: int) -> None:
    """Drop a body onto the ground, cut it twice while it bounces, and write an animation of it."""
    scene = Scene(record, cage_on(SQUARE, dimension), ball(dimension), 0.05, contact_radius=0.02, velocity=(0, 0, -1.0))
    frames = [scene.frame()]
    scene.run(8)
    for name, make in (("down", down), ("across", across)):
        cut = scene.solver.begin_cut("body", make(dimension))
        for share in (0.4, 1.1):
            scene.advance(f"{name} to {share:g}", cut, share, 5)
            frames.append(scene.frame())
    with TemporaryDirectory() as folder:
        path = Path(folder) / "body.usda"
        with AnimationWriter(path, normals=True, separate_caps=False) as writer:
            writer.add_ground_plane()
            for number, frame in enumerate(frames):
                writer.write_frame(number, frame)
        record.add(usd=path.read_text())


def hanging(record: Record, dimension: int) -> None:
    """Hang up a body whose cage has polygons of many corners, cut it with a blade that turns, and undo that."""
    cage, surface = cage_on(star(3, 0.9), dimension, 1.0), ball(dimension, 0.35, 0.0)
    if dimension == 3:
        surface = cagecut.Surface(surface.points + [0.0, 0.0, 0.5], surface.triangles)
    fixed = np.flatnonzero(cage.vertices[:, -1] > (0.7 if dimension == 2 else 0.9))
    scene = Scene(record, cage, surface, 2.0, fixed=fixed, seed=3)
    scene.run(4)
    edge = [[0.1, 1.0, 0.05]] if dimension == 3 else []
    blade = cagecut.Blade(np.append([0.05] * (dimension - 1), 0.0), *edge, np.append(np.zeros(dimension - 1), -1.0))
    cut = scene.solver.begin_cut("body", blade)
    scene.advance("cut to 0.4", cut, 0.4, 4)
    kept = scene.solver.snapshot("body", states=scene.states, cuts=(cut,))
    cut.turn(np.append([0.6] + [0.0] * (dimension - 2), -1.0))
    scene.advance("turned to 0.7", cut, 0.7, 4)
    scene.advance("turned to 1.1", cut, 1.1, 4)
    scene.solver.restore(kept)
    scene.note("restored")
    scene.advance("cut to 1.1", cut, 1.1, 4)


def keyframed(record: Record, dimension: int) -> None:
    """Cut a body that is moved by its cage's vertices alone, with two blades that cross."""
    scene = Scene(record, cage_on(SQUARE, dimension), ball(dimension), quadrature=0, seed=2)
    positions = scene.states[0].particle_q.numpy()
    positions[: scene.body.cage.vertex_count] *= np.array([1.1, 0.8, 1.5], dtype=np.float32)
    scene.states[0].particle_q.assign(positions)
    scene.run(1)
    first, second = (scene.solver.begin_cut("body", make(dimension)) for make in (down, across))
    scene.advance("first to 0.5", first, 0.5, 1)
    scene.advance("second to 0.6", second, 0.6, 1)
    scene.advance("first to 1.2", first, 1.2, 1)
    scene.advance("second to 1.2", second, 1.2, 1)


def knives(record: Record) -> None:
    """Cut a body with a knife of finite width, and with one that starts inside."""
    scene = Scene(record, cage_on(SQUARE, 3), ball(3), 1.0)
    blade = cagecut.Blade([0.5, 0.5, 0.5], [0, 1, 0.1], [0.1, 0, -1], width=(-0.2, 0.15))
    cut = scene.solver.begin_cut("body", blade)
    scene.advance("from above to 0.5", cut, 0.5, 3)
    scene.advance("from above to 1.1", cut, 1.1, 3)
    blade = cagecut.Blade([0.25, 0.5, 0.65], [0.1, 1, 0], [0, 0.1, -1], width=0.3, start=0.0)
    cut = scene.solver.begin_cut("body", blade)
    scene.advance("inside to 0.3", cut, 0.3, 3)
    scene.advance("inside to 0.6", cut, 0.6, 3)
