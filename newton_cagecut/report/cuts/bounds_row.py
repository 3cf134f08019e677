# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How well bounding volumes tell which walks a cut meets (paper, figure 13)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ..bench import Bench, spread
from ..measurement import Measurement, Record, chosen, scenes_of
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Section, Table
from .following import follow
from .locality import POINTS, WALKS

NAME = "bounds"
KINDS = {"dop26": "26-DOP", "dop18": "18-DOP", "aabb": "box", "sphere": "sphere"}


class BoundsRow:
    """Walks flagged and walks changed, a step of 3 % of a scene's first cut, by each kind of bounds."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``. In the plane all bounds are made of the same directions."""
        for bench in benches:
            if bench.scene.cage.dimension == 3:
                yield Measurement(NAME, bench.scene.name, {}, partial(measure_bounds, bench))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows, scenes = [], scenes_of(chosen(records, NAME))
        flagged = {kind: [] for kind in KINDS}
        for scene in scenes:
            (record,) = chosen(records, NAME, scene)
            changed = record.values["changed"]
            for kind in KINDS:
                flagged[kind].append(record.values[kind] / changed if changed else np.nan)
            shares = [f"{100.0 * record.values[kind]:.2f}" for kind in ("changed", *KINDS)]
            rows.append([scene, *shares])
        if not rows:
            return
        text = (
            "Walks that bounds flag as met by a step of 3 % of a scene's first cut, over those that it changes: 1 "
            "would be perfect (figure 13 of the paper, which compares a sphere, a box and a DOP)."
        )
        lines = [Line(KINDS[kind], flagged[kind], range(len(scenes))) for kind in KINDS]
        panel = Panel("", "walks flagged for each walk changed", "", lines, rows=scenes, mark=1.0, logarithmic="")
        head = ["scene", "changed %", *(f"{name} %" for name in KINDS.values())]
        yield Section(
            "Bounding volumes", [text], [Table("", head, rows)], [Chart("bounds", "Bounding volumes", [[panel]])]
        )


def measure_bounds(bench: Bench) -> dict:
    """Measure the mean share of the walks that a step flags, by each kind of bounds, and that it changes.

    Args:
        bench: The scene.
    """
    scene, found = bench.scene, {}
    points = spread(np.asarray(scene.points), POINTS)
    for kind in KINDS:
        followed = follow(scene.cage, points, scene.blades[0], WALKS, bounds=kind, device=bench.device)
        found[kind] = float(np.mean(followed.flagged))
        found["changed"] = float(np.mean(followed.changed))  # the same for all
    return found
