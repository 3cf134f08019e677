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
    assert_reproduces,
    copies,
    interior_points,
    middle_cut,
    multilinear,
    points_inside,
    small_obstacle,
)
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.harmonic.options import WalkOptions


def fitted(cage, points, **options) -> HarmonicCoordinates:
    """Coordinates by the fit alone."""
    return HarmonicCoordinates(cage, points, 0, correction="fitted", **({"quads": "harmonic"} | options))


def assert_same(one: HarmonicCoordinates, other: HarmonicCoordinates) -> None:
    """Assert that weights and gradients are the same, bit for bit."""
    assert np.array_equal(one.weights, other.weights)
    assert np.array_equal(one.gradients, other.gradients)


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("name", ["box", "annulus"])
def test_update_equals_recompute(name, device):
    """Through a cut, up to its end and across pieces, an update has the bits of a recompute and of new coordinates."""
    cage = MAKERS[name]()
    points = interior_points(cage, 60, np.random.default_rng(0))
    coordinates = fitted(cage, points, gradients=np.arange(60) % 2 == 0, device=device)
    assert_reproduces(coordinates, points, gradients=False)
    cut = middle_cut(cage)
    for depth in (0.4 * cut.length, 2.0 * cut.length):
        stats = coordinates.update(cut.advance(to=depth))
        assert stats.resolved_points == 60
        assert set(stats.seconds) >= {"fit", "resolve"}
        weights, gradients = coordinates.weights, coordinates.gradients
        coordinates.recompute()
        assert np.array_equal(coordinates.weights, weights)
        assert np.array_equal(coordinates.gradients, gradients)
    fresh = fitted(cut.cage, points, gradients=np.arange(60) % 2 == 0, device=device)
    assert_same(coordinates, fresh)
    everywhere = fitted(cut.cage, points, gradients=True, device=device)
    assert_reproduces(everywhere, points)
    piece = cut.cage.piece_of(points)
    assert not everywhere.weights[piece[:, None] != cut.cage.vertex_piece].any()


def test_points_come_and_go(tmp_path):
    """Points are set, added and removed, snapshots taken back, coordinates saved and loaded, all to the bit."""
    cage = box()
    points = interior_points(cage, 12, np.random.default_rng(1))
    cut = middle_cut(cage)
    coordinates = fitted(cage, points[:10], point_capacity=12)
    coordinates.update(cut.advance(to=0.5))
    before = coordinates.weights
    snapshot = coordinates.snapshot()
    coordinates.remove_points([2, 5])
    assert not coordinates.weights[[2, 5]].any()
    coordinates.set_points([5, 10, 11], points[[5, 10, 11]])
    assert np.array_equal(coordinates.weights[5], before[5])
    assert np.array_equal(coordinates.weights_at(points[10:]), coordinates.weights[10:])
    coordinates.update(cut.advance(to=0.6))
    assert not coordinates.weights[2].any()
    coordinates.restore(snapshot)
    assert np.array_equal(coordinates.weights, before)
    coordinates.recompute()
    assert np.array_equal(coordinates.weights, before)
    path = tmp_path / "fitted.cagecut"
    coordinates.save(path)
    loaded = HarmonicCoordinates.load(path, coordinates.cage, points[:10], correction="fitted")
    assert np.array_equal(loaded.weights, before)


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


def test_options():
    """Fitted coordinates take no walks, others need some; the text says so."""
    with pytest.raises(ValueError, match="takes walks=0, not 1024"):
        HarmonicCoordinates(box(), np.full((1, 3), 0.5), correction="fitted")
    with pytest.raises(ValueError, match="walks must be a whole number from 1 "):
        WalkOptions(0, 0)
    assert WalkOptions(0, 0, correction="fitted").walks == 0
