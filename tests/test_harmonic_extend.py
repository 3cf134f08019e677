# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Faces that move outward and obstacles: walks resume or are walked again, and the weights are those of a recompute."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import SHAPES, box, prism, voxels
from harmonic_shapes import (
    assert_identical,
    assert_reproduces,
    crossing_blade,
    interior_points,
    random_blade,
    snapshot,
    trilinear,
)
from newton_cagecut.cage import Blade, Cage, CageEdit, Cut
from newton_cagecut.harmonic import HarmonicCoordinates, UpdateStats
from plane_shapes import PLANES, outline, rectangle, square

FACES = {"box": (0, 3), "hexagonal_prism": (3, 1), "merged_cube": (4, 7), "square": (1, 2), "star": (3, 6)}
MAKERS = {**SHAPES, **PLANES}


def bake(cage: Cage, points: np.ndarray, walks: int = 64, **options) -> HarmonicCoordinates:
    """Coordinates with gradients."""
    return HarmonicCoordinates(cage, points, walks, seed=7, gradients=True, **options)


def follow(coordinates: HarmonicCoordinates, edit: CageEdit) -> UpdateStats:
    """Update and assert that a recompute changes no bit."""
    stats = coordinates.update(edit)
    updated = snapshot(coordinates)
    coordinates.recompute()
    assert_identical(updated, snapshot(coordinates))
    return stats


@pytest.mark.parametrize("bounds", ["dop18", "sphere"])
@pytest.mark.parametrize("name", FACES)
def test_resumed_walks_are_those_of_a_recompute(name, bounds):
    """Two faces are extruded, one after the other, then a blade goes through all of it: the same bits at every step."""
    rng = np.random.default_rng(1)
    cage = MAKERS[name]()
    points = interior_points(cage, 30, rng)
    coordinates = bake(cage, points, bounds=bounds)
    first = cage.extrude(FACES[name][0], 0.3 * cage.diameter)
    stats = follow(coordinates, first)
    assert stats.resumed > 0
    assert stats.walk_count == stats.resumed + stats.rewalked + stats.on_face + stats.reused
    second = first.cage.extrude(FACES[name][1], 0.2 * cage.diameter)
    assert follow(coordinates, second).resumed > 0
    cut = Cut(second.cage, random_blade(rng, second.cage))
    edits = [cut.advance(to=part * cut.length) for part in (0.4, 1.1)]
    for edit in edits:
        follow(coordinates, edit)
    assert_reproduces(coordinates, points)


def test_grid_and_all_walls_agree_on_gates():
    """The candidate grid leaves no wall out that a walk meets behind a gate."""
    cage = SHAPES["merged_cube"]()
    points = interior_points(cage, 30, np.random.default_rng(2))
    by_grid, by_all = (bake(cage, points, distance=distance) for distance in ("grid", "all"))
    edit = cage.extrude(4, 0.4)
    blade = crossing_blade(np.random.default_rng(3), [edit])
    cut = Cut(edit.cage, blade)
    for step in (edit, cut.advance(to=0.5 * cut.length)):
        by_grid.update(step)
        by_all.update(step)
        assert_identical(snapshot(by_grid), snapshot(by_all))


def test_a_gate_is_no_bias():
    """A box that grew out of a smaller one has its exact trilinear weights, to a few standard errors over seeds."""
    small = voxels([(0, 0, 0)], np.array([1.0, 1.0, 0.7]))
    points = interior_points(small, 12, np.random.default_rng(4))
    top = int(np.argmax([wall.normal[2] for wall in small.walls]))
    edit = small.move_face(top, 0.6)
    exact, slope = trilinear(edit.cage, points)
    errors, slopes = [], []
    for seed in range(8):
        coordinates = HarmonicCoordinates(small, points, 512, seed=seed, gradients=True, quads="harmonic")
        assert coordinates.update(edit).resumed > 0
        errors.append(coordinates.weights - exact)
        slopes.append(coordinates.gradients - slope)
    for values in (np.array(errors), np.array(slopes)):
        spread = values.std(axis=0, ddof=1)
        resolved = spread > 1e-6
        score = values.mean(axis=0)[resolved] / (spread[resolved] / np.sqrt(len(values)))
        assert 0.7 < np.sqrt(np.mean(score**2)) < 1.6  # Student's t of 7 degrees of freedom: 1.18


