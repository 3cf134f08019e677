# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A dude stands in the wind; his hat is cut off, and a gust takes it (the paper's figure 16).

Success criteria: two pieces; the dude still stands, and his hat lies on the ground downwind of him.
"""

from __future__ import annotations

import newton
import numpy as np

from newton_cagecut import Blade, Material

from ..base import Camera, CutScene, PlannedCut, asset, frames_of, require

HAT_HEIGHT = 0.743  # of the place where the hat sits on the head [m]
BREEZE = (2.5, 0.0, 0.0)  # acceleration of what stands above the waist [m/s^2]
GUST, GUST_FRAMES = (9.0, 0.0, 15.0), 5  # and of the hat when it is loose
CUTS = (
    PlannedCut(name="hat", blade=Blade((0.0, 0.0, HAT_HEIGHT), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)), wait=20, pieces=2),
)


class Example(CutScene):
    name = "dude"
    frame_count = frames_of(CUTS) + 45
    skin_color, cap_color = (0.10, 0.24, 0.50), (0.95, 0.72, 0.45)
    camera = Camera(eye=(1.1, -2.9, 1.1), target=(0.36, 0.0, 0.47))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "dude",
            material=Material(young=6e4, poisson=0.4, density=300.0, damping=0.02),
            fixed=np.flatnonzero(asset("dude")[0].vertices[:, 2] < 0.0),
        )

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def act(self) -> None:
        """Blow: a force on each vertex of the cage, by its mass."""
        body = self.solver.body("dude")
        count = body.cage.vertex_count
        wind = np.where(body.cage.vertices[:, 2:] > 0.3, BREEZE, 0.0)
        if body.cage.piece_count == 2 and self.frame < self.parted_at + GUST_FRAMES:
            wind[self._hat().vertices] = GUST
        force = np.zeros((body.vertices.stop - body.vertices.start, 3), dtype=np.float32)
        force[:count] = self.model.particle_mass[body.vertices].numpy()[:count, None] * wind
        self.state_0.particle_f[body.vertices].assign(force)

    def test_final(self) -> None:
        super().test_final()
        if not self.parted_at or self.frame < self.parted_at + 35:
            return
        points, hat = self.points(), self._hat()
        require(points[:, 2].max() > 0.65, "the dude still stands")
        require(points[hat.surface_points, 2].min() < 0.02, "his hat lies on the ground")
        require(points[hat.surface_points, 0].mean() > 0.5, "his hat was taken by the wind")

    def _hat(self):
        """The piece that no vertex is held of."""
        body = self.solver.body("dude")
        return next(piece for piece in body.pieces if not body.fixed[piece.vertices].any())
