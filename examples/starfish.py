# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A soft starfish lies on a stand; two arms are cut off, a third is cut half way."""

from __future__ import annotations

from pathlib import Path

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut
from assets.starfish import ARM_ANGLES
from examples.cutting import PlannedCut, frames_of
from examples.picture import Camera
from examples.recording import StaticMesh
from examples.scene import CutScene
from newton_cagecut.usd import read_cage, read_surface

ASSETS = Path(__file__).parent.parent / "assets"
STAND_RADIUS, STAND_HEIGHT = 0.16, 0.26
TURN = 0.8 * np.pi  # brings the arms that are cut to the front
CUT_DISTANCE = 0.4  # of the cuts from the middle [m]; closer than 0.23 they would graze the neighbouring arms


def across_arm(arm: int) -> cagecut.Blade:
    """Return a blade that goes down through an arm, square to it."""
    along = np.array([np.cos(ARM_ANGLES[arm]), np.sin(ARM_ANGLES[arm]), 0.0])
    return cagecut.Blade(CUT_DISTANCE * along, np.cross((0.0, 0.0, 1.0), along), (0.0, 0.0, -1.0))


CUTS = (
    PlannedCut(name="first arm", blade=across_arm(0), wait=30, pieces=2),
    PlannedCut(name="second arm", blade=across_arm(1), wait=4, pieces=3),
    PlannedCut(name="third arm", blade=across_arm(2), wait=4, until=0.66, pieces=3),
)


class Example(CutScene):
    """A soft starfish lies on a stand; two arms are cut off, a third is cut half way."""

    name = "starfish"
    frame_count = frames_of(CUTS) + 50
    skin_color, cap_color = (0.74, 0.125, 0.04), (1.0, 0.62, 0.43)
    camera = Camera(eye=(0.42, -1.42, 0.88), target=(0.04, -0.14, 0.175))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        cagecut.add_cage_body(
            builder,
            read_cage(ASSETS / "starfish_cage.usda"),
            read_surface(ASSETS / "starfish.usdc"),
            material=cagecut.Material(young=2e4, poisson=0.4, density=1000.0, damping=0.01),
            xform=wp.transform((0.0, 0.0, STAND_HEIGHT + 0.1), wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), TURN)),
            contact_radius=0.004,
            walks=self.walks,
            label="starfish",
        )
        half, place = 0.5 * STAND_HEIGHT, (0.0, 0.0, 0.5 * STAND_HEIGHT)
        builder.add_shape_cylinder(-1, xform=wp.transform(place), radius=STAND_RADIUS, half_height=half)
        stand = newton.Mesh.create_cylinder(STAND_RADIUS, half, up_axis=newton.Axis.Z, segments=64)
        self.static_meshes = (StaticMesh.of(stand, place),)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS


if __name__ == "__main__":
    Example.main()
