# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Dense products and elimination: right, and the same bit for bit on any number of threads."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from newton_cagecut.harmonic import launch as launching
from newton_cagecut.harmonic.fit.layers.elimination import solve_each
from newton_cagecut.harmonic.fit.layers.products import WIDTH, multiply_spans
from newton_cagecut.harmonic.fit.layers.solve import System
from newton_cagecut.harmonic.fit.layers.spans import SPAN, Span, in_spans

CPU = wp.get_device("cpu")


def flat(lanes: wp.array) -> np.ndarray:
    """Rows of lanes as rows of numbers."""
    return lanes.numpy().reshape(lanes.shape[0], -1)


def filled(matrix: np.ndarray, right: np.ndarray) -> System:
    """A system with its numbers."""
    system = System(len(matrix), right.shape[1], CPU)
    numbers = flat(system.matrix).copy()
    numbers[: len(matrix), : len(matrix)] = matrix
    first = system.first_lane * WIDTH
    numbers[: len(matrix), first : first + right.shape[1]] = right
    system.matrix.assign(numbers.reshape(*system.matrix.shape, WIDTH))
    return system


def solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution by elimination."""
    return flat(filled(matrix, right).solve())[: len(matrix), : right.shape[1]].copy()


def product(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Product of spans: rows of the left matrix are points, its columns stand in another order in the spans."""
    order = np.random.default_rng(0).permutation(left.shape[1])
    spans = in_spans(left)[:, np.argsort(order)].reshape(-1, SPAN, left.shape[1]).swapaxes(1, 2)
    spans = wp.array(np.ascontiguousarray(spans, dtype=np.float32), dtype=Span, device=CPU)
    jobs = np.array([[row, 0, len(order)] for row in range(spans.shape[0])])
    return multiply_spans(jobs, spans, order, right)[: len(left)]


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
    np.testing.assert_allclose(product(left, right), left @ right, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("same", [0, 63, 64, 100, 150])
def test_what_is_kept_of_a_system_keeps_bits(same):
    """Where the first equations are those of another system, going on from it has the bits of solving all anew."""
    other, matrix = positive(150, 1), positive(170, 2)
    matrix[:same, :same] = other[:same, :same]
    rng = np.random.default_rng(3)
    earlier = filled(other, rng.normal(size=(150, 4)))
    earlier.solve()
    right = rng.normal(size=(170, 5))
    expected = flat(filled(matrix, right).solve()).copy()
    system = filled(matrix, right)
    kept = system.take_over(earlier, same)
    assert kept == same // 64 * 64
    assert np.array_equal(flat(system.solve(kept=kept)), expected)


def test_small_systems_are_solved():
    """Many at once, of several sizes, are solved as NumPy would, each whatever the others are."""
    rng = np.random.default_rng(5)
    matrices = [positive(count, count) for count in (3, 40, 17)]
    rights = [rng.normal(size=(len(matrix), columns)) for matrix, columns in zip(matrices, (2, 9, 4))]
    together = solve_each(matrices, rights, CPU)
    for matrix, right, found in zip(matrices, rights, together):
        np.testing.assert_allclose(found, np.linalg.solve(matrix, right), rtol=1e-9, atol=1e-10)
        assert np.array_equal(solve_each([matrix], [right], CPU)[0], found)


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
