# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What the steps of a body were like, kept on the device: nothing is read back in a step."""

from __future__ import annotations

import numpy as np
import warp as wp

from ..solve.stiffness_matrix import DenseMatrix

BAD_FORCE, BAD_START, BAD_RESULT = wp.constant(1), wp.constant(2), wp.constant(3)
REASONS = (
    "",
    "gravity or forces are not finite",
    "positions or velocities of the state are not finite",
    "the result is not finite",
)
"""Why a step was refused, by number."""

STEPS, REFUSED, LIMITED, STALLED, MISSED, ITERATIONS, MOST_ITERATIONS, LAST_REASON = range(8)
COUNT_NAMES = ("steps", "refused", "limited", "stalled", "missed", "iterations", "most_iterations", "reason")
"""What is counted, by column."""


@wp.struct
class StepRecord:
    """The record of one body."""

    counts: wp.array[int]
    """See ``COUNT_NAMES``."""
    residuals: wp.array[wp.float64]
    """Factor by which the last solve shrank the residual, and the worst of all, shape (2,)."""
    reason: wp.array[int]
    """Why the present step cannot be made, 0 if it can, shape (1,)."""
    limited: wp.array[int]
    """Whether the solution of the present step was not taken whole, 2 if not at all, shape (1,)."""
    worst: wp.array[wp.float64]
    """Largest factor of the residual in the present step, shape (1,)."""


def make_step_record(device: wp.context.Device, counts: wp.array | None, residuals: wp.array | None) -> StepRecord:
    """A record; rows of greater arrays are used in place."""
    record = StepRecord()
    with wp.ScopedDevice(device):
        record.counts = counts if counts is not None else wp.zeros(len(COUNT_NAMES), dtype=int)
        record.residuals = residuals if residuals is not None else wp.zeros(2, dtype=wp.float64)
        record.reason, record.limited = (wp.zeros(1, dtype=int) for _ in range(2))
        record.worst = wp.zeros(1, dtype=wp.float64)
    return record


@wp.kernel(enable_backward=False)
def note_solve(
    iterations: wp.array[int],
    energy: wp.array[wp.float64],
    record: StepRecord,
):
    """Add a linear solve to the present step."""
    record.counts[wp.static(ITERATIONS)] = record.counts[wp.static(ITERATIONS)] + iterations[0]
    if energy[1] > wp.float64(0.0):
        left = wp.sqrt(wp.max(energy[0], wp.float64(0.0)) / energy[1])
        record.worst[0] = wp.max(record.worst[0], left)


@wp.kernel(enable_backward=False)
def begin_record(record: StepRecord, matrix: DenseMatrix):
    """Begin a step, with a factor of its own."""
    matrix.stale[0] = 1
    record.counts[wp.static(ITERATIONS)] = 0
    record.reason[0] = 0
    record.limited[0] = 0
    record.worst[0] = wp.float64(0.0)


@wp.kernel(enable_backward=False)
def end_record(tolerance: wp.float64, record: StepRecord):
    """Add a step to the record."""
    counts = record.counts
    counts[wp.static(STEPS)] = counts[wp.static(STEPS)] + 1
    if record.reason[0] != 0:
        counts[wp.static(REFUSED)] = counts[wp.static(REFUSED)] + 1
        counts[wp.static(LAST_REASON)] = record.reason[0]
        return
    if record.limited[0] > 0:
        counts[wp.static(LIMITED)] = counts[wp.static(LIMITED)] + 1
    if record.limited[0] > 1:
        counts[wp.static(STALLED)] = counts[wp.static(STALLED)] + 1
    iterations = counts[wp.static(ITERATIONS)]
    counts[wp.static(MOST_ITERATIONS)] = wp.max(counts[wp.static(MOST_ITERATIONS)], iterations)
    worst = record.worst[0]
    record.residuals[0] = worst
    record.residuals[1] = wp.max(record.residuals[1], worst)
    if worst > tolerance:
        counts[wp.static(MISSED)] = counts[wp.static(MISSED)] + 1


def clear(record: StepRecord) -> None:
    """Start counting anew."""
    record.counts.zero_()
    record.residuals.zero_()


def read_counts(counts: np.ndarray, residuals: np.ndarray) -> dict[str, object]:
    """A record as a dictionary, with the reason in words."""
    found: dict[str, object] = dict(zip(COUNT_NAMES, map(int, counts), strict=True))
    found["reason"] = REASONS[int(counts[LAST_REASON])]
    return {**found, "residual": float(residuals[0]), "worst_residual": float(residuals[1])}
