# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The benchmarks, with few walks: that they measure what they say, not how fast it is."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from benchmarks import accuracy, locality, pictures, revisions, table1
from benchmarks.__main__ import NAMES
from benchmarks.__main__ import main as run_benchmark
from benchmarks.comparison import compared
from benchmarks.error_for_time import STAGES, _line, stage_cages
from benchmarks.error_page import gain, write_page
from benchmarks.scenes import SCENES
from newton_cagecut import HarmonicCoordinates
from newton_cagecut.report.bench import spread
from newton_cagecut.report.cuts.following import Followed, follow
from newton_cagecut.report.paper.cutting import edits, step_count
from newton_cagecut.report.paper.table1 import HEAD, measure_table, recompute_seconds

PIECES = {"dude": 2, "starfish": 2, "key": 4, "octopus": 2, "jelly": 2, "sphere": 2}


@pytest.mark.parametrize("name", SCENES)
def test_cuts_of_a_scene_go_through(name):
    """Each cut takes 34 steps, is complete at the last, and leaves as many pieces as the scene is to have."""
    scene = SCENES[name]
    steps = list(edits(scene.cage, scene.blades))
    assert step_count() == 34
    assert len(steps) == 34 * len(scene.blades)
    assert [edit.complete for edit in steps[33::34]] == [True] * len(scene.blades)
    assert not any(edit.complete for edit in steps[:33])
    assert steps[-1].cage.piece_count == PIECES[name]


def test_hat_comes_off_whole():
    """The cut of DUDE leaves every vertex above it in one piece and all others in the other."""
    scene = SCENES["dude"]
    *_, last = edits(scene.cage, scene.blades, 0.25)
    above = scene.points[:, 2] > scene.blades[0].origin[2]
    assert 0.2 < above.mean() < 0.4
    inside = np.abs(last.cage.winding_numbers(scene.points).round()) > 0
    assert len(np.unique(inside[above], axis=0)) == len(np.unique(inside[~above], axis=0)) == 1


def test_octopus_loses_the_end_of_one_arm_only():
    """What comes off is a small part of the cage."""
    scene = SCENES["octopus"]
    *_, last = edits(scene.cage, scene.blades, 0.5)
    assert last.cage.piece_volumes.min() < 0.01 * scene.cage.volume


def test_table_has_our_row_and_the_papers(capsys, tmp_path):
    """A run measures every step of every cut and three recomputes, and writes both rows as Markdown."""
    file = tmp_path / "table.md"
    (measured,) = table1.main(["--scene", "jelly", "--walks", "4", "--device", "cpu", "--markdown", str(file)])
    assert (measured.step_count, measured.recompute_count, measured.point_count) == (34, 3, 2210)
    assert measured.update_ms == pytest.approx(sum(measured.part_ms.values()))
    assert measured.cache_bytes <= 64 * measured.walk_count
    assert "bit for bit" in capsys.readouterr().out
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in file.read_text().splitlines()[2:]]
    assert [row[0] for row in rows] == ["scene", "---", "jelly", "(paper)"]
    assert {len(row) for row in rows} == {len(HEAD)}
    assert rows[3][-3:] == ["4.2", "115", "520"]


def test_benchmarks_are_run_by_their_names(capsys):
    """The list names each with a line, and an unknown one exits with 2."""
    assert run_benchmark([]) == 0
    assert all(f"  {name} " in capsys.readouterr().out for name in NAMES[:1])
    assert run_benchmark(["speed"]) == 2
    assert "there is no benchmark 'speed'" in capsys.readouterr().err


def test_runs_are_compared(tmp_path, capsys):
    """A run compared with its own file says how the times differ, and not what is the same."""
    kept, command = tmp_path / "kept.json", ["table1", "--scene", "jelly", "--walks", "2", "--device", "cpu"]
    run_benchmark([*command, "--json", str(kept)])
    run_benchmark([*command, "--compare", str(kept)])
    lines = capsys.readouterr().out.split(f"compared with {kept}")[1].splitlines()
    assert any(line.startswith("jelly") and "recompute ms" in line for line in lines)
    assert not any("re-walk %" in line or "(paper)" in line for line in lines)


def test_runs_are_compared_with_a_revision(tmp_path, monkeypatch):
    """The benchmark is run in a checkout of the revision, with the other options; the checkout goes again."""
    made = []

    def run(command: list[str], **options: object) -> SimpleNamespace:
        made.append(command)
        if "benchmarks" in command:
            assert options["env"]["PYTHONPATH"].startswith(str(tmp_path / "tree"))
            (tmp_path / "kept.json").write_text("[]")
        return SimpleNamespace(returncode=0, stdout="abc" if "rev-parse" in command else "")

    monkeypatch.setattr(revisions.subprocess, "run", run)
    given = ["--walks", "2", "--compare", "v1", "--json", "now.json"]
    kept = str(tmp_path / "kept.json")
    assert revisions.with_kept("table1", given, tmp_path) == [*given[:3], kept, *given[4:]]
    assert made[2][1:] == ["-m", "benchmarks", "table1", "--walks", "2", "--json", kept]
    assert [command[3:5] for command in made[1::2]] == [["worktree", "add"], ["worktree", "remove"]]
    assert revisions.with_kept("table1", ["--compare", kept], tmp_path) == ["--compare", kept]


def test_unknown_revision_is_refused(capsys):
    """What is neither a file nor a revision is named, and nothing is run."""
    assert run_benchmark(["table1", "--compare", "no-such-revision"]) == 2
    assert "no-such-revision: there is neither such a file nor such a revision" in capsys.readouterr().err


def test_comparison_matches_rows_by_their_names():
    """Rows are known by their leading texts; a new one is named, and the ratio is of the new to the old."""
    head = ["scene", "what", "ms"]
    old = {"title": "times", "head": head, "rows": [["a", "x", "2.0"], ["a", "y", "3"]]}
    new = {"title": "times", "head": head, "rows": [["b", "x", "1"], ["a", "x", "1.0"], ["a", "y", "3"]]}
    table = [line.split() for line in compared([old], [new])[1:]]
    assert table == [["b", "x", "none", "new"], ["a", "x", "ms", "2.0", "1.0", "0.50"]]
    assert compared([old], [old]) == ["nothing differs"]


def test_quadrature_points_have_gradients_besides():
    """With gradients there are about 600 points more."""
    measured = measure_table(SCENES["jelly"], 2, gradients=True, device="cpu")
    assert 500 < measured.point_count - len(SCENES["jelly"].points) < 700
    assert measured.gradient_bytes > 0


def test_recompute_that_differs_is_refused():
    """Weights that are not those of a recompute are told, not timed."""
    coordinates = HarmonicCoordinates(SCENES["sphere"].cage, SCENES["sphere"].points[:4], 4, device="cpu")
    assert recompute_seconds(coordinates) > 0.0
    coordinates.weights_array.zero_()
    with pytest.raises(ValueError, match="other weights"):
        recompute_seconds(coordinates)


def test_errors_are_lower_with_control_variates():
    """Plain Monte Carlo gains 1 over itself; the harmonic correction more, on weights and on gradients."""
    scene = SCENES["sphere"]
    points = spread(0.8 * scene.points, 30)
    for gradients in (False, True):
        errors = accuracy.measure(
            scene.cage, points, 64, gradients=gradients, runs=2, long_walks=2048, quads="mean_value", device="cpu"
        )
        assert errors.gain("none") == 1.0
        assert errors.gain("harmonic") > 2.0
        assert set(errors.group) == set(range(10))
        assert errors.reference.sum() < 0.2 * errors.correction["harmonic"].sum()


def test_errors_are_grouped_from_the_walls_inward():
    """Points of the first tenth are nearer to the walls than those of the last."""
    scene = SCENES["sphere"]
    points = scene.points[:40] * np.linspace(0.1, 1.0, 40)[:, None]
    errors = accuracy.measure(scene.cage, points, 8, gradients=False, runs=2, long_walks=8, device="cpu")
    radius = np.linalg.norm(points, axis=1)
    assert radius[errors.group == 0].min() > radius[errors.group == 9].max()


def test_error_of_the_reference_is_taken_off():
    """Where runs and long runs have equally many walks, half of the raw difference is the reference's own, and goes."""
    scene = SCENES["jelly"]
    points = spread(0.7 * scene.points + (0.0, 0.0, 0.06), 60)
    fair = accuracy.measure(scene.cage, points, 64, gradients=False, runs=4, long_walks=1024, device="cpu")
    poor = accuracy.measure(scene.cage, points, 64, gradients=False, runs=4, long_walks=64, device="cpu")
    assert poor.reference.sum() > 5.0 * fair.reference.sum()
    assert poor.correction["none"].sum() == pytest.approx(fair.correction["none"].sum(), rel=0.15)


def test_flagged_walks_hold_the_changed_ones():
    """No step changes more walks than it flagged; some were flagged in vain."""
    scene = SCENES["jelly"]
    found = follow(scene.cage, scene.points, scene.blades[0], 4, device="cpu")
    assert len(found.flagged) == 34
    assert all(changed <= flagged for changed, flagged in zip(found.changed, found.flagged))
    assert found.in_vain > 0.0
    assert max(found.changed) <= found.touched.mean() <= 1.0


def test_histogram_of_locality_counts_every_vertex():
    """The bins, with those of no changed walk, hold all vertices."""
    np.testing.assert_allclose(locality.histogram(np.array([0.0, 0.005, 0.02, 1.0])), [25, 25, 25, 0, 0, 25])


def test_figures_are_plotted(tmp_path):
    """Both figures go into one file."""
    pytest.importorskip("matplotlib")
    flagged = Followed([0.2, 0.1], [0.1, 0.1], np.zeros(4, dtype=bool))
    found = {(cut, kind): flagged for cut in locality.DIRECTIONS for kind in ("dop18", "aabb")}
    shares = {place: np.array([0.0, 0.02, 0.3]) for place in locality.PLACES}
    locality.plot(shares, found, tmp_path / "locality.png")
    assert np.array(Image.open(tmp_path / "locality.png")).std() > 10.0


def test_scene_is_drawn_with_its_cage_and_cut(tmp_path):
    """The picture shows the skin, the dark cage and the blue cut."""
    pictures.draw(SCENES["jelly"], tmp_path / "jelly.png", (160, 120))
    red, green, blue = np.array(Image.open(tmp_path / "jelly.png"), dtype=int).reshape(-1, 3).T
    assert np.count_nonzero((red > 180) & (blue < 100)) > 500
    assert np.count_nonzero((blue > red + 80) & (green > red)) > 50
    assert np.count_nonzero(np.maximum(red, blue) < 60) > 100


def test_errors_for_time_make_a_page(tmp_path):
    """Gains are those at the time of the fit, without the reference's error, and the page has them and a picture."""
    own = {
        stage: {"own": {"weights": 1e-8, "gradients": 1e-8}, "check": [1.0, 1.0], "table_bias": 1e-5}
        for stage in STAGES
    }

    def row(method: str, amount: int, squared: float, seconds: float) -> dict:
        errors = {stage: {"weights": squared, "gradients": squared} for stage in STAGES}
        return {"method": method, "amount": amount, "squared": errors, "seconds": {"first": seconds, "step": seconds}}

    rows = [row("affine", 64, 1.6e-3, 1.0), row("affine", 1024, 1e-4 + 1e-8, 16.0)]
    rows += [row("harmonic", 64, 8e-4, 1.0), row("harmonic", 1024, 5e-5, 16.0)]
    rows += [row("fitted", 0, 1.1e-7, 2.0), row("fitted", 64, 1e-8, 4.0)]
    scene = {"faces": 6, "points": 700, "references": own, "rows": rows}
    value, bounded = gain(scene, "before", "weights", walks=0)
    assert value == pytest.approx(1e-4 * 1024 / 128 / 1e-7)  # affine has made 128 walks in two seconds
    assert not bounded
    assert gain(scene, "during", "gradients", walks=64)[1]
    settings = {"point_count": 4, "reference_walks": 8, "machine": {"cores": 2, "processor": "a processor"}}
    write_page({"settings": settings, "scenes": {"cube": scene}}, tmp_path)
    assert "| cube | 8e+03 |" in (tmp_path / "accuracy.md").read_text()
    assert (tmp_path / "accuracy.png").stat().st_size > 1000


def test_times_of_walks_are_linear():
    """Time without walks and that of a walk, neither below 0; and a cage before, half way through and after its cut."""
    assert _line((0, 4, 32), [1.0, 1.1, 1.8]) == pytest.approx((1.0, 0.025))
    assert _line((4, 32), [1.0, 0.9]) == pytest.approx((1.0, 0.0))
    scene = SCENES["jelly"]
    cages = stage_cages(scene)
    assert tuple(cages) == STAGES
    assert [cage.piece_count for cage in cages.values()] == [1, 1, 2]
