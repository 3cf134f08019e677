# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A jelly from a fluted mould, and its cage: ``python -m assets.jelly`` writes jelly.usdc and jelly_cage.usda.

After JELLY in Table 1 of the paper: a surface of 2210 vertices in a hexagonal prism. The table gives its cage 12
vertices and 21 faces, which no closed surface of genus 0 has: by V - E + F = 2, and with three sides or more a face,
there are at most 2 V - 4 = 20 faces, all of them triangles. So the prism's faces are cut into 20 triangles.
Metres, +Z up, 0.8 m across.
"""

from __future__ import annotations

import numpy as np

from assets.fields import union
from assets.implicit import mesh_field
from assets.prism import prism_faces, split_quads
from assets.write import write_asset

VERTEX_COUNT = 2210
FLUTE_COUNT = 12
HEIGHT = 0.42  # [m]


def jelly_field(points: np.ndarray) -> np.ndarray:
    """Return a function that is negative inside the jelly and roughly the distance near its skin [m]."""
    x, y, z = points.T
    share = np.clip(z / HEIGHT, 0.0, 1.0)
    flutes = np.abs(np.cos(0.5 * FLUTE_COUNT * np.arctan2(y, x)))
    reach = 0.4 - 0.13 * share
    ribs = 0.035 * (np.sqrt(flutes**2 + 0.03) - 0.6) * np.clip(np.hypot(x, y) / 0.2, 0.0, 1.0) ** 2
    side = (np.hypot(x, y) - reach - ribs) * 0.92
    dimple = 0.05 * np.exp(-((np.hypot(x, y) / 0.09) ** 2))
    return -union([-side, HEIGHT - dimple - z, z], 0.09)


def jelly_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(2210, 3)`` [m] and the outward triangles ``(4416, 3)`` of the jelly."""
    return mesh_field(jelly_field, (-0.45, -0.45, -0.05), (0.45, 0.45, 0.45), VERTEX_COUNT, seed=4)


def jelly_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices ``(12, 3)`` [m] and the 20 triangles of the cage."""
    angle = 2.0 * np.pi * np.arange(6) / 6
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    top, bottom = np.column_stack([0.5 * ring, np.full(6, 0.45)]), np.column_stack([0.5 * ring, np.full(6, -0.03)])
    lid = [(0, 1, 2), (2, 3, 4), (4, 5, 0), (0, 2, 4)]
    return np.concatenate([top, bottom]), split_quads(prism_faces(lid, 6))


if __name__ == "__main__":
    write_asset("jelly", jelly_mesh(), jelly_cage())
