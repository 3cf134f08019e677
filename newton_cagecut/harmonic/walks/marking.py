# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Marking the walks that an edit concerns, and gathering them so that only they are run."""

from functools import cache

import numpy as np
import warp as wp

from ..walls.wall_triangles import WallTriangles, closest_point_on_triangle
from .bounds.kind import ROUNDING, BoundsKind
from .landing import CAPPED, KEY_MASK, PASSED
from .query_points import QueryPoints
from .walk import ON_WALL

wp.set_module_options({"enable_backward": False})

KEPT = wp.constant(wp.uint8(0))
REWALK = wp.constant(wp.uint8(1))
ON_FACE = wp.constant(wp.uint8(2))
RESUME = wp.constant(wp.uint8(3))

UNCHANGED_KEY = wp.constant(wp.uint8(0))
CHANGED_KEY = wp.constant(wp.uint8(1))
"""A wall's side of which faces changed."""
RETIRED_KEY = wp.constant(wp.uint8(2))
"""A wall's side that bounds the cage no longer."""


@wp.kernel(enable_backward=False)
def meet_first_spheres(
    offset: int, triangles: WallTriangles, first_new: int, points: QueryPoints, met: wp.array[wp.uint8]
):
    """Mark the points whose first sphere, which is that of all their walks, new walls enter."""
    point = offset + wp.tid()
    x = points.position[point]
    reach = points.first_radius[point] * (1.0 + ROUNDING) + ROUNDING
    result = wp.uint8(0)
    for t in range(first_new, triangles.count):
        if wp.length_sq(x - closest_point_on_triangle(triangles, t, x)) <= reach * reach:
            result = wp.uint8(1)
    met[point] = result


@cache
def make_mark_kernel(bounds_kind: BoundsKind) -> wp.Kernel:
    """Make the kernel that sorts walks by what an edit means for them.

    Args:
        bounds_kind: Kind of the walks' bounds.
    """

    @wp.kernel(enable_backward=False, module="unique")
    def mark_walks(
        offset: int,
        block: int,
        walk_count: int,
        walks: int,
        bounds: wp.array2d[bounds_kind.level_type],
        pieces: bounds_kind.PieceBounds,
        points: QueryPoints,
        keys: wp.array[wp.int32],
        key_changes: wp.array[wp.uint8],
        met: wp.array[wp.uint8],
        marks: wp.array[wp.uint8],
        touched: wp.array[wp.uint8],
    ):
        """Sort walks into the paper's three classes (section 5.2): walk again, evaluate again on its face, reuse.

        A fourth one are walks that go on from their landings, since the wall there has retired (section 8). That needs
        a walk that has come through no gate before, and that no cap has stopped on its way to the wall.
        """
        first = (offset + wp.tid()) * block
        for walk in range(first, wp.min(first + block, walk_count)):
            mark = KEPT
            point = walk // walks
            key = keys[walk]
            change = key_changes[key & KEY_MASK]
            # An evaluated landing touches its point if its boundary value changes, which landing finds out; a walk that
            # is walked again, if it ends elsewhere, or on a changed face.
            if change == CHANGED_KEY:
                mark = ON_FACE
            elif change == RETIRED_KEY:
                mark = REWALK
                if (key & (PASSED | CAPPED)) == 0 and points.first_radius[point] >= ON_WALL:
                    mark = RESUME
            again = met[point] != wp.uint8(0)
            if not again and int(bounds[pieces.first_component, walk]) <= pieces.first_limit:
                again = bounds_kind.overlaps_any(bounds, walk, pieces)
            if again:
                mark = REWALK
                if change == CHANGED_KEY:
                    touched[point] = wp.uint8(1)
            marks[walk] = mark

    return mark_walks


@wp.kernel(enable_backward=False)
def unmark_walks(offset: int, work: wp.array[wp.int32], marks: wp.array[wp.uint8]):
    """Keep the walks listed in ``work``, those of removed points, as they are."""
    marks[work[offset + wp.tid()]] = KEPT


@wp.kernel(enable_backward=False)
def _flag(marks: wp.array[wp.uint8], mark: wp.uint8, flags: wp.array[wp.int32]):
    i = wp.tid()
    flags[i] = wp.where(marks[i] == mark, 1, 0)


@wp.kernel(enable_backward=False)
def _gather(marks: wp.array[wp.uint8], mark: wp.uint8, sums: wp.array[wp.int32], result: wp.array[wp.int32]):
    i = wp.tid()
    if marks[i] == mark:
        result[sums[i] - 1] = i


def gather(marks: wp.array, mark: int) -> wp.array:
    """Indices at which ``marks`` equals ``mark``, ascending, as a Warp array."""
    device = marks.device
    if not device.is_cuda:
        return wp.array(np.flatnonzero(marks.numpy() == mark).astype(np.int32), dtype=wp.int32, device=device)
    flags = wp.empty(marks.size, dtype=wp.int32, device=device)
    wp.launch(_flag, dim=marks.size, inputs=[marks, mark, flags], device=device)
    wp.utils.array_scan(flags, flags, inclusive=True)
    result = wp.empty(int(flags[-1:].numpy()[0]), dtype=wp.int32, device=device)
    wp.launch(_gather, dim=marks.size, inputs=[marks, mark, flags, result], device=device)
    return result


@wp.kernel(enable_backward=False)
def _count_capped(capped: wp.int32, keys: wp.array[wp.int32], flags: wp.array[wp.int32]):
    i = wp.tid()
    flags[i] = wp.where((keys[i] & capped) != 0, 1, 0)


def count_capped(keys: wp.array, capped: int) -> int:
    """How many of the landings' keys have the bit ``capped``."""
    if not keys.device.is_cuda:
        return int(np.count_nonzero(keys.numpy() & capped))
    flags = wp.empty(keys.size, dtype=wp.int32, device=keys.device)
    wp.launch(_count_capped, dim=keys.size, inputs=[capped, keys, flags], device=keys.device)
    return int(wp.utils.array_sum(flags))
