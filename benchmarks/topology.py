# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Time of the topology step of a cut, and its growth with the number of the cage's faces.

``python -m benchmarks.topology`` prints a table; ``--plot growth.png`` plots it, with Matplotlib. A cage is a ball with
eight arms (the shape for which section 7 of the paper times its cuts), cut through in 40 steps. Each step counts with
the least time of five runs, which other work on the machine disturbs least.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from benchmarks.progressive import parser_of, show
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.report.page.markdown import Table
from newton_cagecut.report.scenes.armed_ball import armed_ball
from newton_cagecut.section import Blade

FACE_COUNTS = (100, 200, 407, 800, 1600, 3200)
STEPS = 40
RUNS = 5
LIMIT = 5.0  # of the step of a cage of about 400 faces [ms]
BLADE = ([0.1, 0.2, 1.0], [1.0, 0.3, 0.1])  # edge and direction


def step_times(cage: Cage, steps: int = STEPS) -> tuple[np.ndarray, float]:
    """Seconds of each step of a cut through a cage, shape (steps,), and of its beginning.

    Args:
        cage: The cage.
        steps: Steps of equal length.
    """
    start = time.perf_counter()
    cut = Cut(cage, Blade(cage.vertices.mean(axis=0), *BLADE))
    begun = time.perf_counter() - start
    seconds = []
    for step in range(1, steps + 1):
        start = time.perf_counter()
        edit = cut.advance(to=cut.length * step / steps)
        _ = edit.changed_keys
        seconds.append(time.perf_counter() - start)
    return np.array(seconds), begun


def main(arguments: Sequence[str] | None = None) -> None:
    """Print, and plot if asked to.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = parser_of(__doc__.split("\n")[0])
    parser.add_argument("--plot", metavar="FILE", help="write a plot of the growth")
    options = parser.parse_args(arguments)
    rows = []
    for face_count in FACE_COUNTS:
        cage = armed_ball(face_count)
        step_times(cage, 4)
        times = [step_times(cage) for _ in range(RUNS)]
        milliseconds = 1e3 * np.min([seconds for seconds, _ in times], axis=0)
        begun = 1e3 * min(seconds for _, seconds in times)
        crossed = Cut(cage, Blade(cage.vertices.mean(axis=0), *BLADE)).section.chord_count
        rows.append((cage.face_count, crossed, np.median(milliseconds), milliseconds.max(), begun))
    cells = [[str(faces), str(crossed), *(f"{each:.2f}" for each in times)] for faces, crossed, *times in rows]
    show(
        [Table("Topology of a step of a cut.", ("faces", "crossed", "median ms", "worst ms", "begin ms"), cells)],
        options,
    )
    if options.plot:
        _plot(np.array(rows)[:, :4], options.plot)


def _plot(rows: np.ndarray, path: str) -> None:
    import matplotlib.pyplot as plt

    faces, crossed, median, worst = rows.T
    figure, axes = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
    axes.loglog(faces, worst, "^--", color="tab:orange", label="worst step")
    axes.loglog(faces, median, "o-", color="tab:blue", label="median step")
    axes.axhline(LIMIT, linestyle=":", color="gray", label=f"{LIMIT:g} ms")
    axes.set_xticks(faces, [f"{face:.0f}\n({count:.0f})" for face, count in zip(faces, crossed, strict=True)])
    milliseconds = [0.5, 1, 2, 5, 10, 20, 50]
    axes.set_yticks(milliseconds, [f"{tick:g}" for tick in milliseconds])
    axes.minorticks_off()
    axes.set_ylim(0.5 * median.min(), 2.0 * max(worst.max(), LIMIT))
    axes.grid(alpha=0.3)
    axes.set_xlabel("faces of the cage (of them crossed by the blade's plane)")
    axes.set_ylabel("time of the topology step [ms]")
    axes.legend()
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
