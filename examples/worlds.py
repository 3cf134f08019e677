# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""64 balls in 64 worlds are cut at once, each at an angle of its own; ``--worlds N`` takes fewer.

Each world has its own copy of the body; the cuts of a frame are made one after the other.

Success criteria: two pieces in every world, of the same volumes in all.
"""

from __future__ import annotations

from argparse import ArgumentParser

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut

from .base import Camera, CutScene, CutSchedule, PlannedCut, box_cage, require

RADIUS, SPACING = 0.3, 1.1  # [m]


class Example(CutScene):
    name = "worlds"
    frame_count = 75
    skin_color, cap_color = (0.02, 0.28, 0.38), (0.95, 0.75, 0.35)
    camera = Camera(eye=(3.6, -9.5, 7.2), target=(0.0, -0.35, 0.0))

    @classmethod
    def create_parser(cls) -> ArgumentParser:
        parser = super().create_parser()
        parser.add_argument("--worlds", type=int, default=64, metavar="N", help="how many")
        return parser

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        world = newton.ModelBuilder()
        cagecut.SolverCageCut.register_custom_attributes(world)
        ball = newton.Mesh.create_sphere(RADIUS, num_latitudes=20, num_longitudes=28)
        cagecut.add_cage_body(
            world,
            box_cage(3 * (2.1 * RADIUS,)),
            ball,
            material=cagecut.Material(young=1.5e4, density=50.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, RADIUS + 0.02), wp.quat_identity()),
            quadrature=100,
            contact_radius=0.004,
            walks=min(self.walks or 64, 64),
            label="ball",
        )
        side = int(np.ceil(np.sqrt(self.args.worlds)))
        for k in range(self.args.worlds):
            place = SPACING * (np.array([k % side, k // side, 0.0]) - 0.5 * (side - 1) * np.array([1.0, 1.0, 0.0]))
            builder.add_world(world, xform=wp.transform(place, wp.quat_identity()))

    def cuts(self) -> tuple[PlannedCut, ...]:
        """Return the cut of each world, at angles that go round once over all."""
        count = self.args.worlds
        angles = np.pi * np.arange(count) / count
        blades = [cagecut.Blade((0.007, 0.004, 0), (np.cos(a), np.sin(a), 0.0), (0, 0, -1)) for a in angles]
        return tuple(
            PlannedCut(name=f"world {k}", blade=blade, wait=8, body=k, pieces=2 * count)
            for k, blade in enumerate(blades)
        )

    def schedule_cuts(self) -> list[CutSchedule]:
        """Return a schedule for each world: they run at once."""
        return [CutSchedule(self.solver, [cut], step=0.08, pace=self.args.pace) for cut in self.plan]

    def test_final(self) -> None:
        super().test_final()
        if not all(schedule.current for schedule in self.schedules):
            return
        volumes = np.array([[piece.volume for piece in body.pieces] for body in self.solver.bodies])
        require(np.abs(volumes - 0.5 * volumes.sum(axis=1, keepdims=True)).max() < 0.02, "each world is cut in half")
