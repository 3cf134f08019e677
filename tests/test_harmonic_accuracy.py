# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Weights and gradients against exact ones: barycentric on a tetrahedron, trilinear on a box."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box, tetrahedron
from harmonic_shapes import interior_points, trilinear
from newton_cagecut.harmonic import HarmonicCoordinates

SIZE = (1.0, 0.8, 0.6)


def bake_box(points: np.ndarray, walks: int, seed: int, correction: str = "harmonic") -> HarmonicCoordinates:
    """A box whose harmonic coordinates are trilinear."""
    return HarmonicCoordinates(
        box(SIZE), points, walks, seed, gradients=True, quads="harmonic", correction=correction, cuttable=True
    )


def fitted_rate(walks: list[int], errors: list[float]) -> float:
    """Slope of log error over log 1 / N."""
    return -float(np.polyfit(np.log(walks), np.log(errors), 1)[0])


def test_tetrahedron_is_barycentric():
    """On a tetrahedron harmonic coordinates and gradients are the barycentric ones, which controls make exact."""
    cage = tetrahedron()
    points = interior_points(cage, 50, np.random.default_rng(1))
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    inverse = np.linalg.inv(np.c_[cage.vertices, np.ones(4)])
    np.testing.assert_allclose(coordinates.weights, np.c_[points, np.ones(50)] @ inverse, atol=1e-5)
    np.testing.assert_allclose(coordinates.gradients, np.broadcast_to(inverse[:3].T, (50, 4, 3)), atol=1e-4)


@pytest.fixture(scope="module")
def box_errors() -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Errors of weights and gradients by walk count: seeds x points x 8, and one axis more."""
    points = interior_points(box(SIZE), 16, np.random.default_rng(2))
    points = 0.7 * (points - points.mean(axis=0)) + 0.5 * np.array(SIZE)
    exact, slope = trilinear(box(SIZE), points)
    errors = {}
    for walks in (128, 512, 2048):
        runs = [bake_box(points, walks, seed) for seed in range(8)]
        errors[walks] = (
            np.array([run.weights - exact for run in runs]),
            np.array([run.gradients - slope for run in runs]),
        )
    return errors


@pytest.mark.parametrize("quantity", [0, 1], ids=["weights", "gradients"])
def test_box_is_trilinear(box_errors, quantity):
    """Means over seeds deviate from the trilinear weights and gradients by their standard errors, not more."""
    for errors in (box_errors[512][quantity], box_errors[2048][quantity]):
        spread = errors.std(axis=0, ddof=1)
        resolved = spread > 1e-6
        assert resolved.mean() > 0.9
        score = errors.mean(axis=0)[resolved] / (spread[resolved] / np.sqrt(len(errors)))
        assert 0.7 < np.sqrt(np.mean(score**2)) < 1.6  # Student's t of 7 degrees of freedom: 1.18
        assert np.abs(score).max() < 8.0


def test_box_error_is_small(box_errors):
    """The error of 2048 walks is well below that of plain means, which is at least 0.2 / sqrt(2048)."""
    assert np.sqrt(np.mean(box_errors[2048][0] ** 2)) < 0.003


@pytest.mark.parametrize("quantity", [0, 1], ids=["weights", "gradients"])
def test_rate(box_errors, quantity):
    """The error falls as the root of the number of walks."""
    walks = sorted(box_errors)
    errors = [float(np.sqrt(np.mean(box_errors[count][quantity] ** 2))) for count in walks]
    assert fitted_rate(walks, errors) == pytest.approx(0.5, abs=0.1)


def test_rate_of_plain_means():
    """So it does without control variates, from a larger error."""
    points = interior_points(box(SIZE), 24, np.random.default_rng(3))
    exact = trilinear(box(SIZE), points)[0]
    walks, errors = [64, 512, 4096], []
    for count in walks:
        runs = np.array([bake_box(points, count, seed, "none").weights - exact for seed in range(2)])
        errors.append(float(np.sqrt(np.mean(runs**2))))
    assert fitted_rate(walks, errors) == pytest.approx(0.5, abs=0.1)


def test_affine_correction_is_exact_where_promised():
    """The paper's correction sums to 1, reproduces positions and has the gradients' identities, after a noisy mean."""
    points = interior_points(box(SIZE), 20, np.random.default_rng(4))
    coordinates = bake_box(points, 64, 0, "affine")
    np.testing.assert_allclose(coordinates.weights.sum(axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose(coordinates.weights @ coordinates.cage.vertices, points, atol=1e-5)
    identity = np.einsum("vi,pvj->pij", coordinates.cage.vertices, coordinates.gradients)
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), identity.shape), atol=1e-4)


def test_short_walks_are_counted():
    """Walks that the cap on steps stops are counted, and the weights still reproduce the rest shape."""
    points = interior_points(box(SIZE), 20, np.random.default_rng(5))
    coordinates = HarmonicCoordinates(box(SIZE), points, 64, gradients=True, quads="harmonic", max_steps=3)
    stats = coordinates.recompute()
    capped = np.count_nonzero(coordinates.landings["key"] >> 30)
    assert stats.capped == capped > 0
    np.testing.assert_allclose(coordinates.weights @ coordinates.cage.vertices, points, atol=1e-5)


def test_negative_weights_are_reported():
    """The least weight of every point, and that of all in the statistics, is what the weights say."""
    points = interior_points(box(SIZE), 40, np.random.default_rng(6))
    coordinates = bake_box(points, 64, 1)
    least = np.minimum(coordinates.weights.min(axis=1), 0.0)
    np.testing.assert_array_equal(coordinates.lowest_weights, least)
    assert coordinates.recompute().lowest_weight == least.min() < 0.0
    plain = bake_box(points, 64, 1, "none")
    assert plain.recompute().lowest_weight == 0.0
