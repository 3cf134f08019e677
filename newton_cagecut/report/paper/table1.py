# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Table 1 of the paper: how much faster an update is than a full recompute, in steps of 3 % of a cut."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...elastic import sample_quadrature
from ...harmonic import HarmonicCoordinates, UpdateStats, warm_up_coordinates
from ..scenes.scene import Scene
from .cutting import edits, step_count
from .published import PaperRow

QUADRATURE_COUNT = 600  # of STARFISH in section 7.2 of the paper
PARTS = {"walls": "walls", "check": "check", "rewalk": "re-walk", "on_face": "on-face", "resolve": "resolve"}
HEAD = (
    *("scene", "faces", "vertices", "points", "re-walk %", "on-face %"),
    *(f"{name} ms" for name in PARTS.values()),
    *("update ms", "recompute ms", "ratio", "bytes a walk", "cache MB"),
)


@dataclass(frozen=True)
class Measured:
    """What was measured of a scene: means over the steps of its cuts.

    Attributes:
        name: The scene's name.
        face_count: Faces of the cage before the cuts.
        vertex_count: Its vertices.
        point_count: Points whose weights were updated.
        step_count: Steps.
        rewalk_percent: Walks walked again a step [%].
        on_face_percent: Walks whose landing was evaluated again [%].
        part_ms: Time of each part of the update [ms].
        update_ms: Time of the update [ms].
        recompute_count: Full recomputes.
        recompute_ms: Mean time of one [ms].
        walk_count: Walks in all.
        cache_bytes: Bytes of the walk cache.
        gradient_bytes: Bytes of the gradients.
    """

    name: str
    face_count: int
    vertex_count: int
    point_count: int
    step_count: int
    rewalk_percent: float
    on_face_percent: float
    part_ms: dict[str, float]
    update_ms: float
    recompute_count: int
    recompute_ms: float
    walk_count: int
    cache_bytes: int
    gradient_bytes: int

    @property
    def ratio(self) -> float:
        """Time of the recompute over that of the update."""
        return self.recompute_ms / self.update_ms

    def cells(self) -> list[str]:
        """Return the cells of the scene's row."""
        return [
            *(self.name, str(self.face_count), str(self.vertex_count), str(self.point_count)),
            *(f"{self.rewalk_percent:.2f}", f"{self.on_face_percent:.2f}"),
            *(f"{self.part_ms[part]:.1f}" for part in PARTS),
            *(f"{self.update_ms:.1f}", f"{self.recompute_ms:.1f}", f"{self.ratio:.1f}"),
            *(f"{self.cache_bytes / self.walk_count:.0f}", f"{self.cache_bytes / 1e6:.0f}"),
        ]


def measure_table(
    scene: Scene, walks: int, *, gradients: bool = False, on_step: Callable[[], None] | None = None, **options
) -> Measured:
    """Cut a scene step by step and measure.

    Args:
        scene: The scene.
        walks: Walks a point.
        gradients: Whether to add quadrature points, with gradients.
        on_step: Called after each step.
        options: Further options of the coordinates.

    Raises:
        ValueError: A full recompute gave other weights than the updates.
    """
    points, mask = scene.points, np.zeros(len(scene.points), dtype=bool)
    if gradients:
        extra = sample_quadrature(scene.cage, QUADRATURE_COUNT)[0]
        points, mask = np.concatenate([points, extra]), np.append(mask, np.ones(len(extra), dtype=bool))
    warm_up_coordinates(scene.cage, points, gradients=gradients, **options)
    total = len(scene.blades) * step_count()
    coordinates = HarmonicCoordinates(scene.cage, points, walks, gradients=mask, **options)
    steps, recomputes = [], [recompute_seconds(coordinates)]
    for edit in edits(scene.cage, scene.blades):
        steps.append(coordinates.update(edit))
        if len(steps) in (total // 2, total):
            recomputes.append(recompute_seconds(coordinates))
        if on_step:
            on_step()
    return _means(scene, len(points), steps, recomputes, coordinates)


def _means(
    scene: Scene,
    point_count: int,
    steps: Sequence[UpdateStats],
    recomputes: Sequence[float],
    coordinates: HarmonicCoordinates,
) -> Measured:
    memory = coordinates.memory()

    def percent(count: str) -> float:
        return 100.0 * float(np.mean([getattr(stats, count) / stats.walk_count for stats in steps]))

    return Measured(
        name=scene.name,
        face_count=scene.cage.face_count,
        vertex_count=scene.cage.vertex_count,
        point_count=point_count,
        step_count=len(steps),
        rewalk_percent=percent("rewalked"),
        on_face_percent=percent("on_face"),
        part_ms={part: 1e3 * float(np.mean([stats.seconds.get(part, 0.0) for stats in steps])) for part in PARTS},
        update_ms=1e3 * float(np.mean([stats.total_seconds for stats in steps])),
        recompute_count=len(recomputes),
        recompute_ms=1e3 * float(np.mean(recomputes)),
        walk_count=point_count * coordinates.walks,
        cache_bytes=memory["landings"] + memory["bounds"],
        gradient_bytes=memory["gradients"],
    )


def recompute_seconds(coordinates: HarmonicCoordinates) -> float:
    """Compute all weights anew; return the seconds that it takes.

    Args:
        coordinates: The coordinates; nothing of them changes.

    Raises:
        ValueError: The weights or gradients are others than before.
    """
    weights, gradients = coordinates.weights, coordinates.gradients
    seconds = coordinates.recompute().total_seconds
    if not (np.array_equal(weights, coordinates.weights) and np.array_equal(gradients, coordinates.gradients)):
        raise ValueError("the full recompute gave other weights than the updates: they must be identical")
    return seconds


def paper_cells(paper: PaperRow) -> list[str]:
    """Return the cells of the paper's row; it does not tell the walls' and the resolve's share."""
    walk_count = 2048 * paper.mesh_vertex_count
    return [
        *("  (paper)", str(paper.face_count), str(paper.vertex_count), str(paper.mesh_vertex_count)),
        *(f"{paper.rewalk_percent:.2f}", f"{paper.on_face_percent:.2f}", ""),
        *(f"{value:.1f}" for value in (paper.check_ms, paper.rewalk_ms, paper.on_face_ms)),
        *("", f"{paper.update_ms:.1f}", f"{paper.recompute_ms:.1f}", f"{paper.ratio:.1f}"),
        *(f"{1e9 * paper.memory_gb / walk_count:.0f}", f"{1e3 * paper.memory_gb:.0f}"),
    ]
