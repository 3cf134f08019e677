# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``report.json``: settings, machine and records, written whole after each measurement."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path

from .measurement import Record

FORMAT = 1
FILE = "report.json"


class RecordStore:
    """The records of a report, in a folder.

    Args:
        folder: The folder; it is made if it is not there.
        settings: What all measurements have in common. Records that are there already must have been made with equal
            ones.
        machine: What they are made on, and versions; likewise.
        file: The file's name.

    Raises:
        ValueError: The folder holds a report of other settings or another machine, or one that cannot be read. Nothing
            has changed then.
    """

    def __init__(self, folder: Path, settings: dict, machine: dict, *, file: str = FILE) -> None:
        self.folder, self.settings, self.machine, self._file = folder, settings, machine, file
        self._records: dict[str, Record] = {}
        folder.mkdir(parents=True, exist_ok=True)
        if self.path.exists():
            old = read_report(self.path)
            _require_equal(self.path, old["settings"], settings)
            _require_equal(self.path, old["machine"], machine)
            self._records = {record.key: record for record in records_of(old)}

    @property
    def path(self) -> Path:
        """The file."""
        return self.folder / self._file

    @property
    def records(self) -> list[Record]:
        """All records, in the order in which they were added."""
        return list(self._records.values())

    def __contains__(self, key: str) -> bool:
        """Whether there is a record of a key."""
        return key in self._records

    def __getitem__(self, key: str) -> Record:
        """The record of a key."""
        return self._records[key]

    def add(self, record: Record) -> None:
        """Keep a record; the file has it when this returns.

        Args:
            record: The record; one of the same key is replaced.
        """
        self._records[record.key] = record
        self.write()

    def write(self) -> None:
        """Write the file, whole or not at all."""
        found = {
            "format": FORMAT,
            "settings": self.settings,
            "machine": self.machine,
            "records": {
                key: {
                    "row": record.row,
                    "scene": record.scene,
                    "parameters": record.parameters,
                    "values": record.values,
                }
                for key, record in self._records.items()
            },
        }
        part = self.path.with_name(f".{self._file}.part")
        part.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        os.replace(part, self.path)


def read_report(path: Path) -> dict:
    """Read a report's file.

    Args:
        path: The file.

    Raises:
        ValueError: It is not one, or of another format.
    """
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        known = found["format"] == FORMAT and {"settings", "machine", "records"} <= set(found)
    except (ValueError, KeyError, TypeError):
        raise ValueError(f"{path} is not the file of a report; choose another folder with --out") from None
    if not known:
        raise ValueError(f"{path} has another format than {FORMAT}; choose another folder with --out")
    return found


def records_of(report: dict) -> list[Record]:
    """Return the records of a report that was read, in their order.

    Args:
        report: The report.
    """
    return [Record(**record) for record in report["records"].values()]


def _require_equal(path: Path, old: dict, new: dict) -> None:
    """Refuse to mix what was measured otherwise."""
    names: Sequence[str] = sorted(name for name in {*old, *new} if old.get(name) != new.get(name))
    if names:
        told = ", ".join(f"{name} was {old.get(name)!r} and is {new.get(name)!r}" for name in names)
        raise ValueError(f"{path} was made with other settings ({told}); choose another folder with --out")
