# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Bounds of walks: every kind holds every sphere, in both dimensions, and never lets a walk off that meets a piece."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st

from cage_shapes import box
from harmonic_shapes import DEVICES, assert_identical, interior_points, random_blade, snapshot
from newton_cagecut.cage import Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.harmonic.walks.bounds import BOUNDS, make_bounds
from newton_cagecut.harmonic.walks.bounds.kind import BoundsKind
from newton_cagecut.section import Blade
from plane_shapes import square

KINDS = [(kind, dimension) for dimension in (2, 3) for kind in BOUNDS]
BYTES = {"dop18": (16, 36), "dop26": (16, 26), "aabb": (8, 12), "sphere": (6, 8)}
SIDES = np.eye(3)
DIAGONALS = np.array([[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]], dtype=np.float64)
CORNERS = np.array([[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]]) * (2.0 / 3.0)
RANDOM = settings(max_examples=25, deadline=None, derandomize=True, database=None)
SEEDS = st.integers(0, 2**32 - 1)
SCALES = st.sampled_from([1e-3, 0.3, 1.0, 4.0, 100.0])


@dataclass
class Bounded:
    """What a kind makes of walks of spheres, a row a walk."""

    stored: np.ndarray
    held: np.ndarray
    merged: np.ndarray
    flagged: np.ndarray


@cache
def make_probe(kind: BoundsKind) -> wp.Kernel:
    """A kernel that bounds walks whole, and as two parts that are merged, and tests them against pieces."""

    @wp.kernel(enable_backward=False, module="unique")
    def probe(
        spheres: wp.array2d[wp.vec4],
        split: int,
        pieces: kind.PieceBounds,
        levels: wp.array2d[kind.level_type],
        merged: wp.array2d[kind.level_type],
        held: wp.array[kind.Extents],
        flagged: wp.array[wp.int32],
    ):
        walk = wp.tid()
        whole = kind.empty()
        first = kind.empty()
        second = kind.empty()
        for step in range(spheres.shape[1]):
            sphere = spheres[walk, step]
            x = wp.vec3(sphere[0], sphere[1], sphere[2])
            whole = kind.extend(whole, x, sphere[3])
            if step < split:
                first = kind.extend(first, x, sphere[3])
            else:
                second = kind.extend(second, x, sphere[3])
        kind.store(levels, walk, kind.quantize(whole))
        kind.store(merged, walk, kind.merge(kind.quantize(first), kind.quantize(second)))
        held[walk] = kind.dequantize(kind.load(levels, walk))
        if int(levels[pieces.first_component, walk]) <= pieces.first_limit:
            if kind.overlaps_any(levels, walk, pieces):
                flagged[walk] = 1

    return probe


def bound(kind: BoundsKind, spheres: np.ndarray, polygons: list[np.ndarray], split: int = 2) -> Bounded:
    """Bound walks, shape (walk_count, step_count, 4), and test them against pieces."""
    device, count = wp.get_device("cpu"), len(spheres)
    pieces = kind.bound_pieces(polygons, [directions_of(polygon) for polygon in polygons], device)
    levels, merged = kind.empty_levels(count, device), kind.empty_levels(count, device)
    held = wp.zeros(count, dtype=kind.Extents, device=device)
    flagged = wp.zeros(count, dtype=wp.int32, device=device)
    rows = wp.array(spheres.astype(np.float32), dtype=wp.vec4, device=device)
    wp.launch(make_probe(kind), dim=count, inputs=[rows, split, pieces, levels, merged, held, flagged], device=device)
    stored, merged = (array.numpy().T for array in (levels, merged))
    return Bounded(stored, held.numpy().astype(np.float64), merged, flagged.numpy().astype(bool))


def directions_of(polygon: np.ndarray) -> np.ndarray:
    """A piece's normal and a direction across it; of a segment in the plane, its normal and its own direction."""
    along = polygon[1] - polygon[0]
    if len(polygon) == 2:
        rows = np.stack([np.cross(along, [0.0, 0.0, 1.0]), along])
    else:
        normal = np.cross(along, polygon[2] - polygon[0])
        rows = np.stack([normal, np.cross(normal, along)])
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def random_walks(rng: np.random.Generator, dimension: int, scale: float, count: int = 40, steps: int = 6) -> np.ndarray:
    """Spheres about places within a scale, some far larger than others, as in float32; shape (count, steps, 4)."""
    spheres = np.zeros((count, steps, 4))
    spheres[..., :dimension] = rng.uniform(-scale, scale, (count, 1, dimension))
    spheres[..., :dimension] += rng.normal(size=(count, steps, dimension)) * scale * rng.uniform(0, 0.5, (count, 1, 1))
    spheres[..., 3] = scale * 10.0 ** rng.uniform(-5.0, 0.0, (count, steps))
    return spheres.astype(np.float32).astype(np.float64)


