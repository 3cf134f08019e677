# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A sheet of tissue is stretched by its rim; a curved incision gapes under the tension.

The rim's vertices go to targets, farther out than at rest; the knife comes in at the near side and turns on its way.

Success criteria: one piece; the incision gapes by more than a centimetre, and the rim is where it is held.
"""

from __future__ import annotations

import newton
import numpy as np

import newton_cagecut as cagecut

from .base import Camera, CutScene, PlannedCut, along, box_cage, box_mesh, frames_of, require

SIZE, THICKNESS = (0.60, 0.44), 0.05  # of the cage [m]
STRETCH, STRETCH_FRAMES = 1.2, 20  # how far the rim is pulled, and how long that takes
CAGE = box_cage((*SIZE, THICKNESS), (6, 4, 1))
RIM = np.flatnonzero((np.abs(CAGE.vertices[:, :2]) > 0.499 * np.array(SIZE)).any(axis=1))
ANGLES = np.radians(np.linspace(-60.0, 75.0, 9))
ARC = np.array([[-0.11, 0.0, 0.0]]) + 0.17 * np.stack([np.cos(ANGLES), np.sin(ANGLES), 0.0 * ANGLES], axis=1)
PATH = np.concatenate([[[-0.06, -0.24, 0.0]], ARC])
CUTS = (along(CAGE, PATH, edge=(0.0, 0.0, 1.0), name="incision", wait=30, to_end=True),)


class Example(CutScene):
    name = "surgery"
    frame_count = frames_of(CUTS) + 30
    has_ground, ground = False, -0.12
    skin_color, cap_color = (0.80, 0.42, 0.30), (0.50, 0.02, 0.03)
    camera = Camera(eye=(0.25, -1.25, 1.0), target=(0.0, -0.02, 0.0))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        cagecut.add_cage_body(
            builder,
            CAGE,
            box_mesh((0.98 * SIZE[0], 0.98 * SIZE[1], 0.8 * THICKNESS), (48, 36, 4)),
            material=cagecut.Material(young=4e4, poisson=0.4, damping=0.02),
            fixed=RIM,
            walks=self.walks,
            label="tissue",
        )
        frame = 0.5 * STRETCH * np.array(SIZE)
        for axis in (0, 1):
            half = np.array([0.02, 0.02, 0.03])
            half[1 - axis] = frame[1 - axis] + 0.02
            for side in (-1.0, 1.0):
                place = np.zeros(3)
                place[axis] = side * frame[axis]
                builder.add_shape_box(-1, xform=(place, (0.0, 0.0, 0.0, 1.0)), hx=half[0], hy=half[1], hz=half[2])

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def act(self) -> None:
        """Pull the rim out, also what the cut has made of it."""
        body = self.solver.body("tissue")
        share = min(1.0, (self.frame + 1) / STRETCH_FRAMES)
        held = np.flatnonzero(body.fixed)
        targets = self.control.cagecut.target_q.numpy()
        targets[body.vertices.start + held] = body.cage.vertices[held] * (*2 * (1.0 + share * (STRETCH - 1.0),), 1.0)
        self.control.cagecut.target_q.assign(targets)

    def gape(self) -> float:
        """Return how far the two sides of the incision are apart, where that is most [m]."""
        surface, points = self.solver.body("tissue").surface, self.points()
        caps = np.unique(surface.triangles[surface.triangle_cap >= 0])
        if len(caps) == 0:
            return 0.0
        _, place = np.unique(np.round(surface.points[caps], 6), axis=0, return_inverse=True)
        order = np.argsort(place.reshape(-1), kind="stable")
        pairs = order[:-1][np.diff(place.reshape(-1)[order]) == 0], order[1:][np.diff(place.reshape(-1)[order]) == 0]
        return float(np.linalg.norm(points[caps[pairs[0]]] - points[caps[pairs[1]]], axis=1).max(initial=0.0))

    def test_final(self) -> None:
        super().test_final()
        body = self.solver.body("tissue")
        now = self.state_0.particle_q[body.vertices].numpy()[RIM]
        require(np.abs(now[:, :2]).max() <= 0.5 * STRETCH * SIZE[0] + 1e-4, "the rim is where it is held")
        if self.schedule.current:
            require(self.gape() > 0.01, "the incision gapes")
