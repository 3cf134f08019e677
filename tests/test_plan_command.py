# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""``python -m newton_cagecut plan``: what it prints of a scene, and what it refuses."""

from __future__ import annotations

import re

import pytest

from newton_cagecut.__main__ import main
from newton_cagecut.report.scene_plan import size_text

SCRIPT = """
import newton_cagecut as cagecut
from newton_cagecut.report.stability.shapes import bar, surface_in

def build(builder):
    cage = bar(1, (1.0, 0.5, 0.5)).cage()
    for label, options in (("cut", {}), ("still", {"cuttable": False, "quadrature": 0})):
        cagecut.add_cage_body(builder, cage, surface_in(cage), walks=8, label=label, **{"quadrature": 20, **options})
"""


def test_a_scenes_plan_is_printed(tmp_path, capsys):
    """Each body has its features with bytes or as left out, and the total and the kernels follow."""
    script = tmp_path / "scene.py"
    script.write_text(SCRIPT)
    assert main(["plan", str(script), "--device", "cpu"]) == 0
    text = capsys.readouterr().out
    cut, still = (re.search(rf"^{label}\n((?:  .*\n)*)", text, re.MULTILINE)[1] for label in ("cut", "still"))
    assert re.search(r"walk cache +\d.* kB +the body can be cut", cut)
    assert re.search(r"walk cache +left out +cuttable=False", still)
    assert "left out  no contact_radius" in still
    assert re.search(r"MB on cpu for 2 bodies, of which .* is room for cuts", text)
    assert re.search(r"^\d+ kernels were loaded", text, re.MULTILINE)
    assert "  harmonic.walks.walk: walk_on_spheres\n" in text


@pytest.mark.parametrize(
    ("arguments", "refusal"),
    [
        (["nothing"], "there is no scene 'nothing'"),
        (["no.py"], "there is no script"),
        (["starfish", "--device", "tpu"], "there is no device 'tpu'; there are cpu"),
    ],
)
def test_what_is_not_there_is_refused(arguments, refusal, capsys):
    """The error says what there is."""
    assert main(["plan", *arguments]) == 1
    assert refusal in capsys.readouterr().err


def test_a_script_without_bodies_is_refused(tmp_path, capsys):
    """A build that adds no cage body has no plan."""
    script = tmp_path / "empty.py"
    script.write_text("def build(builder):\n    pass\n")
    assert main(["plan", str(script)]) == 1
    assert "no cage bodies" in capsys.readouterr().err


def test_sizes_have_three_digits():
    """Bytes are told in the unit that suits them."""
    assert [size_text(n) for n in (0, 999, 1234, 5_678_900, 1_500_000_000)] == [
        "0 B",
        "999 B",
        "1.23 kB",
        "5.68 MB",
        "1.5 GB",
    ]
