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
from ..journal import Journal
from ..resolve.point_weights import PointWeights
from ..walks.query_points import point_arrays
from ..walks.records import WalkRecords
from .domain import Domain
from .domain_state import DomainState
from .walk_cache import WalkCache


@dataclass(frozen=True, eq=False)
class CoordinatesSnapshot:
    """All that edits change in a set of coordinates; made by ``HarmonicCoordinates.snapshot``."""

    owner: WalkCache
    state: DomainState
    present: DomainState
    records: WalkRecords
    points: dict[str, wp.array]
    weights: PointWeights
    rest: np.ndarray

    @property
    def cage(self) -> Cage:
        """The cage at the time."""
        return self.state.cage

    @property
    def byte_count(self) -> int:
        """Bytes of the copies on the device."""
        arrays = [*self.records.landing_arrays.values(), self.records.bounds]
        arrays += [*self.points.values(), *self.weights.arrays.values()]
        return sum(array.size * wp.types.type_size_in_bytes(array.dtype) for array in arrays)

    @classmethod
    def of(cls, cache: WalkCache, state: DomainState, domain: Domain) -> CoordinatesSnapshot:
        """Copy what edits change.

        Args:
            cache: Points, walks and weights.
            state: The state that they are for.
            domain: The domain, which may have gone on to another state.
        """
        points = {name: wp.clone(array) for name, array in point_arrays(cache.points).items()}
        copies = cache.records.copied(), points, cache.weights.copied()
        return cls(cache, state, domain.now, *copies, cache.rest)

    def restore(self, domain: Domain, journal: Journal) -> None:
        """Bring everything back; arrays of weights that did not grow since stay where they are.

        Args:
            domain: The domain.
            journal: Where all that is overwritten is kept before.
        """
        cache, records = self.owner, self.records.copied()
        grown = cache.weights.vertex_capacity != self.weights.vertex_capacity
        weights = self.weights.copied() if grown else cache.weights
        cache.keep_points(journal)
        journal.keep_attributes(cache, "records", "weights")
        journal.keep_attributes(domain, "now")
        if not grown:
            journal.keep(*weights.arrays.values())
        domain.now, cache.records, cache.weights, cache.rest = self.present, records, weights, self.rest
        for name, array in point_arrays(cache.points).items():
            wp.copy(array, self.points[name])
        if not grown:
            for name, array in weights.arrays.items():
                wp.copy(array, self.weights.arrays[name])