def axes_of(kind: str, dimension: int) -> np.ndarray:
    """The axes of a DOP, shape (axis_count, 3)."""
    sides, diagonals = (SIDES[:2], DIAGONALS[:2]) if dimension == 2 else (SIDES, DIAGONALS)
    if kind == "aabb":
        return sides
    if kind == "dop26" and dimension == 3:
        return np.concatenate([2.0 * sides, diagonals, CORNERS])
    return np.concatenate([sides, diagonals])


@pytest.mark.parametrize(("name", "dimension"), KINDS)
@RANDOM
@given(seed=SEEDS, scale=SCALES)
def test_every_sphere_is_inside(name, dimension, seed, scale):
    """What is stored holds every sphere of a walk, in and far outside of the range that is quantised."""
    spheres = random_walks(np.random.default_rng(seed), dimension, scale)
    held = bound(make_bounds(name, dimension), spheres, []).held
    x, radius = spheres[..., :3], spheres[..., 3]
    if name == "sphere":
        reach = np.linalg.norm(x - held[:, None, :3], axis=2) + radius
        assert (reach <= held[:, 3, None]).all()
        return
    axes = axes_of(name, dimension)
    values, radii = x @ axes.T, radius[..., None] * np.linalg.norm(axes, axis=1)
    assert (values - radii >= held[:, None, : len(axes)]).all()
    assert (values + radii <= -held[:, None, len(axes) :]).all()


@pytest.mark.parametrize(("name", "dimension"), KINDS)
def test_bounds_are_tight(name, dimension):
    """Within the range, a DOP is at most two and a half levels larger than what it holds, a sphere at most twice."""
    spheres = random_walks(np.random.default_rng(1), dimension, 0.4)
    held = bound(make_bounds(name, dimension), spheres, []).held
    x, radius = spheres[..., :3], spheres[..., 3]
    if name == "sphere":  # of one growth after another: not the least sphere, but about as large as the walk
        size = (np.linalg.norm(x - x.mean(axis=1, keepdims=True), axis=2) + radius).max(axis=1)
        assert (held[:, 3] < 2.0 * size).all()
        return
    axes = axes_of(name, dimension)
    quantum = 4.5 / (255 if (name, dimension) == ("dop26", 3) else 65535)
    low = (x @ axes.T - radius[..., None] * np.linalg.norm(axes, axis=1)).min(axis=1)
    assert (low - held[:, : len(axes)] < 2.5 * quantum).all()


@pytest.mark.parametrize(("name", "dimension"), KINDS)
@RANDOM
@given(seed=SEEDS, scale=SCALES, split=st.integers(0, 6))
def test_merged_parts_are_the_whole(name, dimension, seed, scale, split):
    """Merging the bounds of two parts of a walk gives a DOP of the whole, bit for bit, and a sphere that holds both."""
    spheres = random_walks(np.random.default_rng(seed), dimension, scale)
    kind = make_bounds(name, dimension)
    bounded = bound(kind, spheres, [], split)
    if name != "sphere":
        np.testing.assert_array_equal(bounded.merged, bounded.stored)
        return
    merged = bounded.merged.astype(np.float64) * (4.5 / 65535.0)
    reach = np.linalg.norm(spheres[..., :dimension] - (merged[:, None, :-1] - 2.25), axis=2) + spheres[..., 3]
    endless = bounded.merged[:, -1] == 65535
    assert (endless[:, None] | (reach <= merged[:, -1:])).all()


