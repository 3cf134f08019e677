# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``stability.md``, ``stability.json`` and the text that the command prints."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from ..page.markdown import markdown_lines, table_lines
from .equal_error import equal_error
from .kept import jsonable
from .outcome import Limits, Result
from .sweep import Cell, Map, cell_name, map_name
from .text import number, share, step_text

FORMAT = 1
PICTURE = "stability.png"

_HEAD = (
    "",
    "",
    "finite",
    "energy gain",
    "recovers",
    "momentum drift",
    "iterations",
    "missed",
    "limited",
    "error",
    "ms a step",
    "",
)
_EXPLANATION = """\
Energy gain: the highest total energy above that of the start, over the start's; the work of gravity is no gain.
Momentum drift: the change of a free body's linear momentum, over mass times the speed that its energy is worth.
Iterations: the most of one linear solve. Missed: steps in which one ended short of the tolerance. Limited: steps whose
solution was not taken whole, since the energy would have risen. A figure out of its limit is bold, with the limit
behind it. Newton's solvers have their default settings but for the iterations; SolverXPBD's tetrahedra fly apart.
"""


@dataclass(frozen=True, kw_only=True)
class Page:
    """What a run found.

    Args:
        settings: What was asked for.
        machine: Versions and device.
        results: The rows.
        maps: The maps.
        seconds: How long it took [s].
    """

    settings: dict
    machine: dict
    results: Sequence[Result]
    maps: Sequence[Map]
    seconds: float

    @property
    def failed(self) -> list[str]:
        """Names of the rows and maps that are out of their limits."""
        rows = [result.row.name for result in self.results if result.verdict == "FAIL"]
        return [map_name(found.model) for found in self.maps if found.failures()] + rows

    def summary(self) -> str:
        """One line: how many rows keep their limits."""
        judged = [result for result in self.results if result.verdict != "-"]
        count = len(judged) + len(self.maps)
        failed = len(self.failed)
        return f"{count - failed} of {count} rows keep their limits, {failed} do not; {self.seconds:.0f} s"

    def text(self) -> str:
        """The page for a terminal."""
        lines = []
        for group, results in _grouped(self.results):
            body = [_cells(result, bold=False) for result in results]
            lines += [group, *table_lines(_HEAD, body), ""]
        for title, head, body in equal_error(self.results):
            lines += [title, *table_lines(head, body), ""]
        for found in self.maps:
            lines += [_verdict(found), ""]
            for title, body in _map_tables(found):
                lines += [title, *table_lines(_map_head(found), body), ""]
        return "\n".join([*lines, self.summary()])

    def markdown(self) -> str:
        """The page as Markdown."""
        device = ", ".join(f"{name} {value}" for name, value in self.machine.items() if value)
        lines = ["# Stability", "", f"{self.summary()}. {device}.", "", _EXPLANATION]
        for group, results in _grouped(self.results):
            lines += [f"## {group}", "", *markdown_lines(_HEAD, [_cells(result, bold=True) for result in results]), ""]
        for title, head, body in equal_error(self.results):
            lines += [f"### {title}", "", *markdown_lines(head, body), ""]
        lines += [
            "## Map",
            "",
            "A free body that turns once a second and trembles: 200 steps, or a second if that is less.",
        ]
        lines += ["", f"![Energy gain and angular momentum over stiffness and time step]({PICTURE})", ""]
        for found in self.maps:
            lines += [f"{_verdict(found)}.", ""]
            for title, body in _map_tables(found):
                lines += [f"### {title}", "", *markdown_lines(_map_head(found), body), ""]
        return "\n".join(lines)

    def write(self, folder: Path) -> None:
        """Write the page and its figures; the picture is drawn elsewhere."""
        (folder / "stability.md").write_text(self.markdown(), encoding="utf-8")
        (folder / "stability.json").write_text(json.dumps(self.data(), indent=1) + "\n", encoding="utf-8")

    def data(self) -> dict:
        """Every figure, as JSON can hold it."""
        records = {}
        for result in self.results:
            values = {**asdict(result.outcome), "failures": list(result.failures), "seconds": result.seconds}
            limits = None if result.row.limits is None else asdict(result.row.limits)
            parameters = {"group": result.row.group, "limits": limits}
            records[result.row.name] = self._record(result.row.name, parameters, values)
        for found in self.maps:
            for cell in found.cells.values():
                parameters = {"model": found.model, "young": cell.young, "dt": cell.dt}
                name = cell_name(found.model, cell.young, cell.dt)
                records[name] = self._record(map_name(found.model), parameters, asdict(cell.outcome))
        return {"format": FORMAT, "settings": self.settings, "machine": self.machine, "records": records}

    def _record(self, row: str, parameters: dict, values: dict) -> dict:
        return {"row": row, "scene": self.settings["scene"], "parameters": parameters, "values": jsonable(values)}


