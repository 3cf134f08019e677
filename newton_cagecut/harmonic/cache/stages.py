# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The three stages of a walk's life, on whatever arrays they are to fill: walk, land, resolve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import warp as wp

from ..faces.land import land_walks
from ..options import WalkOptions
from ..resolve.fitted import resolve_fitted
from ..resolve.fitted_rows import FittedRows
from ..resolve.point_weights import PointWeights
from ..resolve.resolve import resolve_points
from ..resolve.walked_residuals import WalkedResiduals
from ..stats import UpdateStats
from ..walks.bounds import make_bounds
from ..walks.landing import CAPPED
from ..walks.marking import count_capped
from ..walks.query_points import QueryPoints
from ..walks.records import WalkRecords
from ..walks.walk import run_walks
from ..walks.work import Work
from .domain_state import DomainState

_BATCH_WALKS = 1 << 22


@dataclass(eq=False)
class Stages:
    """What the stages read and write.

    Args:
        state: Walls and faces.
        options: Options of the walks and of the resolve.
        points: Where the walks start.
        point_count: Points that there are.
        weights: Where points are resolved to.
        records: What is kept of all walks; None where nothing is.
        stats: Where counts and times are added.
        rows: Layers of a fit that are kept, if any.
    """

    state: DomainState
    options: WalkOptions
    points: QueryPoints
    point_count: int
    weights: PointWeights
    records: WalkRecords | None
    stats: UpdateStats
    rows: FittedRows = FittedRows()

    def run_all(self, *, progress: Callable[[float], None] | None = None) -> None:
        """Walk, land and resolve every point: all together where walks are kept, else in batches.

        Args:
            progress: Called with the finished fraction, between 0 and 1.
        """
        walks, count = self.options.walks, self.point_count
        batch = count
        if self.records is None:
            batch = min(count, max(1, _BATCH_WALKS // max(walks, 1)))
            self.records = unkept_records(self.state, self.options, batch * walks)
        for first in range(0, count, max(batch, 1)):
            size = min(batch, count - first)

            def report(fraction: float, first: int = first, size: int = size) -> None:
                progress((first + fraction * size) / count)

            work = Work.of_range(first, size, walks, self.options.seed, self.state.device)
            self.walk(work, progress=progress and report)
            self.land(work)
            self.resolve(np.arange(first, first + size), first_point=first)

    def run_points(self, indices: np.ndarray) -> None:
        """Walk, land and resolve some points, whose walks are kept."""
        work = Work.of_points(indices, self.options.walks, self.options.seed, self.state.device)
        self.walk(work)
        self.land(work)
        self.resolve(indices)

    def walk(
        self,
        work: Work,
        *,
        touched: wp.array | None = None,
        resumed: bool = False,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Walk; see ``run_walks``."""
        with self.stats.time("resume" if resumed else "rewalk", self.state.device):
            run_walks(
                work,
                self.records,
                self.points,
                self.state.grid,
                self.options,
                distance=self.state.distance,
                touched=touched,
                resumed=resumed,
                progress=progress,
            )

    def land(self, work: Work, *, part: str = "rewalk", touched: wp.array | None = None) -> None:
        """Evaluate landings on the faces, and mark points of which a value is no longer that before the edit."""
        change = self.state.change
        before = self.state.faces if change is None else change.faces_before
        with self.stats.time(part, self.state.device):
            land_walks(
                work,
                self.records,
                self.points,
                self.state.faces,
                self.options,
                before=before,
                touched=touched,
                nested=self.options.correction != "fitted",
            )

    def resolve(self, indices: np.ndarray, *, first_point: int = 0) -> None:
        """Reduce the landings of points to weights; ``first_point`` is the one whose walks are the first records."""
        if not len(indices):
            return
        stats = self.stats
        if self.options.correction == "fitted":
            self._resolve_fitted(indices, first_point)
            return
        with stats.time("resolve", self.state.device):
            resolve_points(
                indices,
                self.weights,
                self.records,
                self.points,
                self.state.faces,
                self.options,
                half_side=self.state.frame.half_side,
                first_point=first_point,
            )
            self._count_resolved(indices)

    def _resolve_fitted(self, indices: np.ndarray, first_point: int) -> None:
        stats, state, walks = self.stats, self.state, self.options.walks
        with stats.time("fit", state.device):
            fit = state.fit
            residuals = state.residuals if walks else None
        with stats.time("resolve", state.device):
            landed = None
            if walks:
                landed = WalkedResiduals(residuals, state.faces, self.records, self.options, first_point)
            resolve_fitted(indices, self.weights, self.points, fit, state.grid, landed, self.rows)
            self._count_resolved(indices)

    def _count_resolved(self, indices: np.ndarray) -> None:
        self.stats.resolved_points += len(indices)
        self.stats.lowest_weight = float(self.weights.lowest.numpy()[: self.point_count].min())
        if self.options.walks == 0:
            return
        keys, walks = self.records.landings.key, self.options.walks
        if self.records.bounded:
            self.stats.capped = count_capped(keys[: self.point_count * walks], int(CAPPED))
        else:
            self.stats.capped += count_capped(keys[: len(indices) * walks], int(CAPPED))


def unkept_records(state: DomainState, options: WalkOptions, count: int) -> WalkRecords:
    """Room for walks that are forgotten once they are resolved."""
    kind = make_bounds(options.bounds, state.cage.dimension)
    return WalkRecords(state.cage.dimension, count, kind, bounded=False, device=state.device)


def kept_records(state: DomainState, options: WalkOptions, count: int) -> WalkRecords:
    """Room for walks that are kept until edits concern them."""
    kind = make_bounds(options.bounds, state.cage.dimension)
    return WalkRecords(state.cage.dimension, count, kind, bounded=True, device=state.device)
