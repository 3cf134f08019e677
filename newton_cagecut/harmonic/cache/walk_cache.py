# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The arrays of one set of points: where they are, their walks and their weights."""

from __future__ import annotations

import numpy as np
import warp as wp

from ..journal import Journal
from ..options import WalkOptions
from ..resolve.fitted_rows import FittedRows
from ..resolve.point_weights import PointWeights
from ..stats import UpdateStats
from ..walks.query_points import (
    INSIDE,
    REMOVED,
    byte_count,
    empty_points,
    place_points,
    point_arrays,
    write_rows,
)
from ..walks.records import WalkRecords
from ..walks.work import Work
from .domain_state import DomainState
from .placement import Placement
from .stages import Stages, kept_records


class WalkCache:
    """Points, their weights and, where the cage is to be cut, their walks.

    ``rest`` are the rest positions [m], shape (point_count, dimension). An edit replaces it; landings and bounds may be
    replaced as well, while the arrays of weights stay where they are unless they grow.

    Args:
        state: Walls and faces that the points are among.
        options: Options of the walks and of the resolve.
        point_capacity: Points that there is room for.
        vertex_capacity: Cage vertices that there is room for; None lets the room grow.
        gradient_mask: Points that have gradients, shape (initial point count,).
        cuttable: Whether to keep all walks; otherwise they are forgotten once resolved.

    Raises:
        ValueError: There are too many walks.
    """

    def __init__(
        self,
        state: DomainState,
        options: WalkOptions,
        *,
        point_capacity: int,
        vertex_capacity: int | None,
        gradient_mask: np.ndarray,
        cuttable: bool,
    ) -> None:
        self.options = options
        self.point_capacity, self.vertex_capacity = point_capacity, vertex_capacity
        if point_capacity * options.walks >= 1 << 31:
            raise ValueError(f"{point_capacity} points x {options.walks} walks are 2^31 or more; lower either")
        self.points = empty_points(point_capacity, gradient_mask, state.device)
        self.rest = np.zeros((0, state.cage.dimension))
        room = vertex_capacity or state.cage.vertex_count
        errors = options.correction == "fitted" and options.walks > 0
        self.weights = PointWeights(point_capacity, int(gradient_mask.sum()), room, device=state.device, errors=errors)
        self.records: WalkRecords | None = None
        self.fitted_rows = FittedRows()
        if cuttable and options.correction == "fitted":
            self.fitted_rows = FittedRows.kept(state.cage.dimension, len(gradient_mask), state.device)
        if cuttable:
            self.records = kept_records(state, options, point_capacity * options.walks)

    @property
    def point_count(self) -> int:
        """Number of points, those that were removed included."""
        return len(self.rest)

    @property
    def keys(self) -> np.ndarray:
        """Keys of the points, shape (point_count,)."""
        return self.points.key.numpy()[: self.point_count]

    @property
    def pieces(self) -> np.ndarray:
        """Pieces of the cage that the points are in, shape (point_count,)."""
        return self.points.piece.numpy()[: self.point_count]

    @property
    def removed_points(self) -> np.ndarray:
        """Numbers of the points that were removed, ascending."""
        return np.flatnonzero(self.keys == REMOVED)

    @property
    def standard_errors(self) -> np.ndarray:
        """Standard errors of the weights, shape (point_count, vertex_capacity); a copy.

        Raises:
            ValueError: The weights are not fitted, or have fewer than two walks.
        """
        if self.options.correction != "fitted" or self.options.walks < 2:
            raise ValueError("errors: only correction='fitted' with two walks or more tells standard errors")
        return self.weights.errors.numpy()[: self.point_count].copy()

    @property
    def arrays(self) -> dict[str, wp.array]:
        """The arrays that edits write to, of points whose walks are kept, by name."""
        records = self.records
        arrays = {f"landing {name}": array for name, array in records.landing_arrays.items()}
        arrays |= {f"point {name}": array for name, array in point_arrays(self.points).items()}
        return arrays | {"bounds": records.bounds} | self.weights.arrays

    def memory(self) -> dict[str, int]:
        """Bytes of each part on the device."""
        records = self.records
        landings = records.landing_arrays.values() if records else ()
        return {
            "weights": _bytes(self.weights.weights) + _bytes(self.weights.errors),
            "gradients": _bytes(self.weights.gradients),
            "landings": sum(map(_bytes, landings)),
            "bounds": _bytes(records.bounds) if records else 0,
            "points": byte_count(self.points),
            "layers": self.fitted_rows.byte_count,
        }

    def stages(self, state: DomainState, stats: UpdateStats) -> Stages:
        """The stages on these arrays.

        Args:
            state: Walls and faces.
            stats: Where counts and times are added.
        """
        return Stages(
            state, self.options, self.points, self.point_count, self.weights, self.records, stats, self.fitted_rows
        )

    def work_of(self, indices: np.ndarray) -> Work:
        """All walks of some points."""
        return Work.of_points(indices, self.options.walks, self.options.seed, self.points.key.device)

    def work(self, listed: wp.array) -> Work:
        """Walks of a list."""
        return Work(listed, self.options.walks, self.options.seed)

    def regrouped(self, state: DomainState, *, retired_walls: np.ndarray, pieces_changed: bool) -> Placement:
        """What is stored of points after an edit where it is not what it was before.

        Args:
            state: The state after the edit.
            retired_walls: Walls that have retired: points on them are inside from now on.
            pieces_changed: Whether all points in a piece may be in another one.
        """
        keys = self.keys
        concerned = np.isin(keys // 2, retired_walls)
        if pieces_changed:
            concerned |= (keys == INSIDE) & (self.pieces >= 0)
        indices = np.flatnonzero(concerned)
        inside = np.full(len(indices), INSIDE, dtype=np.int32)
        return Placement.of(state, indices, self.rest[indices], inside, outside=np.zeros(0, dtype=np.int64))

    def place(self, placement: Placement, journal: Journal) -> None:
        """Set points; new ones continue the count."""
        indices = placement.indices
        if not len(indices):
            return
        self.keep_points(journal)
        rest = np.zeros((max(self.point_count, int(indices.max()) + 1), self.rest.shape[1]))
        rest[: self.point_count] = self.rest
        rest[indices] = placement.rest
        self.rest = rest
        place_points(self.points, indices, placement.positions, placement.keys, placement.pieces)

    def remove(self, indices: np.ndarray, journal: Journal) -> None:
        """Forget points; what they held is 0, and their numbers are free."""
        if not len(indices):
            return
        work, (rows, slopes) = self.work_of(indices), self._weight_rows(indices)
        self.keep_points(journal)
        journal.keep_rows(self.records.landings.key, work.listed)
        self.keep_weights(indices, journal)
        write_rows(self.points.key, indices, REMOVED)
        write_rows(self.points.piece, indices, -1)
        write_rows(self.weights.degrees, indices, 0)
        wp.indexedarray(self.records.landings.key, [work.listed]).zero_()  # no capped walk is counted
        for array in (self.weights.weights, self.weights.errors):
            if array.size:
                wp.indexedarray(array, [rows, None]).zero_()
        if slopes.size:
            wp.indexedarray(self.weights.gradients, [slopes, None]).zero_()

    def keep_points(self, journal: Journal) -> None:
        """Keep where the points are, before any is set or walked for."""
        journal.keep_attributes(self, "rest")
        journal.keep(*point_arrays(self.points).values())

    def keep_walks(self, work: Work, journal: Journal, *, walked: bool = True) -> None:
        """Keep landings and bounds of walks that are to be run, or of landings that are to be evaluated."""
        for name, array in self.records.landing_arrays.items():
            if walked or name not in ("key", "point"):
                journal.keep_rows(array, work.listed)
        if walked:
            journal.keep_rows(self.records.bounds, work.listed, axis=1)

    def keep_weights(self, indices: np.ndarray, journal: Journal) -> None:
        """Keep the weights of points that are to be resolved."""
        rows, slopes = self._weight_rows(indices)
        for array in (self.weights.weights, self.weights.degrees, self.weights.lowest):
            journal.keep_rows(array, rows)
        journal.keep_rows(self.weights.gradients, slopes)
        if self.weights.errors.size:
            journal.keep_rows(self.weights.errors, rows)

    def _weight_rows(self, indices: np.ndarray) -> tuple[wp.array, wp.array]:
        """Rows of points among the weights, and of those that have gradients among these."""
        slopes = self.points.gradient_row.numpy()[indices]
        rows = (indices, slopes[slopes >= 0])
        device = self.points.key.device
        return tuple(wp.array(row.astype(np.int32), dtype=wp.int32, device=device) for row in rows)


def _bytes(array: wp.array) -> int:
    return array.size * wp.types.type_size_in_bytes(array.dtype)
