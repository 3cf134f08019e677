# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command line as a whole: what help lists and what it imports."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from newton_cagecut.__main__ import _COMMANDS, main

LISTS_HEAVY = """
import json, runpy, sys
sys.argv = ["newton_cagecut", *{arguments}]
try:
    runpy.run_module("newton_cagecut", run_name="__main__")
except SystemExit:
    pass
print(json.dumps([name for name in ("newton", "warp", "matplotlib") if name in sys.modules]))
"""


@pytest.mark.parametrize("arguments", [["--help"], *([name, "--help"] for name in _COMMANDS)])
def test_help_is_light(arguments):
    """Help imports neither Newton nor Warp nor what draws."""
    code = LISTS_HEAVY.format(arguments=arguments)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout.splitlines()[-1]) == []
    assert f"python -m newton_cagecut {' '.join(arguments[:-1])}".strip() in done.stdout


def test_help_lists_the_commands(capsys):
    """Each command stands with its summary."""
    with pytest.raises(SystemExit) as exit_of:
        main(["--help"])
    assert exit_of.value.code == 0
    text = capsys.readouterr().out
    for name, (_, summary) in _COMMANDS.items():
        assert name in text
        assert summary in text


@pytest.mark.parametrize("arguments", [[], ["carve"]])
def test_no_command_is_a_wrong_command_line(arguments, capsys):
    """Without a command, or with an unknown one, it exits with 2 and says what there is."""
    with pytest.raises(SystemExit) as exit_of:
        main(arguments)
    assert exit_of.value.code == 2
    assert "COMMAND" in capsys.readouterr().err
