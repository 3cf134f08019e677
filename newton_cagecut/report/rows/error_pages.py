# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The page's part on error against run time: a plot and a table a scene."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..bench import STAGES
from ..measurement import Record, chosen, scenes_of
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Section, Table, seconds_text
from .error import CORRECTIONS, KINDS
from .error import NAME as ERROR
from .error_curves import Curve, all_curves, walk_curve

_TITLES = {"before": "before the cut", "during": "half way through the cut"}
_Y_LABELS = {
    "weights": "error of a point's weights",
    "gradients": "relative error of gradients",
    "surface": "error of the deformed surface / diameter",
}
_DRAWN = ("weights", "gradients")
_TEXT = (
    "Root mean square over the points: of the Euclidean norm of the errors of all of a point's weights; of that of its "
    "gradients, relative to the gradients; of where a smooth motion takes it, relative to the cage's diameter. Times "
    "are for all points, from the cage to the weights, kernels compiled before. Half way through the cut, walks are "
    "updated by the last step of 3 % (filled) or all walked again (hollow, dashed), which gives the same weights bit "
    "for bit; the finite elements are meshed and solved again. Errors near the grey band cannot be told from those of "
    "the reference."
)


def error_sections(records: Sequence[Record]) -> Iterator[Section]:
    """Write a section a scene.

    Args:
        records: All records.
    """
    scenes = [scene for scene in scenes_of(records) if chosen(records, ERROR, scene)]
    if scenes:
        yield Section("Error against run time", [_TEXT])
    for scene in scenes:
        yield Section(
            f"Error against run time: {scene}",
            _notes(records, scene),
            [_table(records, scene, kind) for kind in KINDS],
            [_chart(records, scene)],
        )


def _notes(records: Sequence[Record], scene: str) -> list[str]:
    notes = []
    for record in chosen(records, "reference", scene):
        found = record.values
        checks = ", ".join(f"{check:.2f}" for stage in STAGES for check in found[stage]["check"])
        notes.append(
            f"{found['points']} points in a cage of {found['faces']} faces and {found['vertices']} vertices. Squared "
            f"difference of the reference from plain runs over what both their errors lead to expect, weights and "
            f"gradients before, then during the cut: {checks} (1 but for chance)."
        )
    failed = {
        text
        for record in chosen(records, "elements", scene)
        for stage in STAGES
        if (text := record.values[stage].get("failed"))
    }
    if not chosen(records, "elements", scene):
        notes.append("Finite elements were not measured: scikit-fem or Netgen is not installed.")
    return notes + [f"Finite elements failed: {text}." for text in sorted(failed)]


def _table(records: Sequence[Record], scene: str, kind: str) -> Table:
    """Errors and times, most accurate last."""
    rows = []
    for stage in STAGES:
        for curve in all_curves(records, scene, stage, kind):
            whole = _whole(records, scene, curve, stage, kind)
            for k in sorted({0, len(curve.errors) // 2, len(curve.errors) - 1}):
                cells = [f"{curve.amount[k]:.0f}", f"{curve.errors[k]:.2e}", seconds_text(curve.seconds[k])]
                rows.append([_TITLES[stage], curve.label, *cells, whole[k]])
    head = ["when", "method", "walks or unknowns", "error", "time", "whole again"]
    return Table(f"{_Y_LABELS[kind][0].upper()}{_Y_LABELS[kind][1:]}:", head, rows)


def _whole(records: Sequence[Record], scene: str, curve: Curve, stage: str, kind: str) -> list[str]:
    """The times of full recomputes beside those of updates."""
    for correction in CORRECTIONS if stage == "during" else ():
        whole = walk_curve(records, scene, correction, stage, kind, seconds="whole_seconds")
        if whole.label == curve.label:
            return [seconds_text(seconds) for seconds in whole.seconds]
    return [""] * len(curve.errors)


def _chart(records: Sequence[Record], scene: str) -> Chart:
    panels = [[_panel(records, scene, stage, kind) for stage in STAGES] for kind in _DRAWN]
    return Chart(f"error_{scene}", f"{scene}: error against run time", panels)


def _panel(records: Sequence[Record], scene: str, stage: str, kind: str) -> Panel:
    lines = []
    for curve in all_curves(records, scene, stage, kind):
        marker = "o" if curve.label.startswith("walks") else "s"
        lines.append(Line(curve.label, curve.seconds.tolist(), curve.errors.tolist(), marker=marker))
    for correction in CORRECTIONS if stage == "during" else ():
        whole = walk_curve(records, scene, correction, stage, kind, seconds="whole_seconds")
        if not whole.empty:
            lines.append(Line(whole.label, whole.seconds.tolist(), whole.errors.tolist(), dashed=True))
    floors = [record.values[stage]["own"][kind] for record in chosen(records, "reference", scene)]
    floor = float(np.sqrt(floors[0])) if floors else None
    return Panel(_TITLES[stage], "time [s]", _Y_LABELS[kind], lines, floor)
