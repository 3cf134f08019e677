# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The table of extreme cases: that it measures what it says, not that the solver is good."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from PIL import Image

from newton_cagecut import Material
from newton_cagecut.__main__ import main
from newton_cagecut.report.stability import stability_run, sweep
from newton_cagecut.report.stability.answers import bending_mode, flip_time, swing, tip_deflection
from newton_cagecut.report.stability.limits import LIMITS, limits_of
from newton_cagecut.report.stability.outcome import Limits, Outcome, Row
from newton_cagecut.report.stability.rows import loads, motion, starts, statics
from newton_cagecut.report.stability.table import measure, rows
from newton_cagecut.report.stability.workbench import CUBE, Workbench

SCRIPT = """
import newton_cagecut as cagecut
from newton_cagecut.report.stability.shapes import bar_cage, surface_in

def build(builder):
    cage = bar_cage(1, (1.0, 0.5, 0.5))
    cagecut.add_cage_body(builder, cage, surface_in(cage), walks=16, quadrature=20, cuttable=False)
"""


@pytest.fixture(scope="module")
def bench() -> Workbench:
    """Bars, made once."""
    return Workbench(quick=True)


def test_every_row_has_its_own_name_and_limits():
    """Names are unique, each row has limits, and no limit stands for nothing."""
    table = rows(quick=False, scene=False)
    names = [row.name for row in table]
    assert len(set(names)) == len(names)
    chosen = {max((key for key in LIMITS if name.startswith(key)), key=len) for name in [*names, "map"]}
    assert chosen == set(LIMITS)
    assert {row.name for row in rows(quick=True, scene=False)} < set(names)
    with pytest.raises(KeyError, match="add a line to LIMITS"):
        limits_of("a row that nobody knows")


def test_limits_judge_each_column():
    """What is out of its limit, or not known but limited, is named; what is not limited is not."""
    limits = Limits(energy_gain=0.1, recovers=True, momentum_drift=0.1, error=0.1)
    good = {"finite": True, "energy_gain": 0.1, "recovers": True, "momentum_drift": 0.0, "iterations": 3, "error": 0.0}
    assert limits.failures(Outcome(**good)) == []
    for column, bad in (
        ("finite", False),
        ("recovers", False),
        ("energy_gain", math.inf),
        ("momentum_drift", None),
        ("error", math.nan),
        ("iterations", 150),
    ):
        assert limits.failures(Outcome(**{**good, column: bad})) == [column]
    assert Limits().failures(Outcome(energy_gain=1.0)) == []


def test_answers_are_those_of_textbooks():
    """A simple pendulum that falls from the side, a rigid top that does not flip at once, and slender beams."""
    time, speed = swing(np.array([1.0, 0.0]), 0.0, 9.81)
    assert time == pytest.approx(1.8540747 * math.sqrt(1.0 / 9.81), rel=1e-4)  # the elliptic integral K(1/sqrt(2))
    assert speed == pytest.approx(math.sqrt(2.0 * 9.81), rel=1e-6)
    assert flip_time(np.array([1.0, 2.0, 3.0]), np.array([1e-3, 10.0, 0.0])) > flip_time(
        np.array([1.0, 2.0, 3.0]), np.array([0.1, 10.0, 0.0])
    )
    slender = (1.0, 0.01, 0.01)
    euler = 22.3733 / (2.0 * math.pi) * math.sqrt(1e6 * 0.01**2 / 12.0 / 1000.0)
    assert bending_mode(slender, 1e6, 0.3, 1000.0)[0] == pytest.approx(euler, rel=2e-3)
    stiff = tip_deflection(1e-6, size=slender, young=1e6, poisson=0.3)
    assert stiff == pytest.approx(1e-6 / (3.0 * 1e6 * 0.01**4 / 12.0), rel=1e-3)


def test_a_trial_sees_energy_and_momentum_that_come_from_nowhere(bench):
    """A push between steps shows as a gain and as a drift; free fall shows as neither."""
    trial = bench.bar(Material(young=1.0e5), segments=1, size=CUBE, gravity=(0.0, 0.0, -9.81))
    fallen = trial.run(10, 1.0 / 60.0).outcome(free=True)
    assert fallen.finite
    assert fallen.energy_gain < 1e-6
    assert fallen.momentum_drift < 1e-5
    trial.reset()
    trial.place(velocities=np.tile((1.0, 0.0, 0.0), (8, 1)))

    def push() -> None:
        trial._write(trial.state.particle_qd, np.tile((2.0, 0.0, 0.0), (8, 1)))

    pushed = trial.run(3, 1.0e-4, watch=push).outcome(free=True)
    assert pushed.energy_gain == pytest.approx(3.0, rel=0.01)
    assert pushed.momentum_drift == pytest.approx(0.5, rel=0.01)
    assert pushed.step_count == 3


