# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tables of two runs side by side: of two commits on one machine, say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from newton_cagecut.report.page.markdown import Table, table_lines


def tables_of(tables: Sequence[Table]) -> list[dict]:
    """Return tables as JSON can hold them."""
    return [
        {"title": table.title, "head": list(table.head), "rows": [list(row) for row in table.rows]} for table in tables
    ]


def compared(earlier: Sequence[dict], now: Sequence[dict]) -> list[str]:
    """Return lines that say what has changed: each number that differs, what it was, and the ratio.

    Args:
        earlier: Tables of an earlier run.
        now: Tables of this one.
    """
    rows = [row for pair in zip(earlier, now) for row in _changes(*pair)]
    unknown = [table["title"] for table in now[len(earlier) :]]
    lines = table_lines(["row", "column", "was", "is", "ratio"], rows) if rows else ["nothing differs"]
    return lines + [f"new: {title}" for title in unknown]


def _changes(earlier: dict, now: dict) -> Iterator[list[str]]:
    """The cells that differ, in rows that both tables have; rows are known by their texts and their number."""
    known = {_name(earlier["rows"], k): row for k, row in enumerate(earlier["rows"])}
    for k, row in enumerate(now["rows"]):
        name = _name(now["rows"], k)
        old = dict(zip(earlier["head"], known.get(name, ())))
        for column, cell in zip(now["head"], row):
            if column in old and old[column] != cell:
                yield [name, column, old[column], cell, _ratio(old[column], cell)]
        if name not in known:
            yield [name, "", "none", "new", ""]


def _name(rows: Sequence[Sequence[str]], number: int) -> str:
    """What stands in a row's leading cells that are no numbers, or its first cell; numbered where others have it."""
    names = []
    for row in rows[: number + 1]:
        texts = []
        for cell in row:
            if _number(cell) is not None:
                break
            texts.append(cell.strip())
        names.append(" ".join(texts) or row[0])
    before = names[:-1].count(names[-1])
    return f"{names[-1]} ({before + 1})" if before else names[-1]


def _ratio(old: str, new: str) -> str:
    a, b = _number(old), _number(new)
    return f"{b / a:.2f}" if a and b is not None else ""


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None
