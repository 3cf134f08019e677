# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The frame that walks live in: the cage's bounding box scaled to [-1, 1] along its longest side.

Working there makes the weights independent of the cage's size and place; the map is applied in float64 before
anything is rounded to float32.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry import lifted


@dataclass(frozen=True)
class UnitFrame:
    """Similarity from a cage's rest frame to the walks' frame.

    Args:
        center: Centre of the cage's bounding box [m], shape (dimension,).
        half_side: Half of the box's longest side [m].
    """

    center: np.ndarray
    half_side: float

    @classmethod
    def of(cls, vertices: np.ndarray) -> UnitFrame:
        """Build the frame of a cage's vertices [m], shape (n, dimension)."""
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        return cls((low + high) / 2.0, float((high - low).max()) / 2.0)

    def to_unit(self, points: np.ndarray) -> np.ndarray:
        """Map rest positions [m] to the unit frame, in float64."""
        return (np.asarray(points, dtype=np.float64) - self.center) / self.half_side

    def to_space(self, points: np.ndarray) -> np.ndarray:
        """Map rest positions [m] to the unit frame as float32 in space; those of 2D lie in the plane z = 0."""
        return lifted(self.to_unit(points)).astype(np.float32)
