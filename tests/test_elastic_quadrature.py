# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the quadrature points."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from newton_cagecut.cage.inside import triangle_distances
from newton_cagecut.elastic import sample_quadrature
from newton_cagecut.elastic.quadrature import _dense_inside

QUADS = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])


def make_box(low, high):
    """A box with all that the sampling needs of a cage."""
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    return SimpleNamespace(
        low=low,
        high=high,
        vertices=low + corners * (high - low),
        triangles=np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]]),
        volume=float(np.prod(high - low)),
        contains=lambda points: np.all((points > low) & (points < high), axis=1),
    )


def merge(*boxes):
    """A cage of several boxes that do not touch."""
    offsets = np.cumsum([0] + [len(b.vertices) for b in boxes])
    return SimpleNamespace(
        vertices=np.concatenate([b.vertices for b in boxes]),
        triangles=np.concatenate([b.triangles + o for b, o in zip(boxes, offsets)]),
        volume=sum(b.volume for b in boxes),
        contains=lambda points: np.any([b.contains(points) for b in boxes], axis=0),
    )


BOX = make_box([10.0, -3.0, 0.0], [10.5, -2.0, 2.0])


@pytest.mark.parametrize("count", [8, 40, 300])
def test_count_volume_and_margin(count):
    """About the wanted number of points, volumes that sum to the cage's, and none too near a face."""
    points, volumes = sample_quadrature(BOX, count, seed=2, margin=0.25)
    spacing = (BOX.volume / count) ** (1.0 / 3.0)
    assert abs(len(points) - count) <= 0.05 * count
    assert volumes.shape == (len(points),)
    assert volumes.sum() == pytest.approx(BOX.volume, rel=1e-12)
    assert volumes.min() > 0.0
    assert np.all(points - BOX.low > 0.25 * spacing)
    assert np.all(BOX.high - points > 0.25 * spacing)


def test_points_keep_apart_and_leave_no_hole():
    """It is a maximal Poisson-disk sample: no two points are close, and no place is far from all of them."""
    points, _ = sample_quadrature(BOX, 300, seed=0)
    nearest = cKDTree(points).query(points, k=2)[0][:, 1]
    spacing = (BOX.volume / 300) ** (1.0 / 3.0)
    assert nearest.min() > 0.6 * spacing
    probe = np.random.default_rng(0).uniform(BOX.low, BOX.high, size=(4000, 3))
    inner = np.minimum(probe - BOX.low, BOX.high - probe).min(axis=1) > 0.25 * spacing
    assert cKDTree(points).query(probe[inner])[0].max() < 1.15 * nearest.min()


def test_quadrature_integrates_moments():
    """The rule gives the box's centre and second moments to a few per cent of its size."""
    points, volumes = sample_quadrature(BOX, 300, seed=5)
    size = BOX.high - BOX.low
    relative = (points - BOX.low) / size
    np.testing.assert_allclose(volumes @ relative / BOX.volume, 0.5, atol=0.01)
    np.testing.assert_allclose(volumes @ relative**2 / BOX.volume, 1.0 / 3.0, atol=0.02)


def test_same_seed_same_points():
    """The sample is a function of its seed."""
    first, second = (sample_quadrature(BOX, 50, seed=7) for _ in range(2))
    assert np.array_equal(first[0], second[0])
    assert np.array_equal(first[1], second[1])
    assert not np.array_equal(first[0], sample_quadrature(BOX, 50, seed=8)[0])


def test_sparse_cage_gets_its_share():
    """Two small boxes far apart fill little of their bounding box; each gets points by its volume."""
    cage = merge(make_box([0, 0, 0], [1, 1, 1]), make_box([4, 4, 4], [5, 5, 6]))
    points, volumes = sample_quadrature(cage, 90, seed=1)
    second = points[:, 0] > 3.0
    assert volumes[second].sum() == pytest.approx(2.0, rel=0.03)
    assert np.isclose(second.sum(), 60, atol=8)


