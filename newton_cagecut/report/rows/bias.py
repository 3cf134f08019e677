# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The bias of control variates that are fitted to the walks that they correct: of the order of 1 / walks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...harmonic import HarmonicCoordinates
from ..bench import Bench
from ..measurement import Measurement, Record, chosen
from ..page.markdown import Section, Table
from ..reference.exact_cases import box

NAME = "bias"
METHODS = {"none": {}, "affine": {}, "harmonic": {"degree": 1}}  # degree 3 leaves no error in a box
WALKS = (8, 32, 128)
_POINTS, _RUNS = 64, 256


class BiasRow:
    """Means of many runs in a box, whose weights are known exactly."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``. It is of no scene; the device is that of the first."""
        for bench in benches[:1]:
            for correction in METHODS:
                for walks in WALKS:
                    chosen = {"correction": correction, "walks": walks}
                    yield Measurement(NAME, "", chosen, partial(measure_bias, bench, **chosen))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows = []
        for record in chosen(records, NAME):
            found = record.values
            cells = [f"{found[name]:.1e}" for name in ("error", "bias", "noise")]
            rows.append([record.parameters["correction"], str(record.parameters["walks"]), *cells])
        if rows:
            text = (
                f"Weights of {_POINTS} points in a box, {_RUNS} runs less the exact ones, root mean square over "
                "the points of the Euclidean norm; beside it what chance leads to expect of an unbiased mean, and the "
                "error of one run. Corrections that are fitted to the walks that they correct are biased by the order "
                "of 1 / walks, less than their error; plain means are not biased, and neither are fits of the boundary."
            )
            head = ["correction", "walks", "error of a run", "difference of the mean", "chance"]
            yield Section("Bias", [text], [Table("", head, rows)])


def measure_bias(bench: Bench, correction: str, walks: int) -> dict:
    """Measure the mean of many runs against exact weights.

    Args:
        bench: For the device.
        correction: Correction of the weights.
        walks: Walks a point.
    """
    case = box(_POINTS)
    options = {**case.options, **METHODS[correction], "correction": correction, "device": bench.device}
    runs = np.stack(
        [
            HarmonicCoordinates(case.cage, case.points, walks, seed, cuttable=False, **options).weights - case.weights
            for seed in range(_RUNS)
        ]
    )
    return {
        "error": float(np.sqrt((runs**2).sum(axis=2).mean())),
        "bias": float(np.sqrt((runs.mean(axis=0) ** 2).sum(axis=1).mean())),
        "noise": float(np.sqrt(runs.var(axis=0, ddof=1).sum(axis=1).mean() / _RUNS)),
    }
