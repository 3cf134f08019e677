# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A ball of 10242 points in a cube of 8 vertices falls in half, and each half again (adversarial).

All walks of the ball pass near the blade: nothing about these cuts is local.

Success criteria: four pieces of about the same size.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from newton_cagecut import Blade, Material

from ..base import Camera, CutScene, PlannedCut, frames_of, require

STAND_RADIUS, STAND_HEIGHT = 0.1, 0.25
CUTS = tuple(
    PlannedCut(name=name, blade=Blade((0.007, 0.004, 0.0), edge, (0.0, 0.0, -1.0)), wait=wait, pieces=pieces)
    for name, edge, wait, pieces in (
        ("in half", (1.0, 1.0, 0.0), 16, 2),
        ("in quarters", (1.0, -1.0, 0.0), 0, 4),
    )
)


class Example(CutScene):
    name = "sphere"
    frame_count = frames_of(CUTS, step=0.05) + 35
    skin_color, cap_color = (0.80, 0.30, 0.03), (1.0, 0.68, 0.25)
    camera = Camera(eye=(0.8, -3.5, 2.0), target=(0.0, 0.0, 0.33))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "sphere",
            material=Material(young=3e4, poisson=0.4, density=200.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, STAND_HEIGHT + 0.5), wp.quat_identity()),
            cuts=4,
            crossing=True,
        )
        self.add_stand(builder, radius=STAND_RADIUS, height=STAND_HEIGHT)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def test_final(self) -> None:
        super().test_final()
        volumes = np.array([piece.volume for piece in self.solver.pieces("sphere")])
        require(np.ptp(volumes) < 0.02 * volumes.sum(), "the pieces are of the same size")