def test_thin_parts_are_covered_to_their_ends():
    """A rod thinner than the spacing that touches nothing else has points all along."""
    cage = merge(make_box([0, 0, 0], [1, 1, 1]), make_box([1.5, 0, 0], [6.5, 0.22, 0.22]))
    points, _ = sample_quadrature(cage, 60, seed=3)
    spacing = (cage.volume / 60) ** (1.0 / 3.0)
    along = np.sort(points[points[:, 0] > 1.4, 0])
    assert spacing > 0.25
    assert np.diff(along, prepend=1.5, append=6.5).max() < 2.0 * spacing


def test_sample_does_not_depend_on_place_and_size():
    """A cage of a millimetre, or a thousand kilometres from the origin, has the points of the same cage at it."""
    points, volumes = sample_quadrature(BOX, 60, seed=3)
    small = make_box(BOX.low * 1e-3, BOX.high * 1e-3)
    np.testing.assert_allclose(sample_quadrature(small, 60, seed=3)[0], points * 1e-3, rtol=1e-9)
    far = make_box(BOX.low + 2.0**20, BOX.high + 2.0**20)
    moved, moved_volumes = sample_quadrature(far, 60, seed=3)
    nearest = cKDTree(moved - 2.0**20).query(points, k=1)[0]
    assert cKDTree(moved).query(moved, k=2)[0][:, 1].min() > 0.6 * (BOX.volume / 60) ** (1.0 / 3.0)
    np.testing.assert_allclose(nearest, 0.0, atol=1e-6)


def test_dense_sample_is_inside_and_even():
    """Cells that no triangle passes are taken or left as a whole, and the others point by point."""
    tilt = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    inner, outer = make_box([0.3, 0.3, 0.3], [0.8, 0.7, 0.6]), make_box([0, 0, 0], [1, 1, 1])
    hollow = SimpleNamespace(
        vertices=np.concatenate([outer.vertices, inner.vertices]) @ tilt,
        triangles=np.concatenate([outer.triangles, inner.triangles[:, ::-1] + 8]),
        volume=1.0 - 0.06,
        contains=lambda points: outer.contains(points @ tilt.T) & ~inner.contains(points @ tilt.T),
    )
    points = _dense_inside(hollow, 4000, np.random.default_rng(0))
    assert hollow.contains(points).all()
    assert len(points) == pytest.approx(3 * 4000, rel=0.01)
    octants = np.unique((points @ tilt.T > (0.8, 0.7, 0.6)) @ [1, 2, 4], return_counts=True)[1] / len(points)
    expected = [0.336 - 0.06, 0.084, 0.144, 0.036, 0.224, 0.056, 0.096, 0.024]
    np.testing.assert_allclose(octants, np.array(expected) / 0.94, atol=0.004)


def test_triangle_distances_match_a_dense_sample():
    """Distances to triangles agree with the nearest of very many points on them."""
    rng = np.random.default_rng(4)
    corners, points = rng.normal(size=(5, 3, 3)), rng.normal(size=(40, 3))
    barycentric = rng.dirichlet([0.6, 0.6, 0.6], size=40000)
    surface = np.einsum("sk,tkc->tsc", barycentric, corners).reshape(-1, 3)
    found, expected = triangle_distances(points, corners).min(axis=1), cKDTree(surface).query(points)[0]
    assert np.all(found <= expected + 1e-12)
    np.testing.assert_allclose(found, expected, atol=0.02)


def test_degenerate_triangle_has_a_distance():
    """A triangle without area is a segment."""
    corners = np.array([[[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]]])
    assert triangle_distances(np.array([[1.0, 3.0, 4.0]]), corners)[0, 0] == pytest.approx(5.0)


def test_bad_arguments_are_refused():
    """Counts and margins out of range, and a cage too thin for the margin, are refused with the remedy."""
    with pytest.raises(ValueError, match="count is 0"):
        sample_quadrature(BOX, 0)
    with pytest.raises(ValueError, match="margin is 1.5"):
        sample_quadrature(BOX, 10, margin=1.5)
    with pytest.raises(ValueError, match="too thin for 4 quadrature points"):
        sample_quadrature(make_box([0, 0, 0], [10.0, 10.0, 0.01]), 4)
