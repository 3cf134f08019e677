# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Updates over the course of a cut, and for larger and smaller steps (paper, figures 14 and 15)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...harmonic import HarmonicCoordinates, warm_up_coordinates
from ..bench import Bench, spread
from ..measurement import Measurement, Record, chosen, scenes_of, values_of
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Section, Table
from ..paper.cutting import STEP, edits

NAME = "course"
STEPS = (0.01, STEP, 0.1, 0.2)
"""Advances of the blade, as shares of the cut's length."""
_POINTS, _WALKS, _COLUMNS = 512, 128, 4
_LINES = {"time": "time of the update", "rewalked": "walked again", "on_face": "evaluated again on faces"}


class CourseRow:
    """A scene's first cut, in steps of several sizes."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        for bench in benches:
            for step in STEPS:
                yield Measurement(NAME, bench.scene.name, {"step": step}, partial(measure_course, bench, step))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        scenes = scenes_of(chosen(records, NAME))
        panels = [_panel(record, scene) for scene in scenes for record in chosen(records, NAME, scene, step=STEP)]
        if not panels:
            return
        grid = [panels[k : k + _COLUMNS] for k in range(0, len(panels), _COLUMNS)]
        text = (
            f"Each step of 3 % of a scene's first cut, {_WALKS} walks a point: walks walked again and those whose "
            "landing on a changed face was evaluated again, in percent of all walks; and the time of the update, in "
            "percent of that of a full recompute at the end. What is checked, resolved and launched takes time too, so "
            "few walks take more than their share (figure 14 of the paper)."
        )
        chart = Chart("course", "Updates over the course of a cut", grid, shared=False)
        yield Section("Over the course of a cut", [text], (), [chart])
        yield _sizes_section(records, scenes)


def measure_course(bench: Bench, step: float) -> dict:
    """Cut a scene by its first blade; measure the shares and the time of each update, and a recompute.

    Args:
        bench: The scene.
        step: Advance of the blade, as a share of the cut's length.
    """
    scene = bench.scene
    points = spread(np.asarray(scene.points), _POINTS)
    warm_up_coordinates(scene.cage, points, gradients=False, device=bench.device)
    coordinates = HarmonicCoordinates(scene.cage, points, _WALKS, device=bench.device)
    found = {"rewalked": [], "on_face": [], "seconds": []}
    for edit in edits(scene.cage, scene.blades[:1], step):
        stats = coordinates.update(edit)
        found["rewalked"].append(stats.rewalked / stats.walk_count)
        found["on_face"].append(stats.on_face / stats.walk_count)
        found["seconds"].append(stats.total_seconds)
    whole = [coordinates.recompute().total_seconds for _ in range(2)]
    return {**found, "whole_seconds": min(whole)}


def _panel(record: Record, scene: str) -> Panel:
    found = record.values
    shares = {**found, "time": np.array(found["seconds"]) / found["whole_seconds"]}
    count = len(found["seconds"])
    depth = (100.0 * np.minimum(record.parameters["step"] * np.arange(1, count + 1), 1.0)).tolist()
    lines = [
        Line(label, depth, (100.0 * np.asarray(shares[name])).tolist(), marker="") for name, label in _LINES.items()
    ]
    return Panel(scene, "depth of the cut [%]", "percent of all", lines, logarithmic="")


def _sizes_section(records: Sequence[Record], scenes: Sequence[str]) -> Section:
    """Figure 15: the mean over the steps, against their size."""
    lines, rows = [], []
    for scene in scenes:
        own = chosen(records, NAME, scene)
        steps = values_of(own, "step")
        found = [record.values for step in steps for record in chosen(own, NAME, step=step)]
        times = [100.0 * float(np.mean(each["seconds"])) / each["whole_seconds"] for each in found]
        shares = [100.0 * float(np.mean(each["rewalked"])) for each in found]
        lines.append(Line(scene, [100.0 * step for step in steps], times))
        rows.append([scene, *(f"{time:.0f} ({share:.1f})" for time, share in zip(times, shares))])
    text = (
        "Mean time of an update in percent of that of a full recompute, against the step in percent of the cut's "
        "length; in the table with the walks walked again [%] (figure 15 of the paper). Where hardly more walks are "
        "walked again for a longer step, it costs hardly more."
    )
    panel = Panel("", "step [% of the cut]", "time of an update [% of a recompute]", lines)
    head = ["scene", *(f"steps of {100.0 * step:g} %" for step in STEPS)]
    chart = Chart("steps", "Updates by steps of several sizes", [[panel]])
    return Section("Size of the steps", [text], [Table("", head, rows)], [chart])
