# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command line: ``python -m newton_cagecut COMMAND``; ``--help`` lists the commands."""

from __future__ import annotations

import importlib
import sys
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from collections.abc import Sequence

_COMMANDS = {
    "cage": ("wrap.cage_command", "make a coarse cage around a mesh"),
    "wrap": ("wrap.cage_command", "the same as cage"),
    "validate": ("usd.validate_command", "check USD files at every sample"),
    "report": ("report.report_command", "measure error against run time, and write a page"),
    "plan": ("report.plan_command", "list what a scene needs, and what it leaves out"),
    "warm-up": ("report.warm_up_command", "compile the kernels of a scene ahead of it"),
    "run": ("report.run_command", "simulate and cut the bodies of a USD stage"),
    "stability": ("report.stability_command", "step extreme cases, and compare with exact answers"),
}
"""Module and summary of each command. Only the module of the command that runs is imported."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Args:
        arguments: Those of the command line, without the program's name; ``sys.argv`` by default.

    Returns:
        The exit status: that of the command, 0 if it says nothing, or 1 with a line on the error stream. A command line
        that makes no sense exits with 2.
    """
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    parser = ArgumentParser(
        prog="python -m newton_cagecut", description="Cages with harmonic coordinates that can be cut, for Newton."
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True, title="commands")
    chosen = arguments[0] if arguments else None
    try:
        for name, (module, summary) in _COMMANDS.items():
            added = commands.add_parser(name, help=summary, formatter_class=RawDescriptionHelpFormatter)
            if name == chosen:
                command = importlib.import_module(f".{module}", __package__)
                added.description, added.epilog = command.DESCRIPTION, command.EPILOG
                command.add_options(added)
        options = parser.parse_args(arguments)
        return command.run(options) or 0
    except (ImportError, OSError, ValueError) as error:
        print(f"{parser.prog}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
