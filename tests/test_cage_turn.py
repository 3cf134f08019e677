# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Curved cuts, whose blade turns about its front, and cuts side by side, which go on in each other's cages."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from cage_shapes import SHAPES, box, check_manifold, opened_characteristic, random_blade, u_shape
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from plane_shapes import PLANES, outline, rectangle

EVERY = SHAPES | PLANES
RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
DOWN = Blade([0.513, 0.5, 0.5], [0, 1, 0], [0, 0, -1])


def _turned(rng: np.random.Generator, cut: Cut, most: float) -> np.ndarray:
    """The cut's direction turned about its edge by a random angle of up to ``most`` radians."""
    plane, angle = cut.plane, rng.uniform(-most, most)
    return np.cos(angle) * plane.across + np.sin(angle) * plane.normal + rng.uniform(-0.2, 0.2) * plane.edge


def _step(cut: Cut, to: float, base: Cage, volume: float) -> None:
    edit = cut.advance(to=to)
    check_manifold(edit.cage, volume)
    if not edit.is_empty:
        assert edit.cage.euler_characteristic == opened_characteristic(base, edit.cage, cut.wall)
        np.testing.assert_array_equal(edit.before.vertices[: base.vertex_count], base.vertices)


def test_a_bent_cut_of_a_box():
    """A cut down and then to the side frees a corner: the two walls meet at the front of the first."""
    cut = Cut(box(), DOWN)
    first = cut.advance(to=0.4).cage
    tips = np.flatnonzero(np.isclose(first.vertices[:, 2], 0.6))
    cut.turn([1, 0, 0])
    assert cut.cage is first
    edit = cut.advance(to=0.6)
    cage = edit.cage
    check_manifold(cage, 1.0)
    assert len(cage.walls) == 8
    assert (cut.wall, cut.depth) == (7, 0.6)
    # Each hinge vertex comes apart into two and has a tip ahead of it.
    assert cage.vertex_count == first.vertex_count + 4
    assert cage.euler_characteristic == 2
    sides = [set(cage.faces[f]) for f in np.flatnonzero(cage.face_wall == 7)]
    assert len(sides) == 2
    assert sum(set(tips.tolist()) <= side for side in sides) == 1
    last = cut.advance(to=5.0)
    check_manifold(last.cage, 1.0)
    assert cut.complete
    assert last.separated
    assert sorted(last.cage.component_volumes) == pytest.approx([0.487 * 0.4, 1.0 - 0.487 * 0.4])
    assert cut.length == pytest.approx(0.4 + 0.487, abs=1e-5)


@pytest.mark.parametrize("name", ["box", "star_prism", "u_shape", "square_torus", *PLANES])
def test_zero_turn_goes_straight_on(name):
    """A turn by nothing gives the volumes and pieces of one straight cut, with a second wall in the same plane."""
    base = EVERY[name]()
    vectors = np.array([[0.1, 1.0, 0.2], [1.0, 0.1, 0.3]])[3 - base.dimension :, : base.dimension]
    blade = Blade(base.vertices.mean(axis=0) + 0.01, *vectors)
    one, two = Cut(base, blade), Cut(base, blade)
    one.advance(to=1e3)
    two.advance(to=0.45 * two.length)
    two.turn(two.plane.direction)
    two.advance(to=1e3)
    check_manifold(two.cage, base.volume)
    np.testing.assert_allclose(sorted(two.cage.component_volumes), sorted(one.cage.component_volumes), rtol=1e-5)
    assert two.cage.euler_characteristic == one.cage.euler_characteristic
    assert len(two.cage.walls) == len(one.cage.walls) + 1


@pytest.mark.parametrize("dimension", [2, 3])
def test_scalpel_around_a_circle(dimension):
    """Twelve short strips in a circle, each turned by 30 degrees, carve a core that the last of them frees."""
    base = box((4.0, 3.0, 1.0)) if dimension == 3 else outline(rectangle((0, 0), (4, 3)))
    edge = ([0, 0, 1],) if dimension == 3 else ()
    cut = Cut(base, Blade([1.5, 0.7, 0.5][:dimension], *edge, [0, 1, 0][:dimension]))
    cut.advance(to=1.4)
    side, angle = 0.45, 0.0
    for _ in range(14):
        angle += np.pi / 6.0
        cut.turn([np.sin(angle), np.cos(angle), 0.0][:dimension])
        cut.advance(to=cut.depth + side)
        check_manifold(cut.cage, base.volume)
    assert len(cut.cage.walls) == base.face_count + 15
    assert cut.cage.component_count == 2
    apothem = 0.5 * side / np.tan(np.pi / 12.0)
    assert min(cut.cage.component_volumes) == pytest.approx(12 * 0.5 * side * apothem, rel=0.2)


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=8, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_random_turns(name, seed):
    """Cuts with random turns, crossing earlier ones, keep a closed manifold of the same volume."""
    rng = np.random.default_rng(seed)
    cage = EVERY[name]()
    volume = cage.volume
    for _ in range(2):
        cut = Cut(cage, random_blade(rng, cage))
        for _ in range(4):
            base = cut.cage
            for _ in range(rng.integers(1, 3)):
                left = cut.length - cut.depth
                _step(cut, cut.depth + rng.uniform(0.0, 0.5) * left, base, volume)
            if cut.complete:
                break
            cut.turn(_turned(rng, cut, 1.5))
        cage = cut.cage


