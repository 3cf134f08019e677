# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Marking the walks that an edit concerns, and gathering them so that only they are run."""

from functools import cache

import numpy as np
import warp as wp

from .bounds_kind import BoundsKind
from .landing import KEY_MASK

wp.set_module_options({"enable_backward": False})

KEPT = wp.constant(wp.uint8(0))
REWALK = wp.constant(wp.uint8(1))
ON_FACE = wp.constant(wp.uint8(2))


@cache
def make_mark_kernel(bounds_kind: BoundsKind) -> wp.Kernel:
    """Make the kernel that sorts walks by what an edit means for them.

    Args:
        bounds_kind: Kind of the walks' bounds.
    """

    @wp.kernel(enable_backward=False, module="unique")
    def mark_walks(
        offset: int,
        walks: int,
        bounds: wp.array[bounds_kind.Quantized],
        pieces: bounds_kind.PieceBounds,
        keys: wp.array[wp.int32],
        changed_keys: wp.array[wp.uint8],
        marks: wp.array[wp.uint8],
        touched: wp.array[wp.uint8],
    ):
        """Sort a walk into the paper's three classes (section 5.2): walk again, evaluate again on its face, reuse."""
        walk = offset + wp.tid()
        mark = KEPT
        on_changed_face = changed_keys[keys[walk] & KEY_MASK] != wp.uint8(0)
        if bounds_kind.overlaps_any(bounds[walk], pieces):
            mark = REWALK
            # Else it touches its point only if it then ends elsewhere, which the walk itself finds out.
            if on_changed_face:
                touched[walk // walks] = wp.uint8(1)
        elif on_changed_face:
            mark = ON_FACE  # touches its point if its boundary value changes, which landing finds out
        marks[walk] = mark

    return mark_walks


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
