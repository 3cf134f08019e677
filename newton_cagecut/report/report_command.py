# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The command ``python -m newton_cagecut report``: error against run time and more, of any scene."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from pathlib import Path

DESCRIPTION = """\
Measure scenes: error against run time of weights and gradients before and during
a cut, beside finite elements that are meshed anew; the paper's table; growth; and
what to choose for a wanted error. Writes report.md with plots and report.json
with every figure. It needs the extra: pip install 'newton_cagecut[report]'
"""
EPILOG = """\
A SCENE is a script with a function build(builder) that adds a cage body to a
newton.ModelBuilder (and, if it likes, a list of blades of the name blades), or in
a checkout the name of one of the project's own scenes.

Stopped by Ctrl-C, it keeps what it has and goes on from there when it is run
again with the same --out and settings.

examples:
  python -m newton_cagecut report starfish --quick
  python -m newton_cagecut report my_scene.py --device cuda:0 --out my_report
"""
QUICK_SCENES = ("starfish", "gingerbread")


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: Its parser.
    """
    parser.formatter_class = RawDescriptionHelpFormatter
    quick = " and ".join(QUICK_SCENES)
    parser.add_argument(
        "scenes", metavar="SCENE", nargs="*", help=f"what to measure (all of a checkout's; with --quick {quick})"
    )
    parser.add_argument("--device", help="Warp device (Warp's own choice)")
    effort = parser.add_mutually_exclusive_group()
    effort.add_argument(
        "--effort",
        choices=("quick", "short", "full"),
        default="full",
        help="how much is measured: on two cores a minute a scene, five, or fifteen (full)",
    )
    effort.add_argument(
        "--quick", action="store_const", dest="effort", const="quick", help="the same as --effort quick"
    )
    parser.add_argument("--out", metavar="DIR", type=Path, default=Path("report"), help="folder to write to (./report)")


def run(options: Namespace) -> int:
    """Measure, and write the page.

    Args:
        options: The parsed arguments.

    Returns:
        0, or 130 if it was stopped.

    Raises:
        ImportError: The extra is not installed.
        OSError: A file is missing or cannot be written.
        ValueError: There is no such scene or device, or the folder holds a report of other settings.
    """
    _require_extra()
    import warp as wp

    wp.config.quiet = True  # before what imports kernels, for which Warp starts
    from .effort import EFFORTS
    from .machine import chosen_device
    from .measuring import measure_all
    from .scenes.scene import load_scenes

    device = chosen_device(options.device)
    scenes = load_scenes(options.scenes, QUICK_SCENES if options.effort == "quick" else ())
    return measure_all(scenes, EFFORTS[options.effort], device, options.out)


def _require_extra() -> None:
    """Refuse to begin what could not be drawn at the end."""
    import importlib.util

    missing = [name for name in ("matplotlib", "tqdm") if importlib.util.find_spec(name) is None]
    if missing:
        raise ImportError(
            f"the report needs {' and '.join(missing)}, which the extra brings: pip install 'newton_cagecut[report]'"
        )
