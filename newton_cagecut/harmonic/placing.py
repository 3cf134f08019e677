# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Points that are passed to coordinates, checked and put among the walls."""

from __future__ import annotations

from .cache.domain_state import DomainState
from .cache.placement import Placement
from .point_change import PointChange
from .point_checks import checked_change


def placed(state: DomainState, change: PointChange, *, count: int = 0, capacity: int) -> Placement:
    """Points that were passed, checked, among the walls of a state.

    Args:
        state: Walls and faces.
        change: The points.
        count: Points that there are already.
        capacity: Points that there is room for.

    Raises:
        TypeError: Numbers of points are not whole.
        ValueError: A point cannot be set; see ``checked_change``.
    """
    change, outside = checked_change(change, state.cage, count=count, capacity=capacity)
    return Placement.of(state, change.indices, change.points, change.keys, outside=outside)
