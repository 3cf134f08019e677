# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
import pytest
import warp as wp
from newton._src.viewer.kernels import compact
from PIL import Image

from examples import __main__ as dispatcher
from examples.base import CutScene, PlannedCut, along, frames_of
from newton_cagecut import Blade, Cage
from newton_cagecut.usd import validate_animation

FAST = ["--viewer", "null", "--quiet", "--test", "--walks", "16", "--pace", "8"]


@pytest.fixture(scope="module", autouse=True)
def compact_for_all_types():
    """Newton's viewer kernels compile once, and not once more for each type that a generic one is called with."""
    for dtype in (wp.vec3, wp.float32):
        wp.overload(compact, {"src": wp.array(dtype=dtype), "dst": wp.array(dtype=dtype)})


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> CutScene | None:
    """Call the dispatcher with a command line."""
    monkeypatch.setattr("sys.argv", ["examples", *arguments])
    return dispatcher.main()


def test_starfish_is_cut_and_recorded(monkeypatch, tmp_path, capsys):
    """The starfish passes its own test after all cuts, in three pieces, and leaves a valid animation and a picture."""
    usd, png = tmp_path / "starfish.usd", tmp_path / "starfish.png"
    files = ["--usd", str(usd), "--picture", str(png)]
    scene = run(monkeypatch, "starfish", *FAST, "--num-frames", "20", *files, "--timings")
    assert (scene.schedule.current, scene.solver.bodies[0].surface.mesh.component_count) == (3, 3)
    output = capsys.readouterr().out
    assert validate_animation(usd) == []
    assert np.array(Image.open(png)).std() > 10.0
    assert "valid at every sample" in output
    assert "third arm" in output


def test_timings_compare_the_update_with_the_recompute(monkeypatch, capsys):
    """A slow cut is recomputed on the way, with the same weights, and the table says how much slower that is."""
    run(monkeypatch, "starfish", *FAST[:-2], "--pace", "4", "--num-frames", "17", "--timings")
    output = capsys.readouterr().out
    assert "same weights, bit for bit" in output
    assert "times faster" in output


def test_bunny_is_cut_twice(monkeypatch):
    """The bunny passes its own test after a cut through it and one across that, which stays inside."""
    scene = run(monkeypatch, "bunny", *FAST, "--num-frames", "14")
    assert (scene.schedule.current, scene.solver.bodies[0].cage.component_count) == (2, 2)


def test_gingerbread_man_is_cut_down(monkeypatch, tmp_path):
    """The flat gingerbread man passes his own test after a bent cut, a slit and two cuts that free him."""
    usd = tmp_path / "gingerbread.usd"
    scene = run(monkeypatch, "gingerbread", *FAST, "--num-frames", "50", "--usd", str(usd))
    body = scene.solver.bodies[0]
    assert (scene.schedule.current, body.cage.piece_count, body.surface.mesh.component_count) == (4, 4, 4)
    assert scene.frame - scene.parted_at >= 20
    assert validate_animation(usd) == []


def test_minimal_scene_stands_alone(monkeypatch):
    """The scene without the base class runs as the others do, and its ball is in two."""
    scene = run(monkeypatch, "minimal", "--viewer", "null", "--quiet", "--test", "--num-frames", "42")
    assert (scene.cut.complete, len(scene.solver.pieces(0))) == (True, 2)


@pytest.mark.parametrize(
    ("name", "frames", "cuts"),
    [("keyframed", 20, 2), ("texture", 14, 2), ("dude", 44, 1), ("key", 24, 3), ("surgery", 24, 1), ("loaf", 28, 3)],
)
def test_scene_passes_its_own_test(monkeypatch, tmp_path, name: str, frames: int, cuts: int):
    """All cuts are made, the scene's success criteria are met, and its animation is valid, with seams and textures."""
    usd = tmp_path / f"{name}.usd"
    scene = run(monkeypatch, name, *FAST, "--num-frames", str(frames), "--usd", str(usd))
    assert (scene.schedule.current, validate_animation(usd)) == (cuts, [])


@pytest.mark.slow
@pytest.mark.parametrize(("name", "frames", "cuts"), [("octopus", 22, 3), ("jelly", 15, 2), ("sphere", 14, 2)])
def test_larger_scene_passes_its_own_test(monkeypatch, name: str, frames: int, cuts: int):
    """The same of scenes with large cages, many points, or cuts through all of a body."""
    scene = run(monkeypatch, name, *FAST, "--num-frames", str(frames))
    assert scene.schedule.current == cuts


