# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Which walks a launch runs: all of some points in a row, or those of a list."""

from __future__ import annotations

import numpy as np
import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class WorkList:
    """Walks that have places among the records; a point has ``walks`` of them.

    ``listed`` are their places; where it is empty they are the first ones. Place 0 is walk ``first_walk`` of all.
    """

    listed: wp.array[wp.int32]
    walks: wp.int32
    first_walk: wp.int32
    seed: wp.uint32


@wp.func
def place_of(work: WorkList, slot: int) -> int:
    """Place of a walk among the records."""
    if work.listed.shape[0] > 0:
        return work.listed[slot]
    return slot


@wp.func
def point_of(work: WorkList, place: int) -> int:
    """The point that a walk starts from."""
    return (work.first_walk + place) // work.walks


@wp.func
def number_of(work: WorkList, place: int) -> wp.uint32:
    """Number of a walk among those of its point."""
    return wp.uint32((work.first_walk + place) % work.walks)


class Work:
    """Walks to be run.

    Args:
        listed: Their places among the records, int32, on a device.
        walks: Walks a point.
        seed: Seed of all walks.
    """

    def __init__(self, listed: wp.array, walks: int, seed: int) -> None:
        self.list = WorkList()
        self.listed = self.list.listed = listed
        self.list.walks, self.list.seed = walks, wp.uint32(seed)
        self.count = listed.size

    @classmethod
    def of_points(cls, indices: np.ndarray, walks: int, seed: int, device: wp.context.Device) -> Work:
        """All walks of some points, which have records of all points.

        Args:
            indices: The points, shape (n,).
            walks: Walks a point.
            seed: Seed of all walks.
            device: Where they are run.
        """
        places = (indices[:, None] * walks + np.arange(walks)).reshape(-1).astype(np.int32)
        return cls(wp.array(places, dtype=wp.int32, device=device), walks, seed)

    @classmethod
    def of_range(cls, first: int, count: int, walks: int, seed: int, device: wp.context.Device) -> Work:
        """All walks of points in a row, which have records of their own.

        Args:
            first: The first point.
            count: Number of points.
            walks: Walks a point.
            seed: Seed of all walks.
            device: Where they are run.
        """
        work = cls(wp.empty(0, dtype=wp.int32, device=device), walks, seed)
        work.list.first_walk = first * walks
        work.count = count * walks
        return work
