# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How much smaller squared errors are than those of the paper's method, at equal run time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..bench import STAGES
from ..measurement import Record
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Table
from .error_curves import Curve, walk_curve

TITLES = {"before": "before the cut", "during": "half way through the cut"}
KINDS = ("weights", "gradients")
PAPER = "affine"
OTHERS = {"none": "plain walks", "harmonic": "harmonic controls", "fitted": "boundary fit"}
_MARKERS = {"weights": "o", "gradients": "D"}
_TITLE = (
    "Squared error of the paper's method (affine) over that of another correction, at equal run time: the least of "
    "squared error times time over the runs of each, because the one falls as the other grows. The reference's own "
    "error is taken off; where hardly more is left, the gain is a lower bound (>)."
)


@dataclass(frozen=True)
class Gain:
    """A gain over the paper's method.

    Attributes:
        value: The ratio of the squared errors at equal time.
        bound: Whether it is a lower bound.
    """

    value: float
    bound: bool

    def __str__(self) -> str:
        """The gain in two digits, or in as many as it has before the point."""
        text = f"{self.value:.2g}" if self.value < 99.5 else f"{self.value:.0f}"
        return f"{'>' if self.bound else ''}{text}"


def gain_of(records: Sequence[Record], scene: str, correction: str, stage: str, kind: str) -> Gain | None:
    """Return the gain of a correction; None where it, or the paper's method, was not measured.

    Args:
        records: All records.
        scene: The scene.
        correction: The correction.
        stage: "before" or "during".
        kind: "weights" or "gradients".
    """
    paper, other = (walk_curve(records, scene, name, stage, kind) for name in (PAPER, correction))
    if paper.empty or other.empty:
        return None
    paper_costs, costs = _costs(paper), _costs(other)
    best = costs.argmin()
    return Gain(float(paper_costs.min() / costs[best]), bool(other.bounded[best]))


def _costs(curve: Curve):
    return curve.net**2 * curve.seconds


def gains_table(records: Sequence[Record], scenes: Sequence[str]) -> Table:
    """Return the gains of all corrections as a table.

    Args:
        records: All records.
        scenes: The scenes.
    """
    rows = []
    for scene in scenes:
        for stage in STAGES:
            gains = [gain_of(records, scene, name, stage, kind) for name in OTHERS for kind in KINDS]
            rows.append([scene, TITLES[stage], *("" if gain is None else str(gain) for gain in gains)])
    head = [f"{kind}, {label}" for label in OTHERS.values() for kind in KINDS]
    return Table(_TITLE, ["scene", "when", *head], rows)


def gains_chart(records: Sequence[Record], scenes: Sequence[str]) -> Chart:
    """Return the gains as dots, a row a scene; a triangle is a lower bound.

    Args:
        records: All records.
        scenes: The scenes.
    """
    panels = [_panel(records, scenes, stage) for stage in STAGES]
    return Chart("gains", "Squared error of the paper's method over ours, at equal run time", [panels])


def _panel(records: Sequence[Record], scenes: Sequence[str], stage: str) -> Panel:
    lines = []
    for correction, label in list(OTHERS.items())[1:]:
        for kind in KINDS:
            found = [(k, gain_of(records, scene, correction, stage, kind)) for k, scene in enumerate(scenes)]
            name = f"{label}, {kind}"
            for bound in (False, True):
                some = [(k, gain.value) for k, gain in found if gain is not None and gain.bound is bound]
                if some:
                    rows, values = zip(*some)
                    looks = {"like": name, "marker": ">"} if bound else {"marker": _MARKERS[kind]}
                    lines.append(
                        Line("at least", values, rows, **looks) if bound else Line(name, values, rows, **looks)
                    )
    return Panel(TITLES[stage], "times smaller", "", lines, rows=scenes, mark=1.0)
