# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Updates: only what an edit concerns is walked, evaluated and resolved again (paper, section 5.2), or everything."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ..journal import Journal
from ..launch import launch, launch_blocks
from ..resolve.fitted_rows import FittedRows
from ..stats import UpdateStats
from ..walks.marking import (
    ON_FACE,
    RESUME,
    REWALK,
    UNCHANGED_KEY,
    gather,
    make_mark_kernel,
    meet_first_spheres,
    unmark_walks,
)
from ..walks.work import Work
from .domain_state import DomainState
from .walk_cache import WalkCache


@dataclass(frozen=True, eq=False)
class ConcernedWalks:
    """Walks that an edit concerns.

    Args:
        rewalk: Walks to walk again.
        on_face: Walks to evaluate again on their faces.
        resume: Walks that go on from their landings.
        touched: Points to resolve whatever comes of their walks, shape (point_count,).
    """

    rewalk: Work
    on_face: Work
    resume: Work
    touched: wp.array


def find_concerned(cache: WalkCache, after: DomainState, stats: UpdateStats) -> ConcernedWalks:
    """Sort walks by what an edit means for them; nothing is changed yet.

    Args:
        cache: Points, whose walks are kept.
        after: The state after the edit.
        stats: Where counts and times are added.
    """
    change, records, device = after.change, cache.records, after.device
    walks, points, point_count = cache.options.walks, cache.points, cache.point_count
    walk_count, removed = point_count * walks, cache.removed_points
    touched = wp.zeros(point_count, dtype=wp.uint8, device=device)
    if walks == 0:
        nothing = cache.work(wp.empty(0, dtype=wp.int32, device=device))
        return ConcernedWalks(nothing, nothing, nothing, touched)
    with stats.time("check", device):
        pieces = records.kind.bound_pieces(change.polygons, change.directions, device)
        marks = wp.zeros(walk_count, dtype=wp.uint8, device=device)
        changes = wp.array(change.key_changes, dtype=wp.uint8, device=device)
        met = wp.zeros(point_count, dtype=wp.uint8, device=device)
        inputs = [after.walls.data, change.first_new, points, met]
        launch(meet_first_spheres, point_count, inputs, device=device)
        inputs = [walks, records.bounds, pieces, points, records.landings.key, changes, met, marks, touched]
        launch_blocks(make_mark_kernel(records.kind), walk_count, inputs, device=device)
        if len(removed):
            work = cache.work_of(removed)
            launch(unmark_walks, work.count, [work.listed, marks], device=device)
        rewalk, on_face, resume = (cache.work(gather(marks, int(mark))) for mark in (REWALK, ON_FACE, RESUME))
    stats.checked = stats.walk_count
    stats.rewalked, stats.on_face, stats.resumed = rewalk.count, on_face.count, resume.count
    return ConcernedWalks(rewalk, on_face, resume, touched)


def run_concerned(
    cache: WalkCache, after: DomainState, concerned: ConcernedWalks, stats: UpdateStats, journal: Journal
) -> None:
    """Bring walks and weights up to date.

    Args:
        cache: Points, whose walks are kept.
        after: The state after the edit.
        concerned: The walks that the edit concerns.
        stats: Where counts and times are added.
        journal: Where all that is overwritten is kept before.
    """
    stages, touched = cache.stages(after, stats), concerned.touched
    cache.keep_points(journal)
    cache.keep_walks(concerned.rewalk, journal)
    cache.keep_walks(concerned.resume, journal)
    cache.keep_walks(concerned.on_face, journal, walked=False)
    stages.walk(concerned.rewalk, touched=touched)
    stages.land(concerned.rewalk)
    if concerned.resume.count:
        stages.walk(concerned.resume, touched=touched, resumed=True)
        stages.land(concerned.resume, part="resume")
    stages.land(concerned.on_face, part="on_face", touched=touched)
    again = touched.numpy() != 0
    if cache.options.correction == "fitted":
        again[:] = True
    elif cache.options.correction != "none":
        # An affine correction is spread over all vertices of a piece, on a wall over all corners of a face.
        keys, changes = cache.keys, after.change.key_changes
        on_changed = changes[np.maximum(keys, 0)] != np.uint8(UNCHANGED_KEY)
        again |= np.where(keys >= 0, on_changed, cache.weights.degrees.numpy()[: cache.point_count] == 0)
    again[cache.removed_points] = False
    indices = np.flatnonzero(again)
    cache.keep_weights(indices, journal)
    stages.resolve(indices)


def run_again(cache: WalkCache, state: DomainState, stats: UpdateStats, journal: Journal) -> None:
    """Walk for all points that were not removed.

    Args:
        cache: Points, whose walks may be kept.
        state: Walls and faces.
        stats: Where counts and times are added.
        journal: Where all that is overwritten is kept before.
    """
    removed, records = cache.removed_points, cache.records
    cache.keep_points(journal)
    journal.keep_attributes(cache, "records")
    journal.keep(*cache.weights.arrays.values())
    if records is not None:
        cache.records = records.copied() if len(removed) else records.fresh()
    stages = cache.stages(state, stats)
    if cache.options.correction == "fitted":
        stages.state, stages.rows = state.forgetful(), FittedRows()
    stats.rewalked = stats.walk_count
    if len(removed):
        stages.run_points(np.setdiff1d(np.arange(cache.point_count), removed))
    else:
        stages.run_all()
