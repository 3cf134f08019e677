# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A key and its cage: ``python -m assets.key`` writes key.usdc and key_cage.usda.

As many vertices and faces as KEY in Table 1 of the paper: a surface of 1256 vertices in a cage of 74 vertices and 81
planar faces. Both have a hole: V - E + F = 0. Metres, lying flat, 1.2 m long.
"""

from __future__ import annotations

import numpy as np

from assets.fields import box, cone, slab, union
from assets.implicit import mesh_field
from assets.prism import Loop, prism_faces
from assets.write import write_asset

VERTEX_COUNT = 1256
BOW = (-0.36, 0.0)  # the middle of its ring [m]
BOW_RADIUS = 0.16
TEETH = ((0.13, 0.2, -0.2), (0.27, 0.33, -0.145), (0.4, 0.47, -0.2))  # of each: from x, to x, down to y [m]
_SHAFT, _HEIGHT, _TOOTH_HEIGHT = 0.064, 0.064, 0.047  # half extents of the cage [m]
_MARGIN = 0.022
_OUTER_COUNT, _HOLE_COUNT = 29, 8


def key_field(points: np.ndarray) -> np.ndarray:
    """Return a function that is negative inside the key and roughly the distance near its skin [m]."""
    x, y, z = points.T
    ring = np.hypot((np.hypot(x - BOW[0], y - BOW[1]) - BOW_RADIUS) / 1.35, z)
    bow = 1.15 * (ring - 0.036)
    shaft = cone(points, (-0.19, 0.0, 0.0), (0.49, 0.0, 0.0), 0.031, 0.031)
    radius = np.hypot(y, z)
    collars = [slab(radius, x - place, 0.048, 0.02, 0.012) for place in (-0.08, 0.05)]
    teeth = [
        box(points, (0.5 * (first + last), 0.5 * low, 0.0), (0.5 * (last - first), -0.5 * low, 0.026), 0.014)
        for first, last, low in TEETH
    ]
    return union([bow, shaft, *collars, *teeth], 0.02)


def key_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(1256, 3)`` [m] and the outward triangles ``(2512, 3)`` of the key."""
    return mesh_field(key_field, (-0.6, -0.24, -0.06), (0.56, 0.24, 0.06), VERTEX_COUNT, seed=3)


def key_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices ``(74, 3)`` [m] and the 81 planar faces of the cage.

    A prism over the outline, 29 corners, and the hole of the bow, 8 corners. The teeth are lower at their ends.
    """
    shaft = [(-0.125, -_SHAFT)]
    for first, last, low in TEETH:
        sides = (first - _MARGIN, last + _MARGIN)
        shaft += [(sides[0], -_SHAFT), (sides[0], low - _MARGIN), (sides[1], low - _MARGIN), (sides[1], -_SHAFT)]
    shaft += [(0.515, -_SHAFT), (0.55, -0.03), (0.55, 0.03), (0.515, _SHAFT), (-0.125, _SHAFT)]
    turn = np.arctan2(_SHAFT, shaft[-1][0] - BOW[0])
    outer = _circle(0.237, np.linspace(turn, 2.0 * np.pi - turn, _OUTER_COUNT - len(shaft) + 2)[1:-1])
    hole = _circle(BOW_RADIUS - 0.049 - _MARGIN, 2.0 * np.pi * (np.arange(_HOLE_COUNT) + 0.5) / _HOLE_COUNT)
    outline = np.concatenate([shaft, outer, hole])
    height = np.where((outline[:, 1] < -_SHAFT) & (outline[:, 0] > 0.0), _TOOTH_HEIGHT, _HEIGHT)
    sides = [np.column_stack([outline, sign * height]) for sign in (1.0, -1.0)]
    return np.concatenate(sides), prism_faces(key_pieces(), len(outline))


def key_pieces() -> list[Loop]:
    """Return the 22 polygons that the outline consists of: the teeth, the shaft and a band around the hole."""
    teeth = [(1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11, 12)]
    shaft = [(17, 0, 1), (17, 1, 4, 5), (17, 5, 8, 16), (16, 8, 9, 12), (16, 12, 13), (13, 14, 15, 16)]
    outer = [*range(17, _OUTER_COUNT), 0]
    band = []
    for k, (a, b) in enumerate(zip(outer, (*outer[1:], outer[0]))):
        near, far = (_OUTER_COUNT + round(i * _HOLE_COUNT / len(outer)) % _HOLE_COUNT for i in (k, k + 1))
        band.append((a, b, near) if near == far else (a, b, far, near))
    return teeth + shaft + band


def _circle(radius: float, angles: np.ndarray) -> np.ndarray:
    """Return points around the middle of the bow [m]."""
    return np.array(BOW) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


if __name__ == "__main__":
    write_asset("key", key_mesh(), key_cage())
