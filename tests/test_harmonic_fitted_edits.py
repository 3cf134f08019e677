# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Fitted coordinates through edits of every kind: an update has the bits of a fit that knows nothing of the past."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import box
from harmonic_shapes import (
    MAKERS,
    assert_identical,
    assert_reproduces,
    crossing_blade,
    interior_points,
    middle_cut,
    random_blade,
    small_obstacle,
)
from newton_cagecut.cage import Cage, CageEdit, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade

COUNT = 24
RANDOM = settings(max_examples=3, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


def bake(cage: Cage, points: np.ndarray, walks: int) -> HarmonicCoordinates:
    """Fitted coordinates, of which every second point has gradients."""
    mask = np.arange(len(points)) % 2 == 0
    return HarmonicCoordinates(cage, points, walks, correction="fitted", quads="harmonic", gradients=mask)


def results(coordinates: HarmonicCoordinates) -> dict[str, np.ndarray]:
    """All that a fit gives."""
    found = {"weights": coordinates.weights, "gradients": coordinates.gradients}
    return found | ({"errors": coordinates.errors} if coordinates.walks else {})


def follow(coordinates: HarmonicCoordinates, points: np.ndarray, *edits: CageEdit) -> None:
    """Bring coordinates up to date and compare with a recompute, and weights with what must hold."""
    for edit in edits:
        coordinates.update(edit)
        updated = results(coordinates)
        coordinates.recompute()
        assert_identical(results(coordinates), updated)
        assert_reproduces(coordinates, points, gradients=False)
        piece = coordinates.cage.piece_of(points)
        assert not coordinates.weights[piece[:, None] != coordinates.cage.vertex_piece].any()


@pytest.mark.parametrize("walks", [0, 4])
@pytest.mark.parametrize(
    "name", ["star", "holed_square", "tetrahedron", "box", pytest.param("merged_cube", marks=pytest.mark.slow)]
)
@RANDOM
@given(seed=st.integers(0, 2**32 - 1))
def test_cuts_that_cross(name, walks, seed):
    """Two cuts in turn, the second across the first, both to their ends or nearly."""
    rng = np.random.default_rng(seed)
    cage = MAKERS[name]()
    points = interior_points(cage, COUNT, rng)
    coordinates = bake(cage, points, walks)
    first = Cut(cage, random_blade(rng, cage))
    edits = [first.advance(to=depth * first.length) for depth in (0.35, rng.choice([0.7, 1.1]))]
    follow(coordinates, points, *edits)
    second = Cut(first.cage, crossing_blade(rng, edits))
    follow(coordinates, points, *(second.advance(to=depth * second.length) for depth in (0.5, rng.choice([0.8, 1.1]))))


@pytest.mark.parametrize("walks", [0, 4])
@pytest.mark.parametrize("kind", ["knife", "inside", "bend"])
def test_blades_of_other_kinds(kind, walks):
    """A knife of finite width, one that starts inside, and a cut that turns."""
    origin, down = [0.5, 0.5, 0.5], [0.0, 0.0, -1.0]
    options = {"knife": {"width": 0.4}, "inside": {"width": 0.4, "start": -0.2}, "bend": {}}
    cage = box()
    points = interior_points(cage, COUNT, np.random.default_rng(0))
    coordinates = bake(cage, points, walks)
    cut = Cut(cage, Blade(origin, [0, 1, 0], down, **options[kind]))
    follow(coordinates, points, cut.advance(to=0.25), cut.advance(to=0.35))
    if kind == "bend":
        cut.turn([0.5, 0.0, -1.0])
        follow(coordinates, points, cut.advance(to=0.6), cut.advance(to=2.0))


@pytest.mark.parametrize("walks", [0, 4])
@pytest.mark.parametrize("name", ["square", "box"])
def test_edits_that_extend_and_cut(name, walks):
    """A face that is moved, an extrusion, an obstacle, and a cut through it all."""
    cage = MAKERS[name]()
    points = interior_points(cage, COUNT, np.random.default_rng(1))
    coordinates = bake(cage, points, walks)
    moved = cage.move_face(1, 0.4)
    extruded = moved.cage.extrude(cage.face_count - 1, 0.3)
    follow(coordinates, points, moved, extruded)
    unit = np.abs(points - 0.5).max(axis=1)
    middle = np.full(cage.dimension, 0.5) if unit.min() > 0.04 else points[unit.argmin()] + 0.05
    inserted = extruded.cage.insert(small_obstacle(MAKERS[name](), middle, 0.04))
    follow(coordinates, points, inserted)
    cut = middle_cut(inserted.cage)
    follow(coordinates, points, *(cut.advance(to=depth * cut.length) for depth in (0.3, 0.6)))


@pytest.mark.parametrize("walks", [0, 4])
def test_undo_and_another_branch(walks):
    """After an undo the bits are those of before, and another cut goes on from there as if nothing had been."""
    cage = MAKERS["star_prism"]()
    points = interior_points(cage, COUNT, np.random.default_rng(2))
    coordinates, cut = bake(cage, points, walks), middle_cut(cage)
    coordinates.update(cut.advance(to=0.3 * cut.length))
    held, before, base = coordinates.snapshot(), results(coordinates), cut.cage
    coordinates.update(cut.advance(to=0.6 * cut.length))
    coordinates.restore(held)
    assert_identical(results(coordinates), before)
    other = Cut(base, Blade(base.vertices.mean(axis=0) + 0.013, [1.0, 0.2, 0.0], [0.0, 0.1, -1.0]))
    follow(coordinates, points, other.advance(to=0.5 * other.length))
    coordinates.restore(held)
    coordinates.recompute()
    assert_identical(results(coordinates), before)


@pytest.mark.parametrize("walks", [0, 4])
def test_points_and_files_in_the_middle_of_a_cut(tmp_path, walks):
    """Points that are moved, added and removed between steps, and a file in between, leave no trace in others' bits."""
    cage = box()
    points = interior_points(cage, 40, np.random.default_rng(3))
    coordinates = HarmonicCoordinates(cage, points[:36], walks, correction="fitted", gradients=True, point_capacity=40)
    cut = middle_cut(cage)
    coordinates.update(cut.advance(to=0.3))
    coordinates.set_points([3, 36, 37], points[[38, 36, 37]])
    coordinates.remove_points([20])
    coordinates.update(cut.advance(to=0.5))
    path = tmp_path / "middle.cagecut"
    coordinates.save(path)
    rest = np.concatenate([points[:3], points[38:39], points[4:38]])
    loaded = HarmonicCoordinates.load(path, coordinates.cage, rest)
    edit = cut.advance(to=0.7)
    coordinates.update(edit)
    loaded.update(edit)
    assert_identical(results(loaded), results(coordinates))
    updated = results(coordinates)
    coordinates.recompute()
    assert_identical(results(coordinates), updated)
