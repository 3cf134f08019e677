# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Table 1 of the paper, its row under each of ours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from functools import partial

from ..bench import Bench
from ..measurement import Measurement, Record, chosen
from ..page.markdown import Section, Table
from ..paper.published import TABLE_1
from ..paper.table1 import HEAD, Measured, measure_table, paper_cells

NAME = "table1"
_PAPER_WALKS = 2048
_LEAST_WALKS = 1 << 17  # of all points together, up to the paper's for each: fewer measure the launches


class PaperTableRow:
    """The update against the full recompute, for all vertices of the mesh."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        for bench in benches:
            yield Measurement(NAME, bench.scene.name, {}, partial(measure_paper_table, bench))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows, walks = [], {}
        for record in chosen(records, NAME):
            rows.append(Measured(**record.values["measured"]).cells())
            walks.setdefault(record.values["walks"], []).append(record.scene)
            if record.scene in TABLE_1:
                rows.append(paper_cells(TABLE_1[record.scene]))
        if rows:
            told = "; ".join(f"{count} for {', '.join(scenes)}" for count, scenes in sorted(walks.items()))
            text = (
                f"Means over the steps of 3 % of a scene's cuts, for all vertices of its mesh. Walks a point: {told}; "
                "in the paper's rows 2048, on an NVIDIA RTX 5090. The weights of the full recompute were those of the "
                "updates, bit for bit."
            )
            yield Section("Table 1 of the paper: update against recompute", [text], [Table("", HEAD, rows)])


def measure_paper_table(bench: Bench) -> dict:
    """Measure a scene's row.

    Args:
        bench: The scene.
    """
    walks = max(bench.effort.table_walks, min(_PAPER_WALKS, _LEAST_WALKS // len(bench.scene.points)))
    return {"walks": walks, "measured": asdict(measure_table(bench.scene, walks, device=bench.device))}
