# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What the benchmarks share: cuts in small steps, and their command lines."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import warp as wp

from benchmarks.scenes import SCENES
from examples.table import markdown_lines, table_lines
from newton_cagecut import Blade, Cage, CageEdit, Cut, HarmonicCoordinates

STEP = 0.03  # of a cut's length, as in section 7 of the paper


def edits(cage: Cage, blades: Sequence[Blade], step: float = STEP) -> Iterator[CageEdit]:
    """Cut a cage by one blade after the other, each through the whole cage.

    Args:
        cage: The cage before the cuts.
        blades: The blades.
        step: Advance of a blade from one edit to the next, as a share of its cut's length.
    """
    for blade in blades:
        cut = Cut(cage, blade)
        for k in range(1, step_count(step) + 1):
            yield cut.advance(to=cut.length * min(k * step, 1.0))
        cage = cut.cage


def step_count(step: float = STEP) -> int:
    """Return the number of steps of one cut."""
    return math.ceil(1.0 / step - 1e-9)


def compile_kernels(cage: Cage, blades: Sequence[Blade], points: np.ndarray, **options) -> None:
    """Run all kernels of an update on a few points, so that none is compiled while the clock runs.

    Args:
        cage: The cage.
        blades: Its cuts.
        points: Points in it [m], shape ``(n, 3)``.
        options: Of the coordinates.
    """
    coordinates = HarmonicCoordinates(cage, points[:: max(1, len(points) // 16)], 8, **options)
    for edit in edits(cage, blades, 0.1):
        coordinates.update(edit)
    coordinates.recompute()


@dataclass(frozen=True)
class Table:
    """A table to print.

    Attributes:
        title: A line over it.
        head: Names of the columns.
        rows: The cells.
    """

    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


def show(tables: Sequence[Table], markdown: Path | None) -> None:
    """Print tables, and write them to a file where one is wanted.

    Args:
        tables: The tables.
        markdown: The file; it is replaced.
    """
    print("\n\n".join("\n".join([table.title, "", *table_lines(table.head, table.rows)]) for table in tables))
    if markdown:
        lines = [line for table in tables for line in (table.title, "", *markdown_lines(table.head, table.rows), "")]
        markdown.write_text("\n".join(lines))


def parser_of(description: str) -> argparse.ArgumentParser:
    """Return a parser with what every benchmark takes: walks, device and a file for the tables.

    Args:
        description: What the program measures.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--walks", type=int, help="walks a point (default: 256 on a CPU, 2048 on CUDA)")
    parser.add_argument("--device", help="Warp device (default: Warp's)")
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the tables to a file too")
    return parser


def add_scenes(parser: argparse.ArgumentParser) -> None:
    """Let the command line name scenes."""
    parser.add_argument("--scene", nargs="+", choices=SCENES, default=list(SCENES), metavar="NAME", help="which scenes")


def parsed(parser: argparse.ArgumentParser, arguments: Sequence[str] | None) -> argparse.Namespace:
    """Return the command line, with the walks that suit the device.

    Args:
        parser: The parser.
        arguments: The command line; that of the program by default.
    """
    wp.config.quiet = True
    options = parser.parse_args(arguments)
    options.device = wp.get_device(options.device)
    options.walks = options.walks or (2048 if options.device.is_cuda else 256)
    return options
