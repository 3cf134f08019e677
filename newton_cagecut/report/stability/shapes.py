# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The bars that are tried, and the surfaces in them."""

from __future__ import annotations

import numpy as np

from ...cage import Cage

_CORNERS = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])


def bar_cage(segments: int, size: tuple[float, float, float]) -> Cage:
    """A bar along x from the origin, its cross-section centred, cut into segments.

    Args:
        segments: Number of segments; each station has four vertices.
        size: Length, width along y and height along z [m].
    """
    length, *section = size
    vertices = [(x, *corner) for x in np.linspace(0.0, length, segments + 1) for corner in _CORNERS * section]
    faces = [(3, 2, 1, 0), tuple(4 * segments + corner for corner in range(4))]
    for first in range(0, 4 * segments, 4):
        for corner in range(4):
            a, b = first + corner, first + (corner + 1) % 4
            faces.append((a, b, b + 4, a + 4))
    return Cage(np.array(vertices), faces)


def surface_in(cage: Cage, share: float = 0.9) -> tuple[np.ndarray, np.ndarray]:
    """A surface like a convex cage, shrunk towards its middle.

    Args:
        cage: The cage.
        share: Size of the surface, of the cage's.

    Returns:
        Points (n, 3) [m] and triangles (m, 3).
    """
    middle = cage.vertices.mean(axis=0)
    return middle + share * (cage.vertices - middle), np.asarray(cage.simplices, dtype=np.int32)
