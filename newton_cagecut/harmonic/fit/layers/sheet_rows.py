# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers of sheets at points, kept from one fit to the next: most sheets of a cage outlive a step of a cut."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...launch import launch
from .layer_rows import SheetRange, make_layer_rows
from .sheets import Sheet, SheetBatch
from .slots import Slots
from .spans import SPAN, Span, WideSpan, span_count


class SheetRows:
    """A matrix of layers: spans of points down, layers of sheets across.

    Numbers of a sheet stay in the columns where they are; which columns these are differs by what came before, what is
    in them does not. Nothing else is ever read than what was computed for just these points and sheets.

    Args:
        dimension: Dimension of the space.
        device: Where to put it.
        slopes: Whether to hold gradients, a row an axis, in place of values.
    """

    def __init__(self, dimension: int, device: wp.context.Device, *, slopes: bool = False) -> None:
        self.dimension, self.device, self.slopes = dimension, device, slopes
        self._rows_each = dimension if slopes else 1
        self._places = np.zeros((0, dimension))
        self._spans = wp.zeros((0, dimension), dtype=WideSpan, device=device)
        self.matrix = wp.zeros((0, 0), dtype=Span, device=device)
        self._columns = Slots()
        self._filled: dict[Sheet, np.ndarray] = {}

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return 4 * SPAN * self.matrix.size + 8 * SPAN * self._spans.size

    @property
    def span_count(self) -> int:
        """Spans of points."""
        return len(self._places) // SPAN

    def place(self, places: np.ndarray) -> None:
        """Say where the points are; what is kept of spans that stay the same stays.

        Args:
            places: Positions in whole spans, shape (span_count * 16, dimension).
        """
        if places.shape == self._places.shape and np.array_equal(places, self._places):
            return
        count = span_count(len(places))
        shared = min(count, self.span_count)
        by_span = (places[: shared * SPAN] == self._places[: shared * SPAN]).reshape(shared, SPAN * self.dimension)
        same = np.zeros(count, dtype=bool)
        same[:shared] = by_span.all(axis=1)
        wide = np.ascontiguousarray(places.reshape(count, SPAN, -1).swapaxes(1, 2))
        spans = wp.array(wide, dtype=WideSpan, device=self.device)
        filled = {}
        for sheet, rows in self._filled.items():
            filled[sheet] = same.copy()
            filled[sheet][:shared] &= rows[:shared]
        self._make_room(count, self._columns.capacity)
        self._places, self._spans, self._filled = places.copy(), spans, filled

    def bring(self, batch: SheetBatch, wanted: np.ndarray) -> np.ndarray:
        """Compute what is missing; layers of other sheets are forgotten.

        Args:
            batch: The sheets.
            wanted: Which spans are wanted of which sheet, shape (sheet_count, span_count).

        Returns:
            Which had been missing, shape (sheet_count, span_count).
        """
        present = set(batch.sheets)
        for sheet in [sheet for sheet in self._filled if sheet not in present]:
            del self._filled[sheet]
        self._columns.keep(present)
        first = np.array([self._columns.take(sheet, sheet.column_count) for sheet in batch.sheets])
        self._make_room(self.span_count, self._columns.capacity)
        none = np.zeros(self.span_count, dtype=bool)
        missing = wanted & ~np.array([self._filled.get(sheet, none) for sheet in batch.sheets])
        tasks = np.argwhere(missing).astype(np.int32)
        if len(tasks):
            ranges = batch.ranges.copy()
            ranges["column"] = first
            kit = make_layer_rows(self.dimension)
            inputs = [
                wp.array(tasks, dtype=wp.vec2i, device=self.device),
                wp.array(ranges, dtype=SheetRange, device=self.device),
                batch.panels,
                self._spans,
                self.matrix,
            ]
            launch(kit.slopes if self.slopes else kit.layers, len(tasks), inputs, device=self.device, smallest_chunk=4)
        for sheet, rows in zip(batch.sheets, missing):
            self._filled[sheet] = self._filled.get(sheet, none) | rows
        return missing

    def columns(self, sheets: list[Sheet]) -> np.ndarray:
        """Columns of the layers of sheets, one after the other: of each its charges', then its dipoles'."""
        first = self.first_columns(sheets)
        return np.concatenate([at + np.arange(sheet.column_count) for at, sheet in zip(first, sheets)])

    def first_columns(self, sheets: list[Sheet]) -> list[int]:
        """First column of the layers of each sheet."""
        return [self._columns.first(sheet) for sheet in sheets]

    def _make_room(self, spans: int, columns: int) -> None:
        rows = spans * self._rows_each
        if rows <= self.matrix.shape[0] and columns <= self.matrix.shape[1]:
            return
        shape = max(rows, self.matrix.shape[0]), max(columns, self.matrix.shape[1])
        matrix = wp.empty(shape, dtype=Span, device=self.device)
        if self.matrix.size:
            wp.copy(matrix[: self.matrix.shape[0], : self.matrix.shape[1]], self.matrix)
        self.matrix = matrix


def own_layers(batch: SheetBatch, places: list[np.ndarray]) -> tuple[wp.array, np.ndarray]:
    """Layers of each sheet at points of its own.

    Args:
        batch: The sheets.
        places: Positions for each sheet, in whole spans, shape (n, dimension) each.

    Returns:
        Layers, shape (span_count, greatest column_count), and the first span of each sheet and the end of the last.
    """
    device, dimension = batch.device, batch.dimension
    first = np.cumsum([0, *(span_count(len(own)) for own in places)])
    wide = np.concatenate(places).reshape(-1, SPAN, dimension).swapaxes(1, 2)
    columns = max(sheet.column_count for sheet in batch.sheets)
    out = wp.empty((len(wide), columns), dtype=Span, device=device)
    tasks = np.stack([np.repeat(np.arange(len(places)), np.diff(first)), np.arange(len(wide))], axis=1)
    inputs = [
        wp.array(tasks.astype(np.int32), dtype=wp.vec2i, device=device),
        wp.array(batch.ranges, dtype=SheetRange, device=device),
        batch.panels,
        wp.array(np.ascontiguousarray(wide), dtype=WideSpan, device=device),
        out,
    ]
    launch(make_layer_rows(dimension).layers, len(tasks), inputs, device=device, smallest_chunk=4)
    return out, first
