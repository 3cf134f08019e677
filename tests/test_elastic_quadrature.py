# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the quadrature points, in the plane and in space."""

import itertools
import math
import time
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import cKDTree

import newton_cagecut as cagecut
from cage_shapes import box, voxels
from newton_cagecut.cage import boundary_distances
from newton_cagecut.elastic import sample_quadrature
from newton_cagecut.elastic.quadrature.dense import dense_inside
from newton_cagecut.geometry import simplex_distances
from newton_cagecut.solver.body.body_quadrature import BodyQuadrature
from plane_shapes import PLANES, square

QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
BOX_SIMPLICES = {
    2: np.array([[0, 2], [2, 3], [3, 1], [1, 0]]),
    3: np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]]),
}


def make_box(low, high):
    """A box, or a rectangle, with all that the sampling needs of a cage."""
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    corners = np.stack(np.meshgrid(*[(0, 1)] * len(low), indexing="ij"), axis=-1).reshape(-1, len(low))
    return SimpleNamespace(
        low=low,
        high=high,
        vertices=low + corners * (high - low),
        simplices=BOX_SIMPLICES[len(low)],
        volume=float(np.prod(high - low)),
        contains=lambda points: np.all((points > low) & (points < high), axis=1),
    )


def merge(*boxes):
    """A cage of several boxes that do not touch."""
    offsets = np.cumsum([0] + [len(b.vertices) for b in boxes])
    return SimpleNamespace(
        vertices=np.concatenate([b.vertices for b in boxes]),
        simplices=np.concatenate([b.simplices + o for b, o in zip(boxes, offsets)]),
        volume=sum(b.volume for b in boxes),
        contains=lambda points: np.any([b.contains(points) for b in boxes], axis=0),
    )


def mean_spacing(cage, count):
    """The side of a point's share of a cage."""
    return (cage.volume / count) ** (1.0 / cage.vertices.shape[1])


BOX = make_box([10.0, -3.0, 0.0], [10.5, -2.0, 2.0])
RECTANGLE = make_box([10.0, -3.0], [10.5, -2.0])
both_dimensions = pytest.mark.parametrize("cage", [RECTANGLE, BOX], ids=["2d", "3d"])


@both_dimensions
@pytest.mark.parametrize("count", [8, 40, 300])
def test_count_volume_and_margin(cage, count):
    """About the wanted number of points, volumes that sum to the cage's, and none too near a face."""
    points, volumes = sample_quadrature(cage, count, seed=2, margin=0.25)
    spacing = mean_spacing(cage, count)
    assert points.shape[1] == cage.vertices.shape[1]
    assert abs(len(points) - count) <= 0.05 * count
    assert volumes.shape == (len(points),)
    assert volumes.sum() == pytest.approx(cage.volume, rel=1e-12)
    assert volumes.min() > 0.0
    assert np.all(points - cage.low > 0.25 * spacing)
    assert np.all(cage.high - points > 0.25 * spacing)


@both_dimensions
def test_points_keep_apart_and_leave_no_hole(cage):
    """It is a maximal Poisson-disk sample: no two points are close, and no place is far from all of them."""
    points, _ = sample_quadrature(cage, 300, seed=0)
    nearest = cKDTree(points).query(points, k=2)[0][:, 1]
    spacing = mean_spacing(cage, 300)
    assert nearest.min() > 0.6 * spacing
    probe = np.random.default_rng(0).uniform(cage.low, cage.high, size=(4000, len(cage.low)))
    inner = np.minimum(probe - cage.low, cage.high - probe).min(axis=1) > 0.25 * spacing
    assert cKDTree(points).query(probe[inner])[0].max() < 1.15 * nearest.min()


@both_dimensions
def test_quadrature_integrates_moments(cage):
    """The rule gives the box's centre and second moments to a few per cent of its size."""
    points, volumes = sample_quadrature(cage, 300, seed=5)
    size = cage.high - cage.low
    relative = (points - cage.low) / size
    np.testing.assert_allclose(volumes @ relative / cage.volume, 0.5, atol=0.01)
    np.testing.assert_allclose(volumes @ relative**2 / cage.volume, 1.0 / 3.0, atol=0.02)


@both_dimensions
def test_same_seed_same_points(cage):
    """The sample is a function of its seed."""
    first, second = (sample_quadrature(cage, 50, seed=7) for _ in range(2))
    assert np.array_equal(first[0], second[0])
    assert np.array_equal(first[1], second[1])
    assert not np.array_equal(first[0], sample_quadrature(cage, 50, seed=8)[0])


