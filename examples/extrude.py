# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A sprout grows: its cage is extruded while it sways, and walks go on from where they had landed.

Coordinates alone, without a solver: the top face of the cage is extruded to begin a new joint, then moved on a little
at a time. Points that the growth leaves alone keep their walks; those of the tip are set anew.

Success criteria: four joints; at rest the weights give every point back.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from newton_cagecut import HarmonicCoordinates
from newton_cagecut.usd import BodyFrame, SceneFrame

from .base import Camera, Scene, box_cage, require

WIDTH, FIRST, JOINT, JOINTS = 0.34, 0.2, 0.18, 4  # of the cage and its joints [m]
RING_COUNT, RING_SIZE, RADIUS = 30, 24, 0.112  # of the sprout
FRAMES_A_JOINT, FRAMES_A_STEP = 24, 4  # walks can tell 31 extensions of a cage apart
SWAY, TWIST = 0.55, 1.6  # of the tip [m/m^2] and [rad/m]


def sprout(height: float) -> np.ndarray:
    """Return the points of a sprout, a bulb on a stem, with the same numbers at any height [m]."""
    s = np.linspace(0.0, 1.0, RING_COUNT)
    z = 0.02 + (height - 0.05) * s
    tip = (height - 0.03 - z) / RADIUS
    radius = RADIUS * (0.45 + 0.55 * np.exp(-(((tip - 1.0) / 0.9) ** 2)) + 0.25 * np.exp(-((z / 0.1) ** 2)))
    radius *= np.sqrt(np.clip(1.0 - (1.0 - tip.clip(0.0, 1.0)) ** 2, 1e-6, 1.0))
    angle = 2.0 * np.pi * np.arange(RING_SIZE) / RING_SIZE
    petals = 1.0 + 0.12 * np.cos(5.0 * angle) * np.exp(-(((tip - 1.0) / 1.2) ** 2))[:, None]
    rings = radius[:, None] * petals
    x, y = rings * np.cos(angle), rings * np.sin(angle)
    return np.stack([x, y, np.broadcast_to(z[:, None], x.shape)], axis=2).reshape(-1, 3)


class Example(Scene):
    name = "extrude"
    frame_count = FRAMES_A_JOINT * JOINTS + 30
    camera = Camera(eye=(0.9, -2.6, 1.2), target=(0.0, 0.0, 0.42))
    skin_color = (0.16, 0.42, 0.05)
    shows_cages = True

    def build(self) -> None:
        self.cage = box_cage((WIDTH, WIDTH, FIRST))
        self.cage = type(self.cage)(self.cage.vertices + (0.0, 0.0, 0.5 * FIRST), self.cage.faces)
        self.height = FIRST
        points = sprout(self.height)
        self.coords = HarmonicCoordinates(self.cage, points, walks=self.walks, cuttable=True)
        a, b = np.meshgrid(np.arange(RING_COUNT - 1), np.arange(RING_SIZE), indexing="ij")
        corner = [(RING_SIZE * (a + i) + (b + j) % RING_SIZE).ravel() for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
        self.triangles = np.concatenate([np.stack([corner[i] for i in t], axis=1) for t in ((0, 1, 2), (0, 2, 3))])
        self.rest = points

    def advance(self) -> None:
        joint, frame = divmod(self.frame, FRAMES_A_JOINT)
        if joint >= JOINTS or frame % FRAMES_A_STEP:
            return
        top = max(range(self.cage.face_count), key=lambda f: self.cage.vertices[list(self.cage.faces[f]), 2].min())
        step = JOINT * FRAMES_A_STEP / FRAMES_A_JOINT
        edit = self.cage.extrude(top, step) if frame == 0 else self.cage.move_face(top, step)
        self.coords.update(edit)
        self.cage, self.height = edit.cage, self.height + step
        rest = sprout(self.height)
        moved = np.flatnonzero(np.abs(rest - self.rest).max(axis=1) > 0.0)
        self.coords.set_points(moved, rest[moved])
        self.rest = rest

    def pose(self) -> np.ndarray:
        """Return where the vertices of the cage are now [m]: bent and twisted, the more the higher."""
        x, y, z = self.cage.vertices.T
        phase = 2.0 * np.pi * self.time
        turn = TWIST * z * np.sin(0.5 * phase)
        bend = SWAY * z**2 * np.array([np.sin(0.4 * phase), 0.4 * np.cos(0.6 * phase)])[:, None]
        across = [np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y]
        return np.stack([*(across + bend), z], axis=1)

    def scene_frame(self) -> SceneFrame:
        pose = self.pose()
        body = BodyFrame(
            name="sprout",
            points=self.coords.weights @ pose,
            triangles=self.triangles,
            rest_points=self.rest,
            cage_points=pose,
            cage_faces=self.cage.faces,
            skin_color=self.skin_color,
        )
        return SceneFrame(bodies=(body,))

    def show(self) -> None:
        pose = self.pose()
        points = wp.array(self.coords.weights @ pose, dtype=wp.vec3)
        self.viewer.log_mesh(
            "/sprout", points, wp.array(self.triangles.ravel(), dtype=wp.int32), color=self.skin_color, dynamic=True
        )
        pairs = np.array([(a, b) for face in self.cage.faces for a, b in zip(face, (*face[1:], face[0])) if a < b])
        ends = [wp.array(pose[pairs[:, k]], dtype=wp.vec3) for k in (0, 1)]
        self.viewer.log_lines("/cage", *ends, (0.1, 0.1, 0.1))

    def test_final(self) -> None:
        joints = min(JOINTS, -(-self.frame // FRAMES_A_JOINT))
        require(self.cage.vertex_count == 8 + 4 * joints, f"the cage has {joints} joints more")
        require(
            np.abs(self.coords.weights @ self.cage.vertices - self.rest).max() < 1e-4, "the rest shape is given back"
        )