def test_a_trial_counts_limited_steps(bench):
    """A body that is torn open goes in limited steps, a resting one does not."""
    trial = bench.bar(Material(young=1.0e5), segments=1, size=CUBE)
    assert trial.run(3, 1.0 / 60.0).outcome().limited_steps == 0
    trial.place(trial.rest * (10.0, 1.0, 1.0))
    assert trial.run(3, 1.0 / 60.0).outcome().limited_steps > 0


def test_rows_measure(bench):
    """A few rows of each kind come out finite and with an error where they promise one."""
    spun = motion.spin(bench, 1.0e4)
    assert spun.finite
    assert 0.0 <= spun.error < 1.0
    assert spun.momentum_drift < 1e-4
    fallen = motion.fall(bench)
    assert fallen.error < 0.02
    bent = statics.cantilever(bench, 0.0, 2)
    assert bent.error < 1.0
    assert "of 0.04096" in bent.note
    start = starts.scaled(bench, "neo_hookean", (1.0, 1.0, 0.5))
    assert start.recovers
    assert start.energy_gain == 0.0
    assert loads.heavy(bench, 9.81, 1.0).finite


def test_a_row_that_breaks_fails_alone(bench):
    """What a row raises is its failure, and its text stands in the note."""

    def broken(bench: Workbench) -> Outcome:
        raise ValueError("no such bar")

    row = Row(name="broken", group="Motion", run=broken, limits=Limits(), quick=True)
    result = measure(row, bench)
    assert result.verdict == "FAIL"
    assert "no such bar" in result.outcome.note


@pytest.fixture
def tiny(monkeypatch):
    """A table of two rows, of which one is out of its limits, and maps of two cells."""

    def row(name: str, error: float, limits: Limits | None) -> Row:
        outcome = Outcome(finite=True, error=error, against="nothing", step_count=1)
        return Row(name=name, group="Motion", run=lambda bench: outcome, limits=limits, quick=True)

    table = [row("good", 0.0, Limits(error=0.1)), row("bad", 0.2, Limits(error=0.1)), row("other", 1.0, None)]
    monkeypatch.setattr(stability_run, "rows", lambda **options: table)
    axes = ((1.0e4,), (1.0e-3, 0.1))
    monkeypatch.setattr(stability_run, "axes", lambda **options: axes)
    monkeypatch.setattr(sweep, "axes", lambda **options: axes)
    monkeypatch.setattr(sweep, "_MOST_STEPS", 3)


def test_the_page_shows_failures_and_the_status_too(tiny, tmp_path, capsys):
    """Page, picture and figures are written; a row out of its limits is marked with its limit, and the status is 1."""
    assert main(["stability", "--quick", "--out", str(tmp_path / "new")]) == 1
    page = (tmp_path / "new" / "stability.md").read_text()
    (bad,) = (line for line in page.splitlines() if line.startswith("| bad"))
    assert "**FAIL**" in bad
    assert "**20 %** > 10 %" in bad
    assert "FAIL" not in next(line for line in page.splitlines() if line.startswith("| other"))
    found = json.loads((tmp_path / "new" / "stability.json").read_text())
    assert found["records"]["bad"]["values"]["failures"] == ["error"]
    assert found["records"]["map, StVK, 10000 Pa, 0.1 s"]["values"]["finite"] is True
    assert found["machine"]["cores"] >= 1
    with Image.open(tmp_path / "new" / "stability.png") as picture:
        assert picture.size[0] > 400
    assert "bad" in capsys.readouterr().out


def test_a_scenes_bodies_are_mapped(tiny, tmp_path):
    """A script's body takes the place of the bar."""
    script = tmp_path / "scene.py"
    script.write_text(SCRIPT)
    main(["stability", str(script), "--quick", "--out", str(tmp_path)])
    found = json.loads((tmp_path / "stability.json").read_text())
    assert found["settings"]["scene"] == str(script)
    bench = Workbench(quick=True, scene=stability_run.build_of(str(script)))
    trial = bench.subject(Material(young=1.0e4, model="stvk"))
    assert trial.solver.bodies[0].material.model == "stvk"
    np.testing.assert_allclose(np.ptp(trial.rest, axis=0), (1.0, 0.5, 0.5), rtol=1e-6)


@pytest.mark.parametrize(
    ("scene", "text"), [("nothing", "there is no scene 'nothing'"), ("no.py", "there is no script")]
)
def test_an_unknown_scene_is_refused(scene, text, tmp_path, capsys):
    """The error says what there is; nothing is written."""
    assert main(["stability", scene, "--out", str(tmp_path / "new")]) == 1
    assert text in capsys.readouterr().err
    assert not (tmp_path / "new").exists()
