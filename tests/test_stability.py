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
from newton_cagecut.report.stability.answers import solid_answers
from newton_cagecut.report.stability.answers.book_answers import bending_mode, flip_time, swing, tip_deflection
from newton_cagecut.report.stability.equal_error import equal_error
from newton_cagecut.report.stability.kept import FILE, KeptOutcomes
from newton_cagecut.report.stability.limits import LIMITS, limits_of
from newton_cagecut.report.stability.outcome import Limits, Outcome, Result, Row
from newton_cagecut.report.stability.rows import against_time, loads, motion, starts, statics
from newton_cagecut.report.stability.shapes import bracket
from newton_cagecut.report.stability.table import judged, measure, rows
from newton_cagecut.report.stability.workbench import CUBE, Workbench

SCRIPT = """
import newton_cagecut as cagecut
from newton_cagecut.report.stability.shapes import bar, surface_in

def build(builder):
    cage = bar(1, (1.0, 0.5, 0.5)).cage()
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
    good = {"finite": True, "energy_gain": 0.1, "recovers": True, "momentum_drift": 0.0, "missed_steps": 0, "error": 0}
    assert limits.failures(Outcome(**good)) == []
    for column, bad in (
        ("finite", False),
        ("recovers", False),
        ("energy_gain", math.inf),
        ("momentum_drift", None),
        ("error", math.nan),
        ("missed_steps", 1),
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
    bent = statics.cantilever(bench, 0.0, 2, "points")
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
    result = judged(row, *measure(row, bench))
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


def test_a_stopped_run_goes_on_from_where_it_was(tiny, tmp_path, monkeypatch):
    """What was measured before the stop is not measured again, and nothing but the page is left in the end."""
    table, measured = stability_run.rows(quick=True, scene=False), []

    def counted(row: Row, bench: Workbench) -> tuple[Outcome, float]:
        if len(measured) == 1:
            measured.append("stopped")
            raise KeyboardInterrupt
        measured.append(row.name)
        return measure(row, bench)

    monkeypatch.setattr(stability_run, "measure", counted)
    with pytest.raises(KeyboardInterrupt):
        stability_run.measure_all(None, tmp_path, quick=True)
    assert (tmp_path / FILE).exists()
    with pytest.raises(ValueError, match="other settings"):
        stability_run.measure_all(None, tmp_path, quick=False)
    assert stability_run.measure_all(None, tmp_path, quick=True) == 1
    assert measured == [table[0].name, "stopped", *(row.name for row in table[1:])]
    assert {path.name for path in tmp_path.iterdir()} == {"stability.md", "stability.json", "stability.png"}


@pytest.mark.parametrize(
    "outcome",
    [
        Outcome(finite=False, energy_gain=math.inf, error=math.nan, note="gone"),
        Outcome(finite=True, iterations=3, missed_steps=0, limited_steps=2, step_count=5, milliseconds=0.5),
    ],
)
def test_kept_outcomes_come_back_as_they_were(outcome, tmp_path):
    """Numbers that JSON cannot hold too."""
    KeptOutcomes(tmp_path, {}, {}).outcome("row", lambda: (outcome, 2.0))
    found, seconds = KeptOutcomes(tmp_path, {}, {}).outcome("row", lambda: pytest.fail("measured again"))
    assert seconds == 2.0
    assert repr(found) == repr(outcome)


def test_boxes_make_a_closed_cage_and_their_own_volume():
    """An L in segments: every edge has two faces, and what is inside is what is filled."""
    blocks = bracket(3, 0.6, 0.2)
    cage = blocks.cage()
    corners = cage.vertices[cage.simplices]
    volume = np.einsum("na,na->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    assert volume == pytest.approx(0.04 * (0.6 + 0.6 + 0.2), rel=1e-12)
    edges = np.sort(np.concatenate([cage.simplices[:, pair] for pair in ((0, 1), (1, 2), (2, 0))]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    inside = blocks.contains(np.array([(0.1, 0.0, 0.1), (0.7, 0.0, 0.75), (0.1, 0.0, 0.75)]))
    assert inside.tolist() == [True, True, False]


def test_the_finite_elements_know_what_books_know():
    """Bending by Timoshenko without Poisson's effect, and Saint-Venant's torsion of a square, up to the held ends."""
    size = (1.0, 0.2, 0.2)
    expected = tip_deflection(1.0, size=size, young=1.0, poisson=0.0)
    assert solid_answers.bar_deflection(size, 0.0, 2) == pytest.approx(expected, rel=0.005)
    torsion = 0.5 * 0.1406 * 0.2**4 / (2.0 * 1.3) * 0.01**2
    assert solid_answers.torsion_energy(size, 0.3, 0.01) == pytest.approx(torsion, rel=0.015)


def test_equal_error_takes_the_cheapest_that_is_near_enough():
    """A solver that gets there dearly, one that does not, and rows that have no part in it."""

    def result(name: str, error: float | None, milliseconds: float) -> Result:
        row = Row(name=name, group="", run=lambda bench: Outcome(), limits=None, quick=False)
        outcome = Outcome(error=error, milliseconds=milliseconds)
        return Result(row=row, outcome=outcome, failures=(), seconds=0.0)

    names = [name for name, _, _ in against_time.ROWS if "Poisson 0.3," in name]
    ours = [name for name in names if name.startswith("SolverCageCut")]
    theirs = [name for name in names if name.startswith("SolverVBD")]
    results = [result(ours[0], 0.3, 1.0), result(ours[1], 0.01, 4.0), result(ours[2], 0.01, 3.0)]
    results += [result(theirs[0], 0.4, 2.0), result("spin", 0.0, 0.1)]
    ((title, head, body),) = equal_error(results)
    assert title.endswith("Poisson 0.3")
    assert head == ["error at most", "SolverCageCut", "SolverVBD"]
    assert [row[1].split(" (")[0] for row in body] == ["1", "3", "3", "3", "3"]
    assert [row[2].startswith("not reached") for row in body] == [False, True, True, True, True]
