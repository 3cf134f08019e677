# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Linear inequalities on the moves of a mesh's vertices, and the moves of least cost under them."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

_SHORTFALL_COST = 100.0  # of a unit of length, where the volume of the mesh's box costs about 1
_ROWS_AT_ONCE = 3  # rows that a round takes in, of the number of unknowns
_SLACK = 1e-10  # by which a row may be missed


class Inequalities:
    """Lower bounds on combinations of moves, gathered block by block.

    Args:
        vertex_count: Number of vertices that move.
    """

    def __init__(self, vertex_count: int):
        self.vertex_count = vertex_count
        self._rows: list[np.ndarray] = []
        self._columns: list[np.ndarray] = []
        self._values: list[np.ndarray] = []
        self._bounds: list[np.ndarray] = []
        self._count = 0

    def require(
        self, vertices: np.ndarray, weights: np.ndarray, directions: np.ndarray, bounds: np.ndarray, *, soft: bool
    ) -> None:
        """Ask that the weighted sum of some vertices' moves along a direction is at least a bound.

        Args:
            vertices: Vertex ids, shape (row_count, k).
            weights: Weight of each of them, shape (row_count, k).
            directions: Unit vectors, shape (row_count, 3).
            bounds: Least sum along the direction, shape (row_count,).
            soft: Whether the bound may be missed by the common shortfall.
        """
        row = self._count + np.arange(len(vertices))
        axes = np.arange(3)
        self._rows.append(np.repeat(row, 3 * vertices.shape[1]))
        self._columns.append((3 * vertices[:, :, None] + axes).reshape(-1))
        self._values.append((weights[:, :, None] * directions[:, None, :]).reshape(-1))
        if soft:
            self._rows.append(row)
            self._columns.append(np.full(len(row), 3 * self.vertex_count))
            self._values.append(np.ones(len(row)))
        self._bounds.append(bounds)
        self._count += len(vertices)

    def least(self, cost: np.ndarray, step: float) -> tuple[np.ndarray, float]:
        """Find the moves of least cost, by a linear program.

        Most rows bind nowhere, so the program is solved with few of them, and those that its solution misses join until
        it misses none: the optimum is that of all rows.

        Args:
            cost: Cost of each vertex's move along each axis, shape (vertex_count, 3).
            step: Longest move along an axis.

        Returns:
            The moves, shape (vertex_count, 3), and the shortfall, as small as it can be.

        Raises:
            ValueError: The hard inequalities exclude each other.
        """
        unknowns = 3 * self.vertex_count + 1
        entries = (np.concatenate(self._rows), np.concatenate(self._columns))
        matrix = csr_matrix((np.concatenate(self._values), entries), shape=(self._count, unknowns))
        bounds = np.concatenate(self._bounds)
        limits = [(-step, step)] * (unknowns - 1) + [(0.0, None)]
        size = np.asarray(abs(matrix).sum(axis=1)).reshape(-1)
        missed = bounds / np.maximum(size, np.finfo(float).tiny)  # the move that a row asks for, at least
        taken = np.zeros(self._count, dtype=bool)
        moves = np.zeros(unknowns)
        while True:
            waiting = np.flatnonzero(~taken & (missed > -step if not taken.any() else missed > _SLACK))
            if len(waiting) == 0:
                return moves[:-1].reshape(-1, 3), float(moves[-1])
            taken[waiting[np.argsort(-missed[waiting], kind="stable")[: _ROWS_AT_ONCE * unknowns]]] = True
            solution = linprog(
                np.append(cost, _SHORTFALL_COST),
                A_ub=-matrix[taken],
                b_ub=-bounds[taken],
                bounds=limits,
                method="highs",
            )
            if solution.x is None:
                raise ValueError(f"the linear program has no solution: {solution.message}")
            moves = solution.x
            missed = bounds - matrix @ moves
