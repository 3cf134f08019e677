# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Pages and tables of text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from .chart import Chart


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes:
        title: A line over it.
        head: Names of the columns.
        rows: The cells.
    """

    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Section:
    """A part of a page.

    Attributes:
        title: Its heading.
        lines: Paragraphs, in Markdown.
        tables: Tables after them and the plots.
        charts: Plots.
    """

    title: str
    lines: Sequence[str] = ()
    tables: Sequence[Table] = field(default=())
    charts: Sequence[Chart] = field(default=())


def table_lines(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return a table as lines, the first column to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(head, *rows)]
    return [
        "  ".join(
            cell.ljust(width) if k == 0 else cell.rjust(width) for k, (cell, width) in enumerate(zip(row, widths))
        )
        for row in (head, *rows)
    ]


def markdown_lines(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return a table as lines of Markdown, the first column to the left, the others to the right."""
    rule = ["---", *["---:"] * (len(head) - 1)]
    return ["| " + " | ".join(row) + " |" for row in (head, rule, *rows)]


def section_lines(section: Section) -> list[str]:
    """Return a section as lines of Markdown; its plots are images ``NAME.png`` beside the page."""
    lines = [f"## {section.title}", ""]
    for paragraph in section.lines:
        lines += [paragraph, ""]
    for chart in section.charts:
        lines += [f"![{chart.title}]({chart.name}.png)", ""]
    for table in section.tables:
        lines += [*([table.title, ""] if table.title else []), *markdown_lines(table.head, table.rows), ""]
    return lines


def seconds_text(seconds: float) -> str:
    """Return a time in three digits with its unit."""
    for unit, scale in (("s", 1.0), ("ms", 1e3)):
        if seconds * scale >= 1.0:
            return f"{seconds * scale:.3g} {unit}"
    return f"{seconds * 1e6:.3g} us"
