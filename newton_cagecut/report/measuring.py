# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Makes the measurements that are not there yet, one after the other, and writes the page."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import warp as wp

from .bench import benches_of
from .effort import Effort
from .machine import machine_of
from .measurement import Measurement, Record
from .page.report_page import write_page
from .record_store import RecordStore, read_report
from .rows import ROWS
from .scenes.scene import Scene

STOPPED = 130
"""Exit status of a program that was stopped."""


def measure_all(scenes: Sequence[Scene], effort: Effort, device: wp.context.Device, folder: Path) -> int:
    """Measure scenes and write the page, also if it is stopped.

    Args:
        scenes: The scenes.
        effort: How much is measured.
        device: The device.
        folder: Where to; what is there of the same settings is kept.

    Returns:
        0, or 130 if it was stopped.

    Raises:
        ValueError: The folder holds a report of other settings.
    """
    store = RecordStore(folder, effort.settings(), machine_of(device))
    benches = benches_of(scenes, effort, device, folder / "references")
    measurements = [each for row in ROWS for each in row.measurements(benches)]
    status = 0
    try:
        add_missing(store, measurements)
    except KeyboardInterrupt:
        done = sum(each.key in store for each in measurements)
        print(f"stopped: {done} of {len(measurements)} measurements are there; run it again to go on", file=sys.stderr)
        status = STOPPED
    if store.path.exists():
        write_page(read_report(store.path), ROWS, folder)
        print(folder / "report.md")
    return status


def add_missing(store: RecordStore, measurements: Iterable[Measurement], *, progress: bool = True) -> None:
    """Make the measurements that a store lacks, and keep each at once.

    Args:
        store: The store.
        measurements: All of them.
        progress: Whether to show a bar on standard error.
    """
    from tqdm import tqdm

    with tqdm(list(measurements), unit="measurement", disable=not progress) as bar:
        for each in bar:
            bar.set_description(each.key, refresh=True)
            if each.key not in store:
                store.add(Record(each.row, each.scene, each.parameters, each.run()))
