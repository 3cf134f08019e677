# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a row of the table says, and whether that is within its limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .workbench import Workbench


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What was measured; None where a column says nothing about a row.

    Args:
        finite: Whether positions and velocities stayed finite.
        energy_gain: Highest total energy above the start's, over the start's, or over the highest seen if the start
            had next to none. Work of gravity is not a gain.
        recovers: Whether the body comes back to its shape.
        momentum_drift: Change of a free body's linear momentum, beyond gravity's, over mass times the speed that its
            starting energy is worth.
        iterations: Most iterations of a linear solve.
        missed_steps: Steps in which a linear solve ended short of the tolerance, as the solver counts them.
        limited_steps: Steps whose solution was not taken whole, as the solver counts them.
        step_count: Steps that were made.
        error: Error against the answer that ``against`` names, relative.
        against: The answer that the error is against.
        milliseconds: Mean time of a step [ms].
        note: Anything to add, such as the value behind the error.
        raised: Whether the measurement itself broke; the note says how.
    """

    finite: bool | None = None
    energy_gain: float | None = None
    recovers: bool | None = None
    momentum_drift: float | None = None
    iterations: int | None = None
    missed_steps: int | None = None
    limited_steps: int | None = None
    step_count: int = 0
    error: float | None = None
    against: str = ""
    milliseconds: float | None = None
    note: str = ""
    raised: bool = False


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What an outcome must keep to; None where anything goes. Every row must stay finite.

    Args:
        energy_gain: Highest gain.
        recovers: Whether the body must come back to its shape.
        momentum_drift: Highest drift.
        missed_steps: Most steps whose solves may end short of the tolerance.
        error: Highest error.
    """

    energy_gain: float | None = None
    recovers: bool = False
    momentum_drift: float | None = None
    missed_steps: int | None = 0
    error: float | None = None

    def failures(self, outcome: Outcome) -> list[str]:
        """The columns in which an outcome is out of these limits, or in which it says nothing but should."""
        found = [] if outcome.finite is not False else ["finite"]
        if self.recovers and not outcome.recovers:
            found.append("recovers")
        for name in ("energy_gain", "momentum_drift", "error"):
            limit, value = getattr(self, name), getattr(outcome, name)
            if limit is not None and not (value is not None and math.isfinite(value) and value <= limit):
                found.append(name)
        if self.missed_steps is not None and (outcome.missed_steps or 0) > self.missed_steps:
            found.append("missed_steps")
        return found


@dataclass(frozen=True, kw_only=True)
class Row:
    """One row of the table.

    Args:
        name: Its name, unique.
        group: The part of the table that it belongs to.
        run: Makes the measurement.
        limits: What it must keep to; None for a row that is only measured.
        quick: Whether it is part of the quick run.
    """

    name: str
    group: str
    run: Callable[[Workbench], Outcome]
    limits: Limits | None
    quick: bool


@dataclass(frozen=True, kw_only=True)
class Result:
    """A row that was measured.

    Args:
        row: The row.
        outcome: What came out.
        failures: The columns in which it is out of its limits.
        seconds: How long it took [s].
    """

    row: Row
    outcome: Outcome
    failures: tuple[str, ...]
    seconds: float

    @property
    def verdict(self) -> str:
        """``"ok"``, ``"FAIL"``, or ``"-"`` for a row that is only measured."""
        if self.row.limits is None:
            return "-"
        return "FAIL" if self.failures else "ok"
