# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A melon with a texture: skin and flesh keep their pictures through cuts.

The texture coordinates of the skin are cut with it; a cut face gets its own, from where it lies at rest.

Success criteria: four pieces; no triangle of the skin reaches across the picture.
"""

from __future__ import annotations

from dataclasses import replace

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut
from newton_cagecut.solver import CageBody
from newton_cagecut.usd import BodyFrame

from .base import ASSETS, Camera, CutScene, PlannedCut, box_cage, frames_of, require

RADII = (0.34, 0.27, 0.27)  # [m]
CUTS = (
    PlannedCut(name="in half", blade=cagecut.Blade((0.004, 0, 0), (0.2, 1, 0), (0, 0, -1)), wait=12, pieces=2),
    PlannedCut(name="a wedge", blade=cagecut.Blade((0, 0.003, 0), (1, 0.1, 0), (0, 0.5, -1)), wait=0, pieces=4),
)


class Example(CutScene):
    name = "texture"
    frame_count = frames_of(CUTS) + 45
    skin_color, cap_color = (0.05, 0.25, 0.04), (0.80, 0.08, 0.06)
    camera = Camera(eye=(0.65, -2.45, 1.5), target=(0.1, 0.0, 0.12))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        ball = newton.Mesh.create_sphere(1.0, num_latitudes=48, num_longitudes=96)
        surface = cagecut.Surface(RADII * ball.vertices[:, [2, 0, 1]], ball.indices.reshape(-1, 3), uvs=ball.uvs)
        cage = box_cage(2.06 * np.array(RADII))
        cagecut.add_cage_body(
            builder,
            cage,
            surface,
            material=cagecut.Material(young=8e4, poisson=0.4, density=900.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, RADII[2] + 0.01), wp.quat_identity()),
            capacity=cagecut.Capacity.for_cuts(cage, surface, cuts=4, crossing=True),
            contact_radius=0.004,
            walks=self.walks,
            label="melon",
        )

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def colored(self, body: CageBody, frame: BodyFrame) -> BodyFrame:
        uvs, places = frame.uvs.copy(), frame.rest_points / RADII
        for wall in np.unique(frame.triangle_cap[frame.triangle_cap >= 0]):  # the flesh is round, whatever the melon
            rows = frame.triangle_cap == wall
            uvs[rows] = 0.5 + 0.5 * places[frame.triangles[rows]] @ body.cage.walls[wall].axes.T
        skin, flesh = (str(ASSETS / f"melon_{part}.png") for part in ("skin", "flesh"))
        return replace(super().colored(body, frame), uvs=uvs, skin_texture=skin, cap_texture=flesh)

    def test_final(self) -> None:
        super().test_final()
        surface = self.solver.body("melon").surface
        skin = surface.corner_uvs(self.solver.body("melon").cage.walls)[surface.triangle_cap < 0]
        require(skin.min() > -1e-6 and skin.max() < 1.0 + 1e-6, "the skin's texture coordinates are in the picture")
        require(np.ptp(skin, axis=1).max() < 0.05, "no triangle of the skin reaches across the picture")
