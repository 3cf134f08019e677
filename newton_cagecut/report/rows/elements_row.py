# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Finite elements in place of walks: meshed and solved before a cut, and again half way through it."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Sequence
from functools import partial

from ..bench import STAGES, Bench
from ..measurement import Measurement, Record
from ..page.markdown import Section

NAME = "elements"
_NEEDED = ("skfem", "netgen")


class ElementsRow:
    """P1 and P2 elements, more and more of them. Their errors are drawn with those of the walks, by ``ErrorRow``."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``. Without scikit-fem or Netgen there is nothing to measure."""
        if any(importlib.util.find_spec(package) is None for package in _NEEDED):
            return
        for bench in benches:
            for cells in bench.effort.cell_counts:
                for order in (1, 2):
                    chosen = {"order": order, "cells": cells}
                    run = partial(measure_elements, bench, **chosen)
                    yield Measurement(NAME, bench.scene.name, chosen, run)

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        yield from ()


def measure_elements(bench: Bench, order: int, cells: int) -> dict:
    """Measure squared errors and times of elements.

    Args:
        bench: The scene.
        order: Degree of the elements, 1 or 2.
        cells: Simplices that would fill the cage if they were regular.

    Returns:
        For each stage the seconds, those without the mesher, the unknowns and the squared errors; or why it failed.
    """
    from ..peers.elements import element_weights, warm_up

    warm_up()
    found = {}
    for stage in STAGES:
        swept, front = bench.opening(stage)
        cages = (bench.scene.cage, bench.cage(stage))
        try:
            weights, gradients, values = element_weights(
                cages, swept, front, bench.points, bench.has_gradient, order=order, cells=cells
            )
        except (ValueError, RuntimeError) as error:
            found[stage] = {"failed": str(error)}
            continue
        found[stage] = {**values, "squared": bench.reference(stage).squared_errors(weights, gradients)}
    return found
