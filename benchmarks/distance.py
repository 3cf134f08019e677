# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The candidate grid against a search of all walls: ``python -m benchmarks.distance [--walks N] [--markdown FILE]``.

The same walks in a ball with eight arms, of more and more triangles, by either query (section 6.2 of the paper). Their
landings and weights are the same bit for bit, and the time of the walks is what differs. Each counts with the least of
three runs, in turn. The grid's memory and the time to build it stand beside.
"""

from __future__ import annotations

import time

import numpy as np

from benchmarks.progressive import parsed, parser_of, show
from newton_cagecut import HarmonicCoordinates
from newton_cagecut.report.page.markdown import Table
from newton_cagecut.report.scenes.armed_ball import armed_ball, inner_points

FACE_COUNTS = (100, 200, 400, 800, 1600)
POINT_COUNT = 200
RUNS = 3


def compare(face_count: int, walks: int) -> list[str]:
    """Return a row of the table.

    Args:
        face_count: Faces of the cage.
        walks: Walks a point.
    """
    cage = armed_ball(face_count)
    points = inner_points(cage, POINT_COUNT)
    start = time.perf_counter()
    by_grid = HarmonicCoordinates(cage, points[:1], 1, distance="grid")
    built = time.perf_counter() - start
    by_grid, by_all = (HarmonicCoordinates(cage, points, walks, distance=query) for query in ("grid", "all"))
    times = {by_grid: [], by_all: []}
    for _ in range(RUNS):
        for coordinates, seconds in times.items():
            seconds.append(coordinates.recompute().seconds["rewalk"])
    same = np.array_equal(by_grid.weights, by_all.weights)
    same &= all(np.array_equal(values, by_all.landings[name]) for name, values in by_grid.landings.items())
    if not same:
        raise AssertionError(f"the queries differ in a cage of {cage.face_count} faces")
    grid, every = (1e6 * min(seconds) / (len(points) * walks) for seconds in times.values())
    memory = by_grid.memory()["grid"] / 1e6
    numbers = (f"{grid:.2f}", f"{every:.2f}", f"{every / grid:.1f}", f"{1e3 * built:.0f}", f"{memory:.1f}")
    return [str(cage.face_count), *numbers]


def main(arguments: list[str] | None = None) -> None:
    """Compare and print.

    Args:
        arguments: Of the command line.
    """
    parser = parser_of(__doc__)
    options = parsed(parser, arguments)
    head = ("triangles", "grid us/walk", "all us/walk", "ratio", "first bake ms", "grid MB")
    compare(FACE_COUNTS[0], 4)  # compiles
    rows = [compare(face_count, options.walks) for face_count in FACE_COUNTS]
    show([Table("Walks by grid and by all walls, the same bit for bit.", head, rows)], options)


if __name__ == "__main__":
    main()
