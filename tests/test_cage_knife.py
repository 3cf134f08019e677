# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Knives of finite width and blades that start inside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import SHAPES, box, check_manifold, opened_characteristic
from cut_sequences import crossings
from newton_cagecut.cage import Cage, CageEdit, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade

RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}


def _check(edit: CageEdit, cut: Cut, volume: float) -> None:
    check_manifold(edit.cage, volume)
    assert edit.created.tolist() == list(range(edit.before.vertex_count, edit.cage.vertex_count))
    assert len(edit.source_faces) == len(edit.created) + len(edit.moved)
    if not edit.is_empty:
        assert edit.cage.euler_characteristic == opened_characteristic(cut.base, edit.cage, cut.wall)
        assert crossings(edit.cage) == 0


def _area(cut: Cut, side: int) -> float:
    area = np.linalg.norm(cut.cage.mesh.face_area_vector, axis=1)
    return float(area[cut.cage.face_key == 2 * cut.wall + side].sum())


def test_a_knife_from_one_side():
    """A knife that reaches in from one side leaves a notch whose front has a corner inside the box."""
    cut = Cut(box(), Blade([0.5, 0.0, 0.5], [0, 1, 0], [0, 0, -1], width=(-1.0, 0.4)))
    for depth, area in ((0.3, 0.12), (0.7, 0.28), (2.0, 0.4)):
        edit = cut.advance(to=depth)
        _check(edit, cut, 1.0)
        assert _area(cut, 0) == pytest.approx(area, abs=1e-5)
        assert _area(cut, 1) == pytest.approx(area, abs=1e-5)
        assert np.sum([np.linalg.norm(np.cross(t[1] - t[0], t[2] - t[0])) / 2 for t in edit.swept_simplices]) > 0.0
        inside = (np.abs(edit.cage.vertices - 0.5) < 0.4999).all(axis=1)
        assert np.count_nonzero(inside) == (1 if depth < 1.0 else 0) + (0 if depth < 1.0 else 1)
    assert cut.complete
    assert cut.cage.component_count == 1


def test_a_narrow_knife_pokes_a_face():
    """A knife narrower than a face slits it without meeting its edges, and comes out on the other side."""
    cut = Cut(box(), Blade([0.5, 0.5, 0.5], [0, 1, 0], [0, 0, -1], width=0.3))
    first = cut.advance(to=0.5)
    _check(first, cut, 1.0)
    top = [face for face in first.cage.faces if len(face) > 6]
    assert len(top) >= 1
    assert _area(cut, 0) == pytest.approx(0.15, abs=1e-5)
    last = cut.advance(to=2.0)
    _check(last, cut, 1.0)
    assert _area(cut, 0) == pytest.approx(0.3, abs=1e-5)
    assert last.cage.component_count == 1
    assert last.cage.euler_characteristic == 0
    across = Cut(last.cage, Blade([0.5, 0.5, 0.4], [1, 0.1, 0], [0, 0.1, -1]))
    for part in (0.3, 0.7, 1.1):
        check_manifold(across.advance(to=part * across.length).cage, 1.0)


def test_a_blade_that_starts_inside():
    """A blade that starts inside cuts ahead of its start only; depth counts from there."""
    cut = Cut(box(), Blade([0.5, 0.5, 0.6], [0, 1, 0], [0, 0, -1], start=0.0))
    assert cut.length == pytest.approx(0.6)
    for depth in (0.2, 0.4, 1.0):
        edit = cut.advance(to=depth)
        _check(edit, cut, 1.0)
        assert _area(cut, 0) == pytest.approx(min(depth, 0.6), abs=1e-5)
        sides = np.flatnonzero(edit.cage.face_wall == cut.wall)
        heights = edit.cage.vertices[[v for f in sides for v in edit.cage.faces[f]], 2]
        assert heights.max() == pytest.approx(0.6, abs=1e-5)
    assert cut.cage.component_count == 1


