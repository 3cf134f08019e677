# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a step costs at equal error: the cheapest body of each solver that is no farther off."""

from __future__ import annotations

from collections.abc import Sequence

from .outcome import Result
from .rows.against_time import ROWS
from .text import number, share

_LEVELS = (0.5, 0.2, 0.1, 0.05, 0.02)
_NAMES = frozenset(name for name, _, _ in ROWS)


def equal_error(results: Sequence[Result]) -> list[tuple[str, list[str], list[list[str]]]]:
    """Tables: title, head, and a row for each error with the least milliseconds a step of each solver.

    Args:
        results: Rows that were measured; those of other groups say nothing here.
    """
    cases: dict[str, dict[str, list[Result]]] = {}
    for result in results:
        if result.row.name in _NAMES and result.outcome.error is not None:
            solver, text = result.row.name.split(": ")
            cases.setdefault(text.split(", ")[1], {}).setdefault(solver, []).append(result)
    return [
        (
            f"Milliseconds a step at equal error, {case}",
            ["error at most", *solvers],
            [[share(level), *(_cheapest(found, level) for found in solvers.values())] for level in _LEVELS],
        )
        for case, solvers in cases.items()
        if len(solvers) > 1
    ]


def _cheapest(results: Sequence[Result], level: float) -> str:
    near = [result for result in results if result.outcome.error <= level]
    if not near:
        best = min(results, key=lambda result: result.outcome.error)
        return f"not reached ({share(best.outcome.error)})"
    best = min(near, key=lambda result: result.outcome.milliseconds)
    return f"{number(best.outcome.milliseconds)} ({best.row.name.split(', ', 2)[2]})"
