# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Harmonic coordinates of points in a cage, by Walk on Spheres, with incremental updates (paper, sections 3 to 5)."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import warp as wp

from ..cage import Cage, CageEdit
from ..geometry import as_callback, as_instance, as_path
from . import point_checks
from .cache.domain import Domain, domain_of
from .cache.domain_state import DomainState
from .cache.further_points import weights_of
from .cache.incremental import find_concerned, run_again, run_concerned
from .cache.placement import Placement
from .cache.snapshot import CoordinatesSnapshot
from .cache.storage import load_cache, save_cache
from .cache.walk_cache import WalkCache
from .journal import Journal
from .options import WalkOptions, as_device
from .placing import placed
from .point_change import PointChange
from .resolve.point_weights import PointWeights
from .stats import UpdateStats
from .wanted_error import chosen_walks


class HarmonicCoordinates:
    """Harmonic coordinates of points with respect to a cage.

    Weights are finite everywhere and sum to 1; but with correction "none" they reproduce the point to rounding. Points
    on the boundary, on edges and vertices too, have the boundary's weights. So do points that lie outside by no more
    than ``cage.length_tolerance``: those of the nearest place on it, extended linearly, some a little below 0. Points
    farther outside, in a cavity or in an obstacle are refused. A point exactly on a cut counts for the side that
    rounding puts it on; ``point_keys`` says which one is meant.

    Args:
        cage: The cage, or a ``Domain`` that other coordinates hold already and that is to be shared.
        points: Rest positions inside the cage [m], shape (point_count, dimension).
        walks: Walks a point. The standard error falls as its root. Fitted weights need none. "auto": by ``error``.
        seed: Seed of all walks. The same seed on the same walls gives the same weights, bit for bit.
        gradients: Whether to estimate the weights' gradients: for all points, or those of a mask, shape (point_count,).
        cuttable: Whether to keep the walk cache that updates need (by default 64 bytes a walk, 32 in the plane).
        device: Where to walk; Warp's current device by default, or the domain's.
        error: Wanted root mean square error of a point's weights, by as many walks as two short runs say it takes; with
            ``walks="auto"`` 0.01 by default.
        correction: "harmonic" (control variates), "affine" (paper, equation 5), "none" (plain means) or "fitted": a
            boundary fit and the mean of what it leaves over where walks land; "auto": fitted unless the cage is large.
        bounds: Bounding volume of a walk: "dop18", "dop26", "aabb" or "sphere". Smaller ones send more walks to be
            walked again; the results are identical.
        distance: "grid" (candidates) or "all" (every wall): identical results. By default "grid", or the domain's.
        quads: "mean_value" (paper, equation 4) or "harmonic" for convex quads of the cage. By default "mean_value", or
            what the domain has.
        epsilon: Distance at which a walk lands, relative to half of the longest side of the cage's bounding box.
        max_steps: Cap on a walk's steps; capped walks land on the nearest wall and are counted.
        degree: Highest degree of the harmonic control variates, 1 to 3.
        point_keys: For points that lie on a wall: its key 2 * wall + side; -1 for the others. Shape (point_count,).
        point_capacity: Points to reserve room for; the number of points by default.
        vertex_capacity: Cage vertices to reserve room for; by default room grows as it is needed. With a capacity
            the arrays never move, so captured CUDA graphs stay valid.
        progress: Called with the finished fraction of the first walk, between 0 and 1.

    Raises:
        ValueError: An option is out of its range, or another one than the domain has, or points lie outside the cage.
    """

    def __init__(
        self,
        cage: Cage | Domain,
        points: np.ndarray,
        walks: int | str = 1024,
        seed: int = 0,
        gradients: bool | np.ndarray = False,
        cuttable: bool = True,
        device: wp.context.Devicelike = None,
        *,
        error: float | None = None,
        correction: str = "harmonic",
        bounds: str = "dop18",
        distance: str | None = None,
        quads: str | None = None,
        epsilon: float = 1.0e-4,
        max_steps: int = 256,
        degree: int = 3,
        point_keys: np.ndarray | None = None,
        point_capacity: int | None = None,
        vertex_capacity: int | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        self.domain = domain_of(cage, quads=quads, distance=distance, device=device)
        self._state = state = self.domain.now
        points = point_checks.checked_points(points, state.cage.dimension)
        tried = {"correction": correction, "epsilon": epsilon, "max_steps": max_steps, "degree": degree}
        walks = chosen_walks(walks, error, type(self), self.domain, points, tried)
        options = WalkOptions(walks, seed, correction, bounds, epsilon, max_steps, degree).chosen_for(state.cage)
        count = len(points)
        room = point_checks.checked_room(point_capacity, vertex_capacity, gradients, cuttable, state.cage, count, walks)
        as_callback(progress, "progress")
        placement = placed(state, PointChange(np.arange(count), points, point_keys), capacity=count)
        self._cache = WalkCache(state, options, **room)
        self._cache.place(placement, Journal())
        self._cache.stages(state, self._new_stats()).run_all(progress=progress)

    @property
    def cage(self) -> Cage:
        """The cage that the weights are for: that of the last update or recompute."""
        return self._state.cage

    @property
    def point_count(self) -> int:
        """Number of points, those that were removed included: rows of the weights."""
        return self._cache.point_count

    @property
    def removed_points(self) -> np.ndarray:
        """Numbers of the points that were removed, ascending; :meth:`set_points` can use them again."""
        return self._cache.removed_points

    @property
    def walks(self) -> int:
        """Walks a point."""
        return self._cache.options.walks

    @property
    def weights(self) -> np.ndarray:
        """The weights, shape (point_count, cage.vertex_count), float32; a copy."""
        return self._cache.weights.weights.numpy()[: self.point_count, : self.cage.vertex_count].copy()

    @property
    def gradients(self) -> np.ndarray:
        """The weights' gradients [1/m] of points that have them, shape (gradient_count, vertex_count, dimension)."""
        return self._cache.weights.gradients.numpy()[:, : self.cage.vertex_count, : self.cage.dimension].copy()

    @property
    def weights_array(self) -> wp.array:
        """The weights on the device, shape (point_capacity, vertex_capacity); unused entries are 0."""
        return self._cache.weights.weights

    @property
    def gradients_array(self) -> wp.array:
        """The gradients [1/m] on the device, vec3, shape (gradient_count, vertex_capacity); unused entries are 0."""
        return self._cache.weights.gradients

    @property
    def degrees(self) -> np.ndarray:
        """Degree of the control variates that each point uses; 0 without, or with an affine correction besides.

        Shape (point_count,).
        """
        return self._cache.weights.degrees.numpy()[: self.point_count].copy()

    @property
    def lowest_weights(self) -> np.ndarray:
        """Least weight of each point, 0 where none is negative: controls can overshoot; shape (point_count,)."""
        return self._cache.weights.lowest.numpy()[: self.point_count].copy()

    @property
    def errors(self) -> np.ndarray:
        """Standard errors of fitted weights by their walks, shape (point_count, cage.vertex_count); 0 on the boundary.

        Raises:
            ValueError: The weights are not fitted, or have fewer than two walks.
        """
        return self._cache.standard_errors[:, : self.cage.vertex_count]

    @property
    def landings(self) -> dict[str, np.ndarray]:
        """The cached landings: "key", "point", "face", "edge", "param", a row a walk; copies."""
        arrays = self._cache_of("landings").records.landing_arrays
        return {name: array.numpy()[: self.point_count * self.walks].copy() for name, array in arrays.items()}

    @property
    def bounds(self) -> np.ndarray:
        """The cached bounds of the walks, quantised, a row a walk; a copy."""
        return self._cache_of("bounds").records.bounds.numpy()[:, : self.point_count * self.walks].T.copy()

    def memory(self) -> dict[str, int]:
        """Bytes of each part on the device."""
        state = self._state
        return self._cache.memory() | {"walls": state.walls.byte_count, "grid": state.grid.byte_count}

    def update(
        self, edit: CageEdit, *, points: PointChange | None = None, journal: Journal | None = None
    ) -> UpdateStats:
        """Bring the weights up to date with an edit of the cage.

        Only the walks that the new piece of wall may have met are walked again, only landings on changed faces are
        evaluated again, only points with either are resolved again (paper, section 5.2). Where an edit has moved a face
        outward, the walks that landed on it go on from there (section 8). The result equals that of ``recompute()`` bit
        for bit.

        Args:
            edit: The next edit of the cage that the coordinates hold.
            points: Points to set on the edited cage, as :meth:`set_points` does; their time is "new_points".
            journal: Journal of a larger edit that this one is a part of, and that can take it back.

        Raises:
            ValueError: There is no walk cache, the edit does not start from the present cage, an obstacle covers
                points, the cage has too many vertices or extensions, or a point cannot be set. Nothing has changed
                then, nor has it after any other failure.
        """
        cache = self._cache_of("update")
        as_instance(edit, CageEdit, "edit", hint="cut.advance(to=depth) returns one")
        if points is not None:
            as_instance(points, PointChange, "points", hint="or use set_points after the update")
        if edit.before is not self.cage:
            raise ValueError(
                "update: the edit starts from another cage than the coordinates hold; pass every edit, in order"
            )
        point_checks.require_vertex_room(edit.cage.vertex_count, cache.vertex_capacity)
        point_checks.require_uncovered(edit, cache.keys, cache.rest)
        stats = self._new_stats()
        with stats.time("walls", self.domain.device):
            after = self.domain.after(edit)
            weights = cache.weights.grown(edit.cage.vertex_count)
            regrouped = cache.regrouped(after, retired_walls=edit.retired_walls, pieces_changed=after.change.regrouped)
        count, capacity = cache.point_count, cache.point_capacity
        added = None if points is None else placed(after, points, count=count, capacity=capacity)
        concerned = None if edit.is_empty else find_concerned(cache, after, stats)
        with Journal.within(journal) as journal:
            self._take_over(after, weights, journal)
            cache.place(regrouped, journal)
            if concerned is not None:
                run_concerned(cache, after, concerned, stats, journal)
            if added is not None and len(added.indices):
                stats.seconds["new_points"] = self._run_placed(added, journal).total_seconds
        return stats

    def recompute(self, *, journal: Journal | None = None) -> UpdateStats:
        """Walk every walk again on the walls as they are: the paper's naive baseline.

        Until it is done the walks are there twice, so that a failure leaves those that were.

        Args:
            journal: Journal of a larger edit that this one is a part of, and that can take it back.
        """
        cache, state = self._cache, self.domain.now
        point_checks.require_vertex_room(state.cage.vertex_count, cache.vertex_capacity)
        weights, stats = cache.weights.grown(state.cage.vertex_count), self._new_stats()
        regrouped = cache.regrouped(state, retired_walls=np.zeros(0, dtype=np.int64), pieces_changed=True)
        with Journal.within(journal) as journal:
            self._take_over(state, weights, journal)
            cache.place(regrouped, journal)
            run_again(cache, state, stats, journal)
        return stats

    def snapshot(self, *, of: HarmonicCoordinates | None = None) -> CoordinatesSnapshot:
        """Copy all that edits change, for :meth:`restore`; as many bytes as the cache and the weights.

        Args:
            of: Other coordinates, made as these were, whose walks and weights are to be restored here.

        Raises:
            ValueError: There is no walk cache, or the other coordinates have other capacities or options.
        """
        if of is not None:
            as_instance(of, HarmonicCoordinates, "of")
            mine, other = (one._cache_of("snapshot") for one in (self, of))
            sizes = [(cache.point_capacity, cache.vertex_capacity) for cache in (mine, other)]
            if sizes[0] != sizes[1] or of.walks != self.walks:
                raise ValueError("snapshot: the other coordinates have other capacities, or more or fewer walks")
            return replace(of.snapshot(), owner=mine)
        return CoordinatesSnapshot.of(self._cache_of("snapshot"), self._state, self.domain)

    def restore(self, snapshot: CoordinatesSnapshot, *, journal: Journal | None = None) -> None:
        """Undo every edit since a snapshot: cage, walls, walks and weights are the same again, bit for bit.

        Args:
            snapshot: A snapshot of these coordinates; it can be restored any number of times.
            journal: Journal of a larger edit that this one is a part of, and that can take it back.

        Raises:
            ValueError: The snapshot is of other coordinates. Nothing has changed then.
        """
        hint = "snapshot() of the coordinates returns one"
        if as_instance(snapshot, CoordinatesSnapshot, "snapshot", hint=hint).owner is not self._cache:
            raise ValueError("restore: the snapshot is of other coordinates; restore those, or take one of these")
        with Journal.within(journal) as journal:
            journal.keep_attributes(self, "_state")
            self._state = snapshot.state
            snapshot.restore(self.domain, journal)

    def save(self, path: str | os.PathLike) -> None:
        """Write the coordinates to a file, walks and cuts so far included, for :meth:`load`.

        Args:
            path: Where to write it; a file that is there is replaced once the new one is whole.

        Raises:
            OSError: The file cannot be written; one that was there is as it was.
            ValueError: There is no walk cache, or a shared domain has gone on to another cage.
        """
        cache = self._cache_of("save")
        if self.domain.now is not self._state:
            raise ValueError(
                "save: the shared domain holds a later cage than these coordinates; recompute() them first"
            )
        save_cache(cache, self.domain, as_path(path))

    @classmethod
    def load(
        cls,
        path: str | os.PathLike,
        cage: Cage,
        points: np.ndarray,
        *,
        device: wp.context.Devicelike = None,
        **options: object,
    ) -> HarmonicCoordinates:
        """Read coordinates that were saved; edits go on from there, bit for bit as if they had never been away.

        Args:
            path: Where the file is.
            cage: The cage that they were for when they were saved; after a cut that is ``cut.cage``.
            points: Rest positions of the points [m], shape (point_count, dimension).
            device: Where to put them; Warp's current device by default.
            **options: Options that they must have been made with, such as the seed; the others are taken as they are.

        Raises:
            OSError: There is no such file, or it cannot be read.
            TypeError: There is no such option.
            ValueError: The file is cut short, damaged, of another version, or of another cage, other points or other
                options, which the text names; or its walks do not repeat themselves on this device.
        """
        coordinates = cls.__new__(cls)
        path, points = as_path(path), point_checks.checked_points(points, as_instance(cage, Cage, "cage").dimension)
        cache, domain = load_cache(path, cage, points, device=as_device(device), options=options)
        coordinates._cache, coordinates.domain, coordinates._state = cache, domain, domain.now
        return coordinates

    def set_points(
        self,
        indices: np.ndarray,
        points: np.ndarray,
        point_keys: np.ndarray | None = None,
        *,
        journal: Journal | None = None,
    ) -> UpdateStats:
        """Move points, put new ones where some were removed, or add them at the end, and walk for them alone.

        Args:
            indices: Points to set, shape (n,); those beyond the count continue it without gaps.
            points: Rest positions [m], shape (n, dimension).
            point_keys: Key 2 * wall + side for points on a wall, else -1, shape (n,).
            journal: Journal of a larger edit that this one is a part of, and that can take it back.

        Raises:
            ValueError: A point lies outside the cage, an index is twice there or leaves a gap, a key is of no wall, or
                there are more points than were reserved. Nothing has changed then.
        """
        cache, change = self._cache_of("set_points"), PointChange(indices, points, point_keys)
        placement = placed(self._state, change, count=cache.point_count, capacity=cache.point_capacity)
        with Journal.within(journal) as journal:
            return self._run_placed(placement, journal)

    def remove_points(self, indices: np.ndarray, *, journal: Journal | None = None) -> None:
        """Remove points: from now on their weights and gradients are 0, and nothing is walked for them.

        The others keep their numbers, by which walks draw their randomness, and so every bit.

        Args:
            indices: Points to remove, shape (n,).
            journal: Journal of a larger edit that this one is a part of, and that can take it back.

        Raises:
            TypeError: The indices are not whole numbers.
            ValueError: An index is of no point, is there twice, or was removed before. Nothing has changed then.
        """
        cache = self._cache_of("remove_points")
        indices = point_checks.checked_indices(indices)
        gone = indices[(indices >= self.point_count) | np.isin(indices, self.removed_points)]
        if len(gone):
            raise ValueError(
                f"remove_points: there is no point {gone[0]}; there are {self.point_count}, less removed ones"
            )
        with Journal.within(journal) as journal:
            cache.remove(indices, journal)

    def boundary_weights(self, points: np.ndarray, point_keys: np.ndarray, *, walks: int = 1024) -> np.ndarray:
        """Weights of points on the cage's walls, on the faces as they are.

        Args:
            points: Rest positions on the walls [m], shape (n, dimension).
            point_keys: Key 2 * wall + side of the side that each lies on, shape (n,).
            walks: Walks a point, for faces that need nested walks.

        Returns:
            Weights, shape (n, cage.vertex_count), float32.

        Raises:
            ValueError: A key is of no wall.
        """
        count = len(point_checks.checked_points(points, self.cage.dimension))
        point_checks.checked_keys(point_keys, count, len(self.cage.walls), lowest=0)
        return self.weights_at(points, point_keys, walks=walks)

    def weights_at(self, points: np.ndarray, point_keys: np.ndarray | None = None, *, walks: int = 1024) -> np.ndarray:
        """Weights of further points in the cage as it is, which are not kept.

        Args:
            points: Rest positions [m], shape (n, dimension).
            point_keys: Key 2 * wall + side for points on a wall, else -1, shape (n,).
            walks: Walks a point; fitted coordinates take their own.

        Returns:
            Weights, shape (n, cage.vertex_count), float32.

        Raises:
            ValueError: A point lies outside the cage, or a key is of no wall.
        """
        own = self._cache.options
        options = own if own.correction == "fitted" else WalkOptions(walks, own.seed, epsilon=own.epsilon)
        points = point_checks.checked_points(points, self.cage.dimension)
        count = len(points)
        placement = placed(self._state, PointChange(np.arange(count), points, point_keys), capacity=count)
        return weights_of(self._state, placement, options)

    def _cache_of(self, wanted: str) -> WalkCache:
        if self._cache.records is None:
            raise ValueError(f"{wanted}: these coordinates were made with cuttable=False and keep no walk cache")
        return self._cache

    def _new_stats(self) -> UpdateStats:
        return UpdateStats(self.walks * (self.point_count - len(self.removed_points)))

    def _take_over(self, state: DomainState, weights: PointWeights, journal: Journal) -> None:
        """Go on to a state of the domain, and to the room for weights that it needs."""
        journal.keep_attributes(self, "_state")
        journal.keep_attributes(self.domain, "now")
        journal.keep_attributes(self._cache, "weights")
        self._state = self.domain.now = state
        self._cache.weights = weights

    def _run_placed(self, placement: Placement, journal: Journal) -> UpdateStats:
        """Set points and walk for them."""
        self._cache.keep_walks(self._cache.work_of(placement.indices), journal)
        self._cache.keep_weights(placement.indices, journal)
        self._cache.place(placement, journal)
        stats = self._new_stats()
        stats.rewalked = len(placement.indices) * self.walks
        self._cache.stages(self._state, stats).run_points(placement.indices)
        return stats
