# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Errors against exact weights, and the power of the number of walks with which they fall."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...harmonic import HarmonicCoordinates
from ..bench import Bench
from ..fit import power_of
from ..measurement import Measurement, Record, chosen, values_of
from ..page.markdown import Section, Table
from ..reference.exact_cases import CASES

NAME = "exact"
POINT_COUNT = 64
# Control variates of degree 3 leave no error in a box, those of degree 1 and affine ones none in a tetrahedron.
METHODS = {"tetrahedron": {"none": {}}, "box": {"none": {}, "affine": {}, "harmonic": {"degree": 1}}}


class ExactRow:
    """A tetrahedron and a box."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``. It is of no scene; effort and device are those of the first."""
        for bench in benches[:1]:
            for case, methods in METHODS.items():
                for correction in methods:
                    for walks in bench.effort.walk_counts:
                        chosen = {"case": case, "correction": correction, "walks": walks}
                        run = partial(measure_exact, bench, **chosen)
                        yield Measurement(NAME, "", chosen, run)

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows = []
        for case, methods in METHODS.items():
            for correction in methods:
                own = chosen(records, NAME, case=case, correction=correction)
                walks = values_of(own, "walks")
                errors = [np.sqrt(record.values["squared"]) for count in walks for record in own_of(own, count)]
                if len(walks) > 1:
                    ends = [f"{errors[0]:.2e}", f"{errors[-1]:.2e}"]
                    rows.append([case, correction, *map(str, (walks[0], walks[-1])), *ends])
                    rows[-1].append(f"{power_of(walks, errors):.2f}")
        if rows:
            text = (
                "A tetrahedron has barycentric coordinates and a box, where its quads are harmonic, trilinear ones. "
                "Plain errors fall as the walks to the power -0.5. The harmonic correction is of degree 1 here; that "
                "of degree 3 leaves no error in a box."
            )
            head = ["cage", "correction", "walks from", "to", "error from", "to", "power"]
            yield Section("Against exact weights", [text], [Table("", head, rows)])


def own_of(records: Sequence[Record], walks: int) -> list[Record]:
    """Return the records of a number of walks."""
    return [record for record in records if record.parameters["walks"] == walks]


def measure_exact(bench: Bench, case: str, correction: str, walks: int) -> dict:
    """Measure the squared error of the weights, mean over points and seeds.

    Args:
        bench: For effort and device.
        case: The cage.
        correction: Correction of the weights.
        walks: Walks a point.
    """
    made = CASES[case](POINT_COUNT)
    options = {**made.options, **METHODS[case][correction]}
    squared = []
    for seed in bench.effort.seeds:
        coordinates = HarmonicCoordinates(
            made.cage,
            made.points,
            walks,
            seed,
            cuttable=False,
            device=bench.device,
            correction=correction,
            **options,
        )
        squared.append(((coordinates.weights - made.weights) ** 2).sum(axis=1).mean())
    return {"squared": float(np.mean(squared))}
