# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Coordinates in files: what is loaded goes on as if it had never been away, or is refused with the reason."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import box
from harmonic_shapes import assert_identical, interior_points, middle_cut, random_blade, snapshot
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.harmonic.cache.container import read_container, write_container
from plane_shapes import square

WALKS = 32
CAGES = {2: square, 3: box}
POINTS = {dimension: interior_points(make(), 15, np.random.default_rng(dimension)) for dimension, make in CAGES.items()}


def bake(dimension: int = 3, **options) -> HarmonicCoordinates:
    """Coordinates with gradients, in a cage of their own."""
    return HarmonicCoordinates(
        CAGES[dimension](), POINTS[dimension], WALKS, **{"gradients": True, "seed": 5, "device": "cpu", **options}
    )


def oblique_cut(cage: Cage) -> Cut:
    """The same cut of a cage, made anew at every call."""
    return Cut(cage, random_blade(np.random.default_rng(9), cage))


def follow(loaded: HarmonicCoordinates, kept: HarmonicCoordinates, cut: Cut, kept_cut: Cut) -> None:
    """Go on with a cut; compare what was loaded with what was kept, and with a recompute."""
    for depth in (0.8, 1.1):
        loaded.update(cut.advance(to=depth * cut.length))
        kept.update(kept_cut.advance(to=depth * cut.length))
        updated = snapshot(loaded)
        assert_identical(updated, snapshot(kept))
        loaded.recompute()
        assert_identical(updated, snapshot(loaded))


@pytest.mark.parametrize("options", [{}, {"distance": "all", "bounds": "sphere", "correction": "affine"}])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_cut_goes_on_after_loading(tmp_path, dimension, options):
    """Saved in the middle of a cut and loaded beside a cage that was cut anew, coordinates go on with the same bits."""
    kept = bake(dimension, **options)
    kept_cut, cut = oblique_cut(kept.cage), oblique_cut(CAGES[dimension]())
    for depth in (0.2, 0.5):
        kept.update(kept_cut.advance(to=depth * kept_cut.length))
    kept.save(tmp_path / "walks")
    for depth in (0.2, 0.5):
        cut.advance(to=depth * cut.length)
    loaded = HarmonicCoordinates.load(tmp_path / "walks", cut.cage, POINTS[dimension], device="cpu")
    assert_identical(snapshot(loaded), snapshot(kept))
    assert loaded.cage is cut.cage
    follow(loaded, kept, cut, kept_cut)


def test_an_extended_cage_is_loaded(tmp_path):
    """Walks that have come through a gate, where a face was extruded, come back with it."""
    kept = bake()
    edit = kept.cage.extrude(1, 0.4)
    kept.update(edit)
    kept.save(tmp_path / "walks")
    cage = box().extrude(1, 0.4).cage
    loaded = HarmonicCoordinates.load(tmp_path / "walks", cage, POINTS[3])
    assert loaded.domain.gated
    assert_identical(snapshot(loaded), snapshot(kept))
    follow(loaded, kept, middle_cut(cage), middle_cut(kept.cage))


def test_capacities_keys_and_removed_points(tmp_path):
    """Room, points on walls, points without gradients and removed ones are what they were; points can be set then."""
    mask = np.arange(15) % 3 == 0
    points, keys = POINTS[3].copy(), np.full(15, -1)
    below = next(number for number, wall in enumerate(box().walls) if wall.normal[2] == -1.0)
    points[4], keys[4] = [0.3, 0.6, 0.0], 2 * below
    kept = HarmonicCoordinates(
        box(), points, WALKS, gradients=mask, point_keys=keys, point_capacity=20, vertex_capacity=30, device="cpu"
    )
    kept.remove_points([2, 9])
    kept.save(tmp_path / "walks")
    given = points.copy()
    given[[2, 9]] = 77.0
    loaded = HarmonicCoordinates.load(tmp_path / "walks", box(), given)
    assert loaded.memory() == kept.memory()
    assert loaded.weights_array.shape == kept.weights_array.shape == (20, 30)
    np.testing.assert_array_equal(loaded.removed_points, [2, 9])
    for one in (loaded, kept):
        one.set_points([9, 15], POINTS[3][:2])
    follow(loaded, kept, middle_cut(loaded.cage), middle_cut(kept.cage))


