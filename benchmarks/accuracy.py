# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Squared error of weights and gradients at equal walks: the corrections against plain Monte Carlo.

``python -m benchmarks.accuracy`` takes each scene of Table 1, by default as it is before its cuts, at vertices of the
embedded mesh for the weights and at quadrature points for the gradients (a vertex near a wall has a gradient that
nobody uses, and whose error would hide all others). Each correction is run with the same seeds, so on the same walks.
The error is measured against the mean of several long runs with other seeds, whose own squared error is known from how
they differ and is taken off. Points are grouped in tenths by their distance from the walls.

With ``--page FOLDER`` it measures errors for time instead, those of fits and of finite elements too, before, half way
through and after a cut; see ``error_for_time``. What is in the folder already is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tqdm import tqdm

from benchmarks.error_page import write_error_page
from benchmarks.progressive import add_scenes, parsed, parser_of, show
from benchmarks.scenes import SCENES, BenchmarkScene
from newton_cagecut import Cage, Cut, HarmonicCoordinates
from newton_cagecut.cage import boundary_distances
from newton_cagecut.elastic import sample_quadrature
from newton_cagecut.report.bench import spread
from newton_cagecut.report.page.markdown import Table

CORRECTIONS = ("none", "affine", "harmonic")
GROUP_COUNT = 10
_REFERENCE_SEED = 1000  # seeds of the long runs start here
HEAD = (
    *("scene", "what", "points", "reference %"),
    *("affine gain", "affine least", "harmonic gain", "harmonic least", "harmonic tenths"),
)


@dataclass(frozen=True)
class Errors:
    """Squared errors of one kind of values at points.

    Attributes:
        correction: Of each correction the mean squared error of each point, summed over the cage's vertices.
        reference: The part of it that is the reference's own and has been taken off, of each point.
        group: The tenth, by distance from the walls, that each point is in; 0 is nearest to them.
    """

    correction: dict[str, np.ndarray]
    reference: np.ndarray
    group: np.ndarray

    def gain(self, correction: str) -> float:
        """How many times lower the squared error is than that of plain Monte Carlo, over all points."""
        return float(self.correction["none"].sum() / self.correction[correction].sum())

    def group_gains(self, correction: str) -> np.ndarray:
        """The same of each tenth of the points, nearest to the walls first."""
        sums = [np.bincount(self.group, weights=self.correction[name]) for name in ("none", correction)]
        return sums[0] / sums[1]

    def cells(self) -> list[str]:
        """Return the cells of a row."""
        share = self.reference.sum() / self.correction["harmonic"].sum()
        tenths = {correction: self.group_gains(correction) for correction in CORRECTIONS[1:]}
        gains = [f"{gain:.2f}" for name, each in tenths.items() for gain in (self.gain(name), each.min())]
        return [
            *(str(len(self.group)), f"{100.0 * share:.1f}", *gains),
            " ".join(f"{gain:.1f}" for gain in tenths["harmonic"]),
        ]


def measure(
    cage: Cage, points: np.ndarray, walks: int, *, gradients: bool, runs: int, long_walks: int, **options
) -> Errors:
    """Measure the squared errors of the weights, or of the gradients, at points.

    Args:
        cage: The cage.
        points: Points in it [m], shape ``(n, 3)``.
        walks: Walks a point whose error is wanted.
        gradients: Whether to measure the gradients.
        runs: Runs with seeds of their own that the errors are averaged over, and as many long ones; 2 or more.
        long_walks: Walks a point of each long run.
        options: Further options of the coordinates.
    """

    def values(count: int, seed: int, correction: str) -> np.ndarray:
        coordinates = HarmonicCoordinates(
            cage, points, count, seed, gradients=gradients, cuttable=False, correction=correction, **options
        )
        return (coordinates.gradients if gradients else coordinates.weights).astype(float).reshape(len(points), -1)

    long = [values(long_walks, _REFERENCE_SEED + run, "harmonic") for run in range(runs)]
    reference = np.mean(long, axis=0)
    own = np.var(long, axis=0, ddof=1).sum(axis=1) / runs
    errors = {
        correction: np.mean([((values(walks, run, correction) - reference) ** 2).sum(axis=1) for run in range(runs)], 0)
        - own
        for correction in CORRECTIONS
    }
    rank = np.argsort(np.argsort(boundary_distances(cage, points), kind="stable"), kind="stable")
    return Errors(errors, own, rank * GROUP_COUNT // len(points))


def cut_cage(scene: BenchmarkScene, share: float) -> Cage:
    """Return the cage of a scene, cut by its first blade to a share of the cut's length."""
    cut = Cut(scene.cage, scene.blades[0])
    return cut.advance(to=share * cut.length).cage if share else scene.cage


def main(arguments: Sequence[str] | None = None) -> dict[tuple[str, str], Errors]:
    """Measure the scenes of the command line and print the table.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = parser_of(__doc__.split("\n")[0])
    add_scenes(parser)
    parser.add_argument("--points", type=int, default=300, help="points of each scene, or 0 for all (default: 300)")
    parser.add_argument("--runs", type=int, default=4, help="runs to average over, and long runs (default: 4)")
    parser.add_argument("--long", type=int, default=1 << 13, help="walks a point of each long run (default: 8192)")
    parser.add_argument("--cut", type=float, default=0.0, help="share of the first cut to make before (default: 0)")
    parser.add_argument("--page", metavar="FOLDER", type=Path, help="measure errors for time, and write a page")
    options = parsed(parser, arguments)
    if options.page:
        write_error_page(options.page, options.scene, options.device)
        return {}
    counts = {"runs": options.runs, "long_walks": options.long, "device": options.device}
    found = {}
    for scene in (SCENES[name] for name in tqdm(options.scene, unit="scene")):
        cage = cut_cage(scene, options.cut)
        places = spread(sample_quadrature(scene.cage, options.points or 600)[0], 0)
        for what, points in (("weights", spread(scene.points, options.points)), ("gradients", places)):
            found[scene.name, what] = measure(cage, points, options.walks, gradients=what == "gradients", **counts)
    means = [
        f"{what}: {np.mean([errors.gain('harmonic') for (_, kind), errors in found.items() if kind == what]):.2f}"
        for what in ("weights", "gradients")
    ]
    title = (
        f"Squared error of plain Monte Carlo over that of each correction, {options.walks} walks a point: over all "
        f'points, least of the tenths, all tenths from the walls inward. Mean of "harmonic" over the scenes: '
        f"{', '.join(means)}."
    )
    rows = [[*key, *errors.cells()] for key, errors in found.items()]
    show([Table(title, HEAD, rows)], options)
    return found


if __name__ == "__main__":
    main()