def _grouped(results: Sequence[Result]) -> list[tuple[str, list[Result]]]:
    groups: dict[str, list[Result]] = {}
    for result in results:
        groups.setdefault(result.row.group, []).append(result)
    return list(groups.items())


def _cells(result: Result, *, bold: bool) -> list[str]:
    """The cells of a row; those out of their limits stand out."""
    outcome, limits = result.outcome, result.row.limits or Limits(missed_steps=None)
    texts = {
        "finite": _yes(outcome.finite),
        "energy_gain": share(outcome.energy_gain),
        "recovers": _yes(outcome.recovers),
        "momentum_drift": number(outcome.momentum_drift),
        "iterations": _count(outcome.iterations),
        "missed_steps": _count(outcome.missed_steps),
        "limited": f"{_count(outcome.limited_steps)} of {outcome.step_count}",
        "error": share(outcome.error),
        "milliseconds": number(outcome.milliseconds),
    }
    for name in set(result.failures) & set(texts):
        limit = getattr(limits, name, None)
        behind = "" if isinstance(limit, bool) or limit is None else f" > {_limit(name, limit)}"
        texts[name] = f"**{texts[name]}**{behind}" if bold else f"{texts[name]}{behind or ' !'}"
    against = f"against {outcome.against}" if outcome.against else ""
    note = "; ".join(text for text in (against, outcome.note) if text)
    verdict = f"**{result.verdict}**" if bold and result.verdict == "FAIL" else result.verdict
    return [result.row.name, verdict, *texts.values(), note]


def _limit(name: str, limit: float) -> str:
    return share(limit) if name in ("energy_gain", "error") else f"{limit:g}"


def _yes(value: bool | None) -> str:
    return "n/a" if value is None else "yes" if value else "no"


def _count(value: int | None) -> str:
    return "n/a" if value is None else str(value)


def _verdict(found: Map) -> str:
    verdict = "FAIL" if found.failures() else "ok"
    return (
        f"{map_name(found.model)}: {verdict}, {len(found.failures())} of {len(found.cells)} places out of their limits"
    )


def _map_head(found: Map) -> list[str]:
    return ["", *(f"{step_text(dt)} s" for dt in found.time_steps)]


def _map_tables(found: Map) -> list[tuple[str, list[list[str]]]]:
    """A map's tables: energy gain, angular momentum and iterations."""

    def body(text: object) -> list[list[str]]:
        return [
            [f"{young:.0e} Pa", *(text(found.cells[young, dt]) for dt in found.time_steps)] for young in found.young
        ]

    def gain(cell: Cell) -> str:
        return share(cell.outcome.energy_gain) if cell.outcome.finite else "not finite"

    name = map_name(found.model)
    return [
        (f"{name}: energy gain", body(gain)),
        (f"{name}: angular momentum kept", body(lambda cell: share(cell.kept))),
        (f"{name}: most iterations", body(lambda cell: _count(cell.outcome.iterations))),
    ]
