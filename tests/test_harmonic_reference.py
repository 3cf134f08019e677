# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Weights against references that share nothing with the walks, before and after cuts, in both dimensions.

A mean over N independent runs is compared with the reference: the deviation of each weight stays within a few of its
standard errors, which the runs themselves tell, plus the reference's own error.
"""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box, prism
from harmonic_shapes import interior_points
from newton_cagecut.cage import Blade, Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from plane_reference import PlaneReference
from plane_shapes import PLANES, outline, ring, square
from solid_reference import SolidReference

RUNS = 16
WALKS = 4096  # so many that what control variates leave of a bias, which falls as 1 / N, is below the noise
SLIT = {
    (0.0, 0.0): 0.3133712067,
    (1.0, 0.0): 0.0633712067,
    (1.0, 1.0): 0.0108204283,
    (0.0, 1.0): 0.2608204283,
    (0.5, 0.5): 0.2465151734,
}
"""Unit square with the slit x = 0.5, y > 0.5, at (0.25, 0.5): corners and tip (spectral, residual 5e-14)."""
MOUTHS = (0.0063362780, 0.0987652787)
"""The slit's mouth on the right, and on the left."""


def runs_of(cage: Cage, points: np.ndarray, walks: int, runs: int = RUNS, **options) -> np.ndarray:
    """Weights of independent runs, shape (run_count, point_count, vertex_count)."""
    repeated = np.tile(points, (runs, 1))  # the walks of equal points at other places of the list are others
    weights = HarmonicCoordinates(cage, repeated, walks, seed=5, cuttable=False, **options).weights
    return weights.astype(np.float64).reshape(runs, len(points), -1)


def assert_agrees(
    runs: np.ndarray, exact: np.ndarray, *, own_error: float = 0.0, which: np.ndarray | None = None
) -> None:
    """Assert that the mean of the runs is the reference, to 3 standard errors and a reference's own error.

    Of many weights a few may lie farther off; their scores are asserted to have the spread of Student's t. A weight
    that few walks reach is left out: its spread over the runs says nothing of its error.
    """
    which = exact > 0.01 if which is None else which
    assert which.sum() > 8
    error = (runs.mean(axis=0) - exact)[which]
    standard = (runs.std(axis=0, ddof=1) / np.sqrt(len(runs)))[which]
    allowed = 3.0 * standard + own_error + 1e-6
    assert (np.abs(error) > allowed).mean() < 0.05
    assert (np.abs(error) < 2.0 * allowed).all()
    resolved = standard > max(1e-6, own_error)
    if resolved.sum() > 40:
        assert 0.7 < np.sqrt(np.mean((error / standard)[resolved] ** 2)) < 1.5


