# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command line: ``python -m newton_cagecut COMMAND``; ``--help`` lists the commands."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from collections.abc import Sequence

from .wrap import command as cage_command

_COMMANDS = {"cage": cage_command}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Args:
        arguments: Those of the command line, without the program's name; ``sys.argv`` by default.

    Returns:
        The exit status: 0, or 1 with a line on the error stream. A command line that makes no sense exits with 2.
    """
    parser = ArgumentParser(
        prog="python -m newton_cagecut", description="Cages with harmonic coordinates that can be cut, for Newton."
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True, title="commands")
    for name, command in _COMMANDS.items():
        texts = {"help": command.HELP, "description": command.DESCRIPTION, "epilog": command.EPILOG}
        command.add_options(commands.add_parser(name, formatter_class=RawDescriptionHelpFormatter, **texts))
    try:
        options = parser.parse_args(arguments)
        _COMMANDS[options.command].run(options)
    except (ImportError, OSError, ValueError) as error:
        print(f"{parser.prog}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
