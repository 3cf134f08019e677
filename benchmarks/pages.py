# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Writes what README.md shows of measurements, and docs/report, from the committed docs/report/report.json.

What stands in a page between ``<!-- report: NAME -->`` and ``<!-- end -->`` is a part of that name, made from the
report's records alone; see ``PARTS``. ``--from DIR`` takes the report of a folder first. Tests write the pages anew and
compare them byte for byte.
"""

from __future__ import annotations

import argparse
import re
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

from newton_cagecut.report.measurement import chosen, scenes_of
from newton_cagecut.report.page.markdown import markdown_lines, seconds_text
from newton_cagecut.report.page.report_page import write_page
from newton_cagecut.report.paper.published import TABLE_1
from newton_cagecut.report.record_store import FILE, read_report, records_of
from newton_cagecut.report.rows import ROWS
from newton_cagecut.report.rows.gains import gain_of
from newton_cagecut.report.rows.recommendation import recommended

ROOT = Path(__file__).parent.parent
REPORT = ROOT / "docs" / "report"
PAGES = (ROOT / "README.md",)
_PART = re.compile(r"(<!-- report: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
_ERROR = 1e-2


def updates(report: dict) -> list[str]:
    """The update beside the full recompute, with the paper's ratio."""
    records = records_of(report)
    rows = []
    for record in chosen(records, "table1"):
        found = record.values["measured"]
        paper = TABLE_1.get(record.scene)
        rows.append(
            [
                record.scene,
                str(found["face_count"]),
                str(found["point_count"]),
                str(record.values["walks"]),
                f"{found['rewalk_percent']:.2f} %",
                seconds_text(1e-3 * found["update_ms"]),
                seconds_text(1e-3 * found["recompute_ms"]),
                f"{found['recompute_ms'] / found['update_ms']:.1f}",
                f"{paper.ratio:.1f}" if paper else "",
            ]
        )
    head = ["scene", "cage faces", "points", "walks", "walked again", "update", "recompute", "ratio", "paper"]
    return markdown_lines(head, rows)


def gains(report: dict) -> list[str]:
    """Squared errors of the paper's method over those of ours, at equal run time, before a cut and in one."""
    records, rows = records_of(report), []
    columns = [(correction, kind) for correction in ("harmonic", "fitted") for kind in ("weights", "gradients")]
    for scene in scenes_of(chosen(records, "error")):
        pairs = [
            [gain_of(records, scene, correction, stage, kind) for stage in ("before", "during")]
            for correction, kind in columns
        ]
        rows.append([scene, *(" / ".join("-" if gain is None else str(gain) for gain in pair) for pair in pairs)])
    return markdown_lines(["scene", *(f"{correction}: {kind}" for correction, kind in columns)], rows)


def choices(report: dict) -> list[str]:
    """What to choose for an error of the weights of 1 %."""
    records, rows = records_of(report), []
    for scene in scenes_of(chosen(records, "error")):
        choice = recommended(records, scene, _ERROR)
        if choice is not None:
            times = [seconds_text(choice.seconds), seconds_text(choice.step_seconds)]
            rows.append([scene, choice.correction, str(choice.walks), *times])
    return markdown_lines(["scene", "correction", "walks", "first weights", "step of a cut"], rows)


def locality(report: dict) -> list[str]:
    """Bias of replayed and of restarted walks, and how many walks bounds flag."""
    records, rows = records_of(report), []
    for record in chosen(records, "replay"):
        found = record.values
        cells = [f"{1e3 * found[how]['bias']:.1f}" for how in ("replay", "restart")]
        rows.append(
            [record.scene, f"{100.0 * found['changed']:.1f} %", *cells, f"{1e3 * found['replay']['noise']:.1f}"]
        )
    return markdown_lines(["scene", "walks met", "replayed", "restarted", "chance"], rows)


def machine(report: dict) -> list[str]:
    """What it was measured on."""
    found, effort = report["machine"], report["settings"]["name"]
    return [
        f"On {found['cores']} cores of an {found['processor']} without a GPU, shared with other work (compare times",
        f"only with each other): {len(report['records'])} measurements by",
        f"`python -m newton_cagecut report --effort {effort}`.",
        "[docs/report](docs/report/report.md) has all of the tables and plots.",
    ]


PARTS: dict[str, Callable[[dict], list[str]]] = {
    "machine": machine,
    "updates": updates,
    "gains": gains,
    "choices": choices,
    "locality": locality,
}
"""What makes each part, by its name."""


def page_with_parts(text: str, report: dict) -> str:
    """Return a page with its parts written anew.

    Args:
        text: The page.
        report: What the file of the report holds.

    Raises:
        ValueError: The page asks for a part that there is not.
    """

    def part(match: re.Match) -> str:
        if match[2] not in PARTS:
            raise ValueError(f"there is no part {match[2]!r} of the report; there are {', '.join(PARTS)}")
        return "\n".join([match[1], *PARTS[match[2]](report), "", match[3]])

    return _PART.sub(part, text)


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the pages.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--from", dest="source", metavar="DIR", type=Path, help="take the report of this folder first")
    options = parser.parse_args(arguments)
    REPORT.mkdir(parents=True, exist_ok=True)
    if options.source:
        shutil.copy(options.source / FILE, REPORT / FILE)
    report = read_report(REPORT / FILE)
    for old in (path for ending in ("png", "svg") for path in REPORT.glob(f"*.{ending}")):
        old.unlink()
    write_page(report, ROWS, REPORT)
    for page in PAGES:
        page.write_text(page_with_parts(page.read_text(encoding="utf-8"), report), encoding="utf-8")


if __name__ == "__main__":
    main()
