# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``report.md`` and its plots, from ``report.json`` alone."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..measurement import Row
from ..record_store import records_of
from .chart import Chart
from .drawing import draw
from .markdown import markdown_lines, section_lines

FILE = "report.md"


def write_page(report: dict, rows: Sequence[Row], folder: Path) -> None:
    """Write the page and its plots; the same report gives the same bytes.

    Args:
        report: What the file of the report holds.
        rows: What writes its sections.
        folder: Where to.
    """
    text, charts = page_of(report, rows)
    (folder / FILE).write_text(text, encoding="utf-8")
    for chart in charts:
        draw(chart, folder)


def page_of(report: dict, rows: Sequence[Row]) -> tuple[str, list[Chart]]:
    """Return the page and what is drawn for it.

    Args:
        report: What the file of the report holds.
        rows: What writes its sections.
    """
    records = records_of(report)
    sections = [section for row in rows for section in row.sections(records)]
    lines = ["# Error against run time", "", _heading(report, len(records)), ""]
    for section in sections:
        lines += section_lines(section)
    lines += _made_on(report)
    return "\n".join(lines).rstrip() + "\n", [chart for section in sections for chart in section.charts]


def _heading(report: dict, count: int) -> str:
    settings, machine = report["settings"], report["machine"]
    return (
        f"Made by `python -m newton_cagecut report --effort {settings['name']}` on "
        f"{machine['device']} ({machine['processor']}, {machine['cores']} cores), from {count} measurements. Seeds "
        f"{', '.join(map(str, settings['seeds']))}; those of the references from 1000 and 2000 on. All figures are in "
        "`report.json`. On a machine that has other work too, times compare with their neighbours only."
    )


def _made_on(report: dict) -> list[str]:
    rows = [[name, str(value)] for part in ("settings", "machine") for name, value in report[part].items()]
    return ["## Settings and versions", "", *markdown_lines(["what", "value"], rows), ""]
