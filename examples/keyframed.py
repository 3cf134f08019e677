# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A starfish that an animator moves, without any dynamics, swims on while arms are cut off.

The vertices of the cage go where the animation puts them, those that a cut makes too; what is cut off drifts away. No
material, no quadrature, no contact: the leanest body there is.

Success criteria: three pieces, and every vertex of the cage where the animation has it.
"""

from __future__ import annotations

import newton
import numpy as np

import newton_cagecut as cagecut

from .base import Camera, CutScene, PlannedCut, asset, frames_of, require
from .paper.starfish import across_arm

WAVE, WAVES, RATE = 0.12, 5.0, 0.8  # of the swimming: height [m], phase over distance [1/m], frequency [Hz]
DRIFT = 0.12  # of what is cut off [m/s]
CUTS = (
    PlannedCut(name="first arm", blade=across_arm(2), wait=20, pieces=2),
    PlannedCut(name="second arm", blade=across_arm(4), wait=8, pieces=3),
)


class Example(CutScene):
    name = "keyframed"
    frame_count = frames_of(CUTS) + 40
    has_ground, ground, substep_count = False, -0.4, 1
    skin_color, cap_color = (0.74, 0.125, 0.04), (1.0, 0.62, 0.43)
    camera = Camera(eye=(0.3, -1.9, 1.35), target=(0.0, 0.02, -0.03))

    _free_since: dict[tuple, float]

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self._free_since = {}
        cagecut.add_cage_body(builder, *asset("starfish"), quadrature=0, walks=self.walks, label="starfish")

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def act(self) -> None:
        """Say where the vertices of the cage are to be at the end of the frame."""
        body = self.solver.body("starfish")
        targets = self.control.cagecut.target_q.numpy()
        targets[body.vertices][: body.cage.vertex_count] = self.animation(self.time + 1.0 / self.fps)
        self.control.cagecut.target_q.assign(targets)

    def animation(self, time: float) -> np.ndarray:
        """Return where the vertices of the cage are at a time [m]."""
        body = self.solver.body("starfish")
        places = body.cage.vertices.copy()
        distance = np.hypot(places[:, 0], places[:, 1])
        places[:, 2] += WAVE * distance / 0.5 * np.sin(2.0 * np.pi * RATE * time - WAVES * distance)
        largest = max(body.pieces, key=lambda piece: piece.volume)
        for piece in body.pieces:
            if piece is not largest:
                away = body.cage.vertices[piece.vertices].mean(axis=0)
                self._free_since.setdefault(tuple(np.round(away, 2)), time)
                since = time - self._free_since[tuple(np.round(away, 2))]
                places[piece.vertices] += DRIFT * since * (away / np.linalg.norm(away) + (0.0, 0.0, -0.4))
        return places

    def test_final(self) -> None:
        super().test_final()
        body = self.solver.body("starfish")
        now = self.state_0.particle_q[body.vertices].numpy()[: body.cage.vertex_count]
        require(np.abs(now - self.animation(self.time)).max() < 1e-5, "the cage is where the animation has it")
