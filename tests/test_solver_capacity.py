# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Room for cuts, against what cuts of the stored bodies take."""

from pathlib import Path

import numpy as np
import pytest

import newton_cagecut as cagecut
from newton_cagecut.surface import Surface, SurfaceCut
from newton_cagecut.usd import read_cage, read_surface

ASSETS = Path(__file__).parent.parent / "assets"
SCENES = ["key", "jelly", "octopus", *(pytest.param(name, marks=pytest.mark.slow) for name in ("dude", "sphere"))]


def cut_a_dozen_times(cage: cagecut.Cage, surface: Surface) -> tuple[cagecut.Cage, Surface]:
    """Cage and surface after twelve complete cuts of any direction, each through a point of the surface."""
    rng, points = np.random.default_rng(0), surface.points
    for _ in range(12):
        edge, direction = rng.normal(size=(2, 3))
        cut = cagecut.Cut(cage, cagecut.Blade(points[rng.integers(len(points))], edge, direction))
        surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
        edit = cut.advance(to=cut.length)
        cage, surface = edit.cage, surface_cut.advance(edit.front).surface
    return cage, surface


@pytest.mark.parametrize("name", SCENES)
def test_a_dozen_cuts_that_cross_fit(name):
    """The room for a dozen cuts that go through one another holds such a dozen, and is not ten times too large."""
    cage, surface = read_cage(ASSETS / f"{name}_cage.usda"), read_surface(ASSETS / f"{name}.usdc")
    room = cagecut.Capacity.for_cuts(cage, surface, crossing=True)
    after = cut_a_dozen_times(cage, surface)
    room.require(*after)
    assert room.surface_points < 10 * after[1].site_count
    with pytest.raises(ValueError, match=r"add_cage_body\(..., capacity=cagecut.Capacity\("):
        cagecut.Capacity.without_cuts(cage, surface).require(*after)
