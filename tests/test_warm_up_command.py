# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""``python -m newton_cagecut warm-up``: what it compiles, and what it refuses."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from newton_cagecut.__main__ import main

SCRIPT = """
import newton_cagecut as cagecut
from newton_cagecut.report.stability.shapes import bar, surface_in

def build(builder):
    cage = bar(1, (1.0, 0.5, 0.5)).cage()
    cagecut.add_cage_body(builder, cage, surface_in(cage), walks=16, quadrature={quadrature})
"""


@pytest.mark.slow
def test_a_second_run_compiles_nothing(tmp_path):
    """In fresh processes: the first fills an empty cache, the second finds all in it."""
    script = tmp_path / "scene.py"
    script.write_text(SCRIPT.format(quadrature=20))
    environment = {**os.environ, "WARP_CACHE_PATH": str(tmp_path / "cache")}
    command = [sys.executable, "-m", "newton_cagecut", "warm-up", str(script), "--device", "cpu"]
    for filled in (False, True):
        before = set((tmp_path / "cache").rglob("*.o"))
        assert bool(before) is filled
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        assert f"the kernels are in {tmp_path / 'cache'}" in done.stdout
    assert set((tmp_path / "cache").rglob("*.o")) == before


def test_bodies_without_elasticity_are_warmed_up_too(tmp_path, capsys):
    """A script's body that only follows its cage."""
    script = tmp_path / "scene.py"
    script.write_text(SCRIPT.format(quadrature=0))
    assert main(["warm-up", str(script), "--device", "cpu"]) == 0
    assert "the kernels are in" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["nothing"], "there is no scene 'nothing'"),
        (["no.py"], "there is no script"),
        (["--device", "tpu:0"], "there is no device 'tpu:0'; there are cpu"),
    ],
)
def test_what_is_not_there_is_refused(arguments, text, capsys):
    """The error says what there is."""
    assert main(["warm-up", *arguments]) == 1
    assert text in capsys.readouterr().err
