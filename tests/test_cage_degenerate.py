# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cuts that are degenerate on purpose: each gives a valid cage by the tolerance rule."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from cage_shapes import box, check_manifold, random_blade
from cut_sequences import EVERY, crossings
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from plane_shapes import PLANES, square

NAMES = ("box", "merged_cube", "star_prism", "square_torus", "collinear_prism", "convex")


def _through(cage, blade: Blade):
    """The cage after a cut in three steps, each checked."""
    cut = Cut(cage, blade)
    assert np.abs(cut.plane.distance(cage.vertices)).min() > cage.length_tolerance
    for part in (0.3, 0.6, 1.1):
        edit = cut.advance(to=part * cut.length)
        check_manifold(edit.cage, cage.volume)
        assert crossings(edit.cage) == 0
    return cut.cage


@pytest.mark.parametrize("name", NAMES)
def test_planes_through_features(name):
    """Planes through a vertex, along an edge, in a face and almost in a face."""
    cage = EVERY[name]()
    for face in range(0, cage.face_count, max(1, cage.face_count // 5)):
        a, b, c = cage.vertices[list(cage.faces[face][:3])]
        if np.linalg.norm(np.cross(b - a, c - a)) < 1e-9:
            continue
        _through(cage, Blade(a, [0.3, 1.0, 0.2], [1.0, 0.1, 0.4]))
        _through(cage, Blade(a, b - a, [0.31, 0.52, 0.73]))
        _through(cage, Blade(a, b - a, c - a))
        for tilt in (1e-9, 1e-6, 1e-4):
            _through(cage, Blade(a, b - a, c - a + tilt * np.array([0.3, 0.5, -0.8])))


@pytest.mark.parametrize("name", PLANES)
def test_lines_through_features(name):
    """Lines through a vertex, through two, along a segment and almost along it."""
    cage = PLANES[name]()
    for a, b in cage.vertices[cage.simplices]:
        _through(cage, Blade(a, [1.0, 0.1]))
        for tilt in (0.0, 1e-9, 1e-6, 1e-4):
            _through(cage, Blade(a, b - a + tilt * np.array([0.3, -0.8])))
        for other in cage.vertices[:: max(1, cage.vertex_count // 4)]:
            if (other != a).any():
                _through(cage, Blade(a, other - a))


@pytest.mark.parametrize("name", [*NAMES, *PLANES])
def test_fronts_at_every_edge(name):
    """A front that stops exactly where the section meets an edge, or a hair before or behind."""
    cage = EVERY[name]()
    center = cage.vertices.mean(axis=0) + 0.01
    blades = [([0, 0, 1], [1, 0.2, 0]), ([0, 1, 0], [1, 0, 0]), ([0.2, 1, 0.1], [0, 0.3, 1])]
    for vectors in blades if cage.dimension == 3 else [([1, 0.2],), ([1, 0],), ([0.3, 1],)]:
        reached = np.sort(Cut(cage, Blade(center, *vectors)).section.node_coordinates[:, 1])
        for hair in (-1e-12, 0.0, 1e-12, 1e-7):
            cut = Cut(cage, Blade(center, *vectors))
            for depth in np.unique(np.maximum(0.0, reached - reached[0] + hair)):
                check_manifold(cut.advance(to=depth).cage, cage.volume)
            assert cut.cage.vertices[:, 0].size > cage.vertex_count


def _middle(x: float, *vectors) -> Blade:
    """A blade through (x, 1/2, ...), of the dimension that its vectors have."""
    return Blade([x, 0.5, 0.5][: len(vectors[0])], *vectors)


CUBES = [
    (box, ([0, 1, 0], [0, 0, -1]), ([1, 0.1, 0], [0, 0.2, -1])),
    (square, ([0, -1],), ([1, 0.1],)),
]


@pytest.mark.parametrize(("cube", "down", "across"), CUBES)
def test_slivers(cube, down, across):
    """Cuts a hair beside each other leave slivers that later cuts cross."""
    cage = cube()
    for gap in (1e-8, 1e-6, 5e-6, 1e-4):
        cut_cage = _through(cage, _middle(0.5, *down))
        cut_cage = _through(cut_cage, _middle(0.5 + gap, *down))
        assert cut_cage.component_count == 3
        cut_cage = _through(cut_cage, _middle(0.5, *across))
        assert cut_cage.component_count == 6


@pytest.mark.parametrize(("cube", "down", "across"), CUBES)
def test_the_same_blade_again(cube, down, across):
    """A blade that cuts where it cut before cuts off a sliver of the tolerance's width, time and again."""
    cage = cube()
    for pieces in (2, 3, 4, 5):
        cage = _through(cage, _middle(0.5, *down))
        assert cage.component_count == pieces


@pytest.mark.parametrize("name", ["box", "star_prism", "square_torus", "square", "star", "annulus"])
def test_twenty_four_cuts(name):
    """Twenty-four cuts of one cage, partial and complete, each crossing those before."""
    rng = np.random.default_rng(4)
    cage = EVERY[name]()
    base = cage
    for number in range(24):
        blade = random_blade(rng, cage, 0.3)
        cut = Cut(cage, blade)
        cage = cut.advance(to=(0.5 if number % 2 else 1.1) * cut.length).cage
        check_manifold(cage, base.volume)
    assert crossings(cage) == 0
    assert len(cage.walls) == len(base.walls) + 24
    assert cage.component_count > 24


@pytest.mark.parametrize("dimension", [2, 3])
def test_blade_in_a_face_warns_of_the_sliver(dimension):
    """A blade in the plane of a face tells of it if it is moved into the body there, and not if it is moved out."""
    if dimension == 3:
        cage, blades = box(), [Blade([1.0, 0.5, 2.0], [0.0, sign, 0.0], [0.0, 0.0, -1.0]) for sign in (1.0, -1.0)]
    else:
        cage, blades = square(), [Blade([1.0, 0.5 + 2.0 * sign], [0.0, -sign]) for sign in (1.0, -1.0)]
    said = []
    for blade in blades:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            cut = Cut(cage, blade)
        said += [str(item.message) for item in caught]
        assert bool(caught) == (cut.plane.origin[0] < 1.0)
    (text,) = said
    face = int(text.split("face ")[1].split()[0])
    np.testing.assert_allclose(cage.vertices[list(cage.faces[face])][:, 0], 1.0)
    assert "would cut off a sliver" in text
