# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Counter-based randomness: the published hash, no two equal streams, uniform directions."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

import harmonic_shapes  # noqa: F401  (quietens Warp)
from newton_cagecut.harmonic.walks.random import NESTED_STREAM, direction_on_circle, direction_on_sphere, pcg4d

POINTS, WALKS = 8158, 64


@wp.kernel(enable_backward=False)
def _draw(
    seed: wp.uint32,
    walks: int,
    step: wp.uint32,
    words: wp.array[wp.vec4ui],
    on_sphere: wp.array[wp.vec3],
    on_circle: wp.array[wp.vec2],
):
    i = wp.tid()
    point = wp.uint32(i // walks)
    walk = wp.uint32(i % walks)
    words[i] = pcg4d(seed, point, walk, step)
    on_sphere[i] = direction_on_sphere(seed, point, walk, step)
    on_circle[i] = direction_on_circle(seed, point, walk, step)


def draw(seed: int, step: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Words and directions of all points and walks at one step."""
    count = POINTS * WALKS
    arrays = [wp.empty(count, dtype=dtype, device="cpu") for dtype in (wp.vec4ui, wp.vec3, wp.vec2)]
    wp.launch(_draw, dim=count, inputs=[wp.uint32(seed), WALKS, wp.uint32(step), *arrays], device="cpu")
    return tuple(array.numpy() for array in arrays)


@pytest.fixture(scope="module")
def first_draw():
    """Words and directions of the first steps."""
    return draw(0, 0)


def pcg4d_by_numpy(counters: np.ndarray) -> np.ndarray:
    """The hash as published, on rows of four words."""
    a, b, c, d = (counters * np.uint32(1664525) + np.uint32(1013904223)).T
    for rounds in range(2):
        a = a + b * d
        b = b + c * a
        c = c + a * b
        d = d + b * c
        if rounds == 0:
            a, b, c, d = (x ^ (x >> np.uint32(16)) for x in (a, b, c, d))
    return np.stack([a, b, c, d], axis=1)


def test_is_pcg4d():
    """The words are those of pcg4d."""
    i = np.arange(POINTS * WALKS, dtype=np.uint32)
    counters = np.stack([np.full_like(i, 9), i // np.uint32(WALKS), i % np.uint32(WALKS), np.full_like(i, 5)], axis=1)
    np.testing.assert_array_equal(draw(9, 5)[0], pcg4d_by_numpy(counters))


def test_no_duplicate_streams(first_draw):
    """No two of 8158 x 64 walks, nor the nested ones, begin with the same two words: those of their first step."""
    volume, nested = first_draw[0], draw(int(NESTED_STREAM), 0)[0]
    words = np.concatenate([volume, nested])[:, :2].astype(np.uint64)
    assert len(np.unique(words[:, 0] << np.uint64(32) | words[:, 1])) == len(words)


def test_first_words_collide_as_random_ones(first_draw):
    """Single words repeat as often as the birthday problem says, 31.7 times, so they are not a short cycle."""
    for k in range(4):
        repeated = len(first_draw[0]) - len(np.unique(first_draw[0][:, k]))
        assert 10 < repeated < 60


@pytest.mark.parametrize("axis", [1, 2], ids=["sphere", "circle"])
def test_directions_are_uniform(first_draw, axis):
    """Directions have length 1 and the first, second and fourth moments of the uniform distribution."""
    directions = first_draw[axis].astype(np.float64)
    count, dimension = directions.shape
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, atol=1e-6)
    tolerance = 5.0 / np.sqrt(count)
    np.testing.assert_allclose(directions.mean(axis=0), 0.0, atol=tolerance)
    np.testing.assert_allclose(directions.T @ directions / count, np.eye(dimension) / dimension, atol=tolerance)
    fourth = 3.0 / (dimension * (dimension + 2))
    np.testing.assert_allclose((directions**4).mean(axis=0), fourth, atol=tolerance)


def test_neighbours_are_independent(first_draw):
    """Neighbouring steps, walks, points and seeds have uncorrelated directions."""
    here = first_draw[1].reshape(POINTS, WALKS, 3).astype(np.float64)
    others = [draw(0, 1)[1].reshape(here.shape), draw(1, 0)[1].reshape(here.shape)]
    others += [np.roll(here, 1, axis=0), np.roll(here, 1, axis=1)]
    for other in others:
        correlation = np.einsum("pwi,pwj->ij", here, other) / (POINTS * WALKS)
        np.testing.assert_allclose(correlation, 0.0, atol=5.0 / 3.0 / np.sqrt(POINTS * WALKS))


def test_every_point_is_uniform(first_draw):
    """Means over the walks of single points scatter as those of independent draws."""
    means = first_draw[1].reshape(POINTS, WALKS, 3).astype(np.float64).mean(axis=1)
    np.testing.assert_allclose((means**2).mean(axis=0) * WALKS * 3.0, 1.0, atol=0.08)
