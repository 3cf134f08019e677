# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The distance at which walks land: its bias, and the time that it saves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from time import perf_counter

import numpy as np

from ..bench import Bench
from ..measurement import Measurement, Record, chosen, scenes_of, values_of
from ..page.markdown import Section, Table, seconds_text

NAME = "epsilon"
_EPSILONS = (1e-2, 1e-3, 1e-4, 1e-5)
_LEAST = 1e-6


class EpsilonRow:
    """Weights by several epsilon against those by the least one, walks of the same randomness."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        for bench in benches:
            for epsilon in _EPSILONS:
                run = partial(measure_epsilon, bench, epsilon)
                yield Measurement(NAME, bench.scene.name, {"epsilon": epsilon}, run)

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows = []
        for scene in scenes_of(chosen(records, NAME)):
            for epsilon in values_of(chosen(records, NAME, scene), "epsilon"):
                (record,) = chosen(records, NAME, scene, epsilon=epsilon)
                found = record.values
                rows.append(
                    [scene, f"{epsilon:g}", seconds_text(found["seconds"])]
                    + [f"{found[name]:.1e}" for name in ("bias", "error")]
                )
        if rows:
            text = (
                f"Walks land within epsilon, relative to half of the cage's longest side. The difference is that of "
                f"the mean weights of all points from those by epsilon = {_LEAST:g} with the same randomness; the "
                "error is that of a point's weights against the reference, at as many walks."
            )
            head = ["scene", "epsilon", "time", "difference of the means", "error"]
            yield Section("Epsilon", [text], [Table("", head, rows)])


def measure_epsilon(bench: Bench, epsilon: float) -> dict:
    """Measure the weights before the cut by an epsilon.

    Args:
        bench: The scene.
        epsilon: Distance at which walks land, relative to half of the cage's longest side.
    """
    bench.warm_up(correction="harmonic")
    walks, seed = bench.effort.row_walks, bench.effort.seeds[0]
    start = perf_counter()
    coordinates = bench.coordinates(walks, seed, epsilon=epsilon, cuttable=False)
    weights, gradients = coordinates.weights, coordinates.gradients
    seconds = perf_counter() - start
    finest = bench.coordinates(walks, seed, epsilon=_LEAST, cuttable=False).weights
    difference = np.linalg.norm((weights.astype(np.float64) - finest).mean(axis=0))
    squared = bench.reference("before").squared_errors(weights, gradients)
    return {
        "walks": walks,
        "seconds": seconds,
        "bias": float(difference),
        "error": float(np.sqrt(squared["weights"])),
    }
