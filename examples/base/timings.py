# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Measures a scene: the steps of its cuts, the full recompute that they save, and the simulation.

The full recompute walks every walk again on the walls as they are (the naive baseline of the paper, section 7). It
changes nothing, because updates are bit-identical to it, which is checked each time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from newton_cagecut import CutReport, HarmonicCoordinates, SolverCageCut
from newton_cagecut.report.page.markdown import table_lines

from .cutting import PlannedCut

RECOMPUTE_EVERY = 8  # steps of the first cut
UPDATE_PARTS = {
    "walls": "walls",
    "check": "check",
    "rewalk": "re-walk",
    "on_face": "on-face",
    "resolve": "resolve",
    "new_points": "new points",
}
OTHER_PARTS = ("topology", "surface", "transfer")


@dataclass
class CutTimes:
    """The steps of one cut.

    Attributes:
        name: What was cut.
        reports: Of each step.
    """

    name: str
    reports: list[CutReport] = field(default_factory=list)

    def mean_part(self, part: str) -> float:
        """Mean time of a part of the update of the weights, a step [ms]."""
        return 1e3 * float(np.mean([report.stats.seconds.get(part, 0.0) for report in self.reports]))

    def mean_update(self) -> float:
        """Mean time of the update of the weights, a step [ms]."""
        return 1e3 * float(np.mean([report.stats.total_seconds for report in self.reports]))

    def mean_other(self, part: str) -> float:
        """Mean time of another part of a step [ms]."""
        return 1e3 * float(np.mean([report.seconds[part] for report in self.reports]))

    def percent(self, count: str) -> float:
        """Mean share of the walks that were "rewalked" or "on_face" a step [%]."""
        return 100.0 * float(np.mean([getattr(r.stats, count) / r.stats.walk_count for r in self.reports]))


class Timings:
    """Collects the times of a scene.

    Args:
        solver: The solver.
        plan: The cuts that the scene will make.
    """

    def __init__(self, solver: SolverCageCut, plan: Sequence[PlannedCut]):
        self._solver, self._plan = solver, tuple(plan)
        self._cuts = [CutTimes(cut.name) for cut in plan]
        self._recompute_seconds: list[float] = []
        self._simulation_steps, self._simulation_seconds = 0, 0.0

    def add_cut_step(self, number: int, report: CutReport) -> None:
        """Add a step of a cut; sometimes measure the full recompute after it.

        Args:
            number: Number of the cut in the plan.
            report: What the step did.

        Raises:
            ValueError: The recompute gave other weights or gradients than the updates.
        """
        cut = self._cuts[number]
        if number == 0 and len(cut.reports) % RECOMPUTE_EVERY == RECOMPUTE_EVERY - 1:
            self._recompute(self._solver.body(self._plan[0].body).coordinates)
        cut.reports.append(report)

    def add_simulation(self, step_count: int, seconds: float) -> None:
        """Add steps of the simulation, collisions included.

        Args:
            step_count: How many.
            seconds: Their time together [s].
        """
        self._simulation_steps += step_count
        self._simulation_seconds += seconds

    def table(self) -> str:
        """Return all that was measured as text."""
        cuts = [cut for cut in self._cuts if cut.reports]
        lines = [*self._scene_lines(), ""]
        lines += table_lines(
            ["means a step", "steps", "re-walk", "on-face", *(f"{name} ms" for name in UPDATE_PARTS.values())],
            [
                [
                    cut.name,
                    str(len(cut.reports)),
                    f"{cut.percent('rewalked'):.2f} %",
                    f"{cut.percent('on_face'):.2f} %",
                    *(f"{cut.mean_part(part):.1f}" for part in UPDATE_PARTS),
                ]
                for cut in cuts
            ],
        )
        lines += [""]
        lines += table_lines(
            ["means a step", "update ms", *(f"{name} ms" for name in OTHER_PARTS)],
            [
                [cut.name, f"{cut.mean_update():.1f}", *(f"{cut.mean_other(p):.1f}" for p in OTHER_PARTS)]
                for cut in cuts
            ],
        )
        return "\n".join([*lines, "", *self._summary_lines(cuts)])

    def _recompute(self, coordinates: HarmonicCoordinates) -> None:
        weights, gradients = coordinates.weights, coordinates.gradients
        self._recompute_seconds.append(coordinates.recompute().total_seconds)
        same = np.array_equal(weights, coordinates.weights) and np.array_equal(gradients, coordinates.gradients)
        if not same:
            raise ValueError("the full recompute gave other weights than the updates: they must be identical")

    def _scene_lines(self) -> list[str]:
        return [
            f"{body.label}: {len(body.surface.points)} points and {body.quadrature_count} quadrature points in a cage "
            f"of now {body.cage.face_count} faces, {body.coordinates.walks} walks a point, on {body.device}"
            for body in self._solver.bodies
        ]

    def _summary_lines(self, cuts: Sequence[CutTimes]) -> list[str]:
        lines = []
        if self._recompute_seconds:
            full, update = 1e3 * float(np.mean(self._recompute_seconds)), cuts[0].mean_update()
            count = len(self._recompute_seconds)
            lines.append(
                f"full recompute    {full:8.1f} ms, {count} times in {cuts[0].name}: same weights, bit for bit"
            )
            lines.append(
                f"update            {update:8.1f} ms, mean of {cuts[0].name}: {full / update:.1f} times faster"
            )
        if self._simulation_steps:
            step = 1e3 * self._simulation_seconds / self._simulation_steps
            lines.append(f"simulation step   {step:8.1f} ms, collisions included, mean of {self._simulation_steps}")
        for body in self._solver.bodies:
            memory = body.coordinates.memory()
            walks = body.coordinates.walks * body.coordinates.weights_array.shape[0]
            byte_count = memory["landings"] + memory["bounds"]
            lines.append(
                f"walk cache        {byte_count / walks:8.1f} bytes a walk, {byte_count / 1e6:.0f} MB reserved"
            )
        return lines
