# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A scene on a device, as the rows measure it: points, a half-made cut, and what the weights truly are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from time import perf_counter

import numpy as np
import warp as wp

from ..cage import Cage, CageEdit, Cut
from ..elastic import sample_quadrature
from ..harmonic import HarmonicCoordinates, warm_up_coordinates
from .effort import Effort
from .paper.cutting import STEP
from .reference.long_walks import Reference, long_walks
from .scenes.scene import Scene

STAGES = ("before", "during")
"""Before the first cut, and half way through it."""
HALF_STEPS = 17
"""Steps of a cut to its half; half a step more, as exactly the half often falls on an edge of a symmetric cage."""


@dataclass(frozen=True)
class HalfCut:
    """The first cut of a scene, half made.

    Attributes:
        most: The edit up to one step before the half.
        step: The step to the half.
        seconds: Time of the step's topology [s].
    """

    most: CageEdit
    step: CageEdit
    seconds: float


@dataclass
class Bench:
    """A scene that is measured.

    Attributes:
        scene: The scene.
        effort: How much is measured.
        device: The device.
        folder: Where references are kept between runs.
    """

    scene: Scene
    effort: Effort
    device: wp.context.Device
    folder: Path
    _references: dict[str, Reference] = field(default_factory=dict)
    _warm: set[tuple] = field(default_factory=set)

    @cached_property
    def points(self) -> np.ndarray:
        """Where errors are measured [m], shape (n, dimension): vertices of the mesh, then quadrature points.

        A mesh vertex near a wall has a gradient that nobody uses, and whose error would hide all others.
        """
        return np.concatenate([self.mesh_points, self.quadrature_points])

    @cached_property
    def mesh_points(self) -> np.ndarray:
        """Vertices of the mesh, spread over their order [m]."""
        return spread(np.asarray(self.scene.points, dtype=np.float64), self.effort.point_count // 2)

    @cached_property
    def quadrature_points(self) -> np.ndarray:
        """Quadrature points [m]."""
        return spread(sample_quadrature(self.scene.cage, self.effort.point_count // 2)[0], 0)

    @property
    def has_gradient(self) -> np.ndarray:
        """Which points have gradients, as a mask."""
        return np.arange(len(self.points)) >= len(self.mesh_points)

    @cached_property
    def half_cut(self) -> HalfCut:
        """The first cut, half made."""
        cut = Cut(self.scene.cage, self.scene.blades[0])
        most = cut.advance(to=(HALF_STEPS - 1) * STEP * cut.length)
        start = perf_counter()
        step = cut.advance(to=HALF_STEPS * STEP * cut.length)
        _ = step.changed_keys
        return HalfCut(most, step, perf_counter() - start)

    def opening(self, stage: str) -> tuple[list[np.ndarray], np.ndarray]:
        """Return what the blade has swept up to a stage, and the ends of its front [m].

        Args:
            stage: One of ``STAGES``.

        Returns:
            Polygons, in the plane segments; and the front's ends, in the plane its tip, shape (n, dimension).
        """
        cage = self.scene.cage
        if stage == "before":
            return [], np.zeros((0, cage.dimension))
        cut = Cut(cage, self.scene.blades[0])
        edit = cut.advance(to=HALF_STEPS * STEP * cut.length)
        ends = np.concatenate(edit.swept)
        place = cut.plane.coordinates(ends)
        front = np.flatnonzero(np.abs(place[:, -1] - edit.front) < 1e-9 * cage.diameter)
        along = place[front, 0]
        return list(edit.swept), ends[front[[along.argmin(), along.argmax()][: cage.dimension - 1]]]

    def cage(self, stage: str) -> Cage:
        """Return the cage of a stage.

        Args:
            stage: One of ``STAGES``.
        """
        return self.scene.cage if stage == "before" else self.half_cut.step.cage

    def coordinates(self, walks: int, seed: int, **options) -> HarmonicCoordinates:
        """Return coordinates of the points in the cage before the cut.

        Args:
            walks: Walks a point.
            seed: Seed of the walks.
            options: Further options.
        """
        return HarmonicCoordinates(
            self.scene.cage, self.points, walks, seed, gradients=self.has_gradient, device=self.device, **options
        )

    def reference(self, stage: str) -> Reference:
        """Return what the weights and gradients of a stage are, found once and kept in the folder.

        Args:
            stage: One of ``STAGES``.
        """
        if stage not in self._references:
            path = self.folder / f"{self.scene.name}_{stage}.npz"
            found = Reference.load(path) if path.exists() else None
            if found is None:
                found = long_walks(
                    self.cage(stage),
                    self.points,
                    self.has_gradient,
                    runs=self.effort.reference_runs,
                    walks=self.effort.reference_walks,
                    device=self.device,
                )
                found.save(path)
            self._references[stage] = found
        return self._references[stage]

    def warm_up(self, **options) -> None:
        """Compile what a run with options needs, if it has not run before.

        Args:
            options: Of the coordinates.
        """
        chosen = tuple(sorted(options.items()))
        if chosen in self._warm:
            return
        warm_up_coordinates(
            self.scene.cage, self.points, gradients=bool(self.has_gradient.any()), device=self.device, **options
        )
        self._warm.add(chosen)


def spread(points: np.ndarray, count: int) -> np.ndarray:
    """Return about ``count`` of the points, evenly over their order, or all where the count is 0."""
    return points[:: max(1, len(points) // count)] if count else points


def benches_of(scenes: Sequence[Scene], effort: Effort, device: wp.context.Device, folder: Path) -> list[Bench]:
    """Return scenes as they are measured.

    Args:
        scenes: The scenes.
        effort: How much is measured.
        device: The device.
        folder: Where references are kept between runs; it is made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    return [Bench(scene, effort, device, folder) for scene in scenes]
