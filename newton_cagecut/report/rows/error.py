# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Error against run time: each correction with more and more walks, before a cut and half way through one."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from ...harmonic import HarmonicCoordinates
from ..bench import Bench

NAME = "error"
CORRECTIONS = ("none", "affine", "harmonic", "fitted")
WALKED = CORRECTIONS[:3]
"""Those of which a recompute does everything again; a fit follows from the walls and is not made again."""
KINDS = ("weights", "gradients", "surface")


def measure_reference(bench: Bench, stage: str) -> dict:
    """Find the reference of a stage; return its own squared errors, its checks, and what it is of.

    Args:
        bench: The scene.
        stage: One of ``STAGES``.
    """
    cage, reference = bench.cage(stage), bench.reference(stage)
    return {
        "faces": cage.face_count,
        "vertices": cage.vertex_count,
        "points": len(bench.points),
        "own": reference.own,
        "check": reference.check.tolist(),
    }


def measure_error(bench: Bench, correction: str, walks: int, seed: int, **options) -> dict:
    """Measure squared errors and times of one run.

    Args:
        bench: The scene.
        correction: Correction of the weights.
        walks: Walks a point.
        seed: Seed of the walks.
        options: Further options of the coordinates.

    Returns:
        For each stage the seconds and squared errors. Half way through the cut, "seconds" are those of the update by
        a step and "whole_seconds" those of the full recompute, the topology's included in both.

    Raises:
        ValueError: The recompute gave other weights than the update.
    """
    bench.warm_up(correction=correction, **options)
    half = bench.half_cut
    start = perf_counter()
    coordinates = bench.coordinates(walks, seed, correction=correction, **options)
    weights, gradients = coordinates.weights, coordinates.gradients
    seconds = perf_counter() - start
    before = {"seconds": seconds, "squared": bench.reference("before").squared_errors(weights, gradients)}
    coordinates.update(half.most)
    start = perf_counter()
    stats = coordinates.update(half.step)
    weights, gradients = coordinates.weights, coordinates.gradients
    update = perf_counter() - start
    during = {
        "seconds": update + half.seconds,
        "whole_seconds": whole_seconds(coordinates, weights, gradients) + half.seconds,
        "rewalked": stats.rewalked / max(stats.walk_count, 1),
        "squared": bench.reference("during").squared_errors(weights, gradients),
    }
    return {"before": before, "during": during}


def whole_seconds(coordinates: HarmonicCoordinates, weights: np.ndarray, gradients: np.ndarray) -> float:
    """Compute all weights anew; return the seconds that it takes.

    Args:
        coordinates: The coordinates; nothing of them changes.
        weights: Their weights.
        gradients: Their gradients.

    Raises:
        ValueError: The weights or gradients are others than before.
    """
    start = perf_counter()
    coordinates.recompute()
    new_weights, new_gradients = coordinates.weights, coordinates.gradients
    seconds = perf_counter() - start
    if not (np.array_equal(weights, new_weights) and np.array_equal(gradients, new_gradients)):
        raise ValueError("the full recompute gave other weights than the update: they must be identical")
    return seconds