def test_no_points(tmp_path):
    """No points are no error."""
    HarmonicCoordinates(box(), np.zeros((0, 3)), WALKS).save(tmp_path / "walks")
    assert HarmonicCoordinates.load(tmp_path / "walks", box(), np.zeros((0, 3))).weights.shape == (0, 8)


@pytest.fixture(scope="module")
def saved(tmp_path_factory) -> Path:
    """A file of a cut cage."""
    coordinates = bake()
    coordinates.update(middle_cut(coordinates.cage).advance(to=0.5))
    path = tmp_path_factory.mktemp("saved") / "walks"
    coordinates.save(path)
    return path


def half_cut_box() -> Cage:
    """The cage of the fixture."""
    cut = middle_cut(box())
    cut.advance(to=0.5)
    return cut.cage


def test_other_cages_are_refused(saved):
    """A cage that is not the one of the file is refused with what differs, and with what to pass instead."""
    other_depth = middle_cut(box())
    other_depth.advance(to=0.6)
    turned = box()
    for cage, text in (
        (box(), r"its cage has \d+ vertices, the given one 8; .*cut\.cage"),
        (other_depth.cage, r"vertex \d+ is \[.*\] in its cage, \[.*\] here"),
        (Cage(turned.vertices[::-1], [[7 - v for v in face] for face in turned.faces]), r"\d+ vertices"),
        (square(), "its cage has dimension 3, the given one 2"),
    ):
        with pytest.raises(ValueError, match=text):
            HarmonicCoordinates.load(saved, cage, POINTS[cage.dimension])


def test_other_faces_are_refused(tmp_path):
    """The same vertices with other faces, or the same faces in another order, are another cage."""
    bake().save(tmp_path / "walks")
    cage = box()
    faces = [cage.faces[1], cage.faces[0], *cage.faces[2:]]
    split = [[*cage.faces[0][:3]], [cage.faces[0][0], *cage.faces[0][2:]], *cage.faces[1:]]
    for other, text in ((faces, r"face 0 is \[.*\] in its cage, \[.*\] here"), (split, "6 faces, the given one 7")):
        with pytest.raises(ValueError, match=text):
            HarmonicCoordinates.load(tmp_path / "walks", Cage(cage.vertices, other), POINTS[3])


def test_other_points_and_options_are_refused(saved):
    """Points elsewhere, more of them, and options other than those of the file are refused by name."""
    cage = half_cut_box()
    moved = POINTS[3].copy()
    moved[11, 1] += 1e-9
    for points, options, error, text in (
        (moved, {}, ValueError, "point 11 lies at .* in it, .* here"),
        (POINTS[3][:14], {}, ValueError, "of 15 points, not 14"),
        (POINTS[3][:, :2], {}, ValueError, r"shape \(n, 3\)"),
        (POINTS[3], {"seed": 6}, ValueError, "its seed is 5, not 6"),
        (POINTS[3], {"epsilon": 1e-3}, ValueError, "its epsilon is 0.0001, not 0.001"),
        (POINTS[3], {"quality": 1}, TypeError, "no option 'quality'; there are walks, seed"),
    ):
        with pytest.raises(error, match=text):
            HarmonicCoordinates.load(saved, cage, points, **options)
    assert HarmonicCoordinates.load(saved, cage, POINTS[3], seed=5, walks=WALKS).walks == WALKS