def test_worlds_are_cut_at_once(monkeypatch):
    """Each of four worlds has a body of its own, cut in half at an angle of its own."""
    scene = run(monkeypatch, "worlds", *FAST, "--num-frames", "6", "--worlds", "4")
    assert [len(scene.solver.pieces(k)) for k in range(4)] == [2, 2, 2, 2]


def test_interactive_scene_cuts_and_undoes(monkeypatch):
    """The knife where it stands at first takes an arm off, and undo brings it back; a panel of any kind drives it."""

    class Panel:
        pressed, lines = "", ()

        def button(self, label: str) -> bool:
            return label == self.pressed

        def slider_float(self, label: str, value: float, least: float, most: float) -> tuple[bool, float]:
            assert least <= value <= most
            return label.startswith("Stiffness"), value

        def text(self, text: str) -> None:
            self.lines += (text,)

    scene = run(monkeypatch, "interactive", *FAST, "--num-frames", "2")
    scene.gizmo = wp.transform((5.0, 0.0, 0.4), wp.quat_identity())
    panel = Panel()
    panel.pressed = "Cut"
    scene.gui(panel)
    assert "does not reach" in panel.lines[0]


def test_sprout_grows(monkeypatch, tmp_path):
    """Coordinates alone follow a cage that is extruded, into files too."""
    usd, png = tmp_path / "sprout.usd", tmp_path / "sprout.png"
    scene = run(monkeypatch, "extrude", *FAST, "--num-frames", "30", "--usd", str(usd), "--picture", str(png))
    assert (scene.cage.vertex_count, validate_animation(usd)) == (16, [])
    assert np.array(Image.open(png)).std() > 10.0


def test_own_mesh_gets_a_cage(monkeypatch):
    """An OBJ file is wrapped into a cage and cut."""
    scene = run(monkeypatch, "own_mesh", *FAST, "--num-frames", "10")
    assert len(scene.solver.pieces(0)) == 2


def test_missing_display_is_explained(monkeypatch):
    """A window without a display is one sentence that says what goes without."""

    class NoSuchDisplayException(Exception):
        pass

    def fail(*_unused):
        raise NoSuchDisplayException('Cannot connect to "None"')

    monkeypatch.setattr("newton.examples.init", fail)
    with pytest.raises(SystemExit, match="needs a display, and there is none .*--headless"):
        run(monkeypatch, "starfish", "--viewer", "gl")


def test_dispatcher_lists_the_scenes(monkeypatch, capsys):
    """Without a name, each scene is listed with one line."""
    run(monkeypatch)
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert [line.split()[0] for line in lines] == list(dispatcher.SCENES)
    assert all(len(line.split()) > 5 for line in lines)


def test_every_scene_says_what_to_see():
    """Each scene is short and says what its test checks."""
    for name in dispatcher.SCENES:
        assert "Success criteria:" in dispatcher.description(name), name
        assert len(dispatcher.scene_path(name).read_text().splitlines()) <= 120, name


def test_dispatcher_refuses_an_unknown_scene(monkeypatch):
    """A wrong name is an error that lists the right ones."""
    with pytest.raises(SystemExit, match=r"no scene 'squid'[\s\S]*starfish[\s\S]*bunny"):
        run(monkeypatch, "squid")


def test_frames_of_a_plan_are_its_waits_and_its_steps():
    """Two cuts, one half way, at 3 % a frame."""
    blade = Blade((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    plan = [PlannedCut(name="a", blade=blade, wait=5), PlannedCut(name="b", blade=blade, until=0.5)]
    assert frames_of(plan) == 5 + 34 + 17


def test_cut_along_a_line_with_corners():
    """The blade starts at the line's first corner and turns at the others, at depths from where it meets the cage."""
    cage = Cage([[0, 0], [1, 0], [1, 1], [0, 1]], [(0, 1), (1, 2), (2, 3), (3, 0)])
    cut = along(cage, np.array([[-0.2, 0.5], [0.3, 0.5], [0.6, 0.9], [0.6, 2.0]]), name="bow")
    assert (cut.blade.window, cut.next_turn(0.31)) == ((-np.inf, np.inf, 0.0), pytest.approx(0.8, abs=1e-5))
    np.testing.assert_allclose([depth for depth, _ in cut.turns], [0.3, 0.8], atol=1e-5)
    np.testing.assert_allclose([turn for _, turn in cut.turns], [[0.3, 0.4], [0.0, 1.1]], atol=1e-12)
