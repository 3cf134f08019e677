# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Errors of weights and gradients, and the times that they take, before, half way through and after a cut.

Errors are measured at some points of a scene, against a fit whose walks evaluate it at every landing. Times are those
of all points of the scene, mesh and quadrature: of the first weights, and of a step of 3 % of the cut half way through
it. Walks take their time one by one, so that times are measured for few walks and are linear in their number.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import numpy as np
import warp as wp

from newton_cagecut import Cage, Cut, HarmonicCoordinates
from newton_cagecut.elastic import sample_quadrature
from newton_cagecut.report.bench import HALF_STEPS, Bench
from newton_cagecut.report.effort import FULL as REPORT_EFFORT
from newton_cagecut.report.paper.cutting import STEP
from newton_cagecut.report.reference.fitted_walks import fitted_walks
from newton_cagecut.report.reference.long_walks import Reference
from newton_cagecut.report.scenes.scene import Scene

STAGES = ("before", "during", "after")
WALK_COUNTS = {
    "none": (64, 256, 1024),
    "affine": (64, 256, 1024),
    "harmonic": (64, 256, 1024),
    "fitted": (0, 16, 64, 256),
}
SEEDS = (1,)
_TIMED = (4, 32)
"""Walks a point whose times are measured."""
_TIMED_STEPS = 3
_QUADRATURE = 600


@dataclass(frozen=True)
class Effort:
    """Sizes of the measurement.

    Attributes:
        point_count: Points whose errors are measured.
        reference_walks: Walks a point of the reference.
        cells: Finite elements.
    """

    point_count: int = 100
    reference_walks: int = 2048
    cells: tuple[int, ...] = (1500, 7500)


FULL = Effort()


def measure_scene(scene: Scene, effort: Effort, device: wp.context.Device, *, folder: Path) -> dict:
    """Measure all corrections on a scene.

    Args:
        scene: The scene.
        effort: How much is measured.
        device: The device.
        folder: A folder that stays empty.

    Returns:
        What was found, as JSON can hold it: "references", and "rows", one a method.
    """
    bench = Bench(scene, _sized(effort), device, folder)
    cages = stage_cages(scene)
    found = {stage: _reference(bench, cage, effort, device) for stage, cage in cages.items()}
    references = {stage: each.reference for stage, each in found.items()}
    rows = []
    for correction, counts in WALK_COUNTS.items():
        times = measure_times(scene, correction, device)
        for walks in counts:
            squared = {stage: [] for stage in STAGES}
            for seed in SEEDS[: 1 if walks == 0 else None]:
                for stage, errors in _errors(bench, cages, references, correction, walks, seed).items():
                    squared[stage].append(errors)
            mean = {stage: _means(each) for stage, each in squared.items()}
            seconds = {name: start + walks * slope for name, (start, slope) in times.items()}
            rows.append({"method": correction, "amount": walks, "squared": mean, "seconds": seconds})
    rows += _element_rows(bench, effort, references)
    return {
        "faces": scene.cage.face_count,
        "points": len(scene.points) + _QUADRATURE,
        "references": {
            stage: {"own": each.reference.own, "check": list(each.reference.check), "table_bias": each.table_bias}
            for stage, each in found.items()
        },
        "rows": rows,
    }


def stage_cages(scene: Scene) -> dict[str, Cage]:
    """Return the cage of a scene before its first cut, half way through it and after it."""
    cut = Cut(scene.cage, scene.blades[0])
    half = cut.advance(to=HALF_STEPS * STEP * cut.length).cage
    return {"before": scene.cage, "during": half, "after": cut.advance(to=1.01 * cut.length).cage}


def measure_times(scene: Scene, correction: str, device: wp.context.Device) -> dict[str, tuple[float, float]]:
    """Measure the first weights and a step of all points.

    Args:
        scene: The scene.
        correction: The correction.
        device: The device.

    Returns:
        For "first" and "step" the time without walks and that of a walk a point [s].
    """
    places = sample_quadrature(scene.cage, _QUADRATURE)[0]
    points = np.concatenate([np.asarray(scene.points, dtype=np.float64), places])
    mask = np.arange(len(points)) >= len(scene.points)
    counts = ((0,) if correction == "fitted" else ()) + _TIMED
    first, step = [], []
    for walks in counts:
        best = []
        for _ in range(2):
            start = perf_counter()
            coordinates = HarmonicCoordinates(
                scene.cage, points, walks, gradients=mask, device=device, correction=correction
            )
            _ = coordinates.weights
            best.append(perf_counter() - start)
        first.append(min(best))
        cut = Cut(scene.cage, scene.blades[0])
        coordinates.update(cut.advance(to=(HALF_STEPS - _TIMED_STEPS) * STEP * cut.length))
        each = []
        for number in range(_TIMED_STEPS):
            edit = cut.advance(to=(HALF_STEPS - _TIMED_STEPS + 1 + number) * STEP * cut.length)
            start = perf_counter()
            coordinates.update(edit)
            each.append(perf_counter() - start)
        step.append(min(each))
    return {"first": _line(counts, first), "step": _line(counts, step)}


def _line(counts: tuple[int, ...], seconds: list[float]) -> tuple[float, float]:
    """Start and slope through the first and the last time; neither is below 0."""
    slope = max(0.0, (seconds[-1] - seconds[-2]) / (counts[-1] - counts[-2]))
    return max(0.0, seconds[0] - slope * counts[0]), slope


def _sized(effort: Effort) -> object:
    return replace(REPORT_EFFORT, point_count=effort.point_count)


def _reference(bench: Bench, cage: Cage, effort: Effort, device: wp.context.Device) -> object:
    return fitted_walks(cage, bench.points, bench.has_gradient, walks=effort.reference_walks, device=device)


def _errors(
    bench: Bench, cages: dict[str, Cage], references: dict[str, Reference], correction: str, walks: int, seed: int
) -> dict[str, dict[str, float]]:
    """Squared errors of each stage."""
    coordinates = bench.coordinates(walks, seed, correction=correction)
    found = {"before": references["before"].squared_errors(coordinates.weights, coordinates.gradients)}
    cut = Cut(bench.scene.cage, bench.scene.blades[0])
    for stage, share in (("during", HALF_STEPS * STEP), ("after", 1.01)):
        coordinates.update(cut.advance(to=share * cut.length))
        found[stage] = references[stage].squared_errors(coordinates.weights, coordinates.gradients)
    return found


def _means(each: list[dict[str, float]]) -> dict[str, float]:
    return {kind: float(np.mean([errors[kind] for errors in each])) for kind in each[0]}


def _element_rows(bench: Bench, effort: Effort, references: dict[str, Reference]) -> list[dict]:
    """Quadratic elements, meshed and solved before the cut and again half way through it."""
    try:
        from newton_cagecut.report.rows.elements_row import measure_elements
    except ImportError:
        return []
    bench._references.update(references)
    rows = []
    for cells in effort.cells:
        found = _tried(lambda cells=cells: measure_elements(bench, 2, cells))
        squared = {stage: values["squared"] for stage, values in found.items() if "squared" in values}
        if len(squared) == 2:
            seconds = {"first": found["before"]["seconds"], "step": found["during"]["seconds"]}
            rows.append({"method": "elements", "amount": found["during"]["unknowns"]} | {"squared": squared})
            rows[-1]["seconds"] = seconds
    return rows


def _tried(run: Callable[[], dict]) -> dict:
    """What a run finds, or nothing where its packages are missing."""
    try:
        return run()
    except ImportError:
        return {}
