# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A jelly on a round stand is cut in half, and again across both halves (adversarial: each cut goes through all of it).

Success criteria: four pieces, all of which have slid off the stand.
"""

from __future__ import annotations

import newton
import warp as wp

from newton_cagecut import Blade, Material

from ..base import Camera, CutScene, PlannedCut, frames_of

STAND_RADIUS, STAND_HEIGHT = 0.16, 0.22
CUTS = tuple(
    PlannedCut(name=name, blade=Blade((0.0, 0.0, 0.0), edge, (0.0, 0.0, -1.0)), wait=wait, pieces=pieces)
    for name, edge, wait, pieces in (
        ("in half", (1.0, 0.0, 0.0), 20, 2),
        ("in quarters", (0.0, 1.0, 0.0), 0, 4),
    )
)


class Example(CutScene):
    name = "jelly"
    frame_count = frames_of(CUTS) + 40
    skin_color, cap_color = (0.55, 0.03, 0.08), (0.90, 0.25, 0.25)
    camera = Camera(eye=(0.95, -2.75, 1.6), target=(0.0, -0.03, 0.17))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "jelly",
            material=Material(young=2e4, poisson=0.4, density=1000.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, STAND_HEIGHT + 0.02), wp.quat_identity()),
            crossing=True,
        )
        self.add_stand(builder, radius=STAND_RADIUS, height=STAND_HEIGHT)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS
