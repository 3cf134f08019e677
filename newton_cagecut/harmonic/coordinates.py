# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Harmonic coordinates of points in a cage, by Walk on Spheres, with incremental updates (paper, sections 3 to 5)."""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np
import warp as wp

from ..cage import Cage, CageEdit, check_inside
from .cache.domain import Domain
from .cache.incremental import run_concerned
from .cache.snapshot import CoordinatesSnapshot, edited_arrays
from .cache.storage import load_walker, save_walker
from .cache.walk_cache import Walker
from .journal import Journal
from .options import WalkOptions
from .point_change import PointChange
from .point_checks import checked_indices, checked_keys, checked_points
from .stats import UpdateStats
from .walks.landing import LANDING_DTYPES


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
        walks: Walks a point. The standard error falls as the root of it.
        seed: Seed of all walks. The same seed on the same walls gives the same weights, bit for bit.
        gradients: Whether to estimate the weights' gradients: for all points, or those of a mask, shape (point_count,).
        cuttable: Whether to keep the walk cache that updates need (by default 64 bytes a walk, 32 in the plane).
        device: Where to walk; Warp's current device by default.
        correction: "harmonic" (control variates), "affine" (paper, equation 5) or "none" (plain means).
        bounds: Bounding volume of a walk: "dop18", "dop26", "aabb" or "sphere". Smaller ones send more walks to be
            walked again; the results are identical.
        distance: "grid" (candidate grid) or "all" (every wall); the results are identical.
        quads: "mean_value" (paper, equation 4) or "harmonic" for convex quads of the cage.
        epsilon: Distance at which a walk lands, relative to half of the longest side of the cage's bounding box.
        max_steps: Cap on a walk's steps; capped walks land on the nearest wall and are counted.
        degree: Highest degree of the harmonic control variates, 1 to 3.
        point_keys: For points that lie on a wall: its key 2 * wall + side; -1 for the others. Shape (point_count,).
        point_capacity: Points to reserve room for; the number of points by default.
        vertex_capacity: Cage vertices to reserve room for; by default room grows as it is needed. With a capacity
            the arrays never move, so captured CUDA graphs stay valid.
        progress: Called with the finished fraction of the first walk, between 0 and 1.

    Raises:
        ValueError: An option is out of its range, or points lie outside the cage.
    """

    def __init__(
        self,
        cage: Cage | Domain,
        points: np.ndarray,
        walks: int = 1024,
        seed: int = 0,
        gradients: bool | np.ndarray = False,
        cuttable: bool = True,
        device: wp.context.Devicelike = None,
        *,
        correction: str = "harmonic",
        bounds: str = "dop18",
        distance: str = "grid",
        quads: str = "mean_value",
        epsilon: float = 1.0e-4,
        max_steps: int = 256,
        degree: int = 3,
        point_keys: np.ndarray | None = None,
        point_capacity: int | None = None,
        vertex_capacity: int | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        options = WalkOptions(walks, seed, correction, bounds, distance, quads, epsilon, max_steps, degree)
        if isinstance(cage, Domain):
            self.domain = cage
        else:
            self.domain = Domain(cage, quads=quads, distance=distance, device=wp.get_device(device))
        self._cage = self.domain.cage
        points = checked_points(points, self.domain.dimension)
        keys = checked_keys(point_keys, len(points), len(self._cage.walls))
        outside = check_inside(self.domain.cage, points, which=np.flatnonzero(keys < 0))
        self._walker = Walker(
            self.domain,
            options,
            point_capacity=max(point_capacity or 0, len(points)),
            vertex_capacity=vertex_capacity,
            gradient_mask=np.broadcast_to(np.asarray(gradients, dtype=bool), len(points)),
            cuttable=cuttable,
        )
        self._walker.place(np.arange(len(points)), points, keys, outside=outside)
        self._walker.run_all(self._new_stats(), progress=progress)

    @property
    def cage(self) -> Cage:
        """The cage that the weights are for: that of the last update or recompute."""
        return self._cage

    @property
    def point_count(self) -> int:
        """Number of points, those that were removed included: rows of the weights."""
        return self._walker.point_count

    @property
    def removed_points(self) -> np.ndarray:
        """Numbers of the points that were removed, ascending; :meth:`set_points` can use them again."""
        return self._walker.removed_points

    @property
    def walks(self) -> int:
        """Walks a point."""
        return self._walker.options.walks

    @property
    def weights(self) -> np.ndarray:
        """The weights, shape (point_count, cage.vertex_count), float32; a copy."""
        return self._walker.weights.numpy()[: self.point_count, : self.cage.vertex_count].copy()

    @property
    def gradients(self) -> np.ndarray:
        """The weights' gradients [1/m] of points that have them, shape (gradient_count, vertex_count, dimension)."""
        return self._walker.gradients.numpy()[:, : self.cage.vertex_count, : self.domain.dimension].copy()

    @property
    def weights_array(self) -> wp.array:
        """The weights on the device, shape (point_capacity, vertex_capacity); unused entries are 0."""
        return self._walker.weights

    @property
    def gradients_array(self) -> wp.array:
        """The gradients [1/m] on the device, vec3, shape (gradient_count, vertex_capacity); unused entries are 0."""
        return self._walker.gradients

    @property
    def degrees(self) -> np.ndarray:
        """Degree of the control variates that each point uses; 0 without, or with an affine correction besides.

        Shape (point_count,).
        """
        return self._walker.degrees.numpy()[: self.point_count].copy()

    @property
    def lowest_weights(self) -> np.ndarray:
        """Least weight of each point, 0 where none is negative: controls can overshoot; shape (point_count,)."""
        return self._walker.lowest.numpy()[: self.point_count].copy()

    @property
    def landings(self) -> dict[str, np.ndarray]:
        """The cached landings: "key", "point", "face", "edge", "param", a row a walk; copies."""
        landings = self._cache_of("landings").landings
        count = self.point_count * self.walks
        return {name: getattr(landings, name).numpy()[:count].copy() for name in LANDING_DTYPES[self.domain.dimension]}

    @property
    def bounds(self) -> np.ndarray:
        """The cached bounds of the walks, quantised, a row a walk; a copy."""
        return self._cache_of("bounds").bounds.numpy()[:, : self.point_count * self.walks].T.copy()

    def memory(self) -> dict[str, int]:
        """Bytes of each part on the device."""
        return self._walker.memory()

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
        self._cache_of("update")
        with Journal.within(journal) as journal:
            self._keep(journal)
            stats = self._updated(edit)
            if points is not None and len(points.indices):
                added = self.set_points(points.indices, points.points, points.keys, journal=journal)
                stats.seconds["new_points"] = added.total_seconds
        return stats

    def _updated(self, edit: CageEdit) -> UpdateStats:
        walker = self._walker
        if edit.before is not self._cage:
            raise ValueError(
                "update: the edit starts from another cage than the coordinates hold; pass every edit, in order"
            )
        walker.require_vertices(edit.cage.vertex_count)
        walker.require_inside(edit)
        stats = self._new_stats()
        with stats.time("walls", self.domain.device):
            change = self.domain.apply(edit)
            walker.grow_vertices(edit.cage.vertex_count)
            walker.free_points(edit.retired_walls)
            if change.regrouped:
                walker.group_points()
        self._cage = edit.cage
        if edit.is_empty:
            return stats
        run_concerned(walker, change, stats)
        return stats

    def recompute(self, *, journal: Journal | None = None) -> UpdateStats:
        """Walk every walk again on the walls as they are: the paper's naive baseline.

        Args:
            journal: Journal of a larger edit that this one is a part of, and that can take it back.
        """
        with Journal.within(journal) as journal:
            self._keep(journal)
            return self._recomputed()

    def _recomputed(self) -> UpdateStats:
        stats = self._new_stats()
        self._cage = self.domain.cage
        self._walker.require_vertices(self._cage.vertex_count)
        self._walker.grow_vertices(self._cage.vertex_count)
        self._walker.group_points()
        self._walker.run_all(stats)
        return stats

    def snapshot(self) -> CoordinatesSnapshot:
        """Copy all that edits change, for :meth:`restore`; as many bytes as the cache and the weights.

        Raises:
            ValueError: There is no walk cache.
        """
        return CoordinatesSnapshot.of(self._cache_of("snapshot"), self.domain)

    def restore(self, snapshot: CoordinatesSnapshot, *, journal: Journal | None = None) -> None:
        """Undo every edit since a snapshot: cage, walls, walks and weights are the same again, bit for bit.

        Args:
            snapshot: A snapshot of these coordinates; it can be restored any number of times.
            journal: Journal of a larger edit that this one is a part of, and that can take it back.

        Raises:
            ValueError: The snapshot is of other coordinates. Nothing has changed then.
        """
        if snapshot.owner is not self._walker:
            raise ValueError("restore: the snapshot is of other coordinates; restore those, or take one of these")
        with Journal.within(journal) as journal:
            self._keep(journal)
            snapshot.restore()
            self._cage = snapshot.cage

    def save(self, path: str | os.PathLike) -> None:
        """Write the coordinates to a file, walks and cuts so far included, for :meth:`load`.

        Args:
            path: Where to write it; a file that is there is replaced once the new one is whole.

        Raises:
            OSError: The file cannot be written; one that was there is as it was.
            ValueError: There is no walk cache, or a shared domain has gone on to another cage.
        """
        walker = self._cache_of("save")
        if self.domain.cage is not self._cage:
            raise ValueError(
                "save: the shared domain holds a later cage than these coordinates; recompute() them first"
            )
        save_walker(walker, path)

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
        walker = load_walker(path, cage, points, device=wp.get_device(device), options=options)
        coordinates._walker, coordinates.domain, coordinates._cage = walker, walker.domain, cage
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
        walker = self._cache_of("set_points")
        points = checked_points(points, self.domain.dimension)
        indices = checked_indices(indices, len(points))
        added = np.sort(indices[indices >= self.point_count])
        if not np.array_equal(added, self.point_count + np.arange(len(added))):
            raise ValueError(f"indices: there are {self.point_count} points; new ones must follow without gaps")
        keys = checked_keys(point_keys, len(points), len(self.domain.cage.walls))
        walker.require_points(int(indices.max(initial=-1)) + 1)
        outside = check_inside(self.domain.cage, points, which=np.flatnonzero(keys < 0))
        with Journal.within(journal) as journal:
            self._keep(journal)
            walker.place(indices, points, keys, outside=outside)
            stats = self._new_stats()
            stats.rewalked = len(indices) * self.walks
            walker.run_points(indices, stats)
        return stats

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
        walker = self._cache_of("remove_points")
        indices = checked_indices(indices)
        gone = indices[(indices >= self.point_count) | np.isin(indices, self.removed_points)]
        if len(gone):
            raise ValueError(
                f"remove_points: there is no point {gone[0]}; there are {self.point_count}, less removed ones"
            )
        with Journal.within(journal) as journal:
            self._keep(journal)
            walker.remove(indices)

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
        count = len(checked_points(points, self.domain.dimension))
        checked_keys(point_keys, count, len(self.domain.cage.walls), lowest=0)
        return self.weights_at(points, point_keys, walks=walks)

    def weights_at(self, points: np.ndarray, point_keys: np.ndarray | None = None, *, walks: int = 1024) -> np.ndarray:
        """Weights of further points in the cage as it is, which are not kept.

        Args:
            points: Rest positions [m], shape (n, dimension).
            point_keys: Key 2 * wall + side for points on a wall, else -1, shape (n,).
            walks: Walks a point.

        Returns:
            Weights, shape (n, cage.vertex_count), float32.

        Raises:
            ValueError: A point lies outside the cage, or a key is of no wall.
        """
        options = self._walker.options
        coordinates = HarmonicCoordinates(
            self.domain,
            points,
            walks,
            options.seed,
            cuttable=False,
            epsilon=options.epsilon,
            point_keys=point_keys,
        )
        return coordinates.weights

    def _cache_of(self, wanted: str) -> Walker:
        if not self._walker.cuttable:
            raise ValueError(f"{wanted}: these coordinates were made with cuttable=False and keep no walk cache")
        return self._walker

    def _keep(self, journal: Journal) -> None:
        """Keep everything that edits overwrite."""
        walker, domain = self._walker, self.domain
        journal.keep_attributes(self, "_cage")
        journal.keep_attributes(domain, "cage", "faces", "faces_before", "_last")
        journal.keep_attributes(domain.walls, "triangle_count", "_rows", "data")
        journal.keep_attributes(domain.grid, "cells", "_nearest", "_built_size", "_farthest")
        journal.keep_attributes(walker, "point_count", "_rest", "weights", "gradients", "vertex_capacity", "landings")
        walker._rest = walker._rest.copy()
        journal.keep(*(array for array in edited_arrays(walker).values() if array.size))

    def _new_stats(self) -> UpdateStats:
        return UpdateStats(self.walks * (self.point_count - len(self.removed_points)))
