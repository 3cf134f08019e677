# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Boundary values: how triangles, quads, slit faces and the sides of a cut interpolate."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box, hexagonal_prism, prism
from harmonic_shapes import MAKERS, UNITS, interior_points, mean_value, middle_cut, side_vertices
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates


def bake(cage: Cage, **options) -> HarmonicCoordinates:
    """Coordinates of a few points, for the sake of their boundary weights."""
    points = interior_points(cage, 4, np.random.default_rng(0))
    return HarmonicCoordinates(cage, points, 64, gradients=True, **options)


def cut_unit(depth: float, name: str = "box") -> tuple[HarmonicCoordinates, Cut]:
    """A box or a square cut from above to a depth; its top and bottom lie across the cut and are split."""
    cage = MAKERS[name]()
    coordinates, cut = bake(cage), middle_cut(cage)
    coordinates.update(cut.advance(to=depth))
    return coordinates, cut


def points_on_face(cage: Cage, face: int, count: int, rng: np.random.Generator) -> np.ndarray:
    """Uniform points of a face's triangles, or of its segment."""
    simplices = cage.vertices[cage.simplices[cage.simplex_face == face]]
    share = rng.dirichlet(np.ones(cage.dimension), count)
    return np.einsum("nk,nki->ni", share, simplices[rng.integers(len(simplices), size=count)])


def face_keys(cage: Cage, face: int, count: int) -> np.ndarray:
    """The face's key for each point."""
    return np.full(count, cage.face_key[face])


def assert_interpolates(weights: np.ndarray, cage: Cage, points: np.ndarray) -> None:
    """Unit sum and linear precision."""
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose(weights @ cage.vertices, points, atol=1e-5 * cage.diameter)


@pytest.mark.parametrize("name", ["star", "tetrahedron"])
def test_simplex_is_barycentric(name):
    """On a triangle or a segment the weights are those that made the point."""
    cage = MAKERS[name]()
    coordinates = bake(cage)
    for face, loop in enumerate(cage.faces):
        share = np.random.default_rng(face).dirichlet(np.ones(cage.dimension), 20)
        corners = list(loop)
        weights = coordinates.boundary_weights(share @ cage.vertices[corners], face_keys(cage, face, 20), walks=4)
        np.testing.assert_allclose(weights[:, corners], share, atol=1e-6)
        assert np.all(np.delete(weights, corners, axis=1) == 0.0)


def test_convex_quad_is_mean_value():
    """Convex quads of any shape have Floater's coordinates: positive, with linear precision, linear on edges."""
    cage = prism(np.array([[0.0, 0.0], [2.0, 0.2], [1.4, 1.1], [0.3, 0.8]]), 0.7)
    coordinates, rng = bake(cage), np.random.default_rng(1)
    for face, loop in enumerate(cage.faces):
        corners = cage.vertices[list(loop)]
        points = points_on_face(cage, face, 30, rng)
        weights = coordinates.boundary_weights(points, face_keys(cage, face, 30), walks=4)
        expected = np.array([mean_value(corners, point) for point in points])
        np.testing.assert_allclose(weights[:, list(loop)], expected, atol=2e-5)
        assert (weights[:, list(loop)] > 0.0).all()
        assert_interpolates(weights, cage, points)
        middle = 0.5 * (corners + np.roll(corners, -1, axis=0))
        on_edges = coordinates.boundary_weights(middle, face_keys(cage, face, 4), walks=4)[:, list(loop)]
        np.testing.assert_allclose(on_edges, 0.5 * (np.eye(4) + np.roll(np.eye(4), 1, axis=1)), atol=1e-5)


def test_hexagon_is_harmonic():
    """On an n-gon nested walks give the harmonic weights: one sixth at its centre, linear precision anywhere."""
    cage = hexagonal_prism()
    points = np.concatenate(
        [cage.vertices[:6].mean(axis=0)[None], points_on_face(cage, 0, 20, np.random.default_rng(2))]
    )
    weights = bake(cage).boundary_weights(points, face_keys(cage, 0, 21), walks=2048)
    assert_interpolates(weights, cage, points)
    np.testing.assert_allclose(weights[0, :6], 1.0 / 6.0, atol=0.02)
    assert np.all(weights[:, 6:] == 0.0)


def test_quad_is_bilinear_on_request():
    """quads="harmonic" gives bilinear weights on a rectangle, within the noise of the nested walks."""
    cage = box()
    points = points_on_face(cage, 0, 30, np.random.default_rng(3))
    weights = bake(cage, quads="harmonic").boundary_weights(points, face_keys(cage, 0, 30), walks=2048)
    loop = list(cage.faces[0])
    corners = cage.vertices[loop]
    varying = np.ptp(corners, axis=0) > 0.0
    bilinear = np.abs(1.0 - corners - points[:, None])[:, :, varying].prod(axis=2)
    assert np.sqrt(np.mean((weights[:, loop] - bilinear) ** 2)) < 0.01
    assert_interpolates(weights, cage, points)


