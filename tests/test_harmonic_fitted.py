# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Coordinates with correction "fitted": through cuts and other edits, and all that is kept of them."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import box
from harmonic_shapes import (
    DEVICES,
    MAKERS,
    assert_identical,
    assert_reproduces,
    by_copy,
    copies,
    interior_points,
    middle_cut,
    multilinear,
    points_inside,
    small_obstacle,
)
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates, choose_correction, closed_form_weights
from newton_cagecut.harmonic.options import WalkOptions
from newton_cagecut.section import Blade
from plane_reference import PlaneReference, plane_reference
from plane_shapes import loops_of


def fitted(cage, points, walks: int = 0, **options) -> HarmonicCoordinates:
    """Coordinates by the fit alone, or with walks."""
    return HarmonicCoordinates(cage, points, walks, **({"correction": "fitted", "quads": "harmonic"} | options))


def results(coordinates: HarmonicCoordinates) -> dict[str, np.ndarray]:
    """Weights, gradients and errors."""
    found = {"weights": coordinates.weights, "gradients": coordinates.gradients}
    return found | ({"errors": coordinates.errors} if coordinates.walks else {})


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize(("name", "walks"), [("box", 0), ("box", 6), ("annulus", 6)])
def test_update_equals_recompute(name, walks, device):
    """Through a cut, up to its end and across pieces, an update has the bits of a recompute and of new coordinates."""
    cage = MAKERS[name]()
    points = interior_points(cage, 60, np.random.default_rng(0))
    coordinates = fitted(cage, points, walks, gradients=np.arange(60) % 2 == 0, device=device)
    assert_reproduces(coordinates, points, gradients=False)
    cut = middle_cut(cage)
    for depth in (0.4 * cut.length, 2.0 * cut.length):
        stats = coordinates.update(cut.advance(to=depth))
        assert stats.resolved_points == 60
        assert set(stats.seconds) >= {"fit", "resolve"}
        before = results(coordinates)
        coordinates.recompute()
        assert_identical(results(coordinates), before)
    fresh = fitted(cut.cage, points, walks, gradients=np.arange(60) % 2 == 0, device=device)
    if walks == 0:  # the walls of a cage that came cut are in another order than those of one that was cut
        assert_identical(results(fresh), before)
    everywhere = fitted(cut.cage, points, walks, gradients=True, device=device)
    assert_reproduces(everywhere, points)
    piece = cut.cage.piece_of(points)
    assert not everywhere.weights[piece[:, None] != cut.cage.vertex_piece].any()


@pytest.mark.parametrize("walks", [0, 5])
def test_points_come_and_go(tmp_path, walks):
    """Points are set, added and removed, snapshots taken back, coordinates saved and loaded, all to the bit."""
    cage = box()
    points = interior_points(cage, 12, np.random.default_rng(1))
    cut = middle_cut(cage)
    coordinates = fitted(cage, points[:10], walks, point_capacity=12)
    coordinates.update(cut.advance(to=0.5))
    before, results_before = coordinates.weights, results(coordinates)
    snapshot = coordinates.snapshot()
    coordinates.remove_points([2, 5])
    assert not coordinates.weights[[2, 5]].any()
    coordinates.set_points([5, 10, 11], points[[5, 10, 11]])
    assert np.array_equal(coordinates.weights[5], before[5])
    if walks == 0:  # walks draw their randomness by the points' numbers
        assert np.array_equal(coordinates.weights_at(points[10:]), coordinates.weights[10:])
    coordinates.update(cut.advance(to=0.6))
    assert not coordinates.weights[2].any()
    coordinates.restore(snapshot)
    assert_identical(results(coordinates), results_before)
    coordinates.recompute()
    assert_identical(results(coordinates), results_before)
    path = tmp_path / "fitted.cagecut"
    coordinates.save(path)
    loaded = HarmonicCoordinates.load(path, coordinates.cage, points[:10], correction="fitted")
    assert_identical(results(loaded), results_before)


