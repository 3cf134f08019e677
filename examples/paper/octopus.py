# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""An octopus loses two arms and half of a third to knives of finite width (the paper's figure 19).

Two cuts are complete, the third stays partial; the knives are no wider than an arm, so that no other is touched.

Success criteria: three pieces, and a third arm that is cut but holds.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from newton_cagecut import Blade, Material

from ..base import Camera, CutScene, PlannedCut, frames_of

DOWN, WIDTH = (0.0, 0.0, -1.0), 0.3  # [m]
# Of each cut: a place on the arm [m], the arm's direction there [deg], and how far the knife goes
PLACES = (
    ((-0.169, -0.624, 0.0), -101.0, 1.0),
    ((0.272, -0.63, 0.0), -35.5, 1.0),
    ((0.569, 0.31, 0.0), 14.0, 0.6),
)
STAND_RADIUS, STAND_HEIGHT = 0.22, 0.3
CUTS = tuple(
    PlannedCut(
        name=f"arm {k}",
        blade=Blade(place, (-np.sin(np.radians(turn)), np.cos(np.radians(turn)), 0.0), DOWN, width=WIDTH),
        wait=16,
        until=until,
        pieces=min(k + 2, 3),
    )
    for k, (place, turn, until) in enumerate(PLACES)
)


class Example(CutScene):
    name = "octopus"
    substep_count = 1
    frame_count = frames_of(CUTS) + 30
    skin_color, cap_color = (0.42, 0.09, 0.22), (0.98, 0.75, 0.72)
    camera = Camera(eye=(0.6, -2.7, 1.75), target=(0.02, -0.1, 0.2))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "octopus",
            material=Material(young=4e4, poisson=0.4, density=1000.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, STAND_HEIGHT + 0.02), wp.quat_identity()),
            quadrature=1500,
            cuts=4,
        )
        self.add_stand(builder, radius=STAND_RADIUS, height=STAND_HEIGHT)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS
