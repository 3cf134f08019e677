# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Hollow cages, of which the faces around a cavity are a component of their own but bound the same solid piece."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import voxels
from harmonic_shapes import assert_identical, assert_reproduces, interior_points, snapshot
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from plane_shapes import outline, rectangle


def hollow_box(*cavities: tuple[int, int, int], length: int = 3) -> Cage:
    """A box of 3 x 3 voxels across, within the unit cube, of which some inside are left out."""
    cells = [(i, j, k) for i in range(length) for j in range(3) for k in range(3)]
    return voxels([cell for cell in cells if cell not in cavities], 1.0 / np.array([length, 3.0, 3.0]))


def hollow_square(*cavities: tuple[int, int], length: int = 3) -> Cage:
    """The same in the plane, with holes."""
    size = 1.0 / np.array([length, 3.0])
    return outline(
        rectangle((0.0, 0.0), (1.0, 1.0)),
        *(rectangle(size * cell, size * (np.array(cell) + 1.0))[::-1] for cell in cavities),
    )


THROUGH = Blade([0.52, 0.5, 0.5], [0, 1, 0.03], [0.02, 0.1, -1])
BESIDE = Blade([0.15, 0.5, 0.5], [0, 1, 0.03], [0.02, 0.1, -1])
ACROSS = Blade([0.5, 0.47, 0.5], [1, 0.05, 0], [0.1, 0, -1])
LEVEL = Blade([0.5, 0.5, 0.51], [1, 0.05, 0.01], [0, 1, 0.02])
KNIFE = Blade([0.5, 0.5, 0.53], [1, 0.05, 0], [0, 0.1, -1], width=(-0.3, 0.25), start=-0.2)
SEQUENCES = {
    "through the cavity": [(THROUGH, (0.2, 0.5, 0.8, 1.1))],
    "past the cavity": [(BESIDE, (0.4, 1.1))],
    "crossing in the cavity": [(THROUGH, (0.4, 1.1)), (ACROSS, (0.5, 1.1)), (LEVEL, (0.6, 1.1))],
    "not to the end": [(THROUGH, (0.5,)), (ACROSS, (0.45, 0.7)), (LEVEL, (0.3,))],
    "a knife around": [(KNIFE, (0.3, 0.7, 1.1)), (THROUGH, (0.4, 1.1))],
}
DOWN = Blade([0.52, 0.5], [0.1, -1])
ALONG = Blade([0.5, 0.47], [-1, 0.05])
PLANE_SEQUENCES = {
    "through the hole": [(DOWN, (0.2, 0.5, 0.8, 1.1))],
    "past the hole": [(Blade([0.15, 0.5], [0.02, -1]), (0.4, 1.1))],
    "crossing in the hole": [(DOWN, (0.4, 1.1)), (ALONG, (0.5, 1.1)), (Blade([0.5, 0.53], [1, 0.05]), (0.6, 1.1))],
    "open in the plane": [(DOWN, (0.5,)), (ALONG, (0.45, 0.7)), (Blade([0.8, 0.9], [-1, -1]), (0.3,))],
}
CAGES = {
    "one cavity": lambda: hollow_box((1, 1, 1)),
    "two cavities": lambda: hollow_box((1, 1, 1), (3, 1, 1), length=5),
    "one hole": lambda: hollow_square((1, 1)),
    "two holes": lambda: hollow_square((1, 1), (3, 1), length=5),
}
CASES = [(name, sequence) for name in list(CAGES)[:2] for sequence in SEQUENCES]
CASES += [(name, sequence) for name in list(CAGES)[2:] for sequence in PLANE_SEQUENCES]


@pytest.mark.parametrize(("name", "sequence"), CASES)
def test_cuts_of_hollow_cages(name, sequence):
    """Updates equal recomputes bit for bit, the rest shape is exact, and other pieces have no weight."""
    cage = CAGES[name]()
    volume = cage.volume
    points = interior_points(cage, 60, np.random.default_rng(8))
    coordinates = HarmonicCoordinates(cage, points, 64, seed=3, gradients=True)
    for blade, parts in (SEQUENCES | PLANE_SEQUENCES)[sequence]:
        cut = Cut(cage, blade)
        for part in parts:
            edit = cut.advance(to=part * cut.length)
            coordinates.update(edit)
            cage = edit.cage
            cage.validate()
            assert cage.piece_volumes.sum() == pytest.approx(volume, rel=1e-9)
            assert_reproduces(coordinates, points)
            foreign = cage.vertex_piece[None] != cage.piece_of(points)[:, None]
            assert np.all(coordinates.weights[foreign] == 0.0)
            assert np.all(coordinates.gradients[foreign] == 0.0)
        updated = snapshot(coordinates)
        coordinates.recompute()
        assert_identical(updated, snapshot(coordinates))


@pytest.mark.parametrize("name", ["one cavity", "one hole"])
def test_cavity_takes_part(name):
    """A point beside the cavity speaks for its vertices too; in a slice that came off beside it, for none of them."""
    cage = CAGES[name]()
    points = np.array([[0.05, 0.5, 0.5], [0.25, 0.4, 0.6]])[:, : cage.dimension]
    inner = np.flatnonzero(cage.vertex_component == 1)
    coordinates = HarmonicCoordinates(cage, points, 256)
    assert (coordinates.weights[:, inner].sum(axis=1) > [0.0, 0.2]).all()
    cut = Cut(cage, BESIDE if cage.dimension == 3 else PLANE_SEQUENCES["past the hole"][0][0])
    for part in (0.5, 1.1):
        coordinates.update(cut.advance(to=part * cut.length))
    assert (coordinates.weights[0, inner] == 0.0).all()
    assert coordinates.weights[1, inner].sum() > 0.2
