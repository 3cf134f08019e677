# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Runs a benchmark: ``python -m benchmarks NAME [options]``; without a name, lists them."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.revisions import with_kept

NAMES = (
    "accuracy",
    "distance",
    "fingerprint",
    "locality",
    "locking",
    "pages",
    "pictures",
    "solve",
    "table1",
    "topology",
    "wrap",
)


def benchmark_list() -> str:
    """Return the benchmarks with one line each, from their docstrings, without importing them."""
    lines = ["usage: python -m benchmarks NAME [options]; NAME --help shows the options", ""]
    for name in NAMES:
        module = ast.parse((Path(__file__).parent / f"{name}.py").read_text())
        lines.append(f"  {name:<12} {ast.get_docstring(module).splitlines()[0]}")
    lines += [
        "",
        "Most take --json FILE, to keep their figures, and --compare FILE, to print what differs from kept ones; with",
        "--compare REV they are run at another commit before, on this machine.",
    ]
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark that the command line names.

    Args:
        arguments: The command line; that of the program by default.

    Returns:
        The exit status.
    """
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    if not arguments or arguments[0] in ("-h", "--help"):
        print(benchmark_list())
        return 0
    if arguments[0] not in NAMES:
        print(f"there is no benchmark {arguments[0]!r}\n{benchmark_list()}", file=sys.stderr)
        return 2
    with TemporaryDirectory() as folder:
        try:
            options = with_kept(arguments[0], arguments[1:], Path(folder))
        except ValueError as error:
            print(error, file=sys.stderr)
            return 2
        found = importlib.import_module(f"benchmarks.{arguments[0]}").main(options)
    return found if isinstance(found, int) else 0


if __name__ == "__main__":
    sys.exit(main())
