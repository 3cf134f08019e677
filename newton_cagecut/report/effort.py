# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How much is measured: all of it, a shorter run of the same, or a quick look."""

from __future__ import annotations

from dataclasses import asdict, dataclass

_SEEDED_WALKS = 4096  # of all runs of a point together, where there is more than one


@dataclass(frozen=True)
class Effort:
    """Sizes of the measurements.

    Attributes:
        name: "full", "short" or "quick".
        point_count: Points of a scene: half of them vertices of its mesh, half quadrature points with gradients.
        walk_counts: Walks a point whose errors are measured.
        fitted_counts: Walks a point on top of a fit.
        seeds: Seeds of the walks; each is a run of its own. Of many walks there are fewer runs, by :meth:`seeds_of`.
        reference_runs: Long runs of the reference, with seeds of their own.
        reference_walks: Walks a point of each.
        row_walks: Walks a point where the walks are not what is varied.
        cell_counts: Finite elements that would fill the cage if they were regular.
        table_walks: Walks a point of the paper's table.
        face_counts: Faces of the cages whose growth is measured.
        point_counts: Points whose growth is measured.
    """

    name: str
    point_count: int
    walk_counts: tuple[int, ...]
    fitted_counts: tuple[int, ...]
    seeds: tuple[int, ...]
    reference_runs: int
    reference_walks: int
    row_walks: int
    cell_counts: tuple[int, ...]
    table_walks: int
    face_counts: tuple[int, ...]
    point_counts: tuple[int, ...]

    def seeds_of(self, walks: int) -> tuple[int, ...]:
        """Return the seeds of runs with some walks a point: one run of many tells as much as several of few.

        Args:
            walks: Walks a point.
        """
        return self.seeds[: max(1, _SEEDED_WALKS // max(walks, 1))]

    def settings(self) -> dict:
        """All of it as JSON can hold it."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}


QUICK = Effort(
    name="quick",
    point_count=128,
    walk_counts=(8, 32, 128, 512),
    fitted_counts=(0, 32, 512),
    seeds=(1, 2),
    reference_runs=4,
    reference_walks=4096,
    row_walks=256,
    cell_counts=(400, 4000),
    table_walks=32,
    face_counts=(50, 200, 800),
    point_counts=(100, 400, 1600),
)
SHORT = Effort(
    name="short",
    point_count=512,
    walk_counts=(8, 32, 128, 512, 2048),
    fitted_counts=(0, 32, 128, 512),
    seeds=(1, 2),
    reference_runs=8,
    reference_walks=4096,
    row_walks=512,
    cell_counts=(400, 2000, 10000),
    table_walks=32,
    face_counts=(50, 200, 800, 3200),
    point_counts=(1000, 4000, 16000),
)
FULL = Effort(
    name="full",
    point_count=512,
    walk_counts=tuple(1 << k for k in range(3, 15)),
    fitted_counts=(0, 8, 32, 128, 512, 2048),
    seeds=(1, 2, 3, 4),
    reference_runs=8,
    reference_walks=8192,
    row_walks=1024,
    cell_counts=(300, 1500, 7500, 25000),
    table_walks=256,
    face_counts=(50, 100, 200, 400, 800, 1600, 3200),
    point_counts=(1000, 4000, 16000, 64000),
)
EFFORTS = {effort.name: effort for effort in (QUICK, SHORT, FULL)}
"""All of them by their names."""
