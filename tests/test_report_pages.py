# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The committed report, and what README.md shows of it, are what the committed figures say."""

from __future__ import annotations

import re
from importlib.metadata import version

import pytest

from benchmarks.pages import PAGES, PARTS, REPORT, page_with_parts
from newton_cagecut.report.page.drawing import draw
from newton_cagecut.report.page.report_page import page_of
from newton_cagecut.report.record_store import FILE, read_report, records_of
from newton_cagecut.report.rows import ROWS

SCENES = {"dude", "starfish", "key", "octopus", "jelly", "sphere", "bunny", "gingerbread"}
MOST_BYTES = 10_000_000


@pytest.fixture(scope="module")
def report() -> dict:
    """The committed report."""
    return read_report(REPORT / FILE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_pages_show_what_was_measured(page, report):
    """Written anew, a page is the same byte for byte; it has parts."""
    text = page.read_text(encoding="utf-8")
    assert len(re.findall("<!-- report: ", text)) >= 3
    assert page_with_parts(text, report) == text


def test_report_is_what_its_figures_say(report):
    """The committed page is what its own file makes, byte for byte, and its plots are there."""
    text, charts = page_of(report, ROWS)
    assert (REPORT / "report.md").read_text(encoding="utf-8") == text
    names = {f"{chart.name}.{ending}" for chart in charts for ending in ("png", "svg")}
    assert names == {path.name for path in REPORT.iterdir()} - {FILE, "report.md"}


@pytest.mark.parametrize("most", [2, pytest.param(None, marks=pytest.mark.slow)])
def test_plots_are_drawn_from_the_figures(most, report, tmp_path):
    """Drawn anew by the Matplotlib that drew them, plots are the same byte for byte: the first two, and all."""
    drawn_by = re.search(r"Matplotlib ([\d.]+)", (REPORT / "gains.svg").read_text(encoding="utf-8"))[1]
    for chart in page_of(report, ROWS)[1][:most]:
        draw(chart, tmp_path)
    for path in tmp_path.iterdir():
        kept = REPORT / path.name
        if drawn_by == version("matplotlib"):
            assert path.read_bytes() == kept.read_bytes(), path.name
        else:  # another version places letters elsewhere
            assert abs(path.stat().st_size - kept.stat().st_size) < 0.2 * kept.stat().st_size, path.name


def test_report_is_of_all_scenes(report):
    """The six scenes, the bunny and the gingerbread man have errors, references and updates; it is not large."""
    records = records_of(report)
    for row in ("reference", "error", "elements", "epsilon", "table1", "replay", "locality", "course"):
        assert {record.scene for record in records if record.row == row} >= SCENES, row
    assert sum(path.stat().st_size for path in REPORT.iterdir()) < MOST_BYTES


def test_unknown_part_is_refused(report):
    """A page that asks for a part that there is not is told of those that there are."""
    with pytest.raises(ValueError, match=f"no part 'gain' of the report.*{next(iter(PARTS))}"):
        page_with_parts("<!-- report: gain -->\n<!-- end -->", report)
