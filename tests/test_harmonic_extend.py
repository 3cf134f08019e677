# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Faces that move outward and obstacles: walks resume or are walked again, and the weights are those of a recompute."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box
from harmonic_shapes import (
    MAKERS,
    UNITS,
    assert_identical,
    assert_reproduces,
    assert_unbiased,
    by_copy,
    copies,
    crossing_blade,
    interior_points,
    multilinear,
    random_blade,
    small_obstacle,
    snapshot,
)
from newton_cagecut.cage import Cage, CageEdit, Cut
from newton_cagecut.harmonic import HarmonicCoordinates, UpdateStats
from newton_cagecut.section import Blade
from plane_shapes import outline, rectangle

FACES = {"box": (0, 3), "hexagonal_prism": (3, 1), "merged_cube": (4, 7), "square": (1, 2), "star": (3, 6)}


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


@pytest.mark.parametrize(("name", "face"), [("star", 3), ("merged_cube", 4)])
def test_grid_and_all_walls_agree_on_gates(name, face):
    """The candidate grid leaves no wall out that a walk meets behind a gate."""
    cage = MAKERS[name]()
    points = interior_points(cage, 30, np.random.default_rng(2))
    by_grid, by_all = (bake(cage, points, distance=distance) for distance in ("grid", "all"))
    edit = cage.extrude(face, 0.4)
    blade = crossing_blade(np.random.default_rng(3), [edit])
    cut = Cut(edit.cage, blade)
    for step in (edit, cut.advance(to=0.5 * cut.length)):
        by_grid.update(step)
        by_all.update(step)
        assert_identical(snapshot(by_grid), snapshot(by_all))


@pytest.mark.parametrize("make", [lambda: outline(rectangle((0, 0), (1, 0.7))), lambda: box((1.0, 1.0, 0.7))])
def test_a_gate_is_no_bias(make):
    """A box that grew out of a smaller one has its exact multilinear weights, to a few standard errors."""
    small = make()
    points = interior_points(small, 12, np.random.default_rng(4))
    edit = small.move_face(last_face(small), 0.6)
    # Controls of degree 1 leave noise in a rectangle, whose weights are polynomials of degree 2.
    coordinates = bake(small, np.repeat(points, 16, axis=0), 512, quads="harmonic", degree=1)
    assert coordinates.update(edit).resumed > 0
    for estimates, exact in zip((coordinates.weights, coordinates.gradients), multilinear(edit.cage, points)):
        assert_unbiased(by_copy(estimates, 16), exact)


@pytest.mark.parametrize("name", ["star", "star_prism"])
def test_extended_weights_agree_with_a_fresh_bake(name):
    """Weights behind an extruded face of a star are those of the extended cage baked anew, to their errors."""
    cage = MAKERS[name]()
    points = interior_points(cage, 16, np.random.default_rng(5))
    edit = cage.extrude(2, 0.5)
    updated = HarmonicCoordinates(cage, np.repeat(points, 16, axis=0), 512)
    updated.update(edit)
    difference = by_copy(updated.weights, 16) - copies(edit.cage, points, 512, 16, seed=1)[0]
    assert_unbiased(difference, np.zeros_like(difference[0]))


@pytest.mark.parametrize("name", UNITS)
def test_obstacles(name):
    """An obstacle is felt at once, by walks again; blades go through it and the weights stay those of a recompute."""
    rng = np.random.default_rng(6)
    cage = MAKERS[name]()
    obstacle = small_obstacle(cage, np.array([0.425, 0.525, 0.525])[: cage.dimension], 0.25)
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
    directions = {2: ([0.1, -1.0],), 3: ([0.2, 1.0, 0.1], [0.1, 0.1, -1.0])}[cage.dimension]
    cut = Cut(edit.cage, Blade(middle, *directions))
    for part in (0.3, 0.7, 1.1):
        follow(coordinates, cut.advance(to=part * cut.length))
    assert_reproduces(coordinates, points)


@pytest.mark.parametrize("name", UNITS)
def test_an_obstacle_covers_no_points(name):
    """An obstacle that covers points is refused by name, and nothing has changed."""
    cage = MAKERS[name]()
    points = np.array([[0.2, 0.2, 0.2], [0.4, 0.5, 0.5], [0.8, 0.8, 0.8]])[:, : cage.dimension]
    coordinates = bake(cage, points)
    before = snapshot(coordinates)
    edit = coordinates.cage.insert(small_obstacle(cage, np.array([0.425, 0.525, 0.525])[: cage.dimension], 0.25))
    with pytest.raises(ValueError, match=r"obstacle covers 1 of 3 points, such as point 1 at"):
        coordinates.update(edit)
    assert_identical(before, snapshot(coordinates))
    assert coordinates.cage is edit.before


@pytest.mark.parametrize("name", UNITS)
def test_points_on_a_wall_that_retires_are_inside(name):
    """A point on the face that is extruded becomes one like those beside it."""
    cage = MAKERS[name]()
    top = last_face(cage)
    points = np.array([[0.4, 0.6, 1.0], [0.5, 0.5, 0.5]])[:, 3 - cage.dimension :]
    coordinates = bake(cage, points, 512, point_keys=np.array([2 * cage.face_wall[top], -1]))
    follow(coordinates, cage.extrude(top, 0.5))
    assert np.count_nonzero(coordinates.weights[0]) > cage.vertex_count
    assert_reproduces(coordinates, points)


@pytest.mark.parametrize("name", UNITS)
def test_too_many_extensions(name):
    """The walks tell 31 gates apart; one more is refused before anything changes."""
    cage = MAKERS[name]()
    points = interior_points(cage, 3, np.random.default_rng(7))
    coordinates = HarmonicCoordinates(cage, points, 8)
    top = last_face(cage)
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


def last_face(cage: Cage) -> int:
    """The face of a box or a rectangle that lies across the last axis at its end."""
    return int(np.argmax([wall.normal[-1] for wall in cage.walls]))
