# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The command ``python -m newton_cagecut warm-up``: compile kernels before they are needed."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

DESCRIPTION = """\
Compile every kernel that a scene can need into Warp's cache, contact and cuts
included, so that nothing is compiled when it runs. Without a SCENE: the kernels of a
body and of a plane one, with the default options.
"""
EPILOG = """\
examples:
  python -m newton_cagecut warm-up
  python -m newton_cagecut warm-up my_scene.py --device cuda:0
"""


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: Its parser.
    """
    parser.add_argument(
        "scene", metavar="SCENE", nargs="*", help="a script with build(builder), or an example's name in a checkout"
    )
    parser.add_argument("--device", help="Warp device (Warp's own choice)")


def run(options: Namespace) -> None:
    """Compile what the scenes need.

    Args:
        options: The parsed arguments.

    Raises:
        OSError: A script is not there.
        ValueError: There is no such scene or device, or the scene has no cage bodies.
    """
    from .scene_kernels import warm_up_scenes

    warm_up_scenes(options.scene, device=options.device)