@pytest.mark.parametrize(("name", "dimension"), KINDS)
@RANDOM
@given(seed=SEEDS, scale=SCALES)
def test_a_touched_piece_is_never_missed(name, dimension, seed, scale):
    """A walk is flagged where a piece only just touches one of its spheres, or reaches anywhere into one."""
    rng = np.random.default_rng(seed)
    spheres = random_walks(rng, dimension, scale)
    x, radius = spheres[7, 3, :3], spheres[7, 3, 3]
    outward = np.zeros(3)
    outward[:dimension] = rng.normal(size=dimension)
    outward /= np.linalg.norm(outward)
    touched = x + radius * (1.0 - 1e-7) * outward
    across = np.linalg.svd(np.concatenate([outward[None], np.eye(3)[dimension:]]))[2][4 - dimension :]
    size = scale * 10.0 ** rng.uniform(-4.0, 0.0)
    if dimension == 2:
        polygon = touched + size * np.outer([-rng.uniform(), rng.uniform()], across[0])
    else:
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, 3)) + np.arange(3)
        ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        polygon = touched + size * (ring - rng.dirichlet((1.0, 1.0, 1.0)) @ ring) @ across
    bounded = bound(make_bounds(name, dimension), spheres, [polygon + 50.0 * scale, polygon])
    assert bounded.flagged[7]
    inside = polygon.mean(axis=0)
    met = (np.linalg.norm(spheres[..., :3] - inside, axis=2) <= spheres[..., 3]).any(axis=1)
    assert bounded.flagged[met].all()


@pytest.mark.parametrize(("name", "dimension"), KINDS)
def test_walks_far_from_pieces_are_let_off(name, dimension):
    """A walk that does not come near a piece is kept; a walk of no sphere meets nothing, and no piece is met."""
    spheres = random_walks(np.random.default_rng(2), dimension, 0.1)
    polygon = np.array([[0.9, 0.9, 0.0], [0.95, 0.9, 0.0], [0.9, 0.97, 0.0]])[:dimension]
    kind = make_bounds(name, dimension)
    assert not bound(kind, spheres, [polygon]).flagged.any()
    assert not bound(kind, spheres[:, :0], [polygon - polygon.mean(axis=0)]).flagged.any()
    assert not bound(kind, spheres, []).flagged.any()
    assert bound(kind, spheres, [polygon - polygon.mean(axis=0) + spheres[3, 0, :3]]).flagged[3]


@pytest.mark.parametrize("name", BOUNDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_bytes_of_a_walk(name, dimension):
    """With everything that updates need, a walk takes at most 64 bytes in space and 36 in the plane."""
    kind = make_bounds(name, dimension)
    assert kind.byte_count == BYTES[name][dimension - 2]
    cage = square() if dimension == 2 else box()
    points = interior_points(cage, 5, np.random.default_rng(0))
    memory = HarmonicCoordinates(cage, points, 8, bounds=name, device="cpu").memory()
    assert memory["bounds"] == 5 * 8 * kind.byte_count
    assert memory["bounds"] + memory["landings"] <= 5 * 8 * (36 if dimension == 2 else 64)


def test_unknown_bounds_are_refused():
    """A kind that there is not is refused with those that there are."""
    with pytest.raises(ValueError, match=r"dop18, dop26, aabb, sphere, not 'obb'"):
        make_bounds("obb", 3)


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize(("name", "dimension"), KINDS)
def test_updates_equal_recomputes(name, dimension, device):
    """Whatever bounds walks, an update is a recompute bit for bit, and gives what every other kind gives.

    The second cut goes exactly through where a walk has landed; the blades are oblique.
    """
    rng = np.random.default_rng(dimension)
    cage = square() if dimension == 2 else box((1.0, 0.9, 0.8))
    points = interior_points(cage, 25, rng)
    coordinates, other = (
        HarmonicCoordinates(cage, points, 24, seed=7, gradients=True, bounds=kind, device=device)
        for kind in (name, "dop18")
    )
    first = Cut(cage, random_blade(rng, cage))
    landing = coordinates.landings["point"][77, :dimension]
    origin = coordinates.domain.frame.center + coordinates.domain.frame.half_side * landing
    steps = [(first, depth * first.length) for depth in (0.3, 0.7)]
    for cut, depth in steps:
        follow(coordinates, other, cut, depth)
    second = Cut(first.cage, Blade(origin, *rng.normal(size=(dimension - 1, dimension))))
    for depth in (0.4, 1.1):
        follow(coordinates, other, second, depth * second.length)


def follow(coordinates: HarmonicCoordinates, other: HarmonicCoordinates, cut: Cut, depth: float) -> None:
    """Advance a cut; compare an update with a recompute, and with coordinates of other bounds."""
    edit = cut.advance(to=depth)
    stats = coordinates.update(edit)
    other.update(edit)
    updated = snapshot(coordinates)
    coordinates.recompute()
    assert_identical(updated, snapshot(coordinates))
    assert 0 < stats.rewalked < stats.walk_count
    expected = snapshot(other)
    for rows in (updated, expected):
        del rows["bounds"]
    assert_identical(updated, expected)
