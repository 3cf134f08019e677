# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walks replayed up to a cut, as updates do, or restarted (paper, figures 5, 9 and 10).

Where a walk lands has its start as its mean, whatever the cage: coordinates are harmonic. Walks that a cut has met and
that go on from there keep that mean. Those that are thrown away for new ones from their start do not, as the ones that
were kept are those that avoided the cut. How far the mean landing is from the start tells the bias without any
reference.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...harmonic import HarmonicCoordinates
from ..bench import Bench, spread
from ..measurement import Measurement, Record, chosen, scenes_of
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Section, Table
from .following import landings_of

NAME = "replay"
_POINTS, _WALKS, _RUNS = 256, 64, 24
_OTHER_SEED = 5000  # of the walks that are restarted


class ReplayRow:
    """Distance of the mean landing from where walks start, half way through the first cut."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        for bench in benches:
            yield Measurement(NAME, bench.scene.name, {}, partial(measure_replay, bench))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        rows, scenes = [], scenes_of(chosen(records, NAME))
        found = [record.values for scene in scenes for record in chosen(records, NAME, scene)]
        for scene, each in zip(scenes, found):
            cells = [f"{1e3 * each[how][what]:.2f}" for how in ("replay", "restart") for what in ("bias", "noise")]
            rows.append([scene, f"{100.0 * each['changed']:.1f}", *cells])
        if not rows:
            return
        text = (
            f"Mean landing of {_RUNS} runs of {_WALKS} walks a point, less the point itself, in thousandths of the "
            "cage's diameter, root mean square over the points of whose walks the cut has met some: of walks that are "
            "replayed up to the cut and go on from there, as updates do, and of walks that are restarted from the "
            "point instead. Beside each the part that is chance. Replay has no bias beyond chance; restarting has "
            "(figure 9 of the paper). As updates equal recomputes bit for bit, they converge as these do (figure 10)."
        )
        lines = [
            Line(label, [1e3 * each[how]["bias"] for each in found], range(len(scenes)))
            for how, label in (("replay", "replayed"), ("restart", "restarted"))
        ]
        lines.append(
            Line("chance alone", [1e3 * each["replay"]["noise"] for each in found], range(len(scenes)), marker="|")
        )
        panel = Panel("", "distance of the mean landing [diameter / 1000]", "", lines, rows=scenes)
        head = ["scene", "walks met [%]", "replayed", "of it chance", "restarted", "of it chance"]
        chart = Chart("replay", "Replayed or restarted", [[panel]])
        yield Section("Replay of walks", [text], [Table("", head, rows)], [chart])


def measure_replay(bench: Bench) -> dict:
    """Measure how far mean landings are from the points, by replaying and by restarting.

    Args:
        bench: The scene.
    """
    cage, edit = bench.scene.cage, bench.half_cut.step
    points = spread(np.asarray(bench.scene.points, dtype=np.float64), _POINTS)
    chosen = {"correction": "none", "device": bench.device}
    means = {"replay": [], "restart": []}
    met = np.zeros(len(points))
    for run in range(_RUNS):
        coordinates = HarmonicCoordinates(cage, points, _WALKS, run, **chosen)
        before = landings_of(coordinates)
        coordinates.update(bench.half_cut.most)
        coordinates.update(edit)
        changed = (landings_of(coordinates) != before).any(axis=1)
        met += changed.reshape(len(points), -1).mean(axis=1) / _RUNS
        replayed = _places(coordinates, cage)
        anew = _places(HarmonicCoordinates(edit.cage, points, _WALKS, _OTHER_SEED + run, **chosen), cage)
        restarted = np.where(changed[:, None], anew, replayed)
        for how, places in (("replay", replayed), ("restart", restarted)):
            means[how].append(places.reshape(len(points), _WALKS, -1).mean(axis=1) - points)
    some = met > 0.0
    found = {how: _bias(np.array(each)[:, some] / cage.diameter) for how, each in means.items()}
    return {"changed": float(met.mean()), **found}


def _places(coordinates: HarmonicCoordinates, cage: object) -> np.ndarray:
    """Where the walks landed [m], shape (walk_count, dimension)."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    unit = coordinates.landings["point"].astype(np.float64)[:, : cage.dimension]
    return 0.5 * (low + high) + 0.5 * (high - low).max() * unit


def _bias(offsets: np.ndarray) -> dict[str, float]:
    """Root mean square over the points of the mean over the runs, and what of it chance leads to expect."""
    bias = np.sqrt((offsets.mean(axis=0) ** 2).sum(axis=1).mean())
    noise = np.sqrt(offsets.var(axis=0, ddof=1).sum(axis=1).mean() / len(offsets))
    return {"bias": float(bias), "noise": float(noise)}
