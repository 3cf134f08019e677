# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The row of error against run time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from ..bench import STAGES, Bench
from ..measurement import Measurement, Record
from ..page.markdown import Section
from .error import NAME, WALKED, measure_error, measure_reference
from .error_pages import error_sections


class ErrorRow:
    """Squared errors and times of corrections, walks and seeds. They are drawn with those of the finite elements."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        for bench in benches:
            for stage in STAGES:
                run = partial(measure_reference, bench, stage)
                yield Measurement("reference", bench.scene.name, {"stage": stage}, run)
            for chosen in self._choices(bench):
                yield Measurement(NAME, bench.scene.name, chosen, partial(measure_error, bench, **chosen))

    @staticmethod
    def _choices(bench: Bench) -> Iterator[dict]:
        """The fit with few walks or none, by one seed as it is the same for all; the others with more and more."""
        for walks in bench.effort.fitted_counts:
            yield {"correction": "fitted", "walks": walks, "seed": bench.effort.seeds[0]}
        for walks in bench.effort.walk_counts:
            for correction in WALKED:
                for seed in bench.effort.seeds_of(walks):
                    yield {"correction": correction, "walks": walks, "seed": seed}

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        yield from error_sections(records)
