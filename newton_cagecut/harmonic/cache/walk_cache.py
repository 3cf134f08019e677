# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The arrays of one set of points, and the three stages that fill them: walk, land, resolve."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import warp as wp

from ...cage import CageEdit, boundary_distances
from ..faces.land import make_land_kernel
from ..launch import launch
from ..options import WalkOptions
from ..resolve.polynomials import make_polynomials
from ..resolve.regression import make_regression
from ..resolve.resolve import make_resolve_kernel
from ..stats import UpdateStats
from ..walks.bounds import make_bounds
from ..walks.landing import CAPPED, LANDING_DTYPES, empty_landings
from ..walks.marking import count_capped
from ..walks.query_points import INSIDE, REMOVED, byte_count, empty_points
from ..walks.walk import make_walk_kernel
from .domain import Domain

_BATCH_WALKS = 1 << 22
_BATCH_BYTES = 1 << 26


class Walker:
    """Points, their walks and their weights on a device.

    Args:
        domain: Walls and faces.
        options: Options of the walks.
        point_capacity: Points that there is room for.
        vertex_capacity: Cage vertices that there is room for; None lets the room grow.
        gradient_mask: Points that have gradients, shape (initial point count,).
        cuttable: Whether to keep all walks; otherwise they are forgotten once resolved.
    """

    def __init__(
        self,
        domain: Domain,
        options: WalkOptions,
        *,
        point_capacity: int,
        vertex_capacity: int | None,
        gradient_mask: np.ndarray,
        cuttable: bool,
    ) -> None:
        self.domain, self.options, self.cuttable = domain, options, cuttable
        self.point_count = 0
        self.point_capacity = point_capacity
        self.fixed_vertex_capacity = vertex_capacity
        self.require_vertices(domain.cage.vertex_count)
        device = domain.device
        self.points = empty_points(point_capacity, gradient_mask, device)
        self.degrees = wp.zeros(point_capacity, dtype=wp.int32, device=device)
        self.lowest = wp.zeros(point_capacity, dtype=float, device=device)
        self._rest = np.zeros((point_capacity, domain.dimension))
        self.gradient_count = int(gradient_mask.sum())
        if point_capacity * options.walks >= 1 << 31:
            raise ValueError(f"{point_capacity} points x {options.walks} walks are 2^31 or more; lower either")
        kept = point_capacity * options.walks if cuttable else 0
        self.landings = self._empty_landings(kept)
        self.bounds_kind = make_bounds(options.bounds, domain.dimension)
        self.bounds = self.bounds_kind.empty_levels(kept, device)
        self._touched = wp.zeros(point_capacity, dtype=wp.uint8, device=device)
        self._make_weights(vertex_capacity or domain.cage.vertex_count)

    def require_vertices(self, vertex_count: int) -> None:
        """Refuse a cage that does not fit the capacity."""
        capacity = self.fixed_vertex_capacity
        if capacity is not None and vertex_count > capacity:
            raise ValueError(
                f"the cage has {vertex_count} vertices, room was reserved for {capacity}: raise vertex_capacity"
            )

    def require_inside(self, edit: CageEdit) -> None:
        """Refuse an obstacle that covers points."""
        if edit.cage.volume >= edit.before.volume or edit.wall >= 0:
            return
        inner = np.flatnonzero(self._keys == INSIDE)
        covered = inner[~edit.cage.contains(self._rest[inner])]
        covered = covered[boundary_distances(edit.before, self._rest[covered]) > edit.before.length_tolerance]
        if len(covered):
            raise ValueError(
                f"the obstacle covers {len(covered)} of {self.point_count} points, such as point {covered[0]} at "
                f"{self._rest[covered[0]].tolist()}; move the obstacle, or remove the points first"
            )

    def require_points(self, point_count: int) -> None:
        """Refuse points that do not fit the capacity."""
        if point_count > self.point_capacity:
            raise ValueError(
                f"{point_count} points, but room was reserved for {self.point_capacity}: raise point_capacity"
            )

    def grow_vertices(self, vertex_count: int) -> None:
        """Make room for more cage vertices, where no capacity was asked for."""
        if vertex_count > self.vertex_capacity:
            weights, gradients = self.weights.numpy(), self.gradients.numpy()
            self._make_weights(max(vertex_count, self.vertex_capacity * 3 // 2))
            for array, old in ((self.weights, weights), (self.gradients, gradients)):
                rows = array.numpy()
                rows[:, : old.shape[1]] = old
                array.assign(rows)

    @property
    def _keys(self) -> np.ndarray:
        """Keys of the points, shape (point_count,)."""
        return self.points.key.numpy()[: self.point_count]

    @property
    def rest(self) -> np.ndarray:
        """Rest positions of the points [m], shape (point_count, dimension)."""
        return self._rest[: self.point_count]

    @property
    def removed_points(self) -> np.ndarray:
        """Numbers of the points that were removed, ascending."""
        return np.flatnonzero(self._keys == REMOVED)

    def remove(self, indices: np.ndarray) -> None:
        """Forget points; what they held is 0, and their numbers are free."""
        _scatter(self.points.key, indices, REMOVED)
        _scatter(self.points.piece, indices, -1)
        _scatter(self.landings.key, self._walk_numbers(indices), 0)  # no capped walk is counted
        _scatter(self.degrees, indices, 0)
        _scatter(self.weights, indices, 0.0)
        rows = self.points.gradient_row.numpy()[indices]
        _scatter(self.gradients, rows[rows >= 0], 0.0)

    def walks_of(self, indices: np.ndarray) -> wp.array:
        """The walks of points, as work to do."""
        return wp.array(self._walk_numbers(indices), dtype=wp.int32, device=self.domain.device)

    def _walk_numbers(self, indices: np.ndarray) -> np.ndarray:
        walks = self.options.walks
        return (indices[:, None] * walks + np.arange(walks)).reshape(-1).astype(np.int32)

    def place(self, indices: np.ndarray, points: np.ndarray, keys: np.ndarray, *, outside: np.ndarray) -> None:
        """Set points' rest positions [m] and keys; new points continue the count.

        Args:
            indices: Points to set, shape (n,).
            points: Their rest positions [m], shape (n, dimension).
            keys: Their keys, shape (n,).
            outside: Which of the n lie outside of the cage, within its tolerance.
        """
        self.point_count = max(self.point_count, int(indices.max(initial=-1)) + 1)
        self._rest[indices] = points
        _scatter(self.points.position, indices, self.domain.frame.to_space(points))
        _scatter(self.points.key, indices, keys)
        pieces = np.full(len(indices), -1, np.int32)
        inner = keys < 0
        pieces[inner] = self.domain.pieces_of(points[inner])
        pieces[outside] = -1
        _scatter(self.points.piece, indices, pieces)

    def group_points(self) -> None:
        """Find the piece of every point again that is in one."""
        inner = np.flatnonzero((self._keys == INSIDE) & (self.points.piece.numpy()[: self.point_count] >= 0))
        _scatter(self.points.piece, inner, self.domain.pieces_of(self._rest[inner]))

    def free_points(self, walls: np.ndarray) -> None:
        """Points on walls that have retired are inside from now on."""
        freed = np.flatnonzero(np.isin(self._keys // 2, walls))
        keys = np.full(len(freed), INSIDE, dtype=np.int32)
        self.place(freed, self._rest[freed], keys, outside=np.zeros(0, dtype=np.int64))

    def run_all(self, stats: UpdateStats, *, progress: Callable[[float], None] | None = None) -> None:
        """Walk, land and resolve every point, in batches where walks are not kept."""
        stats.rewalked = stats.walk_count
        if len(self.removed_points):
            self.run_points(np.flatnonzero(self._keys != REMOVED), stats)
            return
        walks = self.options.walks
        batch = self.point_count if self.cuttable else min(self.point_count, max(1, _BATCH_WALKS // walks))
        if not self.cuttable:
            self.landings = self._empty_landings(batch * walks)
        no_work = wp.zeros(0, dtype=wp.int32, device=self.domain.device)
        for first in range(0, self.point_count, max(batch, 1)):
            count = min(batch, self.point_count - first)

            def report(fraction: float, first: int = first, count: int = count) -> None:
                progress((first + fraction * count) / self.point_count)

            self.walk(no_work, stats, first_point=first, count=count * walks, progress=progress and report)
            self.land(no_work, stats, first_point=first, count=count * walks, part="rewalk")
            self.resolve(np.arange(first, first + count), stats, first_point=first)
        if not self.cuttable:
            self.landings = self._empty_landings(0)

    def run_points(self, indices: np.ndarray, stats: UpdateStats) -> None:
        """Walk, land and resolve some points, whose walks are kept."""
        work = self.walks_of(indices)
        self.walk(work, stats)
        self.land(work, stats)
        self.resolve(indices, stats)

    def walk(
        self,
        work: wp.array,
        stats: UpdateStats,
        *,
        first_point: int = 0,
        count: int | None = None,
        touched: wp.array | None = None,
        resumed: bool = False,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Walk the walks listed in ``work``, or the first ``count`` where it is empty; mark points that it touched.

        Resumed ones go on from the gates on which they landed.
        """
        options, domain = self.options, self.domain
        kernel = make_walk_kernel(
            dimension=domain.dimension,
            distance=domain.distance,
            bounded=self.cuttable,
            bounds_kind=self.bounds_kind,
            gated=domain.gated,
            resumed=resumed,
        )
        inputs = [work, options.walks, first_point * options.walks, wp.uint32(options.seed), self.points]
        inputs += [domain.walls.data, domain.grid.cells, domain.walls.gate_of_wall()]
        inputs += [options.epsilon, options.max_steps]
        inputs += [self.landings, self.bounds, self._touched if touched is None else touched]
        with stats.time("resume" if resumed else "rewalk", domain.device):
            launch(kernel, work.size if count is None else count, inputs, device=domain.device, progress=progress)

    def land(
        self,
        work: wp.array,
        stats: UpdateStats,
        *,
        first_point: int = 0,
        count: int | None = None,
        part: str = "rewalk",
        touched: wp.array | None = None,
    ) -> None:
        """Evaluate the landings of the walks in ``work`` on the faces as they are; mark points that it touched."""
        options, domain = self.options, self.domain
        kernel = make_land_kernel(
            dimension=domain.dimension, nested=domain.has_nested_faces, compare=touched is not None
        )
        inputs = [work, options.walks, first_point * options.walks, wp.uint32(options.seed), self.points]
        inputs += [domain.faces_before, domain.faces, self.landings, options.epsilon, options.max_steps]
        inputs += [self._touched if touched is None else touched]
        with stats.time(part, domain.device):
            launch(kernel, work.size if count is None else count, inputs, device=domain.device)

    def resolve(self, points: np.ndarray, stats: UpdateStats, *, first_point: int = 0) -> None:
        """Reduce the landings of the given points to weights and gradients."""
        if not len(points):
            return
        options, domain = self.options, self.domain
        vertex_count = domain.cage.vertex_count
        kernel = make_resolve_kernel(
            dimension=domain.dimension, correction=options.correction, gradients=self.gradient_count > 0
        )
        slot_bytes = 8 * (make_polynomials(domain.dimension).count + 3) * vertex_count
        batch = max(1, min(len(points), _BATCH_BYTES // slot_bytes))
        with stats.time("resolve", domain.device):
            moments = self._empty_moments(batch)
            rows = wp.array(points.astype(np.int32), dtype=wp.int32, device=domain.device)
            for first in range(0, len(points), batch):
                inputs = [first, rows, moments, options.walks, first_point, wp.uint32(options.seed), options.degree]
                inputs += [domain.frame.half_side, vertex_count, self.points]
                inputs += [domain.faces, self.landings, self.weights, self.gradients, self.degrees, self.lowest]
                launch(kernel, min(batch, len(points) - first), inputs, device=domain.device, smallest_chunk=16)
            stats.resolved_points += len(points)
            stats.lowest_weight = float(self.lowest.numpy()[: self.point_count].min())
            if self.cuttable:
                stats.capped = count_capped(self.landings.key[: self.point_count * options.walks], int(CAPPED))
            else:
                stats.capped += count_capped(self.landings.key[: len(points) * options.walks], int(CAPPED))

    def memory(self) -> dict[str, int]:
        """Bytes of each part on the device."""
        landings = [getattr(self.landings, name) for name in LANDING_DTYPES[self.domain.dimension]]
        return {
            "weights": _bytes(self.weights),
            "gradients": _bytes(self.gradients),
            "landings": sum(map(_bytes, landings)),
            "bounds": _bytes(self.bounds),
            "points": byte_count(self.points),
            "walls": self.domain.walls.byte_count,
            "grid": self.domain.grid.byte_count,
        }

    def _empty_landings(self, count: int) -> object:
        return empty_landings(self.domain.dimension, count, self.domain.device)

    def _empty_moments(self, slots: int) -> object:
        device, shape = self.domain.device, (slots, self.domain.cage.vertex_count)
        moments = make_regression(self.domain.dimension).Moments()
        moments.value = wp.empty(shape, dtype=make_polynomials(self.domain.dimension).Features, device=device)
        moments.slope = wp.empty(shape, dtype=wp.vec3d, device=device)
        return moments

    def _make_weights(self, vertex_capacity: int) -> None:
        self.vertex_capacity = vertex_capacity
        device = self.domain.device
        self.weights = wp.zeros((self.point_capacity, vertex_capacity), dtype=float, device=device)
        self.gradients = wp.zeros((self.gradient_count, vertex_capacity), dtype=wp.vec3, device=device)


def _scatter(array: wp.array, indices: np.ndarray, values: np.ndarray) -> None:
    """Write rows of a device array in place."""
    if len(indices):
        rows = array.numpy()
        rows[indices] = values
        array.assign(rows)


def _bytes(array: wp.array) -> int:
    return array.size * wp.types.type_size_in_bytes(array.dtype)
