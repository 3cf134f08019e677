# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks that points lie in a cage, and their distance from its faces.

Section 3 of the paper defines the coordinates for points inside the cage only.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import simplex_distances
from ..inflation import holding_distance

if TYPE_CHECKING:
    from ..cage import Cage

_CHUNK = 1 << 18


def check_inside(cage: Cage, points: np.ndarray, *, which: np.ndarray | None = None) -> np.ndarray:
    """Check that points lie inside a cage or, within its tolerance, on it.

    Args:
        cage: The cage.
        points: Points, shape (point_count, dimension) [m].
        which: Points to check, by index; all by default.

    Returns:
        Those of them that lie outside, but no farther than the tolerance, by index, ascending where ``which`` is.

    Raises:
        ValueError: If some points are outside; the text has their count, the worst one and its distance.
    """
    points = np.asarray(points, dtype=np.float64)
    which = np.arange(len(points)) if which is None else which
    outside = which[~cage.contains(points[which])]
    if len(outside) == 0:
        return outside
    distance = boundary_distances(cage, points[outside])
    far = np.count_nonzero(distance > cage.length_tolerance)
    if far:
        worst = int(np.argmax(distance))
        needed = holding_distance(cage, points[outside], float(distance[worst]))
        advice = "make the cage larger" if needed is None else f"cage.inflated({needed:g}) holds them; inflate it"
        raise ValueError(
            f"{far} of {len(points)} points lie outside the cage, the farthest (point {outside[worst]}) by "
            f"{distance[worst]:.4g} m; {advice} or move the points into it"
        )
    return outside


def boundary_distances(cage: Cage, points: np.ndarray) -> np.ndarray:
    """Distance of points to the faces of a cage, shape (point_count,) [m].

    Args:
        cage: The cage.
        points: Points, shape (point_count, dimension) [m].
    """
    corners = cage.vertices[cage.simplices]
    step = max(1, _CHUNK // len(corners))
    parts = [simplex_distances(points[i : i + step], corners).min(axis=1) for i in range(0, len(points), step)]
    return np.concatenate(parts) if parts else np.zeros(0)
