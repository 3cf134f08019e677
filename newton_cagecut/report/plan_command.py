# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The command ``python -m newton_cagecut plan``: what a scene needs, and what it leaves out."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

DESCRIPTION = """\
Build a scene, make one step, and list what it needs, what was left out and why: the
bytes of each on the device, all arrays counted, and the kernels that were loaded.
"""
EPILOG = """\
examples:
  python -m newton_cagecut plan my_scene.py
  python -m newton_cagecut plan starfish
"""


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: Its parser.
    """
    parser.add_argument(
        "scene", metavar="SCENE", help="a script with build(builder), or an example's name in a checkout"
    )
    parser.add_argument("--walks", metavar="N", type=int, help="walks a point of an example (its own)")
    parser.add_argument("--device", help="Warp device (Warp's own choice)")


def run(options: Namespace) -> None:
    """Build the scene and print its plan.

    Args:
        options: The parsed arguments.

    Raises:
        OSError: The script is not there.
        ValueError: There is no such scene or device, or the scene has no cage bodies.
    """
    from .scene_plan import plan_text

    print(plan_text(options.scene, device=options.device, walks=options.walks))
