# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""When a scene cuts what: cuts one after the other, each a little deeper every frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import newton
import numpy as np

from newton_cagecut import Blade, Cage, Cut, CutReport, SolverCageCut


@dataclass(frozen=True, kw_only=True)
class PlannedCut:
    """A cut that a scene will make.

    Attributes:
        name: What is cut.
        blade: The blade, in the rest frame of the body's cage.
        wait: Frames after the cut before it, or after the start.
        until: How far the blade goes, as a fraction of the cut's length.
        pieces: Pieces of all bodies together after the cut.
        body: The body's index.
        stop: Depth at which it ends, if not complete before [m].
        turns: Depths at which the blade turns [m], and the directions in which it goes on; see :func:`along`.
    """

    name: str
    blade: Blade
    wait: int = 0
    until: float = 1.0
    pieces: int = 1
    body: int = 0
    turns: tuple[tuple[float, np.ndarray], ...] = ()
    stop: float = math.inf

    def next_turn(self, depth: float) -> float:
        """Depth of the first turn beyond a depth, infinite without one [m]."""
        return min((turn for turn, _ in self.turns if turn > depth), default=math.inf)


def along(
    cage: Cage, path: np.ndarray, *, edge: Sequence[float] | None = None, to_end: bool = False, **options: object
) -> PlannedCut:
    """Return the cut of a cage along a line of straight parts.

    Args:
        cage: The cage.
        path: The line's corners, from the first, outside of the cage, to the last, shape (n, dimension) [m].
        edge: In space, the direction of the blade's edge.
        to_end: Whether the cut ends where the line does, and not where it is complete.
        options: What else the cut has.
    """
    parts = np.diff(path, axis=0)
    blade = Blade(path[0], parts[0], start=0.0) if edge is None else Blade(path[0], edge, parts[0])
    depths = np.cumsum(np.linalg.norm(parts, axis=1)) - Cut(cage, blade).front
    stop = float(depths[-1]) if to_end else math.inf
    return PlannedCut(blade=blade, turns=tuple(zip(depths[:-1].tolist(), parts[1:])), stop=stop, **options)


class CutSchedule:
    """Makes the cuts of a scene, one after the other.

    Args:
        solver: The solver.
        plan: The cuts.
        step: What the blade advances a frame, as a fraction of the cut's length.
        pace: How many times shorter the waits are.
    """

    def __init__(self, solver: SolverCageCut, plan: Sequence[PlannedCut], *, step: float = 0.03, pace: float = 1.0):
        self._solver, self._plan, self._step, self._pace = solver, tuple(plan), step * pace, pace
        self._active = None
        self._number = 0
        self._waited = 0

    @property
    def current(self) -> int:
        """Number of the cut that is being made or waited for."""
        return self._number

    @property
    def active(self) -> bool:
        """Whether a blade is in a body now."""
        return self._active is not None

    def advance(self, states: Sequence[newton.State]) -> CutReport | None:
        """Advance the blade by a frame, if there is something to cut in this one.

        Args:
            states: All states in use.
        """
        if self._number == len(self._plan):
            return None
        planned = self._plan[self._number]
        if self._active is None:
            self._waited += 1
            if self._waited <= planned.wait / self._pace:
                return None
            self._active = self._solver.begin_cut(planned.body, planned.blade)
        cut, turn = self._active, planned.next_turn(self._active.depth)
        end = min(planned.until * cut.length, planned.stop) if math.isinf(turn) else turn
        report = self._solver.advance_cut(cut, to=min(cut.depth + self._step * cut.length, end), states=states)
        if cut.complete or (cut.depth >= end and end < turn):
            self._active, self._waited, self._number = None, 0, self._number + 1
        elif cut.depth >= turn:
            cut.turn(dict(planned.turns)[turn])
        return report


def frames_of(plan: Sequence[PlannedCut], *, step: float = 0.03) -> int:
    """Return the frames that the cuts of a plan take at most, waits included.

    Args:
        plan: The cuts.
        step: What the blade advances a frame, as a fraction of the cut's length.
    """
    return sum(cut.wait + math.ceil(cut.until / step) + len(cut.turns) for cut in plan)
