# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cut cages against references that share nothing with the walks: rational functions and finite elements."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from cage_shapes import box, prism, voxels
from harmonic_shapes import (
    MAKERS,
    assert_unbiased,
    assert_within_errors,
    copies,
    interior_points,
    points_inside,
    side_vertices,
)
from newton_cagecut.cage import Cage, Cut, boundary_distances
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.harmonic.fit.boundary_fit import BoundaryFit
from newton_cagecut.section import Blade
from plane_reference import PlaneReference, plane_reference
from plane_shapes import loops_of, square
from solid_reference import SolidReference, crowded

PUBLISHED = [0.3133712067, 0.0633712067, 0.0108204283, 0.0063362780, 0.2465151734, 0.0987652787, 0.2608204283]
"""Weights of (0.25, 0.5) in the unit square slit from the middle of its top to its centre, counterclockwise from the
origin: by a spectral method with a residual of 5e-14."""


def slit_square() -> tuple[Cage, list[int]]:
    """The unit square slit from the middle of its top to its centre, and its loop from the origin."""
    cage = Cut(square(), Blade([0.5, 0.5], [0.0, -1.0])).advance(to=0.5).cage
    return cage, loops_of(cage)[0]


def extruded(weights: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Coordinates in a prism of those of its polygon and the share of the height: first of the bottom, then the top."""
    return np.concatenate([weights * (1.0 - share[:, None]), weights * share[:, None]], axis=1)


def test_plane_reference_is_the_published_one():
    """Rational functions give the published weights of a slit square, and know how good they are."""
    cage, loop = slit_square()
    reference = PlaneReference(cage.vertices[loop])
    assert reference.error < 1e-8
    np.testing.assert_allclose(reference.weights(np.array([[0.25, 0.5]])), [PUBLISHED], atol=2e-10)
    points = points_inside(cage, 50, 0)
    np.testing.assert_allclose(reference.weights(points) @ cage.vertices[loop], points, atol=1e-9)


@pytest.mark.parametrize("correction", ["harmonic", "none"])
def test_slit_square(correction):
    """All seven weights of 2^16 walks lie within three standard errors of the published ones, on both sides alike.

    The standard error is that of 64 independent estimates of 1024 walks each, over the root of 64.
    """
    cage, loop = slit_square()
    points = np.array([[0.25, 0.5], [0.75, 0.5]])
    mirrored = np.array(PUBLISHED)[[1, 0, 6, 5, 4, 3, 2]]
    error = copies(cage, points, 1 << 10, 64, seed=1, correction=correction)[0].std(axis=0, ddof=1) / 8.0
    weights = HarmonicCoordinates(cage, points, 1 << 16, correction=correction, cuttable=False).weights
    off = np.abs(weights[:, loop] - [PUBLISHED, mirrored])
    assert (off <= 3.0 * error[:, loop]).all()
    assert off.max() < 0.005


@pytest.mark.parametrize("name", ["l_shape", "star"])
def test_prism_is_polygon_times_height(name):
    """In a right prism with harmonic quads weights are those of its polygon times a linear share of the height."""
    plane = MAKERS[name]()
    cage = prism(plane.vertices, 0.8)
    points = points_inside(cage, 8, 1)
    exact = extruded(plane_reference(plane, points[:, :2])[0], points[:, 2] / 0.8)
    assert_unbiased(copies(cage, points, 1024, 32, quads="harmonic", correction="none")[0], exact)
    assert_within_errors(copies(cage, points, 2048, 16, quads="harmonic")[0], exact)


def test_box_cut_part_of_the_way():
    """A box slit along its height is a prism over a slit square: known exactly, part-way cut and all."""
    cut = Cut(box(), Blade([0.5, 0.5, 0.5], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]))
    cage = cut.advance(to=0.5).cage
    plane, loop = slit_square()
    points = points_inside(cage, 10, 2)
    points = points[np.abs(points[:, 0] - 0.5) > 0.03]
    exact = np.zeros((len(points), cage.vertex_count))
    exact[:, _prism_order(cut, plane.vertices[loop])] = extruded(
        PlaneReference(plane.vertices[loop]).weights(points[:, :2]), points[:, 2]
    )
    assert_unbiased(copies(cage, points, 1024, 32, quads="harmonic", correction="none")[0], exact)
    assert_within_errors(copies(cage, points, 2048, 16, quads="harmonic")[0], exact)


def fitted(cage: Cage, points: np.ndarray, *, quads: str = "harmonic", panel_size: float = 1.0) -> np.ndarray:
    """Weights by the fit alone, of points of the first piece."""
    fit = BoundaryFit(cage, quads=quads, panel_size=panel_size, device=wp.get_device("cpu"))
    return fit.values(points, np.zeros(len(points), dtype=int))


def test_fits_of_slits():
    """Fits of a slit square have the published weights, and those of a slit box the exact ones, more so when finer."""
    plane, loop = slit_square()
    mirrored = np.array(PUBLISHED)[[1, 0, 6, 5, 4, 3, 2]]
    found = fitted(plane, np.array([[0.25, 0.5], [0.75, 0.5]]))
    np.testing.assert_allclose(found[:, loop], [PUBLISHED, mirrored], atol=1e-5)
    cut = Cut(box(), Blade([0.5, 0.5, 0.5], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]))
    cage = cut.advance(to=0.5).cage
    points = interior_points(cage, 200, np.random.default_rng(0))
    points = points[boundary_distances(cage, points) > 0.03]
    exact = np.zeros((len(points), cage.vertex_count))
    exact[:, _prism_order(cut, plane.vertices[loop])] = extruded(
        PlaneReference(plane.vertices[loop]).weights(points[:, :2]), points[:, 2]
    )
    coarse, fine = (np.abs(fitted(cage, points, panel_size=size) - exact) for size in (1.0, 0.4))
    assert np.sqrt(np.mean(coarse**2)) < 5e-4
    assert np.sqrt(np.mean(fine**2)) < 1e-4
    assert fine.max() < 5e-3


def _prism_order(cut: Cut, corners: np.ndarray) -> np.ndarray:
    """Vertices of a cut box over the corners of its slit square, first of the bottom, then of the top."""
    cage, order = cut.cage, []
    left = int(cut.plane.normal[0] < 0.0)  # side 1 faces the body where the normal points
    for height in (0.0, 1.0):
        for i, corner in enumerate(corners):
            found = np.flatnonzero(np.abs(cage.vertices - [*corner, height]).max(axis=1) < 1e-9)
            if len(found) > 1:  # the right mouth comes before the tip, the left one after it
                found = np.intersect1d(found, side_vertices(cage, cut.wall, left if i == 5 else 1 - left))
            order.extend(found)
    return np.array(order)


@pytest.fixture(scope="module")
def half_cut_l() -> tuple[Cut, np.ndarray, list[SolidReference]]:
    """An L of three cubes, two of them cut half-way by a blade; points, and finite elements on two grids."""
    cut = Cut(
        voxels([(0, 0, 0), (1, 0, 0), (0, 1, 0)], np.ones(3)), Blade([0.5] * 3, [0.0, 1.0, 0.0], [0.0, 0.0, -1.0])
    )
    cut.advance(to=0.5)

    def ticks(count: int) -> list[np.ndarray]:
        """Planes of the grid, dense at the front, along y at z = 0.5, and at the inner edge, along z at y = 1."""
        return [
            crowded([0.0, 0.5, 1.0, 2.0], [0.5, 1.0], count),
            crowded([0.0, 1.0, 2.0], [1.0], count),
            crowded([0.0, 0.5, 1.0], [0.5], count),
        ]

    x, y, z = ticks(4)
    nodes = [(5, 1, 6), (3, 6, 5), (5, 6, 5), (4, 2, 2), (5, 7, 7), (1, 7, 2)]
    points = np.array([[x[i], y[j], z[k]] for i, j, k in nodes])
    return cut, points, [SolidReference(cut, ticks(count), points) for count in (4, 8)]


@pytest.mark.parametrize("quads", ["harmonic", "mean_value"])
def test_finite_elements(half_cut_l, quads):
    """Weights on both sides of a part-way cut, below its front and far off lie within three standard errors.

    The finite elements' own error is taken as a third of what halving the grid's intervals has changed.
    """
    cut, points, references = half_cut_l
    coarse, fine = (reference.weights(quads=quads) for reference in references)
    own_error = np.abs(fine - coarse) / 3.0
    assert own_error.max() < 0.002
    np.testing.assert_allclose(fine @ cut.cage.vertices, points, atol=1e-7)
    assert_within_errors(copies(cut.cage, points, 8192, 12, quads=quads)[0], fine, own_error=own_error)
    plain = copies(cut.cage, points, 1024, 48, quads=quads, correction="none")[0]
    common = fine > 0.01  # others are met by too few walks for a standard error
    assert_unbiased(plain[:, common], fine[common], own_error=own_error[common])


@pytest.mark.parametrize("quads", ["harmonic", "mean_value"])
def test_fits_and_finite_elements(half_cut_l, quads):
    """A fit of the same cage is as close to the finite elements as they are to the truth, or within 1e-3."""
    cut, points, references = half_cut_l
    coarse, fine = (reference.weights(quads=quads) for reference in references)
    off = np.abs(fitted(cut.cage, points, quads=quads, panel_size=0.5) - fine)
    assert (off < np.abs(fine - coarse) / 3.0 + 1e-3).all()
