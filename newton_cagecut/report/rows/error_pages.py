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
from .error import KINDS, WALKED
from .error import NAME as ERROR
from .error_curves import Curve, all_curves, element_curve, walk_curve
from .gains import TITLES, gains_chart, gains_table

_Y_LABELS = {
    "weights": "error of a point's weights",
    "gradients": "relative error of gradients",
    "surface": "error of the deformed surface / diameter",
}
_TEXT = (
    "Root mean square over the points: of the Euclidean norm of the errors of all of a point's weights; of that of its "
    "gradients, relative to the gradients; of where a smooth motion takes it, relative to the cage's diameter. Times "
    "are for all points, from the cage to the weights, kernels compiled before. The fit begins without walks. Half way "
    "through the cut, walks are updated by the last step of 3 % or all walked again, which gives the same weights bit "
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
        tables, charts = [gains_table(records, scenes)], [gains_chart(records, scenes)]
        yield Section("Error against run time", [_TEXT], tables, charts)
    for scene in scenes:
        yield Section(
            f"Error against run time: {scene}",
            _notes(records, scene),
            [_table(records, scene)],
            [_chart(records, scene)],
        )


def _notes(records: Sequence[Record], scene: str) -> list[str]:
    notes = []
    for record in chosen(records, "reference", scene):
        found = record.values
        checks = " and ".join(f"{check:.2f}" for check in found["check"])
        notes.append(
            f"{found['points']} points in a cage that has {found['faces']} faces and {found['vertices']} vertices "
            f"{TITLES[record.parameters['stage']]}. Squared difference of the reference from plain runs over what "
            f"both their errors lead to expect: {checks}, of weights and of gradients (1 but for chance)."
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


def _table(records: Sequence[Record], scene: str) -> Table:
    """The most accurate run of each method."""
    rows = []
    for stage in STAGES:
        curves = {kind: all_curves(records, scene, stage, kind) for kind in KINDS}
        for k, curve in enumerate(curves["weights"]):
            errors = [f"{curves[kind][k].errors[-1]:.2e}" for kind in KINDS]
            times = [seconds_text(curve.seconds[-1]), _whole(records, scene, curve, stage)]
            rows.append([TITLES[stage], curve.label, f"{curve.amount[-1]:.0f}", *errors, *times])
    head = ["when", "method", "walks or unknowns", *KINDS, "time", "all walked again"]
    return Table("Errors of the most accurate run of each method:", head, rows)


def _whole(records: Sequence[Record], scene: str, curve: Curve, stage: str) -> str:
    """The time of the full recompute beside that of the update, of the run with the most walks."""
    for correction in WALKED if stage == "during" else ():
        whole = walk_curve(records, scene, correction, stage, "weights", seconds="whole_seconds")
        if whole.label == curve.label:
            return seconds_text(whole.seconds[-1])
    return ""


def _chart(records: Sequence[Record], scene: str) -> Chart:
    panels = [[_panel(records, scene, stage, kind) for stage in STAGES] for kind in KINDS]
    return Chart(f"error_{scene}", f"{scene}: error against run time", panels)


def _panel(records: Sequence[Record], scene: str, stage: str, kind: str) -> Panel:
    lines = []
    for curve in all_curves(records, scene, stage, kind):
        lines.append(_line(curve, curve.label, marker="s" if curve.label.startswith("finite") else "o"))
    for correction in WALKED if stage == "during" else ():
        whole = walk_curve(records, scene, correction, stage, kind, seconds="whole_seconds")
        lines.append(_line(whole, "all walked again", like=whole.label))
    solve = element_curve(records, scene, 2, stage, kind, seconds="solve_seconds")
    lines.append(_line(solve, "elements without the time of meshing", like=solve.label, marker="s"))
    floors = [record.values["own"][kind] for record in chosen(records, "reference", scene, stage=stage)]
    floor = float(np.sqrt(floors[0])) if floors else None
    return Panel(TITLES[stage], "run time [s]", _Y_LABELS[kind], [line for line in lines if len(line.x)], floor)


def _line(curve: Curve, label: str, **options: str) -> Line:
    return Line(label, curve.seconds.tolist(), curve.errors.tolist(), **options)
