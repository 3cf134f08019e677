# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Snapshots of coordinates, so that a cut can be undone.

The paper only cuts; an editor also takes cuts back. Walls, grids and faces are replaced by edits, never written to, so
a snapshot keeps the old ones; the walk cache and the weights are written in place, so a snapshot copies them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ...cage import Cage
from ..walks.landing import LANDING_DTYPES
from .domain import Domain, DomainState
from .walk_cache import Walker

_POINT_ARRAYS = ("position", "key", "piece", "gradient_row", "first_radius")


@dataclass(frozen=True, eq=False)
class CoordinatesSnapshot:
    """All that edits change in a set of coordinates; made by ``HarmonicCoordinates.snapshot``."""

    owner: Walker
    domain: DomainState
    arrays: dict[str, wp.array]
    rest: np.ndarray
    point_count: int

    @property
    def cage(self) -> Cage:
        """The cage at the time."""
        return self.domain.cage

    @property
    def byte_count(self) -> int:
        """Bytes of the copies on the device."""
        return sum(array.size * wp.types.type_size_in_bytes(array.dtype) for array in self.arrays.values())

    @classmethod
    def of(cls, walker: Walker, domain: Domain) -> CoordinatesSnapshot:
        """Copy what edits change.

        Args:
            walker: Points, walks and weights.
            domain: Walls, grid and faces.
        """
        arrays = {name: wp.clone(array) for name, array in edited_arrays(walker).items()}
        return cls(walker, domain.state(), arrays, walker._rest.copy(), walker.point_count)

    def restore(self) -> None:
        """Bring everything back; arrays that did not grow since stay where they are."""
        walker = self.owner
        walker.domain.restore(self.domain)
        for name, array in edited_arrays(walker).items():
            kept = self.arrays[name]
            if array.shape == kept.shape:
                wp.copy(array, kept)
            else:
                array.zero_()
                rows = array.numpy()
                rows[:, : kept.shape[1]] = kept.numpy()
                array.assign(rows)
        walker._rest[:] = self.rest
        walker.point_count = self.point_count


def edited_arrays(walker: Walker) -> dict[str, wp.array]:
    """The arrays that edits write to, by name."""
    arrays = {f"landing {name}": getattr(walker.landings, name) for name in LANDING_DTYPES[walker.domain.dimension]}
    arrays |= {f"point {name}": getattr(walker.points, name) for name in _POINT_ARRAYS}
    arrays |= {"bounds": walker.bounds, "weights": walker.weights, "gradients": walker.gradients}
    return arrays | {"degrees": walker.degrees, "lowest": walker.lowest}
