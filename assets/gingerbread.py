# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The gingerbread man and his plane cage: ``python -m assets.gingerbread`` writes gingerbread.usdc, its cage and icing.

A flat mesh in a cage of segments. Metres, +Y up, 1 m tall. Edges run along the borders of the icing.
"""

from __future__ import annotations

import numpy as np

from assets.fields import ball, cone, union
from assets.planar import fill
from assets.write import FOLDER
from newton_cagecut import Cage
from newton_cagecut.geometry import lifted
from newton_cagecut.usd import write_cage, write_mesh

SPACING = 0.0125  # of the points [m]
LOWER, UPPER = (-0.52, -0.56), (0.52, 0.56)

# Half of the cage's outline, from the crotch over the foot, the hand and the head to the middle [m]
OUTLINE = [
    (0.0, -0.262),
    (0.055, -0.5),
    (0.13, -0.555),
    (0.24, -0.54),
    (0.285, -0.44),
    (0.225, -0.16),
    (0.185, 0.005),
    (0.275, 0.06),
    (0.43, 0.1),
    (0.505, 0.17),
    (0.47, 0.265),
    (0.36, 0.295),
    (0.2, 0.245),
    (0.205, 0.38),
    (0.15, 0.51),
    (0.0, 0.555),
]


def gingerbread_field(points: np.ndarray) -> np.ndarray:
    """Return a function that is negative inside the gingerbread man and roughly the distance near his border [m]."""
    points = np.abs(points * [1.0, 0.0]) + points * [0.0, 1.0]  # left as right
    leg = cone(points, (0.085, -0.16), (0.17, -0.43), 0.08, 0.078)
    arm = cone(points, (0.06, 0.08), (0.405, 0.2), 0.07, 0.072)
    torso = cone(points, (0.0, 0.06), (0.0, -0.1), 0.12, 0.13)
    return union([union([torso, leg, arm], 0.13), ball(points, (0.0, 0.355), 0.162)], 0.17)


def gingerbread_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(n, 2)`` [m] and the counterclockwise triangles ``(m, 3)`` of the gingerbread man."""
    return fill(gingerbread_field, LOWER, UPPER, SPACING, fixed=icing().vertices)


def gingerbread_cage() -> Cage:
    """Return the cage: one loop of 30 segments."""
    right = np.array(OUTLINE)
    return _loops([np.concatenate([right, right[-2:0:-1] * [-1.0, 1.0]])])


def icing() -> Cage:
    """Return the borders of the icing: eyes, mouth, buttons and cuffs."""
    turn = np.linspace(np.radians(212.0), np.radians(328.0), 30)
    mouth = [(0.0, 0.36)] + 0.098 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    bands = [_band(mouth, 0.011)]
    for side in (-1.0, 1.0):
        bands.append(_disk((side * 0.066, 0.395), 0.026))
        bands.append(_band(_wave((side * 0.345, 0.179), (side * -0.12, 0.345), 0.052), 0.01))
        bands.append(_band(_wave((side * 0.152, -0.375), (0.27, side * 0.085), 0.06), 0.01))
    bands += [_disk((0.0, y), 0.03) for y in (0.12, 0.01, -0.1)]
    return _loops(bands)


def _disk(center: tuple[float, float], radius: float) -> np.ndarray:
    """Return points around a circle, counterclockwise."""
    angle = np.linspace(0.0, 2.0 * np.pi, round(2.0 * np.pi * radius / SPACING), endpoint=False)
    return np.array(center) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _wave(center: tuple[float, float], across: tuple[float, float], half: float) -> np.ndarray:
    """Return a wavy line across a limb.

    Args:
        center: Its middle [m].
        across: Its direction, of any length.
        half: Half of its length [m].
    """
    along = np.array(across) / np.hypot(*across)
    t = np.linspace(-1.0, 1.0, 80)[:, None]
    return center + half * t * along + 0.01 * np.cos(1.5 * np.pi * t) * np.array([-along[1], along[0]])


def _band(line: np.ndarray, half_width: float) -> np.ndarray:
    """Return points around a line with round ends, counterclockwise."""
    along = np.gradient(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    left = half_width * np.stack([-along[:, 1], along[:, 0]], axis=1)
    turn = np.linspace(0.0, np.pi, 9)[1:-1, None]
    outward = half_width * along
    last, first = (
        line[i] + sign * (np.sin(turn) * outward[i] - np.cos(turn) * left[i]) for i, sign in ((-1, 1.0), (0, -1.0))
    )
    return _evenly(np.concatenate([line - left, last, (line + left)[::-1], first]))


def _evenly(loop: np.ndarray) -> np.ndarray:
    """Return points at even distances along a loop."""
    closed = np.concatenate([loop, loop[:1]])
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    place = np.linspace(0.0, length[-1], round(length[-1] / SPACING), endpoint=False)
    return np.stack([np.interp(place, length, values) for values in closed.T], axis=1)


def _loops(loops: list[np.ndarray]) -> Cage:
    """Return the plane cage of some loops."""
    first = np.cumsum([0] + [len(loop) for loop in loops])
    segments = [(a + i, a + (i + 1) % len(loop)) for a, loop in zip(first, loops) for i in range(len(loop))]
    return Cage(np.concatenate(loops), segments)


if __name__ == "__main__":
    points, triangles = gingerbread_mesh()
    write_mesh(FOLDER / "gingerbread.usdc", lifted(points), triangles, name="gingerbread", up_axis="Y")
    write_cage(FOLDER / "gingerbread_cage.usda", gingerbread_cage(), name="gingerbread_cage", up_axis="Y")
    write_cage(FOLDER / "gingerbread_icing.usda", icing(), name="gingerbread_icing", up_axis="Y")
