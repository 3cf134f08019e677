# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command ``python -m newton_cagecut stability``: extreme cases and exact answers, as a page."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter

DESCRIPTION = """\
Step bodies that are stiff, light, heavy, flat, inside out, spinning, cut and dropped,
compare them with exact answers, and map Young's modulus against the time step. It
writes stability.md, stability.png and stability.json, and prints the tables. It needs
the extra: pip install 'newton_cagecut[report]'
"""
EPILOG = """\
With a SCENE, the map and the impossible starts are made with its bodies instead of a
bar. The exit status is 1 if a row is out of its limits.

examples:
  python -m newton_cagecut stability --quick
  python -m newton_cagecut stability starfish --out starfish_stability
"""


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: Its parser.
    """
    parser.add_argument(
        "scene", metavar="SCENE", nargs="?", help="a script with build(builder), or an example's name in a checkout"
    )
    parser.add_argument("--quick", action="store_true", help="fewer rows and a coarser map: about a minute")
    parser.add_argument("--out", metavar="DIR", type=Path, default=Path("stability"), help="where to (stability)")


def run(options: Namespace) -> int:
    """Measure, write and print.

    Args:
        options: The parsed arguments.

    Returns:
        1 if a row is out of its limits, else 0.

    Raises:
        ImportError: The extra is not installed.
        OSError: The folder cannot be written.
        ValueError: There is no such scene.
    """
    if find_spec("matplotlib") is None:
        raise ImportError("the picture needs matplotlib: pip install 'newton_cagecut[report]'")
    options.out.mkdir(parents=True, exist_ok=True)
    import warp as wp

    wp.config.quiet = True
    from .scene_file import load_scene
    from .stability.bench import Bench
    from .stability.machine import machine
    from .stability.page import PICTURE, Page
    from .stability.picture import draw
    from .stability.progress import Progress
    from .stability.rows_starts import MODELS
    from .stability.sweep import axes, map_name, sweep
    from .stability.table import measure, rows

    start = perf_counter()
    scene = load_scene(options.scene) if options.scene else None
    bench = Bench(quick=options.quick, scene=scene)
    young, time_steps = axes(quick=options.quick)
    table = rows(quick=options.quick, scene=scene is not None)
    results, maps = [], []
    with Progress(len(table) + len(MODELS) * len(young) * len(time_steps), "stability") as progress:
        for row in table:
            results.append(measure(row, bench))
            progress.advance(row.name)
        for model in MODELS:
            maps.append(sweep(bench, model, lambda model=model: progress.advance(map_name(model))))
    settings = {"scene": options.scene, "quick": options.quick}
    page = Page(settings=settings, machine=machine(), results=results, maps=maps, seconds=perf_counter() - start)
    draw(maps, options.out / PICTURE)
    page.write(options.out)
    print(page.text())
    print(f"{options.out / 'stability.md'} has the page")
    return 1 if page.failed else 0
