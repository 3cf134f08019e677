# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Strips of polygon meshes without a cage, and the states of cuts that are made of them."""

from __future__ import annotations

import copy
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from cage_shapes import box, star_prism
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade, BladePlane, Opening, Strip
from newton_cagecut.surface import SurfaceCut
from surface_shapes import EVERY, around, sphere

KNIFE = Blade([0.5, 0.5, 0.5], [0, 0, 1], [1, 0.2, 0.1], width=0.3, start=-0.2)


def _strip(window=None) -> Strip:
    return Strip.of_polygons(sphere(2).mesh, BladePlane.of(KNIFE), window=window, tolerance=1e-9)


def _assert_same(one: Opening, other: Opening) -> None:
    assert one.faces.first_loops == other.faces.first_loops
    assert one.faces.extra_loops == other.faces.extra_loops
    np.testing.assert_array_equal(one.vertices.positions, other.vertices.positions)
    assert one.region.polygons == other.region.polygons


@pytest.mark.parametrize("window", [None, KNIFE.window])
def test_openings_know_nothing_of_each_other(window):
    """What a strip opens follows from the front alone, whatever was opened before."""
    strip = _strip(window)
    fronts = np.linspace(strip.fronts[0] + 0.01, strip.fronts[-1], 4)
    before = [strip.opened(front) for front in fronts]
    for front, opening in zip(fronts[::-1], before[::-1], strict=True):
        _assert_same(strip.opened(front), opening)
        _assert_same(_strip(window).opened(front), opening)


@pytest.mark.parametrize("window", [None, KNIFE.window])
def test_swept_polygons_add_up(window):
    """The polygons of the steps cover what is open at the end."""
    strip = _strip(window)

    def area(region) -> float:
        corners = [region.coordinates[loop] for loop in region.polygons]
        return sum(0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) for x, y in (c.T for c in corners))

    fronts = np.linspace(strip.fronts[0] - 0.1, strip.fronts[-1] + 0.1, 9)
    swept = [area(strip.swept(strip.opened(b), a)) for a, b in zip(fronts[:-1], fronts[1:], strict=True)]
    assert sum(swept) == pytest.approx(area(strip.opened(fronts[-1]).region), rel=1e-9)
    assert strip.is_complete(fronts[-1])
    assert not strip.is_complete(fronts[-2] - 0.1)


def test_sections_and_strips_do_not_change():
    """Neither a section nor a strip takes another value."""
    strip = _strip()
    with pytest.raises(FrozenInstanceError):
        strip.tolerance = 0.1
    with pytest.raises(FrozenInstanceError):
        strip.section.window = None


@pytest.mark.parametrize("cage", [box, star_prism])
def test_copies_of_cuts_go_their_own_ways(cage):
    """A shallow copy of a cage's cut advances and turns without the cut."""
    cut = Cut(cage(), Blade([0.2, 0.1, 0.3], [0.1, 0.2, 1], [1, 0.3, 0.1]))
    here = cut.advance(to=0.4 * cut.length).cage
    other = copy.copy(cut)
    other.turn([1, 0.6, 0.1])
    other.advance(to=cut.depth + 0.2)
    assert cut.cage is here
    assert not cut.hinged
    assert other.hinged
    assert other.rewind(cut.snapshot()) is here


@pytest.mark.parametrize("name", EVERY)
def test_copies_of_surface_cuts_go_their_own_ways(name):
    """A shallow copy of a surface's cut advances without the cut."""
    surface = EVERY[name]()
    vectors = ([0, 0, 1], [1, 0.2, 0.1]) if surface.dimension == 3 else ([1, 0.2],)
    cut = Cut(around(surface), Blade(np.full(surface.dimension, 0.5), *vectors))
    surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
    here = surface_cut.advance(cut.advance(to=0.4 * cut.length).front).surface
    other = copy.copy(surface_cut)
    assert not other.advance(cut.advance(to=0.8 * cut.length).front).is_empty
    assert surface_cut.surface is here
    assert surface_cut.front < other.front
    assert other.rewind(surface_cut.snapshot()) is here