def test_extended_weights_agree_with_a_fresh_bake():
    """Weights behind an extruded face of a star are those of the extended cage baked anew, to their errors."""
    cage = SHAPES["star_prism"]()
    points = interior_points(cage, 16, np.random.default_rng(5))
    edit = cage.extrude(2, 0.5)
    difference = []
    for seed in range(6):
        updated = HarmonicCoordinates(cage, points, 512, seed=seed)
        updated.update(edit)
        fresh = HarmonicCoordinates(edit.cage, points, 512, seed=100 + seed, cuttable=False)
        difference.append(updated.weights - fresh.weights)
    spread = np.std(difference, axis=0, ddof=1)
    resolved = spread > 1e-5
    score = np.mean(difference, axis=0)[resolved] / (spread[resolved] / np.sqrt(len(difference)))
    assert 0.7 < np.sqrt(np.mean(score**2)) < 1.7  # Student's t of 5 degrees of freedom: 1.29


@pytest.mark.parametrize("dimension", [2, 3])
def test_obstacles(dimension):
    """An obstacle is felt at once, by walks again; blades go through it and the weights stay those of a recompute."""
    rng = np.random.default_rng(6)
    cage, obstacle = (square(), _small_square()) if dimension == 2 else (box(), _small_box())
    points = interior_points(cage, 60, rng)
    points = points[~obstacle.contains(points)]
    coordinates = bake(cage, points)
    before = coordinates.weights
    edit = cage.insert(obstacle)
    stats = follow(coordinates, edit)
    assert stats.rewalked > 0
    assert stats.resumed == 0
    assert np.abs(coordinates.weights[:, : cage.vertex_count] - before).max() > 0.05
    assert coordinates.weights[:, cage.vertex_count :].sum() > 0.5
    middle = obstacle.vertices.mean(axis=0)
    blade = Blade(middle, [0.1, -1.0]) if dimension == 2 else Blade(middle, [0.2, 1.0, 0.1], [0.1, 0.1, -1.0])
    cut = Cut(edit.cage, blade)
    for part in (0.3, 0.7, 1.1):
        follow(coordinates, cut.advance(to=part * cut.length))
    assert_reproduces(coordinates, points)


def test_an_obstacle_covers_no_points():
    """An obstacle that covers points is refused by name, and nothing has changed."""
    points = np.array([[0.2, 0.2, 0.2], [0.4, 0.5, 0.5], [0.8, 0.8, 0.8]])
    coordinates = bake(box(), points)
    before = snapshot(coordinates)
    edit = coordinates.cage.insert(_small_box())
    with pytest.raises(ValueError, match=r"obstacle covers 1 of 3 points, such as point 1 at"):
        coordinates.update(edit)
    assert_identical(before, snapshot(coordinates))
    assert coordinates.cage is edit.before


def test_points_on_a_wall_that_retires_are_inside():
    """A point on the face that is extruded becomes one like those beside it."""
    cage = box()
    top = int(np.argmax([wall.normal[2] for wall in cage.walls]))
    points = np.array([[0.4, 0.6, 1.0], [0.5, 0.5, 0.5]])
    coordinates = bake(cage, points, 512, point_keys=np.array([2 * cage.face_wall[top], -1]))
    follow(coordinates, cage.extrude(top, 0.5))
    assert np.count_nonzero(coordinates.weights[0]) > 8
    assert_reproduces(coordinates, points)


def test_too_many_extensions():
    """The walks tell 31 gates apart; one more is refused before anything changes."""
    cage = prism(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float))
    points = interior_points(cage, 3, np.random.default_rng(7))
    coordinates = HarmonicCoordinates(cage, points, 8)
    top = int(np.argmax([wall.normal[2] for wall in cage.walls]))
    for _ in range(31):
        edit = coordinates.cage.move_face(top, 0.1)
        coordinates.update(edit)
    before = snapshot_without_gradients(coordinates)
    with pytest.raises(ValueError, match="extended 31 times"):
        coordinates.update(edit.cage.move_face(top, 0.1))
    assert_identical(before, snapshot_without_gradients(coordinates))


def snapshot_without_gradients(coordinates: HarmonicCoordinates) -> dict[str, np.ndarray]:
    """Weights and landings."""
    return {"weights": coordinates.weights, **coordinates.landings}


def _small_square() -> Cage:
    return outline(rectangle((0.3, 0.4), (0.55, 0.65)))


def _small_box() -> Cage:
    cage = box((0.25, 0.25, 0.25))
    return Cage(cage.vertices + [0.3, 0.4, 0.4], cage.faces)
