# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The starfish and its cage: ``python -m assets.starfish`` writes starfish.usdc and starfish_cage.usda.

As many vertices and faces as STARFISH in Table 1 of the paper: a surface of 8158 vertices in a cage of 50 vertices
and 53 planar faces (triangles, quads and a pentagon). Metres, +Z up, about 1 m across.
"""

from __future__ import annotations

import numpy as np

from assets.implicit import mesh_field
from assets.write import write_asset

VERTEX_COUNT = 8158
ARM_COUNT = 5
ARM_ANGLES = np.pi / 2 + 2 * np.pi / ARM_COUNT * np.arange(ARM_COUNT)


def starfish_field(points: np.ndarray) -> np.ndarray:
    """Return a function that is negative inside the starfish and roughly the distance near its skin [m]."""
    sharpness = 40.0
    arms = np.stack([-sharpness * arm_field(points, angle) for angle in ARM_ANGLES])
    skin = -np.logaddexp.reduce(arms, axis=0) / sharpness
    belly = -(points[:, 2] + 0.062)
    blend = np.clip(0.5 + 0.5 * (belly - skin) / 0.06, 0.0, 1.0)
    return skin + (belly - skin) * blend + 0.06 * blend * (1.0 - blend) - 0.006 * tubercles(points)


def arm_field(points: np.ndarray, angle: float) -> np.ndarray:
    """Return the distance to a tapered arm [m], higher in the middle and with its tip raised."""
    along = points[:, 0] * np.cos(angle) + points[:, 1] * np.sin(angle)
    across = -points[:, 0] * np.sin(angle) + points[:, 1] * np.cos(angle)
    t = np.clip(along / 0.44, 0.0, 1.0)
    height = points[:, 2] - 0.03 * t**3
    radius = 0.118 - 0.078 * t**0.9
    return np.sqrt((along - 0.44 * t) ** 2 + across**2 + (1.12 * height) ** 2) - radius


def tubercles(points: np.ndarray) -> np.ndarray:
    """Return the bumps of the upper skin, between 0 and 1: one row on each arm's ridge, one on each flank."""
    sector = 2 * np.pi / ARM_COUNT
    angle = np.arctan2(points[:, 1], points[:, 0]) - ARM_ANGLES[0]
    angle = np.abs(angle - sector * np.round(angle / sector))
    radius = np.hypot(points[:, 0], points[:, 1])
    along, across = radius * np.cos(angle), radius * np.sin(angle)
    bumps = np.zeros(len(points))
    for k in range(9):
        centre = 0.06 + 0.046 * k
        size = 0.019 - 0.0008 * k
        bumps += np.exp(-((along - centre) ** 2 + across**2) / size**2)
        flank = (along - centre - 0.023) ** 2 + (across - 0.058 + 0.0042 * k) ** 2
        bumps += 0.8 * np.exp(-flank / (0.8 * size) ** 2)
    return bumps * np.clip(0.5 + points[:, 2] / 0.06, 0.0, 1.0)


def starfish_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(8158, 3)`` [m] and the outward triangles ``(16312, 3)`` of the starfish."""
    return mesh_field(starfish_field, (-0.55, -0.55, -0.12), (0.55, 0.55, 0.16), VERTEX_COUNT, seed=5)


def starfish_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices ``(50, 3)`` [m] and the 53 planar faces of the cage.

    A prism over a star of 25 corners, five an arm: a valley, the middle and the tip of one flank, and back. Each
    corner has a height of its own above and below, equal on both flanks, so that every face stays planar.
    """
    # along the arm, across it, top, bottom [m]
    valley = (0.182, 0.182 * np.tan(np.pi / ARM_COUNT), 0.170, -0.092)
    middle, tip = (0.330, 0.097, 0.104, -0.068), (0.515, 0.071, 0.099, -0.036)
    corners = [(valley, -1), (middle, -1), (tip, -1), (tip, 1), (middle, 1)]
    top, bottom = [], []
    for angle in ARM_ANGLES:
        for (along, across, high, low), flank in corners:
            x = along * np.cos(angle) - flank * across * np.sin(angle)
            y = along * np.sin(angle) + flank * across * np.cos(angle)
            top.append((x, y, high))
            bottom.append((x, y, low))
    return np.array(top + bottom), starfish_cage_faces()


def starfish_cage_faces() -> list[tuple[int, ...]]:
    """Return the faces of the cage: the arms, then the middle above (a quad and a triangle) and below."""
    faces: list[tuple[int, ...]] = []
    ring = 5 * ARM_COUNT
    for arm in range(ARM_COUNT):
        valley, right, tip_right, tip_left, left = range(5 * arm, 5 * arm + 5)
        following = (5 * arm + 5) % ring
        faces += [(valley, right, left, following), (right, tip_right, tip_left), (right, tip_left, left)]
        faces += [tuple(ring + v for v in (following, left, right, valley))]
        faces += [tuple(ring + v for v in (left, tip_left, tip_right, right))]
        outline = (valley, right, tip_right, tip_left, left, following)
        faces += [(b, a, ring + a, ring + b) for a, b in zip(outline[:-1], outline[1:])]
    valleys = range(0, ring, 5)
    middle = [tuple(valleys[:4]), (valleys[3], valleys[4], valleys[0]), tuple(ring + v for v in reversed(valleys))]
    return faces + middle


if __name__ == "__main__":
    write_asset("starfish", starfish_mesh(), starfish_cage())
