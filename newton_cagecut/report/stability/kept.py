# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a run has measured so far, in a file of its own: one that was stopped goes on from there."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from ..measurement import Record, key_of
from ..record_store import RecordStore
from .outcome import Outcome

FILE = "stability.part.json"


class KeptOutcomes:
    """Outcomes by name.

    Args:
        folder: Where the file is; it is made if it is not there.
        settings: What the run was asked for; that of a file that is there must be equal.
        machine: Versions and device, likewise.

    Raises:
        ValueError: The file is of a run with other settings, or on another machine.
    """

    def __init__(self, folder: Path, settings: dict, machine: dict) -> None:
        self._store = RecordStore(folder, settings, machine, file=FILE)

    def outcome(self, name: str, measure: Callable[[], tuple[Outcome, float]]) -> tuple[Outcome, float]:
        """The outcome of a name, and the seconds that it took: the kept one, or a new one that is kept.

        Args:
            name: The name.
            measure: Makes the outcome; returns it with its seconds.
        """
        key = key_of(name, "", {})
        if key in self._store:
            values = dict(self._store[key].values)
            seconds = values.pop("seconds")
            return Outcome(**{name: _number(value) for name, value in values.items()}), seconds
        outcome, seconds = measure()
        values = {**jsonable(asdict(outcome)), "seconds": seconds}
        self._store.add(Record(row=name, scene="", parameters={}, values=values))
        return outcome, seconds

    def drop(self) -> None:
        """Remove the file: the run is at its end."""
        self._store.path.unlink(missing_ok=True)


def jsonable(values: dict) -> dict:
    """The same values, what is not finite as text, which JSON can hold.

    Args:
        values: The values.
    """
    return {key: str(v) if isinstance(v, float) and not math.isfinite(v) else v for key, v in values.items()}


def _number(value: object) -> object:
    return float(value) if value in ("inf", "-inf", "nan") else value
