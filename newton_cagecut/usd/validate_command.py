# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command ``python -m newton_cagecut validate``: what is wrong with USD files, in words and by the exit status."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace

from pxr import Usd, UsdValidation

from .read import open_stage
from .validate import validate_animation

DESCRIPTION = """\
Check USD files: meshes and curves at every sample and between two, which
usdchecker does not, and all that OpenUSD's own validators check.
"""
EPILOG = """\
The exit status is 0 where nothing was found, and 1 otherwise.

example:
  python -m newton_cagecut validate cut.usd
"""
_TIME = re.compile(r" at (-?[\d.e+]+): ")


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: Its parser.
    """
    parser.add_argument("files", metavar="FILE", nargs="+", help="USD files")


def run(options: Namespace) -> int:
    """Check the files and print what was found.

    Args:
        options: The parsed arguments.

    Returns:
        1 if something is wrong with one of them.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: A file is no USD.
    """
    bad = 0
    for path in options.files:
        stage = open_stage(path)
        lines = _gathered(validate_animation(stage)) + _findings_of_openusd(stage)
        print("\n".join([f"{path}: {_verdict(stage, len(lines))}", *(f"  {line}" for line in lines)]))
        bad += bool(lines)
    return int(bad > 0)


def _verdict(stage: Usd.Stage, count: int) -> str:
    if count:
        return f"{count} problem{'s' if count > 1 else ''}"
    if not stage.HasAuthoredTimeCodeRange():
        return "valid"
    return f"valid at every sample from {stage.GetStartTimeCode():g} to {stage.GetEndTimeCode():g}"


def _gathered(problems: list[str]) -> list[str]:
    """Return problems with those that differ in nothing but their times as one."""
    times: dict[tuple[str, str | None], list[str]] = {}
    for problem in problems:
        found = _TIME.search(problem)
        key = (problem[: found.start()], problem[found.end() :]) if found else (problem, None)
        times.setdefault(key, []).append(found[1] if found else "")
    return [where if what is None else f"{where} at {_several(at)}: {what}" for (where, what), at in times.items()]


def _several(times: list[str]) -> str:
    return times[0] if len(times) == 1 else f"{times[0]} and {len(times) - 1} other times"


def _findings_of_openusd(stage: Usd.Stage) -> list[str]:
    """Return errors and warnings of the validators that OpenUSD brings."""
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    lines = []
    for finding in UsdValidation.ValidationContext(validators).Validate(stage):
        if finding.GetType() in (UsdValidation.ValidationErrorType.Error, UsdValidation.ValidationErrorType.Warn):
            lines.append(f"{finding.GetName()}: {' '.join(finding.GetMessage().split())}")
    return list(dict.fromkeys(lines))
