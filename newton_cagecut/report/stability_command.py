# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command ``python -m newton_cagecut stability``: extreme cases and exact answers, as a page."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from importlib.util import find_spec
from pathlib import Path

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
    from .stability.stability_run import measure_all

    return measure_all(options.scene, options.out, quick=options.quick)
