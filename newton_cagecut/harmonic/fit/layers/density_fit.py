# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The densities with which layers meet given boundary functions, all functions at once.

A harmonic function with boundary values phi is the single layer of its normal derivative less the double layer of phi.
The double layers are known; the densities of the single ones are found by Galerkin's method: on every panel the
residual of the boundary values, weighted with each hat function, has no mean. Where two sides of a cut coincide, one
sheet of charges stands for the sum of both normal derivatives, and either side's values may be met: the double layers
bring the jump.
"""

from __future__ import annotations

import numpy as np

from .galerkin import Galerkin
from .products import multiply_spans
from .sheet_rows import SheetRows
from .sheets import Sheet, SheetBatch
from .solve import System
from .spans import in_spans

_BATCH = 4096
"""Points whose layers are held at a time where none are kept."""


class DensityFit:
    """Harmonic functions with given boundary values, by layers of some sheets.

    The sums run over the sheets in their order, so that sheets which change often belong at the end.

    Args:
        sheets: The sheets, in order.
        columns: The function that each function of a sheet is.
        column_count: Number of functions.
        galerkin: Integrals between the sheets.
        earlier: An earlier fit; what both have in common is not solved again.

    Raises:
        ValueError: There is no solution.
    """

    def __init__(
        self,
        sheets: list[Sheet],
        columns: list[np.ndarray],
        column_count: int,
        galerkin: Galerkin,
        *,
        earlier: DensityFit | None = None,
    ) -> None:
        self.sheets, self.column_count = sheets, column_count
        self.node_count = sum(sheet.node_count for sheet in sheets)
        system = System(self.node_count, column_count, galerkin.device)
        kept = 0
        if earlier is not None:
            kept = system.take_over(earlier._system, _shared(sheets, earlier.sheets))
        galerkin.fill(sheets, system, columns, known=kept)
        density = system.solve(kept=kept).numpy().reshape(-1, system.lanes * 8)[: self.node_count, :column_count]
        if not np.isfinite(density).all():
            raise ValueError(
                "the fit of this cage has no solution: faces of no area, or walls that all but coincide; "
                "take correction='harmonic'"
            )
        self._system = system
        self._right = _right_side(sheets, columns, density)

    def evaluated(self, rows: SheetRows, spans: np.ndarray) -> np.ndarray:
        """The functions at spans of points, or their gradients, whose layers have been computed.

        Args:
            rows: Layers of the sheets.
            spans: The spans, shape (n,).

        Returns:
            Values, shape (n, 16, column_count), or gradients, shape (n, 16, column_count, dimension).
        """
        axes = rows.dimension if rows.slopes else 1
        row = (axes * spans[:, None] + np.arange(axes)).reshape(-1)
        columns = rows.columns(self.sheets)
        jobs = np.stack([row, np.zeros_like(row), np.full_like(row, len(columns))], axis=1)
        found = multiply_spans(jobs, rows.matrix, columns, self._right).astype(np.float64)
        found = found.reshape(len(spans), axes, -1, self.column_count)
        return np.moveaxis(found, 1, 3) if rows.slopes else found[:, 0]

    def at(self, points: np.ndarray, batch: SheetBatch, *, slopes: bool = False) -> np.ndarray:
        """The functions at points of which nothing is kept.

        Args:
            points: Points inside, shape (point_count, dimension).
            batch: The sheets, these among others.
            slopes: Whether gradients are wanted in place of values.

        Returns:
            Values, shape (point_count, column_count), or gradients, with a last axis of the dimension.
        """
        shape = (len(points), self.column_count) + ((batch.dimension,) if slopes else ())
        out = np.empty(shape)
        own = np.isin(np.array([id(sheet) for sheet in batch.sheets]), [id(sheet) for sheet in self.sheets])
        for first in range(0, len(points), _BATCH):
            some = points[first : first + _BATCH]
            rows = SheetRows(batch.dimension, batch.device, slopes=slopes)
            rows.place(in_spans(some))
            spans = np.arange(rows.span_count)
            rows.bring(batch, np.repeat(own[:, None], len(spans), axis=1))
            found = self.evaluated(rows, spans)
            out[first : first + len(some)] = found.reshape(-1, *shape[1:])[: len(some)]
        return out


def _shared(sheets: list[Sheet], earlier: list[Sheet]) -> int:
    """Unknowns of the first sheets that are the same in both lists."""
    count = 0
    for sheet, other in zip(sheets, earlier):
        if sheet is not other:
            break
        count += sheet.node_count
    return count


def _right_side(sheets: list[Sheet], columns: list[np.ndarray], density: np.ndarray) -> np.ndarray:
    """What each layer counts for the functions: charges their densities, dipoles minus one for their own function."""
    right = np.zeros((sum(sheet.column_count for sheet in sheets), density.shape[1]), dtype=np.float32)
    first = node = 0
    for sheet, own in zip(sheets, columns):
        right[first : first + sheet.node_count] = density[node : node + sheet.node_count]
        right[first + sheet.node_count + np.arange(len(own)), own] = -1.0
        first, node = first + sheet.column_count, node + sheet.node_count
    return right
