# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Dense products and elimination: right, and the same bit for bit on any number of threads."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from newton_cagecut.harmonic import launch as launching
from newton_cagecut.harmonic.fit.layers.products import LANE, WIDTH, lane_count, multiply_lanes
from newton_cagecut.harmonic.fit.layers.solve import System
from newton_cagecut.harmonic.launch import launch

CPU = wp.get_device("cpu")


def flat(lanes: wp.array) -> np.ndarray:
    """Rows of lanes as rows of numbers."""
    return lanes.numpy().reshape(lanes.shape[0], -1)


def solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution by elimination."""
    system = System(len(matrix), right.shape[1], CPU)
    numbers = flat(system.matrix).copy()
    numbers[: len(matrix), : len(matrix)] = matrix
    first = system.first_lane * WIDTH
    numbers[: len(matrix), first : first + right.shape[1]] = right
    system.matrix.assign(numbers.reshape(*system.matrix.shape, WIDTH))
    return flat(system.solve())[: len(matrix), : right.shape[1]].copy()


def product(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Product by lanes."""

    def lanes_of(numbers: np.ndarray, rows: int) -> wp.array:
        filled = np.zeros((rows, lane_count(numbers.shape[1]) * WIDTH))
        filled[: len(numbers), : numbers.shape[1]] = numbers
        return wp.array(filled.reshape(rows, -1, WIDTH), dtype=LANE, device=CPU)

    a, b = lanes_of(left, len(left)), lanes_of(right, lane_count(left.shape[1]) * WIDTH)
    out = wp.zeros((len(left), b.shape[1]), dtype=LANE, device=CPU)
    launch(multiply_lanes, -(-len(left) // 4) * b.shape[1], [a, b, a.shape[1], out], device=CPU, smallest_chunk=4)
    return flat(out)[:, : right.shape[1]].copy()


def positive(count: int, seed: int) -> np.ndarray:
    """A matrix that is positive, but not quite symmetric."""
    drawn = np.random.default_rng(seed).normal(size=(2, count, count))
    return drawn[0] @ drawn[0].T / count + np.eye(count) + 0.02 * drawn[1]


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (7, 9), (32, 3), (45, 20), (200, 11)])
def test_systems_are_solved(count, columns):
    """Solutions are those of NumPy, for sizes that fill blocks and lanes and others."""
    matrix, right = positive(count, count), np.random.default_rng(1).normal(size=(count, columns))
    np.testing.assert_allclose(solved(matrix, right), np.linalg.solve(matrix, right), rtol=1e-9, atol=1e-10)


@pytest.mark.parametrize("shape", [(1, 1, 1), (5, 9, 17), (33, 40, 8), (100, 61, 30)])
def test_products(shape):
    """Products are those of NumPy, for sizes that fill lanes and threads' rows and others."""
    rng = np.random.default_rng(2)
    left, right = rng.normal(size=shape[:2]), rng.normal(size=shape[1:])
    np.testing.assert_allclose(product(left, right), left @ right, rtol=1e-12, atol=1e-12)


def test_bits_do_not_depend_on_threads(monkeypatch):
    """One thread and many give the same bits."""
    matrix, right = positive(300, 3), np.random.default_rng(4).normal(size=(300, 12))
    found = []
    for cores in (1, 4):
        monkeypatch.setattr(launching, "_core_count", lambda cores=cores: cores)
        monkeypatch.setattr(launching, "_pool", None)
        found.append((solved(matrix, right), product(matrix, right)))
    assert np.array_equal(found[0][0], found[1][0])
    assert np.array_equal(found[0][1], found[1][1])