@pytest.mark.parametrize("name", ["star_prism", "star", "annulus"])
def test_rewinding_turns(name):
    """Rewinding takes turns back: the same cages come again, the last turn's very base at its depth."""
    base = EVERY[name]()
    edge = ([0, 0.1, 1],)[: base.dimension - 2]
    cut = Cut(base, Blade([0.0, 0.1, 0.5][: base.dimension], *edge, [1, 0.2, 0][: base.dimension]))
    known = [cut.advance(to=0.3).cage, cut.advance(to=0.6).cage]
    snapshot = cut.snapshot()
    cut.turn([0.5, 1.0, 0.0][: base.dimension])
    known.append(cut.advance(to=0.8).cage)
    cut.turn([0.0, 1.0, 0.1][: base.dimension])
    cut.advance(to=0.9)
    assert cut.rewind(0.8).faces == known[2].faces
    np.testing.assert_array_equal(cut.cage.vertices, known[2].vertices)
    assert cut.rewind(0.6) is known[1]
    assert cut.rewind(0.3).faces == known[0].faces
    assert cut.rewind(snapshot) is known[1]
    cut.turn([0.5, 1.0, 0.0][: base.dimension])
    assert cut.advance(to=0.8).cage.faces == known[2].faces


def test_turns_are_refused():
    """A blade does not turn back into its cut, nor along its edge, nor when there is no front left."""
    cut = Cut(box(), DOWN)
    cut.advance(to=0.4)
    cage = cut.cage
    for direction, text in (([0.05, 0, 1], "back into its own cut"), ([0, 1, 0], "parallel"), ([0, 0, 0], "zero")):
        with pytest.raises(ValueError, match=text):
            cut.turn(direction)
    assert cut.cage is cage
    assert len(cut._strips) == 1
    cut.advance(to=2.0)
    with pytest.raises(ValueError, match="no front to turn about"):
        cut.turn([1, 0, 0])


def test_turning_in_the_gap_between_legs():
    """A blade may turn where it touches nothing; the next leg is cut in the new direction."""
    cut = Cut(u_shape(), Blade([1.5, 2.0, 0.4], [0, 0, 1], [1, 0, 0]))
    cut.advance(to=1.5)
    cut.turn([1.0, 0.5, 0.0])
    cut.advance(to=5.0)
    check_manifold(cut.cage, u_shape().volume)
    assert cut.cage.component_count == 3
    assert sorted(cut.cage.component_volumes)[0] == pytest.approx(0.8 * 0.5)


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=8, **RANDOM)
@given(st.integers(0, 2**32 - 1))
@example(55)
def test_cuts_side_by_side(name, seed):
    """Two cuts that advance in turn, crossing each other, keep a closed manifold and every vertex's id."""
    rng = np.random.default_rng(seed)
    cage = EVERY[name]()
    volume, blades = cage.volume, [random_blade(rng, cage) for _ in range(2)]
    cuts = [Cut(cage, blade) for blade in blades]
    for part in (0.2, 0.4, 0.7, 1.05):
        for cut in cuts:
            if cut.cage is not cage:
                cut.resume(cage)
            _step(cut, max(cut.depth, part * cut.length), cut._strips[-1][0].base, volume)
            cage = cut.cage
    whole = Cut(Cut(EVERY[name](), blades[0]).advance(to=1e3).cage, blades[1]).advance(to=1e3).cage
    np.testing.assert_allclose(sorted(cage.component_volumes), sorted(whole.component_volumes), atol=1e-4 * volume)


def test_weights_follow_a_turning_cut():
    """Updates through a turn, and through two cuts side by side, equal full recomputes bit for bit."""
    points = np.random.default_rng(3).uniform(0.1, 0.9, (10, 3))
    coordinates = HarmonicCoordinates(box(), points, walks=64, seed=5, gradients=True, device="cpu")
    cut, other = Cut(coordinates.cage, DOWN), Cut(coordinates.cage, Blade([0.5, 0.5, 0.31], [0, 1, 0.1], [1, 0, 0]))

    def check() -> None:
        weights, gradients = coordinates.weights, coordinates.gradients
        coordinates.recompute()
        np.testing.assert_array_equal(weights, coordinates.weights)
        np.testing.assert_array_equal(gradients, coordinates.gradients)
        np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-5)
        np.testing.assert_allclose(weights @ coordinates.cage.vertices, points, atol=1e-5)

    coordinates.update(cut.advance(to=0.3))
    cut.turn([1.0, 0.0, -0.5])
    coordinates.update(cut.advance(to=0.5))
    check()
    other.resume(coordinates.cage)
    coordinates.update(other.advance(to=0.4))
    check()
    cut.resume(coordinates.cage)
    coordinates.update(cut.advance(to=2.0))
    other.resume(coordinates.cage)
    coordinates.update(other.advance(to=2.0))
    check()
    assert coordinates.cage.component_count > 1


def box_of(coordinates: HarmonicCoordinates) -> Cage:
    """The cage that the coordinates hold."""
    return coordinates.cage
