# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Weights and gradients are unbiased, after updates too: tests over many seeds, at a significance of 1e-4.

Each run gives a vector a point, whose mean is to be nothing. Of each point one projection is tested, as its components
hang together; the squares of the points' t values are summed. Seeds are fixed, so that nothing fails by chance.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm

from newton_cagecut import Blade, Cage, Cut, HarmonicCoordinates
from newton_cagecut.report.cuts.following import landings_of

RUNS, WALKS, POINTS = 24, 96, 24
SIGNIFICANCE = 1e-4


def excess(values: np.ndarray) -> float:
    """How unlikely it is that the mean is nothing, as a normal deviate; values of shape (runs, points, n)."""
    runs, points, size = values.shape
    directions = np.random.default_rng(0).normal(size=(points, size))
    found = np.einsum("rpn,pn->rp", values, directions)
    deviation = found.std(axis=0, ddof=1)
    moving = deviation > 1e-12
    squares = runs * (found.mean(axis=0)[moving] / deviation[moving]) ** 2  # of t, with runs - 1 degrees of freedom
    free = runs - 1
    mean = free / (free - 2)
    variance = 2.0 * free**2 * (free - 1) / ((free - 2) ** 2 * (free - 4))
    return float((squares - mean).sum() / np.sqrt(variance * moving.sum()))


LIMIT = float(norm.isf(SIGNIFICANCE))


def solid() -> tuple[Cage, Blade, np.ndarray]:
    """A crooked prism of triangles and quads, a blade, and points on both sides of it."""
    outline = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.6], [0.0, 1.2]])
    corners = np.concatenate([np.c_[outline, np.full(5, z)] for z in (0.0, 1.0)])
    tops = [(0, 3, 4), (0, 1, 3), (1, 2, 3)]
    faces = [tuple(5 + k for k in top) for top in tops] + [top[::-1] for top in tops]
    for k in range(5):
        a, b = k, (k + 1) % 5
        faces += [(a, b, 5 + b), (a, 5 + b, 5 + a)]
    cage = Cage(corners, faces)
    points = np.random.default_rng(4).uniform([0.1, 0.1, 0.1], [1.9, 0.55, 0.9], (POINTS, 3))
    return cage, Blade((0.9, 0.0, 1.0), (0.0, 1.0, 0.0), (0.1, 0.0, -1.0)), points


def plane() -> tuple[Cage, Blade, np.ndarray]:
    """The prism's outline in the plane."""
    outline = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.6], [0.0, 1.2]])
    cage = Cage(outline, [(k, (k + 1) % 5) for k in range(5)])
    points = np.random.default_rng(5).uniform([0.1, 0.1], [1.9, 0.55], (POINTS, 2))
    return cage, Blade((0.9, 1.0), (0.1, -1.0)), points


def cut_runs(shape: tuple[Cage, Blade, np.ndarray], first_seed: int, **options: object) -> list[HarmonicCoordinates]:
    """Coordinates of many seeds that have followed two steps of a cut."""
    cage, blade, points = shape
    made = []
    for seed in range(first_seed, first_seed + RUNS):
        cut = Cut(cage, blade)
        coordinates = HarmonicCoordinates(cage, points, WALKS, seed, gradients=True, device="cpu", **options)
        for share in (0.3, 0.55):
            coordinates.update(cut.advance(to=share * cut.length))
        made.append(coordinates)
    return made


@pytest.fixture(scope="module", params=[solid, plane], ids=["3D", "2D"])
def plain(request: pytest.FixtureRequest) -> tuple:
    """A shape, and plain coordinates after a cut, of many seeds."""
    shape = request.param()
    return shape, cut_runs(shape, 100, correction="none")


def test_updated_plain_weights_are_unbiased(plain):
    """The cage's vertices by the weights are where walks land on average, the point; of gradients, the identity."""
    (_, _, points), runs = plain
    vertices = runs[0].cage.vertices
    places = np.stack([run.weights.astype(float) @ vertices - points for run in runs])
    assert excess(places) < LIMIT
    slopes = np.stack([np.einsum("pjk,jd->pdk", run.gradients.astype(float), vertices) for run in runs])
    slopes -= np.eye(points.shape[1])
    assert excess(slopes.reshape(RUNS, POINTS, -1)) < LIMIT


@pytest.mark.parametrize("correction", ["affine", "harmonic", pytest.param("fitted", marks=pytest.mark.slow)])
def test_updated_corrections_agree_with_plain_means(plain, correction):
    """Weights by other seeds and a correction have the mean of plain ones, after the cut that both have followed."""
    shape, runs = plain
    others = cut_runs(shape, 500, correction=correction)
    pairs = list(zip(others, runs))
    assert excess(np.stack([one.weights.astype(float) - other.weights for one, other in pairs])) < LIMIT
    slopes = np.stack([one.gradients.astype(float) - other.gradients for one, other in pairs])
    assert excess(slopes.reshape(RUNS, POINTS, -1)) < LIMIT


def test_restarted_walks_are_found_out(plain):
    """The same test rejects walks that are restarted from their points where the cut has met them."""
    (cage, _, points), runs = plain
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low).max()

    def places(coordinates: HarmonicCoordinates) -> np.ndarray:
        return middle + half * coordinates.landings["point"].astype(float)[:, : cage.dimension]

    offsets = {"replayed": [], "restarted": []}
    for seed, replayed in enumerate(runs):
        before = HarmonicCoordinates(cage, points, WALKS, 100 + seed, correction="none", device="cpu")
        anew = HarmonicCoordinates(replayed.cage, points, WALKS, 900 + seed, correction="none", device="cpu")
        met = (landings_of(before) != landings_of(replayed)).any(axis=1)
        landed = places(replayed)
        for how, where in (("replayed", landed), ("restarted", np.where(met[:, None], places(anew), landed))):
            offsets[how].append(where.reshape(POINTS, WALKS, -1).mean(axis=1) - points)
    assert excess(np.array(offsets["replayed"])) < LIMIT
    assert excess(np.array(offsets["restarted"])) > LIMIT
