# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A key is held by its bow and shortened cut by cut (the paper's figure 17).

Each cut goes on a little every frame, and the pieces fall one after the other.

Success criteria: four pieces; the three that came off lie on the ground, the bow is where it was.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from newton_cagecut import Blade, Material

from ..base import Camera, CutScene, PlannedCut, asset, frames_of, require

HEIGHT = 0.42  # of the shaft above the ground [m]
PLACES = (0.365, 0.235, 0.02)  # of the cuts along the shaft [m]
CUTS = tuple(
    PlannedCut(name=f"cut {k}", blade=Blade((x, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)), wait=12, pieces=k + 2)
    for k, x in enumerate(PLACES)
)


class Example(CutScene):
    name = "key"
    frame_count = frames_of(CUTS) + 30
    skin_color, cap_color = (0.62, 0.40, 0.10), (0.75, 0.10, 0.04)
    camera = Camera(eye=(0.62, -1.75, 1.0), target=(0.0, 0.0, 0.25))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "key",
            material=Material(young=1.5e7, poisson=0.35, density=1000.0, damping=0.002),
            xform=wp.transform((0.0, 0.0, HEIGHT), wp.quat_from_axis_angle(wp.vec3(1.0, 0.0, 0.0), 0.3)),
            fixed=np.flatnonzero(asset("key")[0].vertices[:, 0] < -0.45),
        )
        size = {"hx": 0.03, "hy": 0.09, "hz": 0.5 * HEIGHT}
        no_contact = newton.ModelBuilder.ShapeConfig(has_particle_collision=False)
        place = wp.transform((-0.545, 0.0, 0.5 * HEIGHT), wp.quat_identity())
        builder.add_shape_box(-1, xform=place, cfg=no_contact, **size)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def test_final(self) -> None:
        super().test_final()
        body, points = self.solver.body("key"), self.points()
        if self.frame < self.parted_at + 25:
            return
        for piece in body.pieces:
            lowest = points[piece.surface_points, 2].min()
            if body.fixed[piece.vertices].any():
                require(lowest > 0.2, "the bow is where it was")
            else:
                require(lowest < 0.02, "what has come off lies on the ground")