@pytest.mark.parametrize("name", ["box", "star"])
def test_points_on_the_boundary(name):
    """On vertices, edges, faces and a little outside weights are those of the boundary; on a cut those of its side."""
    cage = MAKERS[name]()
    middles = np.array([cage.vertices[list(face)].mean(axis=0) for face in cage.faces])
    outside = middles[:1] + 0.5 * cage.length_tolerance * cage.walls[0].normal
    points = np.concatenate([cage.vertices, middles, outside])
    weights = fitted(cage, points).weights
    np.testing.assert_allclose(weights[: cage.vertex_count], np.eye(cage.vertex_count), atol=1e-6)
    np.testing.assert_allclose(weights @ cage.vertices, points, atol=3e-6)
    for face, row in zip(cage.faces, weights[cage.vertex_count :]):
        assert not np.delete(row, list(face)).any()
    cut = middle_cut(cage)
    opened = cut.advance(to=0.5 * cut.length).cage
    on_cut = np.flatnonzero(opened.face_wall == cut.wall)
    place = np.repeat(opened.vertices[list(opened.faces[on_cut[0]])].mean(axis=0)[None], 2, axis=0)
    keys = 2 * cut.wall + np.arange(2)
    sides = fitted(opened, place, point_keys=keys).weights
    for key, row in zip(keys, sides):
        own = np.unique(np.concatenate([opened.faces[face] for face in np.flatnonzero(opened.face_key == key)]))
        assert not np.delete(row, own).any()
    np.testing.assert_allclose(sides @ opened.vertices, place, atol=3e-6)


def slit_square():
    """A square that is slit from the top to its middle."""
    return Cut(MAKERS["square"](), Blade([0.5, 0.5], [0.0, -1.0])).advance(to=0.5).cage


def around_the_tip(count: int, *, nearest: float = 1e-3) -> np.ndarray:
    """Points near the end of the square's slit, at distances that fall by powers."""
    rng = np.random.default_rng(4)
    angle = rng.uniform(-0.9 * np.pi, 0.9 * np.pi, count) - 0.5 * np.pi
    return 0.5 + np.geomspace(nearest, 0.1, count)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


@pytest.mark.parametrize(("name", "bias"), [("box", 3e-6), ("l_shape", 3e-6), ("slit_square", 2e-5)])
def test_errors_are_standard_errors(name, bias):
    """Copies of a point spread by the errors that they tell, about the exact weights, at the tip of a slit too."""
    cage = slit_square() if name == "slit_square" else MAKERS[name]()
    points = around_the_tip(12) if name == "slit_square" else points_inside(cage, 12, 1)
    exact = multilinear(cage, points)[0] if name == "box" else plane_reference(cage, points)[0]
    many = np.repeat(points, 24, axis=0)
    coordinates = fitted(cage, many, 96)
    estimates, errors = (by_copy(found, 24) for found in (coordinates.weights, coordinates.errors))
    told = np.sqrt(np.mean(errors**2, axis=0))
    spread = np.maximum(estimates.std(axis=0, ddof=1), 1e-7)
    assert 0.8 < np.median(told / spread) < 1.25
    assert (np.abs(estimates.mean(axis=0) - exact) < 4.0 * told / np.sqrt(24) + bias).all()


def test_walks_correct_gradients_where_they_can():
    """At the tip of a slit, where the fit is worst, walks correct its gradients; in a box their noise is held back."""
    cage, points = slit_square(), around_the_tip(60, nearest=5e-3)
    exact = plane_reference(cage, points)[1]
    off = [np.sqrt(np.mean((fitted(cage, points, n, gradients=True).gradients - exact) ** 2)) for n in (0, 16, 1024)]
    assert off[1] < 1.05 * off[0]
    assert off[2] < 0.6 * off[0]
    cage = box()
    points = points_inside(cage, 60, 1)
    exact = multilinear(cage, points)[1]
    for walks in (2, 16, 256):
        found = fitted(cage, points, walks, gradients=True)
        assert np.sqrt(np.mean((found.gradients - exact) ** 2)) < 1e-3
        assert_reproduces(found, points)


def test_bias_of_tables():
    """Tables of what the fit leaves over change the weights by far less than it leaves over."""
    cut = Cut(box(), Blade([0.5, 0.5, 0.5], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]))
    turn = np.linalg.qr(np.random.default_rng(6).normal(size=(3, 3)))[0]
    turn[:, 0] *= np.linalg.det(turn)
    turned = Cage((box().vertices @ turn).astype(np.float32), box().faces)  # planar as far as files tell
    for cage, points in (
        (cut.advance(to=0.5).cage, points_inside(box(), 20, 3)),
        (slit_square(), around_the_tip(20)),
        (turned, points_inside(box(), 20, 3) @ turn),
    ):
        found = closed_form_weights(cage, points, 64, 5, quads="harmonic" if cage.dimension == 3 else None)
        told = np.sqrt(np.mean(found.squared_errors))
        assert np.sqrt(np.mean(found.table_bias**2)) < 0.5 * told
        assert np.sqrt(np.mean(found.table_bias**2)) < 1e-4


