# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What is measured: one measurement after the other, each kept under its own key; and the rows that they make up."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from .bench import Bench
from .page.markdown import Section

Number = int | float | str


@dataclass(frozen=True)
class Record:
    """A measurement that was made, as ``report.json`` keeps it.

    Attributes:
        row: The row that it belongs to.
        scene: The scene, "" for what is of none.
        parameters: What was chosen.
        values: What was found: numbers, texts, lists and tables of them.
    """

    row: str
    scene: str
    parameters: dict[str, Number]
    values: dict

    @property
    def key(self) -> str:
        """The measurement's key."""
        return key_of(self.row, self.scene, self.parameters)


@dataclass(frozen=True)
class Measurement:
    """A measurement to be made.

    Attributes:
        row: The row that it belongs to.
        scene: The scene, "" for what is of none.
        parameters: What is chosen; with the row and the scene they make the key.
        run: Makes it; returns what was found as JSON can hold it.
    """

    row: str
    scene: str
    parameters: dict[str, Number]
    run: Callable[[], dict] = field(compare=False)

    @property
    def key(self) -> str:
        """The key under which it is kept."""
        return key_of(self.row, self.scene, self.parameters)


def key_of(row: str, scene: str, parameters: dict[str, Number]) -> str:
    """Return the key of a measurement, such as ``starfish/error/correction=affine,walks=64``.

    Args:
        row: The row.
        scene: The scene, or "".
        parameters: What is chosen.
    """
    chosen = ",".join(f"{name}={value}" for name, value in parameters.items())
    return "/".join(part for part in (scene, row, chosen) if part)


class Row(Protocol):
    """A subject of the report. A new one is a class with these and a line in ``rows/__init__.py``."""

    name: str
    """Its name in the keys."""

    def measurements(self, benches: Sequence[Bench]) -> Iterable[Measurement]:
        """Say what is to be measured; nothing is measured yet.

        Args:
            benches: The scenes, on a device.
        """

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """Write the page's sections from the records alone.

        Args:
            records: All records, those of other rows too.
        """


def chosen(records: Iterable[Record], row: str, scene: str | None = None, **parameters: Number) -> list[Record]:
    """Return the records of a row, and of a scene and with parameters where these are given.

    Args:
        records: Where to look.
        row: The row.
        scene: The scene.
        parameters: Values that parameters have.
    """
    return [
        record
        for record in records
        if record.row == row
        and scene in (None, record.scene)
        and all(record.parameters.get(name) == value for name, value in parameters.items())
    ]


def scenes_of(records: Iterable[Record]) -> list[str]:
    """Return the names of the scenes that records are of, in their order."""
    return list(dict.fromkeys(record.scene for record in records if record.scene))


def values_of(records: Iterable[Record], parameter: str) -> list[Number]:
    """Return the values that a parameter has in records, ascending."""
    return sorted({record.parameters[parameter] for record in records if parameter in record.parameters})
