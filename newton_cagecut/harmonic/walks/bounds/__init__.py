# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Bounds of whole walks, and their test against new pieces of wall.

A walk is kept as it is when none of its spheres meets the new wall (paper, section 4.1). Its bounding volume holds
every sphere but the first, the last one included, plus a rounding margin, and is quantised outward. The first sphere is
the largest as a rule and the same for all walks of a point, so it is tested by itself, once for the point. The test is
conservative: it may send a walk to be walked again for nothing, never the other way round.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import warp as wp

from ....geometry import as_choice
from ...options import BOUNDS
from .dop import make_dop
from .kind import BoundsKind
from .sphere import make_sphere

__all__ = ["BOUNDS", "BoundsKind", "make_bounds"]

_SIDES = np.eye(3)
_DIAGONALS = np.array([[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]], dtype=np.float64)
_CORNERS = np.array([[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]], dtype=np.float64)


def make_bounds(kind: str, dimension: int) -> BoundsKind:
    """Make one kind of walk bounds.

    Args:
        kind: One of ``BOUNDS``. In the plane, "dop18" and "dop26" are both the octagon.
        dimension: 2 or 3; in the plane, points have z = 0.

    Raises:
        ValueError: There is no such kind.
    """
    as_choice(kind, BOUNDS, "bounds")
    return _make("dop18" if dimension == 2 and kind == "dop26" else kind, dimension)


@cache
def _make(kind: str, dimension: int) -> BoundsKind:
    if kind == "sphere":
        return make_sphere(dimension)
    sides, diagonals = (_SIDES[:2], _DIAGONALS[:2]) if dimension == 2 else (_SIDES, _DIAGONALS)
    if kind == "aabb":
        return make_dop(sides, dimension, wp.uint16)
    if kind == "dop18":
        return make_dop(np.concatenate([sides, diagonals]), dimension, wp.uint16)
    # At 8 bits a plane a walk takes fewer bytes than the 18-DOP's 36, and on starfish cuts 5 to 13 % more of them are
    # flagged than at 16. Scaled so that the unit frame's box fills the range along every axis: a byte has no level to
    # give away.
    axes = np.concatenate([2.0 * sides, diagonals, _CORNERS * (2.0 / 3.0)])
    return make_dop(axes, dimension, wp.uint8)
