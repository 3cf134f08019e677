# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Mutation test: random sequences of cuts over every cage, 200 in all, or 2000 with ``CAGECUT_NIGHTLY=1``.

A failure is shrunk to a short sequence of small numbers and printed with what reproduces it.
"""

from __future__ import annotations

import os

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from cut_sequences import CAGES, EVERY, SEQUENCES, check_step, long_sequence, play
from newton_cagecut.harmonic import HarmonicCoordinates

COUNT = 2000 if os.environ.get("CAGECUT_NIGHTLY") == "1" else 200
EACH = -(-COUNT // len(CAGES))
RANDOM = {
    "deadline": None,
    "print_blob": True,
    "suppress_health_check": [HealthCheck.too_slow, HealthCheck.data_too_large],
}
_cages = {}


def cage_of(name: str):
    """A cage of the collection, built once."""
    if name not in _cages:
        _cages[name] = EVERY[name]()
    return _cages[name]


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=EACH, **RANDOM)
@given(SEQUENCES)
def test_random_sequences(name, sequence):
    """Every step leaves a closed manifold of planar faces that cross nowhere, of the volume and characteristic due."""
    cage = cage_of(name)
    play(cage, sequence, lambda edit, cut, base: check_step(edit, cut, base, cage.volume))


@pytest.mark.parametrize("name", EVERY)
def test_long_sequences(name):
    """Sequences of 26 operations, three a cage or thirty in the nightly run; the seed is printed with a failure."""
    cage = cage_of(name)
    for seed in range(30 if COUNT > 200 else 3):
        print(f"{name}: seed {seed}")
        play(cage, long_sequence(seed), lambda edit, cut, base: check_step(edit, cut, base, cage.volume))


def test_bridge_at_the_front():
    """A cut that turns at a vertex to which a bridge leads goes on in the right one of the face's corners there."""
    cage = cage_of("square_torus")
    play(cage, long_sequence(5326), lambda edit, cut, base: check_step(edit, cut, base, cage.volume))


@pytest.mark.parametrize("name", ["box", "square_torus", "star_shaped"])
@settings(max_examples=max(3, EACH // 4), **RANDOM)
@given(SEQUENCES)
def test_updates_equal_recomputes(name, sequence):
    """On a sample, weights updated step by step equal those computed anew, bit for bit."""
    cage = cage_of(name)
    rng = np.random.default_rng(7)
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    points = low + (high - low) * rng.random((200, 3))
    points = points[cage.contains(points)][:5]
    coordinates = HarmonicCoordinates(cage, points, walks=32, seed=3, gradients=True, device="cpu")
    play(cage, sequence, lambda edit, cut, base: coordinates.update(edit))
    weights, gradients = coordinates.weights, coordinates.gradients
    landings, bounds = coordinates.landings, coordinates.bounds
    coordinates.recompute()
    np.testing.assert_array_equal(coordinates.weights, weights)
    np.testing.assert_array_equal(coordinates.gradients, gradients)
    np.testing.assert_array_equal(coordinates.bounds, bounds)
    for key, values in coordinates.landings.items():
        np.testing.assert_array_equal(values, landings[key], err_msg=key)
