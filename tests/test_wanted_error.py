# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Walks that are chosen for a wanted error."""

from __future__ import annotations

import newton
import numpy as np
import pytest

import newton_cagecut as cagecut
from newton_cagecut.report.reference.exact_cases import box, tetrahedron

TETRAHEDRON = tetrahedron(100)


def root_mean_square(weights: np.ndarray, case: object) -> float:
    """Error of the weights, as the report has it."""
    return float(np.sqrt(((weights - case.weights) ** 2).sum(axis=1).mean()))


@pytest.mark.parametrize("error", [0.05, 0.02])
@pytest.mark.parametrize(
    ("case", "options"),
    [(TETRAHEDRON, {"correction": "none"}), (box(100), {"correction": "affine", "quads": "harmonic"})],
    ids=["tetrahedron", "box"],
)
def test_error_is_reached(error, case, options):
    """The error against exact weights is the wanted one within what 100 points leave to chance, not far below it."""
    coords = cagecut.HarmonicCoordinates(case.cage, case.points, error=error, seed=3, device="cpu", **options)
    assert root_mean_square(coords.weights, case) == pytest.approx(error, rel=0.25)


def test_walks_grow_as_the_inverse_square():
    """Half of the error takes four times the walks, which give the same bits as walks that are named."""
    counts = []
    for error in (0.04, 0.02):
        coords = cagecut.HarmonicCoordinates(
            TETRAHEDRON.cage, TETRAHEDRON.points, error=error, correction="none", device="cpu"
        )
        counts.append(coords.walks)
    assert counts[1] / counts[0] == pytest.approx(4.0, rel=0.1)
    named = cagecut.HarmonicCoordinates(
        TETRAHEDRON.cage, TETRAHEDRON.points, counts[1], correction="none", device="cpu"
    )
    np.testing.assert_array_equal(named.weights, coords.weights)


def test_auto_is_one_percent():
    """``walks="auto"`` is an error of 0.01; where nothing is left to err, what controls need."""
    assert cagecut.HarmonicCoordinates(TETRAHEDRON.cage, TETRAHEDRON.points, walks="auto", device="cpu").walks == 64
    some, options = TETRAHEDRON.points[:30], {"correction": "none", "device": "cpu"}
    auto, named = (
        cagecut.HarmonicCoordinates(TETRAHEDRON.cage, some, **options, **chosen)
        for chosen in ({"walks": "auto"}, {"error": 0.01})
    )
    assert auto.walks == named.walks > 200


def test_body_takes_a_wanted_error():
    """A body has as many walks as coordinates of its mesh's points."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    mesh = (TETRAHEDRON.points, np.arange(99).reshape(-1, 3))
    cagecut.add_cage_body(builder, TETRAHEDRON.cage, mesh, error=0.05, correction="none")
    (definition,) = dict(enumerate(builder.custom_attributes["cagecut:definition"].values)).values()
    assert 10 < definition.walks < 1000


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"error": 0.0}, "error must be positive"),
        ({"error": -1.0}, "error must be positive"),
        ({"error": 1e-9, "correction": "none"}, "takes .* walks a point.*most; ask for"),
        ({"walks": "some"}, "walks must be a whole number"),
    ],
)
def test_bad_wishes_are_refused(options, text):
    """An error that nothing can reach is told with what can be reached."""
    with pytest.raises(ValueError, match=text):
        cagecut.HarmonicCoordinates(TETRAHEDRON.cage, TETRAHEDRON.points, device="cpu", **options)
