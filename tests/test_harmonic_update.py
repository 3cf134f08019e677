# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""An update equals the full recompute, bit for bit, whatever is cut and however."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import box
from harmonic_shapes import (
    DEVICES,
    MAKERS,
    UNITS,
    assert_identical,
    assert_reproduces,
    crossing_blade,
    interior_points,
    middle_cut,
    random_blade,
    snapshot,
)
from newton_cagecut.cage import Cage, CageEdit, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from plane_shapes import outline, rectangle

RANDOM = settings(
    max_examples=6, deadline=None, derandomize=True, database=None, suppress_health_check=[HealthCheck.too_slow]
)


def bake(cage: Cage, points: np.ndarray, walks: int = 64, device: str = "cpu") -> HarmonicCoordinates:
    """Coordinates with gradients."""
    return HarmonicCoordinates(cage, points, walks, seed=7, gradients=True, device=device)


def follow(coordinates: HarmonicCoordinates, cut: Cut, depths: np.ndarray) -> list[CageEdit]:
    """Advance a cut and assert at every step that the update equals the recompute."""
    edits = []
    for depth in depths:
        edit = cut.advance(to=depth)
        stats = coordinates.update(edit)
        assert stats.walk_count == stats.rewalked + stats.on_face + stats.reused
        updated = snapshot(coordinates)
        coordinates.recompute()
        assert_identical(updated, snapshot(coordinates))
        edits.append(edit)
    return edits


@pytest.mark.parametrize("name", ["square", "holed_square", "star", "tetrahedron", "box", "merged_cube"])
@RANDOM
@given(seed=st.integers(0, 2**32 - 1))
def test_update_equals_recompute(name, seed):
    """Two random cuts, the second through the first, in random steps; some points next to the walls."""
    rng = np.random.default_rng(seed)
    cage = MAKERS[name]()
    points = interior_points(cage, 40, rng)
    coordinates = bake(cage, points)
    first = Cut(cage, random_blade(rng, cage))
    edits = follow(coordinates, first, np.sort(rng.uniform(0.2, 1.1, 3)) * first.length)
    second = Cut(first.cage, crossing_blade(rng, edits))
    later = follow(coordinates, second, np.array([*np.sort(rng.uniform(0.1, 1.0, 2)), 1.1]) * second.length)
    crossed = {2 * first.wall, 2 * first.wall + 1}
    assert any(crossed <= set(edit.changed_keys.tolist()) for edit in later)
    assert_reproduces(coordinates, points)


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("name", UNITS)
def test_devices(name, device):
    """The identity holds on every device that there is."""
    rng = np.random.default_rng(3)
    cage = MAKERS[name]()
    coordinates = bake(cage, interior_points(cage, 60, rng), device=device)
    cut = Cut(cage, random_blade(rng, cage))
    follow(coordinates, cut, np.linspace(0.1, 1.1, 5) * cut.length)


NORMALS = [[1.0, 0.0], [0.6, 0.8], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.3, -0.5, 0.8]]


@pytest.mark.parametrize("normal", NORMALS)
@pytest.mark.parametrize("target", ["landing", "query point", "front at a landing", "edge"])
def test_adversarial_blades(target, normal):
    """A blade whose plane or front passes exactly through a landing or a query point, or runs along an edge."""
    rng = np.random.default_rng(11)
    size = np.array([1.0, 0.9, 0.8][: len(normal)])
    cage = outline(rectangle((0.0, 0.0), size)) if len(normal) == 2 else box(size)
    points = interior_points(cage, 30, rng)
    coordinates = bake(cage, points)
    landing = coordinates.domain.frame.center + coordinates.domain.frame.half_side * coordinates.landings["point"][777]
    origin = {"query point": points[3], "edge": cage.vertices[0]}.get(target, landing)
    along = cage.vertices[1] - cage.vertices[0] if target == "edge" else None
    cut = Cut(cage, Blade(origin, *_directions(np.array(normal), along)))
    depths = np.linspace(0.25, 1.1, 4) * cut.length
    if target == "front at a landing":
        reached = cut.plane.coordinates(origin[None])[0, 1] - cut.section.node_coordinates[:, 1].min()
        depths = reached + np.array([-1e-6, 0.0, 1e-6, 0.1]) * cut.length
        assert depths[0] > 0.0
    follow(coordinates, cut, depths)


def _directions(normal: np.ndarray, along: np.ndarray | None) -> list[np.ndarray]:
    """A blade's edge, if it has one, and its direction, across a normal; or along an edge, with no regard to that."""
    if len(normal) == 2:
        return [np.array([-normal[1], normal[0]]) if along is None else along]
    if along is not None:
        return [along, np.cross([0.1, 0.2, 0.97], along)]
    edge = np.cross(normal, [0.1, 0.2, 0.97])
    return [edge, np.cross(normal, edge)]


@pytest.mark.parametrize("name", UNITS)
def test_front_through_query_points(name):
    """Points exactly on the plane of the cut, met by its front one after the other, keep finite exact weights."""
    cage = MAKERS[name]()
    heights = np.linspace(0.05, 0.95, 10)
    points = np.c_[np.full(10, 0.47), np.linspace(0.1, 0.9, 10), heights]
    points = np.delete(points, np.arange(1, 4 - cage.dimension), axis=1)
    coordinates = bake(cage, points, walks=32)
    follow(coordinates, middle_cut(cage), np.array([*(1.0 - heights[::-1]), 1.1]))
    assert np.isfinite(coordinates.weights).all()
    assert np.isfinite(coordinates.gradients).all()
    assert_reproduces(coordinates, points, gradients=False)


@pytest.mark.parametrize("name", UNITS)
def test_step_by_step_is_one_step(name):
    """Twenty small steps and one large step give weights of the same walls: equal up to where walls are split."""
    rng = np.random.default_rng(5)
    cage = MAKERS[name]()
    points = interior_points(cage, 20, rng)
    blade = Blade(
        *{2: ([0.5, 0.5], [0.3, -1.0]), 3: ([0.5, 0.4, 0.5], [0.2, 1.0, 0.1], [0.0, 0.3, -1.0])}[cage.dimension]
    )
    many, one = bake(cage, points, 256), bake(cage, points, 256)
    cut = Cut(cage, blade)
    for depth in np.linspace(0.0, 0.6, 21)[1:]:
        many.update(cut.advance(to=depth))
    one.update(Cut(cage, blade).advance(to=0.6))
    same = np.abs(many.landings["point"] - one.landings["point"]).max(axis=1) < 1e-4
    assert same.mean() > 0.98
    np.testing.assert_allclose(many.weights, one.weights, atol=0.02)


@pytest.mark.parametrize("name", UNITS)
def test_empty_edit(name):
    """A blade that misses the cage changes nothing and walks nothing."""
    cage = MAKERS[name]()
    coordinates = bake(cage, interior_points(cage, 10, np.random.default_rng(0)))
    before = snapshot(coordinates)
    missing = Blade(5.0 + np.zeros(cage.dimension), *np.eye(cage.dimension)[1:])
    stats = coordinates.update(Cut(cage, missing).advance(to=3.0))
    assert (stats.rewalked, stats.on_face, stats.resolved_points) == (0, 0, 0)
    assert_identical(before, snapshot(coordinates))
