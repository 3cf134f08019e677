# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Table 1 of the paper: how much faster an update is than a full recompute, on six scenes.

``python -m benchmarks.table1`` cuts each scene in steps of 3 % and prints means over the steps, with the paper's row
under each. The points are the vertices of the embedded mesh, as in the paper. The full recompute walks every walk
again on the walls as they are, at the beginning, in the middle and at the end of the cuts; the weights must be the
same before and after, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from tqdm import tqdm

from benchmarks.paper import PaperRow
from benchmarks.progressive import Table, add_scenes, compile_kernels, edits, parsed, parser_of, show, step_count
from benchmarks.scenes import SCENES, BenchmarkScene
from newton_cagecut import HarmonicCoordinates, UpdateStats
from newton_cagecut.elastic import sample_quadrature

QUADRATURE_COUNT = 600  # of STARFISH in section 7.2 of the paper
PARTS = {"walls": "walls", "check": "check", "rewalk": "re-walk", "on_face": "on-face", "resolve": "resolve"}
HEAD = (
    *("scene", "faces", "vertices", "points", "re-walk %", "on-face %"),
    *(f"{name} ms" for name in PARTS.values()),
    *("update ms", "recompute ms", "ratio", "bytes a walk", "cache MB"),
)


@dataclass(frozen=True)
class Measured:
    """What was measured of a scene.

    Attributes:
        scene: The scene.
        point_count: Points whose weights were updated.
        steps: Of each step of the cuts.
        recomputes: Seconds of the full recomputes.
        walk_count: Walks in all.
        memory: Bytes of each part.
    """

    scene: BenchmarkScene
    point_count: int
    steps: Sequence[UpdateStats]
    recomputes: Sequence[float]
    walk_count: int
    memory: dict[str, int]

    def mean_ms(self, part: str) -> float:
        """Mean time of a part of the update, a step [ms]."""
        return 1e3 * float(np.mean([stats.seconds.get(part, 0.0) for stats in self.steps]))

    def percent(self, count: str) -> float:
        """Mean share of the walks that were "rewalked" or "on_face", a step [%]."""
        return 100.0 * float(np.mean([getattr(stats, count) / stats.walk_count for stats in self.steps]))

    @property
    def update_ms(self) -> float:
        """Mean time of the update, a step [ms]."""
        return 1e3 * float(np.mean([stats.total_seconds for stats in self.steps]))

    @property
    def recompute_ms(self) -> float:
        """Mean time of the full recompute [ms]."""
        return 1e3 * float(np.mean(self.recomputes))

    @property
    def ratio(self) -> float:
        """Time of the recompute over that of the update."""
        return self.recompute_ms / self.update_ms

    def row(self) -> list[str]:
        """Return the cells of the scene's row."""
        cage = self.scene.cage
        byte_count = self.memory["landings"] + self.memory["bounds"]
        return [
            *(self.scene.name, str(cage.face_count), str(cage.vertex_count), str(self.point_count)),
            *(f"{self.percent('rewalked'):.2f}", f"{self.percent('on_face'):.2f}"),
            *(f"{self.mean_ms(part):.1f}" for part in PARTS),
            *(f"{self.update_ms:.1f}", f"{self.recompute_ms:.1f}", f"{self.ratio:.1f}"),
            *(f"{byte_count / self.walk_count:.0f}", f"{byte_count / 1e6:.0f}"),
        ]


def measure(
    scene: BenchmarkScene, walks: int, *, gradients: bool = False, progress: bool = True, **options
) -> Measured:
    """Cut a scene step by step and measure.

    Args:
        scene: The scene.
        walks: Walks a point.
        gradients: Whether to add quadrature points, with gradients.
        progress: Whether to show a bar on standard error.
        options: Further options of the coordinates.

    Raises:
        ValueError: A full recompute gave other weights than the updates.
    """
    points, mask = scene.points, np.zeros(len(scene.points), dtype=bool)
    if gradients:
        extra = sample_quadrature(scene.cage, QUADRATURE_COUNT)[0]
        points, mask = np.concatenate([points, extra]), np.append(mask, np.ones(len(extra), dtype=bool))
    compile_kernels(scene.cage, scene.blades, points, gradients=gradients, **options)
    total = len(scene.blades) * step_count()
    steps, recomputes = [], []
    with tqdm(total=total, desc=scene.name, unit="step", disable=not progress) as bar:
        coordinates = HarmonicCoordinates(scene.cage, points, walks, gradients=mask, **options)
        recomputes.append(recompute(coordinates))
        for edit in edits(scene.cage, scene.blades):
            steps.append(coordinates.update(edit))
            if len(steps) in (total // 2, total):
                recomputes.append(recompute(coordinates))
            bar.update()
    return Measured(scene, len(points), steps, recomputes, len(points) * walks, coordinates.memory())


def recompute(coordinates: HarmonicCoordinates) -> float:
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


def main(arguments: Sequence[str] | None = None) -> list[Measured]:
    """Measure the scenes of the command line and print the table.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = parser_of(__doc__.split("\n")[0])
    add_scenes(parser)
    parser.add_argument("--bounds", default="dop18", help="bounding volume of a walk (default: dop18)")
    parser.add_argument(
        "--gradients", action="store_true", help=f"add {QUADRATURE_COUNT} quadrature points, with gradients"
    )
    options = parsed(parser, arguments)
    measured = [
        measure(scene, options.walks, gradients=options.gradients, bounds=options.bounds, device=options.device)
        for scene in (SCENES[name] for name in options.scene)
    ]
    rows = [cells for result in measured for cells in (result.row(), paper_cells(result.scene.paper))]
    title = (
        f"Means over the steps of 3 %: {options.walks} walks a point, {options.bounds} bounds, on {options.device}. "
        "The weights of the full recompute were those of the updates, bit for bit."
    )
    show([Table(title, HEAD, rows)], options.markdown)
    return measured


if __name__ == "__main__":
    main()