@pytest.mark.parametrize("correction", ["harmonic", "none"])
def test_slit_square(correction):
    """All seven weights of a slit square agree with their spectral values, at 2^16 walks."""
    cut = Cut(square(), Blade((0.5, 2.0), (0.0, -1.0)))
    cage = cut.advance(to=0.5).cage
    exact = np.array([SLIT.get(tuple(np.round(vertex, 6)), np.nan) for vertex in cage.vertices])
    mouths = np.flatnonzero(np.isnan(exact))
    right = cage.face_component  # one loop: the sides are told apart by the faces at the mouths
    assert right.max() == 0
    for mouth in mouths:
        faces = [face for face in cage.faces if mouth in face]
        beside = [v for face in faces for v in face if v != mouth and np.isnan(exact[v]) == 0]
        corner = max(cage.vertices[beside], key=lambda place: abs(place[0] - 0.5))
        exact[mouth] = MOUTHS[0] if corner[0] > 0.5 else MOUTHS[1]
    assert exact.sum() == pytest.approx(1.0, abs=1e-8)
    runs = runs_of(cage, np.array([[0.25, 0.5]]), (1 << 16) // RUNS, correction=correction)
    standard = runs.std(axis=0, ddof=1) / np.sqrt(RUNS)
    assert (np.abs(runs.mean(axis=0) - exact) < 3.0 * standard).all()


def test_triangle_is_barycentric():
    """In a triangle the weights and gradients are the barycentric ones, to rounding."""
    cage = outline([[0.0, 0.0], [1.0, 0.1], [0.3, 0.8]])
    points = interior_points(cage, 40, np.random.default_rng(1))
    coordinates = HarmonicCoordinates(cage, points, 64, gradients=True)
    inverse = np.linalg.inv(np.c_[cage.vertices, np.ones(3)])
    np.testing.assert_allclose(coordinates.weights, np.c_[points, np.ones(40)] @ inverse, atol=2e-6)
    np.testing.assert_allclose(coordinates.gradients, np.broadcast_to(inverse[:2].T, (40, 3, 2)), atol=1e-4)


@pytest.mark.parametrize("name", ["l_shape", "star", "square"])
def test_polygons(name):
    """Weights and gradients in polygons agree with rational functions that solve the same problem."""
    cage = PLANES[name]()
    reference = PlaneReference(cage.vertices)
    points = interior_points(cage, 12, np.random.default_rng(2))
    assert reference.error < 1e-4
    exact = reference.weights(points)
    assert_agrees(runs_of(cage, points, WALKS), exact, own_error=reference.error)
    repeated = np.tile(points, (RUNS, 1))
    slopes = HarmonicCoordinates(cage, repeated, WALKS, seed=6, gradients=True, cuttable=False).gradients
    slopes = slopes.astype(np.float64).reshape(RUNS, 12, -1, 2)
    assert_agrees(slopes, reference.gradients(points), own_error=10.0 * reference.error, which=exact > 0.01)


def test_right_prism_is_a_product():
    """In a right prism the weights are those of its polygon times linear ones in the height, with harmonic quads."""
    polygon = ring(5)
    cage = prism(polygon, 0.8)
    points = interior_points(cage, 10, np.random.default_rng(3))
    across, up = PlaneReference(polygon).weights(points[:, :2]), points[:, 2:] / 0.8
    exact = np.concatenate([across * (1.0 - up), across * up], axis=1)
    assert_agrees(runs_of(cage, points, 512, quads="harmonic"), exact)


def test_rate_in_the_plane():
    """The error of controls of one degree falls as the root of the number of walks."""
    cage = PLANES["l_shape"]()
    points = interior_points(cage, 24, np.random.default_rng(4))
    exact = PlaneReference(cage.vertices).weights(points)
    walks = [64, 512, 4096]
    errors = [np.sqrt(np.mean((runs_of(cage, points, count, 4, degree=1) - exact) ** 2)) for count in walks]
    assert -np.polyfit(np.log(walks), np.log(errors), 1)[0] == pytest.approx(0.5, abs=0.1)


def test_bias_falls_with_epsilon():
    """Landing 0.05 away from the walls is a bias that can be seen; landing 1e-4 away is none that can."""
    cage = PLANES["star"]()
    points = interior_points(cage, 12, np.random.default_rng(5))
    exact = PlaneReference(cage.vertices).weights(points)
    errors = [
        np.sqrt(np.mean((runs_of(cage, points, 1024, epsilon=epsilon).mean(axis=0) - exact) ** 2))
        for epsilon in (0.05, 1e-4)
    ]
    assert errors[0] > 2.0 * errors[1]


@pytest.mark.parametrize("quads", ["harmonic", "mean_value"])
def test_part_way_cut_against_finite_elements(quads):
    """A box cut half-way has the weights of quadratic finite elements, to 3 standard errors and the elements' error."""
    cut = Cut(box(), Blade([0.5, 0.5, 2.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]))
    cut.advance(to=0.5)
    points = np.array([[x, y, z] for x in (0.25, 0.75) for y in (0.5,) for z in (0.25, 0.5, 0.75)])
    coarse, fine = (
        SolidReference(cut, [np.linspace(0.0, 1.0, count + 1)] * 3, points).weights(quads=quads) for count in (8, 12)
    )
    # The front's square root makes the elements converge as their width: what is left is twice the last change.
    own_error = 2.0 * float(np.abs(fine - coarse).max())
    assert own_error < 0.01
    exact = fine + 2.0 * (fine - coarse)
    assert_agrees(runs_of(cut.cage, points, 1024, quads=quads), exact, own_error=own_error)


def test_finite_elements_are_a_reference():
    """On the uncut box the elements give trilinear weights: the test above fails for the right reasons."""
    cage = box()
    cut = Cut(cage, Blade([0.5, 0.5, 2.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]))
    points = np.array([[0.25, 0.5, 0.75], [0.5, 0.25, 0.5]])
    found = SolidReference(cut, [np.linspace(0.0, 1.0, 9)] * 3, points).weights(quads="harmonic")
    factor = np.where(cage.vertices > 0.5, points[:, None], 1.0 - points[:, None])
    np.testing.assert_allclose(found, factor.prod(axis=2), atol=1e-6)
