# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The options that the scenes have beyond those of Newton's examples."""

from __future__ import annotations

from argparse import Action, ArgumentParser, ArgumentTypeError, Namespace

CPU_WALKS = 256


class DemoAction(Action):
    """``--demo``: no window, all files, and the timings."""

    def __call__(self, parser: ArgumentParser, namespace: Namespace, *_unused) -> None:
        for name, value in self.const.items():
            setattr(namespace, name, value)


def positive(text: str) -> float:
    """Return a positive number, or refuse it."""
    number = float(text)
    if not 0.0 < number < float("inf"):
        raise ArgumentTypeError(f"must be a positive number, not {text}")
    return number


def add_options(parser: ArgumentParser, name: str) -> None:
    """Add the options.

    Args:
        parser: The parser.
        name: The scene's name.
    """
    group = parser.add_argument_group("cutting")
    group.add_argument(
        "--walks", type=int, metavar="N", help="walks a point; None: 256 on a CPU, 2048 (the paper's) on CUDA"
    )
    group.add_argument(
        "--pace", type=positive, default=1.0, metavar="FACTOR", help="how many times faster the scene is cut"
    )
    group.add_argument("--usd", metavar="PATH", help="write the animation, whose topology changes, to a USD file")
    group.add_argument("--picture", metavar="PATH", help="draw a picture to a PNG file, without OpenGL")
    group.add_argument("--picture-frame", type=int, metavar="FRAME", help="of this frame; None: the last one")
    group.add_argument("--timings", action="store_true", help="measure, also the full recompute, and print a table")
    files = {"usd": f"{name}.usd", "picture": f"{name}.png"}
    demo = {"viewer": "null", "quiet": True, "timings": True, "demo": True, **files}
    group.add_argument(
        "--demo",
        action=DemoAction,
        nargs=0,
        const=demo,
        default=False,
        help=f"the same as --viewer null --quiet --usd {name}.usd --picture {name}.png --timings, and says what "
        "happens",
    )