def slit_face(cut: Cut) -> int:
    """The box's face in the plane y = 0, which the cut's front has slit."""
    (face,) = (f for f, loop in enumerate(cut.cage.faces) if np.all(cut.cage.vertices[list(loop)][:, 1] == 0.0))
    return face


def test_slit_face():
    """A slit face interpolates: unit sum, linear precision, no weight but of its own loop."""
    coordinates, cut = cut_unit(0.6)
    cage, face = cut.cage, slit_face(cut)
    assert len(cage.faces[face]) == 7
    points = points_on_face(cage, face, 40, np.random.default_rng(4))
    weights = coordinates.boundary_weights(points, face_keys(cage, face, 40), walks=256)
    assert_interpolates(weights, cage, points)
    assert np.all(np.delete(weights, cage.faces[face], axis=1) == 0.0)


@pytest.mark.parametrize("side", [0, 1])
def test_no_weight_across_the_slit(side):
    """A point next to a slit has no weight at all of the slit's other side, and is linear along its own."""
    coordinates, cut = cut_unit(0.6)
    cage, face = cut.cage, slit_face(cut)
    loop, sides = set(cage.faces[face]), [set(side_vertices(cage, cut.wall, s).tolist()) for s in (0, 1)]
    (opened,), (other,) = (loop & (sides[s] - sides[1 - s]) for s in (side, 1 - side))
    (tip,) = loop & sides[0] & sides[1]
    share = np.linspace(0.05, 0.95, 15)
    offset = (2 * side - 1) * 1e-5 * cut.plane.normal
    points = share[:, None] * cage.vertices[opened] + (1.0 - share)[:, None] * cage.vertices[tip] + offset
    weights = coordinates.boundary_weights(points, face_keys(cage, face, 15), walks=64)
    assert np.all(weights[:, other] == 0.0)
    np.testing.assert_allclose(weights[:, opened], share, atol=1e-3)
    np.testing.assert_allclose(weights[:, tip], 1.0 - share, atol=1e-3)


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("name", UNITS)
def test_sides_of_the_cut(name, side):
    """A side of the cut interpolates among its own vertices only; on the front linearly between the tips."""
    coordinates, cut = cut_unit(0.6, name)
    cage = cut.cage
    own, other = side_vertices(cage, cut.wall, side), side_vertices(cage, cut.wall, 1 - side)
    tips = np.intersect1d(own, other)
    assert len(tips) == cage.dimension - 1
    (face,) = np.flatnonzero(cage.face_key == 2 * cut.wall + side)
    points = points_on_face(cage, face, 30, np.random.default_rng(5))
    weights = coordinates.boundary_weights(points, face_keys(cage, face, 30), walks=64)
    assert_interpolates(weights, cage, points)
    assert np.all(weights[:, np.setdiff1d(other, tips)] == 0.0)
    share = np.linspace([0.0, 1.0], [1.0, 0.0], 11) if len(tips) == 2 else np.ones((1, 1))
    weights = coordinates.boundary_weights(share @ cage.vertices[tips], face_keys(cage, face, len(share)), walks=64)
    np.testing.assert_allclose(weights[:, tips], share, atol=1e-5)


@pytest.mark.parametrize("offset", [-1e-5, 1e-5, -0.2, 0.2])
@pytest.mark.parametrize("name", UNITS)
def test_split_face(name, offset):
    """Once a face is split a point of it has weights of its own piece only, however close to the cut."""
    coordinates, cut = cut_unit(1.1, name)
    cage = cut.cage
    points = np.c_[np.full(9, 0.47 + offset), np.linspace(0.1, 0.9, 9), np.ones(9)]
    points = np.delete(points, np.arange(1, 4 - cage.dimension), axis=1)
    (key,) = {int(k) for f, k in enumerate(cage.face_key) if np.all(cage.vertices[list(cage.faces[f])][:, -1] == 1.0)}
    weights = coordinates.boundary_weights(points, np.full(9, key), walks=64)
    assert_interpolates(weights, cage, points)
    foreign = cage.vertex_piece != cage.piece_of(points - 0.1 * np.eye(cage.dimension)[-1])[:, None]
    assert foreign.any()
    assert np.all(weights[foreign] == 0.0)


@pytest.mark.parametrize("name", UNITS)
def test_keys_are_checked(name):
    """A key that no wall has is refused, with the range; so are points of another dimension."""
    cage = MAKERS[name]()
    coordinates = bake(cage)
    point, count = np.array([[0.5, 0.5, 1.0]])[:, 3 - cage.dimension :], 2 * cage.face_count
    for key in (count, -1):
        with pytest.raises(ValueError, match=f"0 to {count - 1}"):
            coordinates.boundary_weights(point, np.array([key]))
    with pytest.raises(ValueError, match=r"point_keys must have shape \(1,\), got \(2,\)"):
        coordinates.boundary_weights(point, np.array([0, 1]))
    with pytest.raises(ValueError, match=rf"shape \(n, {cage.dimension}\)"):
        coordinates.boundary_weights(point[:, 1:], np.array([0]))
