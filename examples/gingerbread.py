# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A flat gingerbread man hangs by his hands; a foot is bitten off, the belly slit, then he is cut down."""

from __future__ import annotations

from pathlib import Path

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut
from assets.gingerbread import icing
from examples.cutting import PlannedCut, along, frames_of
from examples.picture import Camera
from examples.recording import StaticMesh
from examples.scene import CutScene, require
from newton_cagecut.solver import CageBody
from newton_cagecut.usd import read_cage, read_surface

ASSETS = Path(__file__).parent.parent / "assets"
HEIGHT = 0.85  # of the middle above the ground [m]
UPRIGHT = wp.quat_from_axis_angle(wp.vec3(1.0, 0.0, 0.0), 0.5 * np.pi)  # the plane's y axis points up
HANDS = (10, 20)  # cage vertices that are held
PINS = ((-0.468, 0.0, HEIGHT + 0.263), (0.468, 0.0, HEIGHT + 0.263))  # [m], only to look at
PIN_RADIUS, PIN_HALF = 0.016, 0.03  # [m]
FALL_FRAMES = 20  # after which a piece that has come off is down
CAGE, ICING = read_cage(ASSETS / "gingerbread_cage.usda"), icing()


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
    """A flat gingerbread man hangs by his hands; a foot is bitten off, the belly slit, then he is cut down."""

    name = "gingerbread"
    frame_count = frames_of(CUTS) + 60
    skin_color, paint_color = (0.35, 0.13, 0.04), (0.95, 0.93, 0.88)
    cap_color = skin_color  # a plane body has no caps
    camera = Camera(eye=(0.7, -3.35, 1.05), target=(0.08, 0.0, 0.64))
    _piece_count, _parted_at = 1, 0
    _painted: tuple[cagecut.Surface | None, np.ndarray] = (None, np.zeros(0, dtype=bool))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        cagecut.add_cage_body(
            builder,
            CAGE,
            read_surface(ASSETS / "gingerbread.usdc", flat=True),
            material=cagecut.Material(young=3e5, poisson=0.35, density=700.0, damping=0.02),
            xform=wp.transform((0.0, 0.0, HEIGHT), UPRIGHT),
            fixed=HANDS,
            contact_radius=0.004,
            thickness=0.02,
            walks=self.walks,
            label="gingerbread",
        )
        for place in PINS:
            builder.add_shape_cylinder(
                -1,
                xform=wp.transform(place, UPRIGHT),
                radius=PIN_RADIUS,
                half_height=PIN_HALF,
                cfg=newton.ModelBuilder.ShapeConfig(has_particle_collision=False),
            )
            pin = newton.Mesh.create_cylinder(PIN_RADIUS, PIN_HALF, up_axis=newton.Axis.Y)
            self.static_meshes += (StaticMesh.of(pin, place),)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def painted(self, body: CageBody) -> np.ndarray:
        surface, painted = self._painted
        if surface is not body.surface:
            surface = body.surface
            painted = ICING.contains(surface.points[surface.triangles].mean(axis=1))
            self._painted = (surface, painted)
        return painted

    def step(self) -> None:
        super().step()
        count = self.solver.bodies[0].cage.piece_count
        if count != self._piece_count:
            self._piece_count, self._parted_at = count, self.frame

    def test_final(self) -> None:
        """Check the plane, the hands, and that what has come off lies on the ground."""
        super().test_final()
        body, hands = self.solver.bodies[0], list(HANDS)
        points, _ = self.solver.surface(self.state_0, body.label)
        require((points[:, 1] == 0.0).all(), "the surface is in its plane to the last bit")
        now, start = (owner.particle_q[body.vertices].numpy() for owner in (self.state_0, self.model))
        require(np.array_equal(now[hands], start[hands]), "the hands are where they were")
        if self.frame - self._parted_at < FALL_FRAMES:
            return
        for piece in self.solver.pieces(body.label):
            if not np.isin(HANDS, piece.vertices).any():
                require(points[piece.surface_points, 2].min() < 0.02, "what has come off lies on the ground")


if __name__ == "__main__":
    Example.main()