@pytest.mark.parametrize("dimension", [2, 3])
def test_sparse_cage_gets_its_share(dimension):
    """Two small boxes far apart fill little of their bounding box; each gets points by its volume."""
    one, four = np.ones(dimension), np.full(dimension, 4.0)
    cage = merge(make_box(0.0 * one, one), make_box(four, four + [2, 1, 1][:dimension]))
    points, volumes = sample_quadrature(cage, 90, seed=1)
    second = points[:, 0] > 3.0
    assert volumes[second].sum() == pytest.approx(2.0, rel=0.03)
    assert np.isclose(second.sum(), 60, atol=8)


@pytest.mark.parametrize("dimension", [2, 3])
def test_thin_parts_are_covered_to_their_ends(dimension):
    """A rod thinner than the spacing that touches nothing else has points all along."""
    width = {2: 0.12, 3: 0.22}[dimension]
    rod = make_box([1.5, 0, 0][:dimension], [6.5, width, width][:dimension])
    cage = merge(make_box(np.zeros(dimension), np.ones(dimension)), rod)
    points, _ = sample_quadrature(cage, 60, seed=3)
    spacing = mean_spacing(cage, 60)
    along = np.sort(points[points[:, 0] > 1.4, 0])
    assert spacing > width
    assert np.diff(along, prepend=1.5, append=6.5).max() < 2.0 * spacing


@both_dimensions
def test_sample_does_not_depend_on_place_and_size(cage):
    """A cage of a millimetre, or a thousand kilometres from the origin, has the points of the same cage at it."""
    points, volumes = sample_quadrature(cage, 60, seed=3)
    small = make_box(cage.low * 1e-3, cage.high * 1e-3)
    np.testing.assert_allclose(sample_quadrature(small, 60, seed=3)[0], points * 1e-3, rtol=1e-9)
    far = make_box(cage.low + 2.0**20, cage.high + 2.0**20)
    moved, moved_volumes = sample_quadrature(far, 60, seed=3)
    nearest = cKDTree(moved - 2.0**20).query(points, k=1)[0]
    assert cKDTree(moved).query(moved, k=2)[0][:, 1].min() > 0.6 * mean_spacing(cage, 60)
    np.testing.assert_allclose(nearest, 0.0, atol=1e-6)


@pytest.mark.parametrize("name", PLANES)
def test_plane_cages_are_covered_piece_by_piece(name):
    """Points lie inside concave, holed and nested plane cages, keep their margin, and share out each piece's area."""
    cage = PLANES[name]()
    points, areas = sample_quadrature(cage, 150, seed=4)
    assert cage.contains(points).all()
    assert boundary_distances(cage, points).min() > 0.25 * mean_spacing(cage, 150) * (1.0 - 1e-9)
    shares = np.bincount(cage.piece_of(points), areas, minlength=cage.piece_count)
    np.testing.assert_allclose(shares, cage.piece_volumes, rtol=0.05)


@pytest.mark.parametrize("dimension", [2, 3])
def test_dense_sample_is_inside_and_even(dimension):
    """Cells that no face passes are taken or left as a whole, and the others point by point."""
    tilt = np.linalg.qr(np.random.default_rng(2).normal(size=(dimension, dimension)))[0]
    high = np.array([0.8, 0.7, 0.6])[:dimension]
    inner, outer = make_box(np.full(dimension, 0.3), high), make_box(np.zeros(dimension), np.ones(dimension))
    hollow = SimpleNamespace(
        vertices=np.concatenate([outer.vertices, inner.vertices]) @ tilt,
        simplices=np.concatenate([outer.simplices, inner.simplices[:, ::-1] + 2**dimension]),
        volume=outer.volume - inner.volume,
        contains=lambda points: outer.contains(points @ tilt.T) & ~inner.contains(points @ tilt.T),
    )
    points = dense_inside(hollow, 4000, np.random.default_rng(0))
    assert hollow.contains(points).all()
    assert len(points) == pytest.approx(3 * 4000, rel=0.01)
    beyond = points @ tilt.T > high
    for sides in itertools.product([False, True], repeat=dimension):
        expected = np.where(sides, 1.0 - high, high).prod() - (0.0 if any(sides) else inner.volume)
        share = np.all(beyond == sides, axis=1).mean()
        assert share == pytest.approx(expected / hollow.volume, abs=0.004)


@pytest.mark.parametrize("dimension", [2, 3])
def test_distances_match_a_dense_sample(dimension):
    """Distances to segments and triangles agree with the nearest of very many points on them."""
    rng = np.random.default_rng(4)
    corners, points = rng.normal(size=(5, dimension, dimension)), rng.normal(size=(40, dimension))
    barycentric = rng.dirichlet(np.full(dimension, 0.6), size=40000)
    surface = np.einsum("sk,tkc->tsc", barycentric, corners).reshape(-1, dimension)
    found, expected = simplex_distances(points, corners).min(axis=1), cKDTree(surface).query(points)[0]
    assert np.all(found <= expected + 1e-12)
    np.testing.assert_allclose(found, expected, atol=0.02)


