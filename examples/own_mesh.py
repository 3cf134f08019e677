# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A mesh of your own: a file (an OBJ here) gets a cage and is cut, in 25 lines.

The cage is made by ``wrap_cage``, which needs ``pip install 'newton_cagecut[wrap]'``.

Success criteria: two pieces or more.
"""

from __future__ import annotations

import newton
import numpy as np

import newton_cagecut as cagecut

from .base import ASSETS, Camera, CutScene, PlannedCut


class Example(CutScene):
    name = "own_mesh"
    frame_count = 100
    skin_color, cap_color = (0.45, 0.55, 0.05), (0.95, 0.90, 0.60)
    camera = Camera(eye=(0.55, -1.5, 0.85), target=(0.0, 0.0, 0.19))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        mesh = cagecut.read_mesh(ASSETS / "pear.obj", up_axis="Z")
        points = 0.5 * mesh.points / np.ptp(mesh.points, axis=0).max()  # half a metre along its longest side,
        points -= (*points.mean(axis=0)[:2], points[:, 2].min() - 0.01)  # on the ground
        cage = cagecut.wrap_cage(points, mesh.triangles, 40)
        material = cagecut.Material(young=5e4, density=800.0, damping=0.01)
        cagecut.add_cage_body(
            builder, cage, (points, mesh.triangles), material=material, contact_radius=0.004, walks=self.walks
        )

    def cuts(self) -> tuple[PlannedCut, ...]:
        blade = cagecut.Blade(origin=(0.0, 0.0, 0.0), edge=(0.8, -0.6, 0.0), direction=(0.0, 0.0, -1.0))
        return (PlannedCut(name="in half", blade=blade, wait=15, pieces=2),)