def _knife(rng: np.random.Generator, cage: Cage) -> Blade:
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    size = float(np.linalg.norm(high - low))
    reach = rng.choice([0.1, 0.5]) * size
    heel, tip = np.sort(rng.uniform(-reach, reach, 2))
    window = {"width": [(heel, tip), (heel, tip), (heel, np.inf), (-np.inf, tip)][rng.integers(4)]}
    if rng.random() < 0.6:
        window["start"] = rng.uniform(-reach, 0.2 * size)
    return Blade(low + (high - low) * rng.uniform(0.2, 0.8, 3), rng.normal(size=3), rng.normal(size=3), **window)


@pytest.mark.parametrize("name", SHAPES)
@settings(max_examples=12, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_random_knives(name, seed):
    """Knives of random widths and starts, crossing each other, keep a closed manifold; one step is many."""
    rng = np.random.default_rng(seed)
    cage = SHAPES[name]()
    volume = cage.volume
    for _ in range(3):
        blade = _knife(rng, cage)
        cut, one = Cut(cage, blade), Cut(cage, blade)
        fixed = cage.vertices
        for part in np.sort(rng.uniform(0.0, 1.1, 4)):
            edit = cut.advance(to=part * cut.length)
            _check(edit, cut, volume)
            np.testing.assert_array_equal(edit.cage.vertices[: len(fixed)], fixed)
        one.advance(to=cut.depth)
        assert one.cage.faces == cut.cage.faces
        np.testing.assert_array_equal(one.cage.vertices, cut.cage.vertices)
        assert _area(cut, 0) == pytest.approx(_area(cut, 1), abs=1e-9)
        cage = cut.cage


def test_weights_follow_a_knife():
    """Updates through a knife's corner, and through a cut across what it left, equal recomputes bit for bit."""
    points = np.random.default_rng(3).uniform(0.1, 0.9, (10, 3))
    coordinates = HarmonicCoordinates(box(), points, walks=64, seed=5, gradients=True, device="cpu")
    knife = Cut(coordinates.cage, Blade([0.5, 0.0, 0.5], [0, 1, 0.1], [0.1, 0, -1], width=(0.2, 0.7)))
    across = Blade([0.5, 0.5, 0.7], [0, 1, 0], [1, 0, 0.05], start=-0.3)
    for cut in (knife, None):
        cut = cut or Cut(coordinates.cage, across)
        for part in (0.3, 0.7, 1.1):
            coordinates.update(cut.advance(to=part * cut.length))
            weights, gradients = coordinates.weights, coordinates.gradients
            np.testing.assert_allclose(weights @ coordinates.cage.vertices, points, atol=1e-5)
            coordinates.recompute()
            np.testing.assert_array_equal(weights, coordinates.weights)
            np.testing.assert_array_equal(gradients, coordinates.gradients)


def test_plain_cuts_cross_what_knives_left():
    """A blade without ends opens a slit of finite width that it crosses: each half keeps its part as a tunnel."""
    base = box()
    slit = Cut(base, Blade([0.5, 0.5, 0.5], [0, 1, 0], [0, 0, -1], width=0.4)).advance(to=2.0).cage
    cut = Cut(slit, Blade([0.5, 0.5, 0.5], [1, 0.1, 0], [0, 1, 0.05]))
    for part in (0.2, 0.4, 0.6, 0.8, 1.1):
        _check(cut.advance(to=part * cut.length), cut, 1.0)
    assert cut.cage.component_count == 2
    assert cut.cage.euler_characteristic == 0


def test_refusals():
    """Turned knives, and widths that are none, are refused."""
    with pytest.raises(ValueError, match="heel must lie before its tip"):
        Blade([0, 0, 0], [1, 0, 0], [0, 1, 0], width=(0.3, 0.1))
    with pytest.raises(TypeError, match="width must be a length"):
        Blade([0, 0, 0], [1, 0, 0], [0, 1, 0], width="wide")
    with pytest.raises(ValueError, match="start must lie between"):
        Blade([0, 0, 0], [1, 0, 0], [0, 1, 0], start=np.nan)
    cut = Cut(box(), Blade([0.5, 0.5, 0.5], [0, 1, 0], [0, 0, -1], width=0.3))
    assert Blade([0, 0, 0], [1, 0, 0], [0, 1, 0]).window is None
    cage = cut.advance(to=0.4).cage
    with pytest.raises(ValueError, match="neither turns nor goes on"):
        cut.turn([1, 0, 0])
    assert cut.cage is cage
