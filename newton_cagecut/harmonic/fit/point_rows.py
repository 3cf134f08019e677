# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers at the points of coordinates, kept through edits: only those of new sheets are computed at every step."""

from __future__ import annotations

import numpy as np
import warp as wp

from .layers.density_fit import DensityFit
from .layers.sheet_rows import SheetRows
from .layers.sheets import SheetBatch
from .layers.spans import SPAN, span_count


class PointRows:
    """Layers, or their gradients, at numbered points.

    Args:
        dimension: Dimension of the space.
        device: Where to put them.
        slopes: Whether to hold gradients in place of values.
    """

    def __init__(self, dimension: int, device: wp.context.Device, *, slopes: bool = False) -> None:
        self._rows = SheetRows(dimension, device, slopes=slopes)
        self._chosen = np.zeros(0, dtype=np.int64)
        self._places = np.zeros((0, dimension))

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return self._rows.byte_count

    def choose(self, numbers: np.ndarray) -> PointRows:
        """Say which points the next ones are.

        Args:
            numbers: Their numbers, shape (n,).
        """
        self._chosen = numbers
        return self

    def bring(self, batch: SheetBatch, sheet_piece: np.ndarray, points: np.ndarray, piece: np.ndarray) -> None:
        """Compute the layers of sheets at the chosen points, as far as they are missing.

        Args:
            batch: All sheets.
            sheet_piece: Piece of each sheet.
            points: Where the points are, shape (n, dimension).
            piece: Piece of each, -1 for those without layers, shape (n,).
        """
        count = max(len(self._places), span_count(int(self._chosen.max(initial=-1)) + 1) * SPAN)
        places = np.zeros((count, self._rows.dimension))
        places[: len(self._places)] = self._places
        inside = piece >= 0
        places[self._chosen[inside]] = points[inside]
        self._rows.place(places)
        self._places = places
        wanted = np.zeros((len(batch.sheets), count // SPAN), dtype=bool)
        for number in np.unique(piece[inside]).tolist():
            spans = np.unique(self._chosen[piece == number] // SPAN)
            wanted[np.ix_(sheet_piece == number, spans)] = True
        self._rows.bring(batch, wanted)

    def evaluated(self, fit: DensityFit, some: np.ndarray) -> np.ndarray:
        """A fit's functions, or their gradients, at some of the chosen points, all of the same piece.

        Args:
            fit: The fit.
            some: Which of them, shape (n,).
        """
        numbers = self._chosen[some]
        spans, span = np.unique(numbers // SPAN, return_inverse=True)
        return fit.evaluated(self._rows, spans)[span, numbers % SPAN]
