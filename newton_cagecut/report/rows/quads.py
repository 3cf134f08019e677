# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How convex quads interpolate: mean value coordinates, as the paper has it, or harmonic ones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from time import perf_counter

import numpy as np

from ..bench import Bench
from ..measurement import Measurement, Record, chosen, scenes_of
from ..page.markdown import Section, Table, seconds_text

NAME = "quads"
RULES = ("mean_value", "harmonic")


class QuadsRow:
    """Times of both rules, and how far apart they are on the same landings."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``. A cage without quads has nothing to tell."""
        for bench in benches:
            if bench.scene.cage.dimension == 3 and any(len(face) == 4 for face in bench.scene.cage.faces):
                yield Measurement(NAME, bench.scene.name, {}, partial(measure_quads, bench))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows = []
        for scene in scenes_of(chosen(records, NAME)):
            (record,) = chosen(records, NAME, scene)
            found = record.values
            rows.append(
                [scene, *(seconds_text(found["seconds"][rule]) for rule in RULES), f"{found['difference']:.1e}"]
            )
        if rows:
            text = (
                "Root mean square difference of a point's weights by the two rules, as the mean of many walks on the "
                "same landings tells it; no number of walks takes it away."
            )
            head = ["scene", "mean value", "harmonic", "difference"]
            yield Section("Quads: mean value or harmonic", [text], [Table("", head, rows)])


def measure_quads(bench: Bench) -> dict:
    """Measure the weights before the cut by both rules.

    Args:
        bench: The scene.
    """
    walks, seed = 4 * bench.effort.row_walks, bench.effort.seeds[0]
    seconds, weights = {}, {}
    for rule in RULES:
        bench.warm_up(correction="harmonic", quads=rule)
        start = perf_counter()
        coordinates = bench.coordinates(walks, seed, quads=rule, cuttable=False)
        weights[rule] = coordinates.weights.astype(np.float64)
        seconds[rule] = perf_counter() - start
    difference = weights[RULES[0]] - weights[RULES[1]]
    return {
        "walks": walks,
        "seconds": seconds,
        "difference": float(np.sqrt((difference**2).sum(axis=1).mean())),
    }
