# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A flat gingerbread man hangs by his hands; a foot is bitten off, the belly slit, then he is cut down.

Success criteria: four pieces in one plane to the last bit; the hands stay where they are held, what is cut off lies on
the ground.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut
from newton_cagecut.solver import CageBody
from newton_cagecut.usd import read_cage

from ..base import ASSETS, Camera, CutScene, PlannedCut, along, frames_of, require

HEIGHT = 0.85  # of the middle above the ground [m]
UPRIGHT = wp.quat_from_axis_angle(wp.vec3(1.0, 0.0, 0.0), 0.5 * np.pi)  # the plane's y axis points up
HANDS = (10, 20)  # cage vertices that are held
PINS = ((-0.468, 0.0, HEIGHT + 0.263), (0.468, 0.0, HEIGHT + 0.263))  # [m], only to look at
PIN_RADIUS, PIN_HALF = 0.016, 0.03  # [m]
FALL_FRAMES = 20  # after which a piece that has come off is down
CAGE, ICING = (read_cage(ASSETS / f"gingerbread_{part}.usda") for part in ("cage", "icing"))


def bite(center: tuple[float, float], radius: float, start: float, end: float, count: int = 12) -> np.ndarray:
    """Return the corners of an arc, from one angle to another [deg]."""
    angle = np.radians(np.linspace(start, end, count))
    return center + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


CUTS = (
    along(CAGE, bite((-0.17, -0.5), 0.17, 155.0, 15.0), name="bite", wait=20, pieces=2),
    along(CAGE, np.array([[0.4, -0.06], [-0.4, -0.03]]), name="slit", wait=4, until=0.6, pieces=2),
    along(CAGE, np.array([[-0.22, 0.33], [-0.4, -0.2]]), name="left arm", wait=20, pieces=3),
    along(CAGE, np.array([[0.22, 0.33], [0.4, -0.2]]), name="right arm", wait=30, pieces=4),
)


class Example(CutScene):
    name = "gingerbread"
    frame_count = frames_of(CUTS) + 60
    skin_color, paint_color = (0.35, 0.13, 0.04), (0.95, 0.93, 0.88)
    cap_color = skin_color  # a plane body has no caps
    camera = Camera(eye=(0.5, -3.05, 1.0), target=(0.02, 0.0, 0.63))
    _painted: tuple[cagecut.Surface | None, np.ndarray] = (None, np.zeros(0, dtype=bool))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        self.add_asset(
            builder,
            "gingerbread",
            material=cagecut.Material(young=3e5, poisson=0.35, density=700.0, damping=0.02),
            xform=wp.transform((0.0, 0.0, HEIGHT), UPRIGHT),
            fixed=HANDS,
            thickness=0.02,
        )
        for place in PINS:
            builder.add_shape_cylinder(
                -1,
                xform=wp.transform(place, UPRIGHT),
                radius=PIN_RADIUS,
                half_height=PIN_HALF,
                cfg=newton.ModelBuilder.ShapeConfig(has_particle_collision=False),
            )

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def painted(self, body: CageBody) -> np.ndarray:
        surface, painted = self._painted
        if surface is not body.surface:
            surface = body.surface
            painted = ICING.contains(surface.points[surface.triangles].mean(axis=1))
            self._painted = (surface, painted)
        return painted

    def test_final(self) -> None:
        """Check the plane, the hands, and that what has come off lies on the ground."""
        super().test_final()
        body, hands = self.solver.bodies[0], list(HANDS)
        points = self.points()
        require((points[:, 1] == 0.0).all(), "the surface is in its plane to the last bit")
        now, start = (owner.particle_q[body.vertices].numpy() for owner in (self.state_0, self.model))
        require(np.array_equal(now[hands], start[hands]), "the hands are where they were")
        if self.frame - self.parted_at < FALL_FRAMES:
            return
        for piece in self.solver.pieces(body.label):
            if not np.isin(HANDS, piece.vertices).any():
                require(points[piece.surface_points, 2].min() < 0.02, "what has come off lies on the ground")
