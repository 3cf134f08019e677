# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""All rows of the table, and their measurement."""

from __future__ import annotations

import time

from .limits import limits_of
from .outcome import Outcome, Result, Row
from .rows import against_time, cuts, loads, motion, starts, statics, tetrahedra
from .workbench import Workbench

_GROUPS = {
    "Motion": motion.ROWS,
    "Impossible starts": starts.ROWS,
    "Loads": loads.ROWS,
    "Cuts": cuts.ROWS,
    "Small deformations": statics.ROWS,
    "The same bodies as tetrahedra": tetrahedra.ROWS,
    "Error against time a step": against_time.ROWS,
}
_OF_ANY_SCENE = ("Impossible starts",)


def rows(*, quick: bool, scene: bool) -> list[Row]:
    """The rows of a run.

    Args:
        quick: Whether it is the quick run.
        scene: Whether it is on a scene's bodies rather than on bars.
    """
    return [
        Row(name=name, group=group, run=run, limits=limits_of(name), quick=is_quick)
        for group, members in _GROUPS.items()
        for name, run, is_quick in members
        if (is_quick or not quick) and (group in _OF_ANY_SCENE or not scene)
    ]


def measure(row: Row, bench: Workbench) -> tuple[Outcome, float]:
    """Measure a row; what it raises is its note, and :func:`judged` its failure.

    Args:
        row: The row.
        bench: Where the bodies come from.

    Returns:
        What came out, and the seconds that it took.
    """
    start = time.perf_counter()
    try:
        outcome = row.run(bench)
    except Exception as error:  # a row that breaks must not take the others with it
        outcome = Outcome(raised=True, note=f"{type(error).__name__}: {' '.join(str(error).split())}")
    return outcome, time.perf_counter() - start


def judged(row: Row, outcome: Outcome, seconds: float) -> Result:
    """A row's outcome, held against its limits.

    Args:
        row: The row.
        outcome: What came out.
        seconds: How long it took [s].
    """
    failures = ["raised"] if outcome.raised else row.limits.failures(outcome) if row.limits is not None else []
    return Result(row=row, outcome=outcome, failures=tuple(failures), seconds=seconds)
