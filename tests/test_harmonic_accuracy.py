# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Weights and gradients against exact ones in both dimensions: noise, rates and bias."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box, tetrahedron
from harmonic_shapes import (
    MAKERS,
    UNITS,
    assert_reproduces,
    assert_unbiased,
    copies,
    interior_points,
    multilinear,
    points_inside,
)
from newton_cagecut.cage import Cage
from newton_cagecut.harmonic import HarmonicCoordinates
from plane_reference import plane_reference
from plane_shapes import outline

CASES = {"l_shape": (MAKERS["l_shape"], plane_reference), "box": (lambda: box((1.0, 0.8, 0.6)), multilinear)}
"""Cages of which all coordinates are known, and what knows them; in a square, controls would leave no error at all."""
QUANTITIES = pytest.mark.parametrize("quantity", [0, 1], ids=["weights", "gradients"])


def bake(cage: Cage, points: np.ndarray, walks: int, seed: int = 0, **options) -> HarmonicCoordinates:
    """Coordinates with gradients and harmonic faces."""
    return HarmonicCoordinates(cage, points, walks, seed, gradients=True, quads="harmonic", **options)


def root_mean_square(values: np.ndarray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def fitted_rate(walks: list[int], errors: list[float]) -> float:
    """Slope of log error over log 1 / N."""
    return -float(np.polyfit(np.log(walks), np.log(errors), 1)[0])


@pytest.mark.parametrize("make", [lambda: outline([[0, 0], [1.1, 0.2], [0.3, 0.9]]), tetrahedron])
def test_simplex_is_barycentric(make):
    """In a simplex coordinates and gradients are the barycentric ones, which controls make exact to rounding."""
    cage = make()
    points = interior_points(cage, 50, np.random.default_rng(1))
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    inverse = np.linalg.inv(np.c_[cage.vertices, np.ones(cage.vertex_count)])
    np.testing.assert_allclose(coordinates.weights, np.c_[points, np.ones(50)] @ inverse, atol=1e-6)
    slopes = np.broadcast_to(inverse[:-1].T, coordinates.gradients.shape)
    np.testing.assert_allclose(coordinates.gradients, slopes, atol=1e-4)


@pytest.fixture(scope="module", params=CASES)
def runs(request) -> tuple[tuple[np.ndarray, np.ndarray], dict[int, tuple[np.ndarray, np.ndarray]]]:
    """Exact weights and gradients, and estimates by walk count: seeds x points x vertices, gradients one axis more."""
    make, exact = CASES[request.param]
    cage = make()
    points = points_inside(cage, 16, 2)
    estimates = {}
    for walks in (128, 512, 2048):
        baked = [bake(cage, points, walks, seed) for seed in range(8)]
        estimates[walks] = tuple(np.array([getattr(run, name) for run in baked]) for name in ("weights", "gradients"))
    return exact(cage, points), estimates


@pytest.mark.parametrize("correction", ["none", "affine"])
@pytest.mark.parametrize("name", CASES)
def test_plain_means_are_unbiased(name, correction):
    """Means over points in one place deviate from the exact weights and gradients by standard errors, not more."""
    make, exact = CASES[name]
    points = points_inside(make(), 16, 2)
    for estimates, values in zip(
        copies(make(), points, 512, 32, gradients=True, quads="harmonic", correction=correction), exact(make(), points)
    ):
        assert_unbiased(estimates, values)


def test_bias_of_controls_falls_as_one_over_walks():
    """The bias of the control variates falls twice as fast as the error, of which it is the lesser part."""
    cage = MAKERS["l_shape"]()
    points, walks, biases = points_inside(cage, 16, 2), [64, 256, 1024], []
    exact = plane_reference(cage, points)[0]
    for count in walks:
        estimates = copies(cage, points, count, 64)[0]
        variance = np.mean(estimates.var(axis=0, ddof=1))
        biases.append(float(np.sqrt(np.mean((estimates.mean(axis=0) - exact) ** 2) - variance / 64)))
        assert biases[-1] < 0.6 * np.sqrt(variance)
    assert fitted_rate(walks, biases) == pytest.approx(1.0, abs=0.25)


@QUANTITIES
def test_rate(runs, quantity):
    """The error falls as the root of the number of walks."""
    exact, estimates = runs
    errors = [root_mean_square(values[quantity] - exact[quantity]) for values in estimates.values()]
    assert fitted_rate(list(estimates), errors) == pytest.approx(0.5, abs=0.1)


def test_error_is_small(runs):
    """The error of 2048 walks is well below that of plain means, which is at least 0.2 / sqrt(2048)."""
    exact, estimates = runs
    assert root_mean_square(estimates[2048][0] - exact[0]) < 0.003


@pytest.mark.parametrize("name", CASES)
def test_rate_of_plain_means(name):
    """So it does without control variates, from a larger error."""
    make, exact = CASES[name]
    cage = make()
    points = points_inside(cage, 24, 3)
    walks, errors = [64, 512, 4096], []
    for count in walks:
        runs = np.array([bake(cage, points, count, seed, correction="none").weights for seed in range(2)])
        errors.append(root_mean_square(runs - exact(cage, points)[0]))
    assert fitted_rate(walks, errors) == pytest.approx(0.5, abs=0.1)


def test_bias_falls_with_epsilon():
    """Landing early is a bias that falls as epsilon does: a tenth, a hundredth, and no more than noise of it.

    The error is measured along that of the greatest epsilon, over which the noise averages out.
    """
    cage = MAKERS["star"]()
    points = points_inside(cage, 24, 2)
    exact = plane_reference(cage, points)[0]
    errors = [
        HarmonicCoordinates(cage, points, 1 << 14, epsilon=epsilon, cuttable=False).weights - exact
        for epsilon in (1e-1, 1e-2, 1e-3, 1e-4)
    ]
    square = np.sum(errors[0] ** 2)
    first, second, third = (float(np.sum(error * errors[0]) / square) for error in errors[1:])
    assert first == pytest.approx(0.1, abs=0.04)
    assert second == pytest.approx(0.01, abs=0.01)
    assert third == pytest.approx(0.0, abs=0.01)
    assert [root_mean_square(error) for error in errors[:3]] == sorted(map(root_mean_square, errors[:3]), reverse=True)


@pytest.mark.parametrize("name", CASES)
def test_affine_correction_is_exact_where_promised(name):
    """The paper's correction sums to 1, reproduces positions and has the gradients' identities, after a noisy mean."""
    cage = CASES[name][0]()
    points = interior_points(cage, 20, np.random.default_rng(4))
    assert_reproduces(bake(cage, points, 64, correction="affine"), points)


@pytest.mark.parametrize("name", CASES)
def test_short_walks_are_counted(name):
    """Walks that the cap on steps stops are counted, and the weights still reproduce the rest shape."""
    cage = CASES[name][0]()
    points = interior_points(cage, 20, np.random.default_rng(5))
    coordinates = bake(cage, points, 64, max_steps=3)
    stats = coordinates.recompute()
    capped = np.count_nonzero(coordinates.landings["key"] >> 30)
    assert stats.capped == capped > 0
    assert_reproduces(coordinates, points)


@pytest.mark.parametrize("name", ["star", "star_prism"])
def test_negative_weights_are_reported(name):
    """The least weight of every point, and that of all in the statistics, is what the weights say."""
    cage = MAKERS[name]()
    points = interior_points(cage, 200, np.random.default_rng(6))
    coordinates = HarmonicCoordinates(cage, points, 32)
    least = np.minimum(coordinates.weights.min(axis=1), 0.0)
    np.testing.assert_array_equal(coordinates.lowest_weights, least)
    assert coordinates.recompute().lowest_weight == least.min() < 0.0
    assert HarmonicCoordinates(cage, points, 32, correction="none").recompute().lowest_weight == 0.0


@pytest.mark.parametrize("name", UNITS)
def test_unit_cubes_are_exact_by_degree(name):
    """Where every boundary function is a polynomial of the controls no error is left: bilinear in a square."""
    cage = MAKERS[name]()
    points = points_inside(cage, 10, 7)
    weights = multilinear(cage, points)[0]
    for degree in (1, 2):
        error = np.abs(HarmonicCoordinates(cage, points, 256, gradients=True, degree=degree).weights - weights).max()
        assert (error < 1e-5) == (name == "square" and degree == 2)
