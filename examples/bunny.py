# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Newton's bunny sits on a block; what overhangs is cut off, and a second blade goes between the ears.

Success criteria: two pieces, of which one lies on the ground and the other, slit, sits on the block.
"""

from __future__ import annotations

from dataclasses import replace

import newton
import newton.examples
import warp as wp

import newton_cagecut as cagecut
from newton_cagecut.usd import read_cage, read_mesh

from .base import ASSETS, Camera, CutScene, PlannedCut, frames_of

SIZE = 0.3  # of the bunny, which comes 1.6 m tall
BLOCK_CENTER, BLOCK_HALF = (-0.20, -0.05, 0.05), (0.20, 0.22, 0.05)  # [m]

DOWN = (0.0, 0.0, -1.0)
ACROSS = cagecut.Blade((0.01, 0.0, 0.0), (0.0, 1.0, 0.0), DOWN)  # behind the neck and the edge of the block
ALONG = cagecut.Blade((0.0, -0.04, 0.0), (1.0, 0.0, 0.0), DOWN)  # between the ears
CUTS = (
    PlannedCut(name="across", blade=ACROSS, wait=24, pieces=2),
    PlannedCut(name="along", blade=ALONG, wait=4, until=0.6, pieces=2),
)


class Example(CutScene):
    name = "bunny"
    frame_count = frames_of(CUTS) + 40
    skin_color, cap_color = (0.20, 0.075, 0.03), (0.85, 0.62, 0.40)
    camera = Camera(eye=(1.25, -1.15, 0.85), target=(0.02, -0.05, 0.2))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        cage = read_cage(ASSETS / "bunny_cage.usda")
        cage = cagecut.Cage(SIZE * cage.vertices, cage.faces)
        mesh = read_mesh(newton.examples.get_asset("bunny.usd"), up_axis="Z")
        surface = cagecut.Surface(SIZE * mesh.points, mesh.triangles)
        room = cagecut.Capacity.for_cuts(cage, surface)
        cagecut.add_cage_body(
            builder,
            cage,
            surface,
            material=cagecut.Material(young=3e4, poisson=0.4, density=1000.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, 2.0 * BLOCK_HALF[2] + 0.03), wp.quat_identity()),
            contact_radius=0.004,
            walks=self.walks,
            capacity=replace(room, vertices=4 * cage.vertex_count + 64),  # each cut goes through all of the body
            label="bunny",
        )
        hx, hy, hz = BLOCK_HALF
        builder.add_shape_box(-1, xform=wp.transform(BLOCK_CENTER, wp.quat_identity()), hx=hx, hy=hy, hz=hz)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS
