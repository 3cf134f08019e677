# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The report: what is kept, resumed and written, and what is refused."""

from __future__ import annotations

import importlib.util
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
import warp as wp

from newton_cagecut import Blade
from newton_cagecut.__main__ import main
from newton_cagecut.report.effort import Effort
from newton_cagecut.report.measurement import Measurement, Record, chosen
from newton_cagecut.report.measuring import STOPPED, add_missing, measure_all
from newton_cagecut.report.page.report_page import write_page
from newton_cagecut.report.record_store import RecordStore, read_report, records_of
from newton_cagecut.report.reference.exact_cases import box
from newton_cagecut.report.rows import ROWS, error
from newton_cagecut.report.scenes.scene import PlainScene, blade_across, load_scenes

TINY = Effort(
    name="tiny",
    point_count=16,
    walk_counts=(16, 64),
    fitted_counts=(0, 16),
    seeds=(1,),
    reference_runs=2,
    reference_walks=128,
    row_walks=16,
    cell_counts=(50,),
    table_walks=4,
    face_counts=(50, 100),
    point_counts=(8, 16),
)
SCRIPT = """
import numpy as np
import newton_cagecut as cagecut

def build(builder):
    corners = np.array([[x, y, z] for x in (0, 3) for y in (0, 2) for z in (0, 1)], dtype=float)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = (0.5 + 0.1 * corners, np.array([[0, 1, 3], [0, 3, 2]]))
    cagecut.add_cage_body(builder, cagecut.Cage(corners, faces), mesh)
"""


def small_scene() -> PlainScene:
    """A box that is cut across."""
    case = box(12)
    return PlainScene("small", case.cage, case.points, (Blade((0.43, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),))


def store_in(folder: Path, **settings: int) -> RecordStore:
    """A store with some settings."""
    return RecordStore(folder, {"walks": 8, **settings}, {"device": "cpu"})


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a tiny report."""
    folder = tmp_path_factory.mktemp("report")
    assert measure_all([small_scene()], TINY, wp.get_device("cpu"), folder) == 0
    return folder


def test_store_goes_on_where_it_was(tmp_path):
    """What was measured before an interrupt is kept, and only the rest is measured when it is run again."""
    made = []

    def measurement(number: int, *, interrupted: bool) -> Measurement:
        def run() -> dict:
            if interrupted and number == 2:
                raise KeyboardInterrupt
            made.append(number)
            return {"squared": 0.1 * number}

        return Measurement("error", "scene", {"walks": number}, run)

    with pytest.raises(KeyboardInterrupt):
        add_missing(store_in(tmp_path), [measurement(k, interrupted=True) for k in range(4)], progress=False)
    assert [record.parameters["walks"] for record in store_in(tmp_path).records] == [0, 1]
    store = store_in(tmp_path)
    add_missing(store, [measurement(k, interrupted=False) for k in range(4)], progress=False)
    assert made == [0, 1, 2, 3]
    assert store_in(tmp_path).records == store.records
    assert "scene/error/walks=3" in store
    assert not list(tmp_path.glob("*.part"))


def test_store_refuses_what_was_measured_otherwise(tmp_path):
    """Other settings are named, and the file stays as it was."""
    store_in(tmp_path).add(Record("error", "", {}, {}))
    before = (tmp_path / "report.json").read_bytes()
    with pytest.raises(ValueError, match=r"walks was 8 and is 9.*--out"):
        store_in(tmp_path, walks=9)
    assert (tmp_path / "report.json").read_bytes() == before
    (tmp_path / "report.json").write_text("{}")
    with pytest.raises(ValueError, match="not the file of a report"):
        store_in(tmp_path)


def test_stopped_report_has_a_page(tmp_path, monkeypatch, capsys):
    """Ctrl-C in the middle exits with 130, says how far it came and leaves a page of what there is."""

    def stop(*_: object, **_options: object) -> dict:
        raise KeyboardInterrupt

    monkeypatch.setattr("newton_cagecut.report.rows.error_row.measure_error", stop)
    assert measure_all([small_scene()], TINY, wp.get_device("cpu"), tmp_path) == STOPPED
    assert "stopped: 2 of" in capsys.readouterr().err
    assert "from 2 measurements" in (tmp_path / "report.md").read_text()


def test_page_is_made_from_the_file_alone(report, tmp_path):
    """Page and plots of the same file are the same, byte for byte."""
    write_page(read_report(report / "report.json"), ROWS, tmp_path)
    names = sorted(path.name for path in tmp_path.iterdir())
    charts = ("bounds", "course", "error_small", "gains", "growth", "locality", "replay", "steps")
    assert names == sorted([*(f"{name}.{ending}" for name in charts for ending in ("png", "svg")), "report.md"])
    for name in names:
        assert (tmp_path / name).read_bytes() == (report / name).read_bytes(), name


def test_page_shows_its_figures(report):
    """The page has a section a row, the plots, a line to paste, and the error of every method."""
    text = (report / "report.md").read_text()
    for part in ("Recommendation", "run time: small", "exact weights", "Epsilon", "Quads", "Table 1", "Growth"):
        assert f"{part}\n" in text or part in text
    assert "cagecut.HarmonicCoordinates(cage, points, walks=" in text
    assert "![small: error against run time](error_small.png)" in text
    for method in ("walks, affine (the paper)", "boundary fit, and walks", "finite elements, P2"):
        assert method in text


def test_records_hold_finite_figures(report):
    """Every number is finite; each stage has times and squared errors of all kinds."""

    def check(value: object) -> None:
        if isinstance(value, dict):
            for each in value.values():
                check(each)
        elif isinstance(value, list):
            for each in value:
                check(each)
        elif isinstance(value, float):
            assert math.isfinite(value)

    found = json.loads((report / "report.json").read_text())
    check(found)
    assert {"device", "processor", "newton_cagecut", "warp-lang"} <= set(found["machine"])
    records = records_of(found)
    runs = chosen(records, "error", "small", correction="harmonic")
    assert [record.parameters["walks"] for record in runs] == [16, 64]
    fits = chosen(records, "error", "small", correction="fitted")
    assert [record.parameters["walks"] for record in fits] == [0, 16]
    for record in (*runs, *fits, *chosen(records, "elements", "small")):
        for stage in ("before", "during"):
            assert record.values[stage]["seconds"] > 0.0
            assert set(record.values[stage]["squared"]) == set(error.KINDS)


def test_errors_fall_as_the_root_of_the_walks(report):
    """Against exact weights, plain errors of 16 and 64 walks differ by about two."""
    records = records_of(read_report(report / "report.json"))
    for case in ("tetrahedron", "box"):
        few, many = (
            chosen(records, "exact", case=case, correction="none", walks=walks)[0].values["squared"]
            for walks in TINY.walk_counts
        )
        assert 0.5 * math.log2(few / many) == pytest.approx(1.0, abs=0.25)


def test_script_is_a_scene(tmp_path):
    """The first body that a script builds is measured, cut square to its longest side without blades."""
    (tmp_path / "block.py").write_text(SCRIPT)
    (scene,) = load_scenes([str(tmp_path / "block.py")], ())
    assert (scene.name, scene.cage.face_count, len(scene.points)) == ("block", 6, 8)
    (blade,) = scene.blades
    np.testing.assert_allclose(np.cross(blade.edge, blade.direction), [-1.0, 0.0, 0.0])
    assert blade_across(scene.cage).origin[0] == 1.5


@pytest.mark.parametrize(
    ("scene", "text"),
    [
        ("no_such", "there is no scene 'no_such'.*starfish.*script"),
        ("body.usda", "a stage cannot be measured.*script"),
        ("no_such.py", "there is no script"),
    ],
)
def test_unknown_scenes_are_refused(scene, text, capsys, tmp_path):
    """What is no scene is named, with what to do, and nothing is written."""
    assert main(["report", scene, "--device", "cpu", "--out", str(tmp_path / "out")]) == 1
    assert re.search(text, capsys.readouterr().err)
    assert not (tmp_path / "out").exists()


def test_script_without_a_body_is_refused(tmp_path):
    """A script needs build(builder), and that a body."""
    script = tmp_path / "empty.py"
    script.write_text("")
    with pytest.raises(ValueError, match="no function build"):
        load_scenes([str(script)], ())
    script.write_text("def build(builder):\n    pass\n")
    with pytest.raises(ValueError, match="added no cage body"):
        load_scenes([str(script)], ())


def test_missing_extra_is_named(monkeypatch, capsys, tmp_path):
    """Without Matplotlib it says which extra brings it, before anything is measured."""
    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "matplotlib" else found(name))
    assert main(["report", "starfish", "--out", str(tmp_path / "out")]) == 1
    assert "matplotlib, which the extra brings: pip install 'newton_cagecut[report]'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_unknown_device_is_refused(capsys, tmp_path):
    """A device that is not there is named, with those that are."""
    assert main(["report", "starfish", "--device", "abacus", "--out", str(tmp_path)]) == 1
    assert "no device 'abacus'; there are cpu" in capsys.readouterr().err
