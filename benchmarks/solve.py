# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A dense factor against diagonal blocks in the solves of steps: ``python -m benchmarks.solve [--markdown FILE]``.

Boxes of 8 to 800 vertices with trilinear weights hang by their tops and swing, at Poisson's ratio 0.4 and 0.499. The
same steps are taken with both preconditioners, in turn; each counts with its median step. The crossover, after which a
factor does not pay, is what ``SolverCageCut.Config.dense_vertices`` follows.
"""

from __future__ import annotations

import time

import numpy as np
import warp as wp

from benchmarks.progressive import parsed, parser_of, show
from newton_cagecut.elastic import Material, ReducedSystem, SolveLimits
from newton_cagecut.report.page.markdown import Table

CELLS = ((1, 1, 1), (1, 1, 5), (2, 2, 4), (3, 3, 5), (4, 4, 7), (5, 5, 9), (6, 6, 11), (7, 7, 11))
"""Cells of the boxes along their axes."""
POINT_COUNT = 400
STEPS = 8
DT = 1.0 / 60.0


def trilinear(points: np.ndarray, cells: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return vertices of a box of cubes of 0.1 m, and weights and gradients of its vertices at points.

    Args:
        points: Places in the box, in cells, shape (n, 3).
        cells: Cells along the axes.
    """
    axes = [np.arange(n + 1.0) for n in cells]
    vertices = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    offset = points[:, None] - vertices
    hats = np.clip(1.0 - np.abs(offset), 0.0, 1.0)
    slopes = np.where(np.abs(offset) < 1.0, -np.sign(offset), 0.0)
    gradients = np.stack([slopes[..., k] * np.delete(hats, k, axis=-1).prod(axis=-1) for k in range(3)], axis=-1)
    return 0.1 * vertices, hats.prod(axis=-1), 10.0 * gradients


class SwingingBox:
    """A box that hangs by its top and is pulled aside by gravity.

    Args:
        cells: Cells along the axes.
        poisson: Poisson's ratio.
        dense: Whether its solves have a factor.
    """

    def __init__(self, cells: tuple[int, int, int], poisson: float, *, dense: bool) -> None:
        count = max(POINT_COUNT, 4 * int(np.prod(cells)))
        points = np.random.default_rng(0).uniform(0.0, cells, size=(count, 3))
        vertices, weights, gradients = trilinear(points, cells)
        self.vertex_count = len(vertices)
        self.system = ReducedSystem(
            wp.array(vertices, dtype=wp.vec3),
            wp.array(weights, dtype=float),
            wp.array(gradients, dtype=wp.vec3),
            np.full(count, 1.0e-3 * np.prod(cells) / count),
            Material(young=1.0e5, poisson=poisson),
            wp.array([len(vertices)], dtype=int),
            fixed=wp.array(vertices[:, 2] > 0.1 * (cells[2] - 0.5), dtype=int),
            limits=SolveLimits(dense_vertices=len(vertices) if dense else 0),
        )
        self._x, self._gravity = wp.clone(self.system.rest), wp.array([(3.0, 0.0, -9.81)], dtype=wp.vec3)
        self._v = wp.zeros_like(self._x)

    def step(self) -> float:
        """Step, and return how long that took [ms]."""
        start = time.perf_counter()
        self.system.step(self._x, self._v, self._x, self._v, DT, gravity=self._gravity)
        wp.synchronize_device()
        return 1.0e3 * (time.perf_counter() - start)


def compare(cells: tuple[int, int, int], poisson: float) -> tuple[int, list[float], list[str]]:
    """Return vertices, milliseconds a step with a factor and with blocks, and a row of the table.

    Args:
        cells: Cells of the box.
        poisson: Poisson's ratio.
    """
    boxes = [SwingingBox(cells, poisson, dense=dense) for dense in (True, False)]
    times = np.array([[box.step() for box in boxes] for _ in range(STEPS)])
    found = [box.system.step_statistics() for box in boxes]
    dense, blocks = np.median(times[1:], axis=0)
    row = [str(boxes[0].vertex_count), f"{poisson:g}", f"{dense:.2f}", f"{blocks:.2f}", f"{blocks / dense:.2f}"]
    row += [str(statistics["most_iterations"]) for statistics in found]
    row += [f"{statistics['worst_residual']:.0e}" for statistics in found]
    return boxes[0].vertex_count, [dense, blocks], row


def main(arguments: list[str] | None = None) -> None:
    """Compare and print.

    Args:
        arguments: Of the command line.
    """
    options = parsed(parser_of(__doc__), arguments)
    head = (
        "vertices",
        "Poisson",
        "factor ms",
        "blocks ms",
        "ratio",
        "iterations",
        "with blocks",
        "residual",
        "with blocks",
    )
    compare(CELLS[0], 0.4)  # compiles
    rows, lines = [], []
    for poisson in (0.4, 0.499):
        found = [compare(cells, poisson) for cells in CELLS]
        rows += [row for *_, row in found]
        pays = [count for count, (dense, blocks), _ in found if dense <= 1.1 * blocks]
        end = f"pays, or costs a tenth at most, up to {max(pays)} vertices" if pays else "never pays"
        lines.append(f"At Poisson's ratio {poisson:g} a factor {end}.")
    show([Table(f"Steps by TR-BDF2, two solves each. {' '.join(lines)}", head, rows)], options)


if __name__ == "__main__":
    main()