def test_walks_of_a_slit_box():
    """Near a slit and its tip, where the fit is worst, the mean of many walks is several times closer to the truth."""
    plane = Cut(MAKERS["square"](), Blade([0.5, 0.5], [0.0, -1.0])).advance(to=0.5).cage
    cut = Cut(box(), Blade([0.5, 0.5, 0.5], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]))
    cage = cut.advance(to=0.5).cage
    corners = plane.vertices[loops_of(plane)[0]]
    rng = np.random.default_rng(2)
    points = np.array([0.5, 0.5, 0.2]) + rng.uniform(0.01, 0.05, (40, 3)) * rng.choice([-1.0, 1.0], (40, 3))
    reference = PlaneReference(corners).weights(points[:, :2])
    lower = np.isclose(cage.vertices[:, 2], 0.0)
    off = []
    for walks in (0, 1024):
        found = fitted(cage, points, walks).weights.astype(np.float64)
        # Vertices that coincide are summed: the sides of the slit are told apart elsewhere.
        sums = [
            found[:, lower & (np.abs(cage.vertices[:, :2] - corner) < 1e-9).all(axis=1)].sum(axis=1)
            for corner in corners
        ]
        exact = [reference[:, (np.abs(corners - corner) < 1e-9).all(axis=1)].sum(axis=1) for corner in corners]
        off.append(np.sqrt(np.mean((np.array(sums) - np.array(exact) * (1.0 - points[:, 2])) ** 2)))
    assert off[0] < 2e-3
    assert off[1] < off[0] / 2.0


def test_other_edits():
    """A face that has moved outward, an extrusion and an obstacle: what walks say of the cage as it is then."""
    cage = box()
    points = points_inside(cage, 8, 0)
    coordinates = fitted(cage, points)
    moved = cage.move_face(1, 0.4)
    coordinates.update(moved)
    np.testing.assert_allclose(coordinates.weights, multilinear(moved.cage, points)[0], atol=3e-3)
    extruded = moved.cage.extrude(3, 0.3)
    coordinates.update(extruded)
    coordinates.update(extruded.cage.insert(small_obstacle(box(), np.array([0.5, 0.52, 0.5]), 0.05)))
    walked = copies(coordinates.cage, points, 1024, 12, quads="harmonic")[0]
    error = walked.std(axis=0, ddof=1) / np.sqrt(12)
    assert np.sqrt(np.mean((coordinates.weights - walked.mean(axis=0)) ** 2)) < np.sqrt(np.mean(error**2)) + 1e-3


def test_choice_by_size(tmp_path):
    """By "auto" a cage that a fit is quick for has one, others are walked for; a file keeps what was chosen."""
    points = points_inside(box(), 6, 0)
    chosen = fitted(box(), points, 4, correction="auto")
    assert_identical(results(chosen), results(fitted(box(), points, 4)))
    path = tmp_path / "chosen.cagecut"
    chosen.save(path)
    loaded = HarmonicCoordinates.load(path, chosen.cage, points, correction="auto")
    assert_identical(results(loaded), results(chosen))
    large = box().triangulated()
    while sum(map(len, large.faces)) <= 2000:
        large = large.refine()
    assert choose_correction(large).correction == "harmonic"
    found = HarmonicCoordinates(large, points, 8, correction="auto")
    assert np.array_equal(found.weights, HarmonicCoordinates(large, points, 8).weights)
    with pytest.raises(ValueError, match="walks must be a whole number from 1 "):
        HarmonicCoordinates(large, points, 0, correction="auto")


def test_options():
    """Fitted coordinates need no walks, others do; errors are told by walks of a fit, and the text says so."""
    with pytest.raises(ValueError, match="walks must be a whole number from 1 "):
        WalkOptions(0, 0)
    point = np.full((1, 3), 0.5)
    for options in ({"walks": 0, "correction": "fitted"}, {"walks": 1, "correction": "fitted"}, {"walks": 8}):
        with pytest.raises(ValueError, match="two walks or more"):
            _ = HarmonicCoordinates(box(), point, **options).errors
