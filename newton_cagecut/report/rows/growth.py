# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Time and memory against the cage's faces, the points and the walks, with the powers of their growth."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from time import perf_counter

from ...cage import Cut
from ...harmonic import HarmonicCoordinates
from ...section import Blade
from ..bench import Bench
from ..fit import power_of
from ..measurement import Measurement, Record, chosen, values_of
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Section, Table, seconds_text
from ..paper.cutting import STEP
from ..scenes.armed_ball import armed_ball, inner_points

NAME = "growth"
_FACES, _POINTS, _WALKS = 200, 200, 64  # where they are not what grows
_BLADE = ([0.1, 0.2, 1.0], [1.0, 0.3, 0.1])  # edge and direction
_TIMES = {"first": "first weights", "update": "update by a step", "whole": "full recompute", "topology": "topology"}


class GrowthRow:
    """A ball with eight arms, larger and larger."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``. It is of no scene; effort and device are those of the first."""
        for bench in benches[:1]:
            effort = bench.effort
            counts = {"faces": effort.face_counts, "points": effort.point_counts, "walks": effort.walk_counts}
            for what, amounts in counts.items():
                for amount in amounts:
                    chosen = {"what": what, "amount": amount}
                    run = partial(measure_growth, bench, **chosen)
                    yield Measurement(NAME, "", chosen, run)

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows, panels = [], []
        for what in ("faces", "points", "walks"):
            own = chosen(records, NAME, what=what)
            amounts = values_of(own, "amount")
            if len(amounts) < 2:
                continue
            found = [record.values for amount in amounts for record in chosen(own, NAME, amount=amount)]
            lines = [Line(label, amounts, [each[name] for each in found]) for name, label in _TIMES.items()]
            panels.append(Panel(f"against {what}", what, "time [s]", lines))
            for name, label in (*_TIMES.items(), ("bytes", "memory")):
                ends = [found[0][name], found[-1][name]]
                texts = [f"{end / 1e6:.3g} MB" if name == "bytes" else seconds_text(end) for end in ends]
                power = f"{power_of(amounts, [each[name] for each in found]):.2f}"
                rows.append([label, what, str(amounts[0]), str(amounts[-1]), *texts, power])
        if rows:
            text = (
                f"A ball with eight arms; {_FACES} faces, {_POINTS} points and {_WALKS} walks a point where they are "
                "not what grows. A power below 1 at the small end is the time of the launches."
            )
            head = ["what", "against", "from", "to", "from", "to", "power"]
            chart = Chart("growth", "Time against faces, points and walks", [panels])
            yield Section("Growth", [text], [Table("", head, rows)], [chart])


def measure_growth(bench: Bench, what: str, amount: int) -> dict:
    """Measure the time of the first weights, of a step half way through a cut and of a recompute; and the bytes.

    Args:
        bench: For the device.
        what: What is grown: "faces", "points" or "walks".
        amount: How many.
    """
    sizes = {"faces": _FACES, "points": _POINTS, "walks": _WALKS, what: amount}
    cage = armed_ball(sizes["faces"])
    points = inner_points(cage, sizes["points"])
    _run(bench, cage, points[:8], 4)  # compiles
    return _run(bench, cage, points, sizes["walks"])


def _run(bench: Bench, cage: object, points: object, walks: int) -> dict:
    start = perf_counter()
    coordinates = HarmonicCoordinates(cage, points, walks, device=bench.device)
    _ = coordinates.weights
    first = perf_counter() - start
    cut = Cut(cage, Blade(cage.vertices.mean(axis=0), *_BLADE))
    coordinates.update(cut.advance(to=0.5 * cut.length))
    start = perf_counter()
    edit = cut.advance(to=(0.5 + STEP) * cut.length)
    _ = edit.changed_keys
    topology = perf_counter() - start
    update = coordinates.update(edit).total_seconds
    whole = coordinates.recompute().total_seconds
    size = sum(coordinates.memory().values())
    return {"first": first, "update": update, "whole": whole, "topology": topology, "bytes": size}
