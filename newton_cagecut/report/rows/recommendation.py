# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walks and correction for a wanted error, from the fitted errors and times, as a line of Python to paste."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...harmonic import MOST_WALKS, walks_for_error
from ..bench import Bench
from ..fit import linear_of
from ..measurement import Measurement, Record, chosen, scenes_of
from ..page.markdown import Section, Table, seconds_text
from .error import CORRECTIONS
from .error import NAME as ERROR
from .error_curves import Curve, element_curve, walk_curve

NAME = "recommendation"
ERRORS = (3e-2, 1e-2, 3e-3, 1e-3)


@dataclass(frozen=True)
class Choice:
    """What reaches an error in the least time.

    Attributes:
        correction: The correction.
        walks: Walks a point.
        seconds: Expected time of the first weights of the points that were measured [s].
        step_seconds: Expected time of a step of a cut [s].
    """

    correction: str
    walks: int
    seconds: float
    step_seconds: float

    @property
    def line(self) -> str:
        """A line of Python that makes the coordinates."""
        return f"coords = cagecut.HarmonicCoordinates(cage, points, walks={self.walks}, correction={self.correction!r})"


class RecommendationRow:
    """It measures nothing of its own."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        yield from ()

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows = []
        for scene in scenes_of(chosen(records, ERROR)):
            for error in ERRORS:
                choice = recommended(records, scene, error)
                if choice:
                    peers = [element_curve(records, scene, order, "during", "weights") for order in (1, 2)]
                    peer = min(curve.seconds_at(error) for curve in peers)
                    times = [seconds_text(each) for each in (choice.seconds, choice.step_seconds)]
                    peer_text = seconds_text(peer) if np.isfinite(peer) else ""
                    rows.append([scene, f"{error:g}", *times, peer_text, f"`{choice.line}`"])
        if rows:
            text = (
                "For a wanted root mean square error of a point's weights: the correction that reaches it soonest, "
                "from errors fitted as the walks to the power -1/2 and times fitted as linear in them; times are for "
                "the points that were measured here. Beside them the time of finite elements for a step, where their "
                "errors measured reach so far; between sizes it is interpolated."
            )
            head = ["scene", "error", "first weights", "step of a cut", "elements, a step", "line to paste"]
            yield Section("Recommendation", [text], [Table("", head, rows)])


def recommended(records: Sequence[Record], scene: str, error: float) -> Choice | None:
    """Return the fastest choice that reaches an error before and during a cut; None if nothing was measured.

    Args:
        records: All records.
        scene: The scene.
        error: Wanted root mean square error of a point's weights.
    """
    choices = []
    for correction in CORRECTIONS:
        before, during = (walk_curve(records, scene, correction, stage, "weights") for stage in ("before", "during"))
        if before.empty:
            continue
        both = (before, during)
        if not before.amount[0] and max(curve.net[0] for curve in both) <= error:
            choices.append(Choice(correction, 0, *(curve.seconds[0] for curve in both)))
        walks = max(_walks_for(error, curve) for curve in both)
        if walks <= MOST_WALKS:
            fits = [linear_of(curve.amount, curve.seconds) for curve in both]
            choices.append(Choice(correction, walks, *(start + slope * walks for start, slope in fits)))
    return min(choices, key=lambda choice: choice.seconds, default=None)


def _walks_for(error: float, curve: Curve) -> int:
    """Walks for an error, by the later half of the curve: control variates of few walks are still of low degree."""
    later = slice(len(curve.amount) // 2, None)
    return walks_for_error(float(np.mean((curve.net**2 * curve.amount)[later])), error)
