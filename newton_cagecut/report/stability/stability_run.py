# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A whole run: rows, maps, picture, page."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter

import warp as wp

from ..machine import machine_of
from ..scenes.building import build_of
from .kept import KeptOutcomes
from .picture import draw
from .progress import Progress
from .rows.starts import MODELS
from .stability_page import PICTURE, Page
from .sweep import axes, map_name, sweep
from .table import judged, measure, rows
from .workbench import WALKS, Workbench


def measure_all(scene: str | None, folder: Path, *, quick: bool) -> int:
    """Measure, write and print; what an earlier run of the same settings left unfinished is gone on with.

    Args:
        scene: The scene; None for bars.
        folder: Where to write; it is made if it is not there.
        quick: Whether it is the quick run.

    Returns:
        1 if a row is out of its limits, else 0.

    Raises:
        OSError: The folder cannot be written.
        ValueError: There is no such scene, or the folder has an unfinished run of other settings.
    """
    wp.config.log_level = wp.LOG_WARNING
    start = perf_counter()
    bench = Workbench(quick=quick, scene=None if scene is None else build_of(scene, walks=WALKS))
    settings, machine = {"scene": scene, "quick": quick}, machine_of(wp.get_device())
    kept = KeptOutcomes(folder, settings, machine)
    young, time_steps = axes(quick=quick)
    table, results, maps = rows(quick=quick, scene=scene is not None), [], []
    with Progress(len(table) + len(MODELS) * len(young) * len(time_steps), "stability") as progress:
        for row in table:
            results.append(judged(row, *kept.outcome(row.name, lambda row=row: measure(row, bench))))
            progress.advance(row.name)
        for model in MODELS:
            maps.append(sweep(bench, model, kept, lambda model=model: progress.advance(map_name(model))))
    page = Page(
        settings=settings,
        machine=machine,
        results=results,
        maps=maps,
        seconds=perf_counter() - start,
    )
    draw(maps, folder / PICTURE)
    page.write(folder)
    kept.drop()
    print(page.text())
    print(f"{folder / 'stability.md'} has the page")
    return 1 if page.failed else 0