def test_other_versions_are_refused(saved, tmp_path, monkeypatch):
    """A file of another layout or of another version of the library is refused with both numbers."""
    header, arrays = read_container(saved)
    write_container(tmp_path / "later", {**header, "format": 99}, arrays)
    with pytest.raises(ValueError, match="format is number 99, this library's is 1"):
        HarmonicCoordinates.load(tmp_path / "later", half_cut_box(), POINTS[3])
    monkeypatch.setattr("newton_cagecut.harmonic.cache.storage.__version__", "7.0")
    with pytest.raises(ValueError, match=r"newton_cagecut .* has written it, this is 7\.0"):
        HarmonicCoordinates.load(saved, half_cut_box(), POINTS[3])


@pytest.mark.parametrize("name", ["landing point", "bounds", "weights", "wall corner_1"])
def test_walks_that_do_not_repeat_are_refused(saved, tmp_path, name):
    """A whole file whose numbers do not come out here, as of another processor, is refused."""
    header, arrays = read_container(saved)
    rows = arrays[name]
    changed = np.nextafter(rows, np.float32(9.0)) if rows.dtype == np.float32 else rows - 1
    write_container(tmp_path / "other", header, {**arrays, name: changed})
    with pytest.raises(ValueError, match=r"do not repeat themselves bit for bit .*made on the CPU"):
        HarmonicCoordinates.load(tmp_path / "other", half_cut_box(), POINTS[3])


@settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0.0, 1.0, exclude_max=True), bit=st.integers(0, 7))
def test_damaged_files_are_refused(saved, tmp_path, share, bit):
    """A file of which any bit is another one, or that ends anywhere before its end, is refused before it is read."""
    content = bytearray(saved.read_bytes())
    place = int(share * len(content))
    for damaged in (content[:place], content[:place] + bytes([content[place] ^ (1 << bit)]) + content[place + 1 :]):
        (tmp_path / "damaged").write_bytes(damaged)
        with pytest.raises(ValueError, match=r"damaged.*(no file of harmonic coordinates|cut short or damaged)"):
            HarmonicCoordinates.load(tmp_path / "damaged", half_cut_box(), POINTS[3])


def test_other_files(tmp_path):
    """A file of something else is refused, and a missing one is a missing file."""
    np.savez(tmp_path / "other.npz", weights=np.zeros(3))
    with pytest.raises(ValueError, match="no file of harmonic coordinates"):
        HarmonicCoordinates.load(tmp_path / "other.npz", box(), POINTS[3])
    with pytest.raises(FileNotFoundError):
        HarmonicCoordinates.load(tmp_path / "missing", box(), POINTS[3])


def test_a_save_that_fails_leaves_the_old_file(tmp_path, monkeypatch):
    """Where the disk is full in the middle, the file of before is still there, and nothing else."""
    coordinates = bake()
    coordinates.save(tmp_path / "walks")
    before = (tmp_path / "walks").read_bytes()
    coordinates.update(middle_cut(coordinates.cage).advance(to=0.5))

    def fail(file: object, **arrays: np.ndarray) -> None:
        file.write(b"half")
        raise OSError("no space left")

    monkeypatch.setattr("newton_cagecut.harmonic.cache.container.np.savez", fail)
    with pytest.raises(OSError, match="no space left"):
        coordinates.save(tmp_path / "walks")
    assert [path.name for path in tmp_path.iterdir()] == ["walks"]
    assert (tmp_path / "walks").read_bytes() == before


def test_what_cannot_be_saved(tmp_path):
    """Without walks there is nothing to cut later; coordinates that missed an edit are not those of their domain."""
    with pytest.raises(ValueError, match="cuttable=False"):
        bake(cuttable=False).save(tmp_path / "walks")
    first = bake()
    second = HarmonicCoordinates(first.domain, POINTS[3], WALKS)
    first.update(middle_cut(first.cage).advance(to=0.5))
    with pytest.raises(ValueError, match=r"later cage.*recompute\(\)"):
        second.save(tmp_path / "walks")
    assert not list(tmp_path.iterdir())
