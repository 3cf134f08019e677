# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers at points that are kept between edits, for weights and for gradients, where there is room for them."""

from __future__ import annotations

from dataclasses import dataclass

import warp as wp

from ..fit.point_rows import PointRows

_MOST_POINTS = 40_000
"""Points of which layers are kept: about 6 kB each."""


@dataclass(frozen=True, eq=False)
class FittedRows:
    """Layers at points.

    Args:
        values: Those that weights are made of, None where none are kept.
        slopes: Those that gradients are made of.
    """

    values: PointRows | None = None
    slopes: PointRows | None = None

    @classmethod
    def kept(cls, dimension: int, point_count: int, device: wp.context.Device) -> FittedRows:
        """Rows for points of a cage that is to be cut; none in the plane, nor for too many points.

        Args:
            dimension: Dimension of the space.
            point_count: Number of points.
            device: Where to put them.
        """
        if dimension == 2 or point_count > _MOST_POINTS:
            return cls()
        return cls(PointRows(dimension, device), PointRows(dimension, device, slopes=True))

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return sum(rows.byte_count for rows in (self.values, self.slopes) if rows is not None)
