# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A soft starfish lies on a stand; two arms are cut off, a third is cut half way.

Success criteria: three pieces; the arms that are cut off lie on the ground; the third hangs on.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from newton_cagecut import Blade, Material

from ..base import Camera, CutScene, PlannedCut, frames_of

STAND_RADIUS, STAND_HEIGHT = 0.16, 0.26
TURN = 0.8 * np.pi  # brings the arms that are cut to the front
CUT_DISTANCE = 0.4  # of the cuts from the middle [m]; closer than 0.23 they would graze the neighbouring arms


def across_arm(arm: int) -> Blade:
    """Return a blade that goes down through an arm, square to it."""
    angle = np.radians(90.0 + 72.0 * arm)
    along = np.array([np.cos(angle), np.sin(angle), 0.0])
    return Blade(CUT_DISTANCE * along, np.cross((0.0, 0.0, 1.0), along), (0.0, 0.0, -1.0))


CUTS = (
    PlannedCut(name="first arm", blade=across_arm(0), wait=30, pieces=2),
    PlannedCut(name="second arm", blade=across_arm(1), wait=4, pieces=3),
    PlannedCut(name="third arm", blade=across_arm(2), wait=4, until=0.66, pieces=3),
)


class Example(CutScene):
    name = "starfish"
    frame_count = frames_of(CUTS) + 50
    skin_color, cap_color = (0.74, 0.125, 0.04), (1.0, 0.62, 0.43)
    camera = Camera(eye=(0.42, -1.42, 0.88), target=(0.04, -0.14, 0.175))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "starfish",
            material=Material(young=2e4, poisson=0.4, density=1000.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, STAND_HEIGHT + 0.1), wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), TURN)),
        )
        self.add_stand(builder, radius=STAND_RADIUS, height=STAND_HEIGHT)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS
