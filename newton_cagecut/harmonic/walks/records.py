# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What walks leave behind: where they landed and, where they are kept, their bounds."""

from __future__ import annotations

import warp as wp

from .bounds import BoundsKind
from .landing import LANDING_DTYPES, empty_landings


class WalkRecords:
    """Landings and bounds of walks on a device, a row a walk.

    Args:
        dimension: 2 or 3.
        count: Number of walks.
        kind: Kind of the walks' bounds.
        bounded: Whether the walks are kept until edits, and so need bounds.
        device: Where to put them.
    """

    def __init__(
        self, dimension: int, count: int, kind: BoundsKind, *, bounded: bool, device: wp.context.Device
    ) -> None:
        self.dimension, self.count, self.kind, self.bounded = dimension, count, kind, bounded
        self.device = device
        self.landings = empty_landings(dimension, count, device)
        self.bounds = kind.empty_levels(count if bounded else 0, device)

    @property
    def landing_arrays(self) -> dict[str, wp.array]:
        """The arrays of the landings, by name."""
        return {name: getattr(self.landings, name) for name in LANDING_DTYPES[self.dimension]}

    def fresh(self) -> WalkRecords:
        """Room for as many other walks."""
        return WalkRecords(self.dimension, self.count, self.kind, bounded=self.bounded, device=self.device)

    def copied(self) -> WalkRecords:
        """A copy."""
        copy = self.fresh()
        for name, array in self.landing_arrays.items():
            wp.copy(getattr(copy.landings, name), array)
        wp.copy(copy.bounds, self.bounds)
        return copy
