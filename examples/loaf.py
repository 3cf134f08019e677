# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A loaf is sliced at the end of a board, over which it stands out; the slices fall off and lie on one another.

Success criteria: four pieces; the slices have fallen, two of them to the ground; the loaf stays on the board.
"""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut

from .base import Camera, CutScene, PlannedCut, box_cage, box_mesh, frames_of, require

LENGTH, WIDTH, HEIGHT = 0.62, 0.24, 0.22  # [m]
BOARD, OVERHANG = 0.16, 0.2  # height of the board, and how far the loaf stands out [m]
PLACES = (0.26, 0.2, 0.14)  # of the cuts from the loaf's middle [m]
CUTS = tuple(
    PlannedCut(name=f"slice {k}", blade=cagecut.Blade((x, 0, 0), (0, 1, 0), (0.12, 0, -1)), wait=8, pieces=k + 2)
    for k, x in enumerate(PLACES)
)


def loaf() -> tuple[np.ndarray, np.ndarray]:
    """Return the points and triangles of a loaf: a box with round edges and a crust that bulges."""
    points, triangles = box_mesh((2.0, 2.0, 2.0), (40, 18, 16))
    length = np.linalg.norm(points, ord=5, axis=1, keepdims=True)
    points = points / length  # on the unit sphere of the 5-norm
    points[:, 2] += 0.08 * np.clip(points[:, 2], 0.0, 1.0) * (1.0 - points[:, 1] ** 2)
    return points * 0.455 * np.array([LENGTH, WIDTH, HEIGHT]), triangles


class Example(CutScene):
    name = "loaf"
    frame_count = frames_of(CUTS) + 25
    skin_color, cap_color = (0.42, 0.17, 0.045), (0.93, 0.82, 0.60)
    camera = Camera(eye=(0.95, -1.35, 0.8), target=(0.14, 0.0, 0.13))

    def add_bodies(self, builder: newton.ModelBuilder) -> None:
        cagecut.add_cage_body(
            builder,
            box_cage((LENGTH, WIDTH, HEIGHT), (4, 1, 1)),
            loaf(),
            material=cagecut.Material(young=6e4, poisson=0.3, density=300.0, damping=0.02),
            xform=wp.transform((0.0, 0.0, BOARD + 0.47 * HEIGHT), wp.quat_identity()),
            contact_radius=0.004,
            pieces_touch=True,
            walks=self.walks,
            label="loaf",
        )
        half = 0.5 * (LENGTH - OVERHANG + 0.1)
        place = wp.transform((0.5 * LENGTH - OVERHANG - half, 0.0, 0.5 * BOARD), wp.quat_identity())
        builder.add_shape_box(-1, xform=place, hx=half, hy=0.2, hz=0.5 * BOARD)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return CUTS

    def test_final(self) -> None:
        super().test_final()
        if self.frame < self.parted_at + 20:
            return
        points, lowest = self.points(), {}
        for piece in self.solver.pieces("loaf"):
            lowest[piece.volume] = points[piece.surface_points, 2].min()
        loaf = lowest.pop(max(lowest))
        require(loaf > 0.5 * BOARD, "the loaf stays on the board")
        require(max(lowest.values()) < 0.8 * BOARD, "the slices have fallen")
        require(sorted(lowest.values())[1] < 0.02, "two slices lie on the ground")
