# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The incremental update: only what an edit concerns is walked, evaluated and resolved again (paper, section 5.2)."""

from __future__ import annotations

import numpy as np
import warp as wp

from ..launch import launch, launch_blocks
from ..stats import UpdateStats
from ..walks.marking import ON_FACE, RESUME, REWALK, gather, make_mark_kernel, meet_first_spheres, unmark_walks
from .domain import DomainChange
from .walk_cache import Walker


def run_concerned(walker: Walker, change: DomainChange, stats: UpdateStats) -> None:
    """Bring walks and weights up to date with an edit that the domain has taken over.

    Args:
        walker: Points, whose walks are kept.
        change: What the edit means for walks.
        stats: Where counts and times are added.
    """
    touched = wp.zeros(walker.point_count, dtype=wp.uint8, device=walker.domain.device)
    removed = walker.removed_points
    rewalk, on_face, resume = _sorted_walks(walker, change, removed, touched, stats)
    walker.walk(rewalk, stats, touched=touched)
    walker.land(rewalk, stats, part="rewalk")
    if resume.size:
        walker.walk(resume, stats, touched=touched, resumed=True)
        walker.land(resume, stats, part="resume")
    walker.land(on_face, stats, part="on_face", touched=touched)
    concerned = touched.numpy() != 0
    if walker.options.correction != "none":
        # An affine correction is spread over all vertices of a piece.
        concerned |= walker.degrees.numpy()[: walker.point_count] == 0
    concerned[removed] = False
    walker.resolve(np.flatnonzero(concerned), stats)


def _sorted_walks(
    walker: Walker, change: DomainChange, removed: np.ndarray, touched: wp.array, stats: UpdateStats
) -> tuple[wp.array, wp.array, wp.array]:
    """Walks to walk again, to evaluate again on their faces, and to resume."""
    device, kind, walks = walker.domain.device, walker.bounds_kind, walker.options.walks
    walk_count = walker.point_count * walks
    with stats.time("check", device):
        pieces = kind.bound_pieces(change.polygons, change.directions, device)
        marks = wp.zeros(walk_count, dtype=wp.uint8, device=device)
        changes = wp.array(change.key_changes, dtype=wp.uint8, device=device)
        met = wp.zeros(walker.point_count, dtype=wp.uint8, device=device)
        inputs = [walker.domain.walls.data, change.first_new, walker.points, met]
        launch(meet_first_spheres, walker.point_count, inputs, device=device)
        inputs = [walks, walker.bounds, pieces, walker.points, walker.landings.key, changes, met, marks, touched]
        launch_blocks(make_mark_kernel(kind), walk_count, inputs, device=device)
        if len(removed):
            work = walker.walks_of(removed)
            launch(unmark_walks, work.size, [work, marks], device=device)
        rewalk, on_face, resume = (gather(marks, int(mark)) for mark in (REWALK, ON_FACE, RESUME))
    stats.checked = stats.walk_count
    stats.rewalked, stats.on_face, stats.resumed = rewalk.size, on_face.size, resume.size
    return rewalk, on_face, resume
