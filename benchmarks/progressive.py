# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What the benchmarks share: their command lines, and tables that are printed, kept and compared."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import warp as wp

from benchmarks.comparison import compared, tables_of
from benchmarks.scenes import SCENES
from newton_cagecut.report.page.markdown import Table, markdown_lines, table_lines


def show(tables: Sequence[Table], options: argparse.Namespace) -> None:
    """Print tables; write them as Markdown and as JSON, and compare them with earlier ones, where that is wanted.

    Args:
        tables: The tables.
        options: The parsed command line.
    """
    print("\n\n".join("\n".join([table.title, "", *table_lines(table.head, table.rows)]) for table in tables))
    if options.markdown:
        lines = [line for table in tables for line in (table.title, "", *markdown_lines(table.head, table.rows), "")]
        options.markdown.write_text("\n".join(lines))
    earlier = json.loads(options.compare.read_text()) if options.compare else None
    if options.json:
        options.json.write_text(json.dumps(tables_of(tables), indent=1) + "\n")
    if earlier is not None:
        print("\n".join(["", f"compared with {options.compare}", *compared(earlier, tables_of(tables))]))


def parser_of(description: str) -> argparse.ArgumentParser:
    """Return a parser with what every benchmark takes: walks, device and a file for the tables.

    Args:
        description: What the program measures.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--walks", type=int, help="walks a point (default: 256 on a CPU, 2048 on CUDA)")
    parser.add_argument("--device", help="Warp device (default: Warp's)")
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the tables to a file too")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the figures to a file, for --compare")
    parser.add_argument("--compare", metavar="FILE", type=Path, help="print what differs from such a file")
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