def test_degenerate_simplex_has_a_distance():
    """A triangle without area is a segment, and a segment without length a point."""
    triangle = np.array([[[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]]])
    assert simplex_distances(np.array([[1.0, 3.0, 4.0]]), triangle)[0, 0] == pytest.approx(5.0)
    segment = np.array([[[1.0, 1.0], [1.0, 1.0]]])
    assert simplex_distances(np.array([[4.0, 5.0]]), segment)[0, 0] == pytest.approx(5.0)


def test_bad_arguments_are_refused():
    """Counts and margins out of range, and a cage too thin for the margin, are refused with the remedy."""
    with pytest.raises(ValueError, match="count is 0"):
        sample_quadrature(BOX, 0)
    with pytest.raises(ValueError, match="margin is 1.5"):
        sample_quadrature(BOX, 10, margin=1.5)
    for sheet in (make_box([0, 0], [10.0, 0.01]), make_box([0, 0, 0], [10.0, 10.0, 0.01])):
        with pytest.raises(ValueError, match="too thin for 4 quadrature points"):
            sample_quadrature(sheet, 4)


@both_dimensions
@pytest.mark.parametrize("count", [8, 300])
def test_linear_and_quadratic_functions_are_exact(cage, count):
    """Mass and centre of mass are exact to rounding, and with enough points inertia too."""
    points, volumes = sample_quadrature(cage, count, seed=5)
    middle, size = 0.5 * (cage.low + cage.high), cage.high - cage.low
    relative = (points - middle) / size
    np.testing.assert_allclose(volumes @ relative, 0.0, atol=1e-13 * cage.volume)
    assert volumes.sum() == pytest.approx(cage.volume, rel=1e-13)
    if count > 100:
        second = np.einsum("q,qi,qj->ij", volumes, relative, relative)
        np.testing.assert_allclose(second, cage.volume / 12.0 * np.eye(len(size)), atol=1e-13 * cage.volume)
        assert volumes.min() > 0.2 * cage.volume / count


def test_two_thousand_points_take_a_moment():
    """Two thousand points in an L of many faces take some tenths of a second."""
    cage = voxels([(i, j, k) for i in range(6) for j in range(2) for k in range(6) if i < 2 or k < 2], np.full(3, 0.1))
    start = time.process_time()
    points, _ = sample_quadrature(cage, 2000, seed=1)
    assert len(points) == 2000
    assert time.process_time() - start < 1.0


@pytest.mark.parametrize("name", PLANES)
def test_every_piece_has_its_mass_and_centre(name):
    """Pieces of concave, holed and nested plane cages have their area and centre of area to rounding."""
    cage = PLANES[name]()
    quadrature = BodyQuadrature.sampled(cage, 150, spare_count=0, seed=3, thickness=0.5)
    assert_pieces_are_exact(cage, quadrature)


@pytest.mark.parametrize("dimension", [2, 3])
def test_pieces_of_a_cut_have_their_mass_and_centre(dimension):
    """After cuts that take off a sliver and a half, each piece has its own volume and centre to rounding."""
    cage = square() if dimension == 2 else box()
    quadrature = BodyQuadrature.sampled(cage, 60, spare_count=32, seed=3, thickness=None)
    for offset, slope in ((0.05, 0.02), (0.55, 0.3)):
        if dimension == 2:
            blade = cagecut.Blade([offset, 0.5], [slope, -1.0])
        else:
            blade = cagecut.Blade([offset, 0.5, 0.5], [0.1, 1.0, 0.1], [slope, 0.0, -1.0])
        cut = cagecut.Cut(cage, blade)
        cage = cut.advance(to=cut.length).cage
        quadrature = quadrature.distributed(cage, lambda points, cage=cage: boundary_distances(cage, points))
        assert_pieces_are_exact(cage, quadrature)
    assert cage.piece_count == 3
    assert quadrature.used_count > 60


def assert_pieces_are_exact(cage, quadrature):
    """Each piece's points have its volume and centre, and positive volumes."""
    points, volumes = quadrature.points[: quadrature.used_count], quadrature.volumes[: quadrature.used_count]
    piece = cage.piece_of(points)
    assert volumes.min() > 0.0
    corners = cage.vertices[cage.simplices]
    cones = np.linalg.det(corners) / math.factorial(cage.dimension)
    owner = cage.face_piece[cage.simplex_face]
    for index, volume in enumerate(cage.piece_volumes):
        own, sides = piece == index, owner == index
        thick_volume = quadrature.thickness * volume
        assert volumes[own].sum() == pytest.approx(thick_volume, rel=1e-12)
        centre = cones[sides] @ corners[sides].sum(axis=1) / ((cage.dimension + 1) * volume)
        np.testing.assert_allclose(volumes[own] @ points[own] / thick_volume, centre, atol=1e-12 * cage.diameter)
