# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Points that sheets bring along, and the layers of all sheets there, kept from one fit to the next."""

from __future__ import annotations

import numpy as np
import warp as wp

from .sheet_rows import SheetRows
from .sheets import Sheet, SheetBatch
from .slots import Slots
from .spans import SPAN, span_count


class SheetSites:
    """Layers at points of sheets.

    Args:
        dimension: Dimension of the space.
        device: Where to put them.
    """

    def __init__(self, dimension: int, device: wp.context.Device) -> None:
        self.rows = SheetRows(dimension, device)
        self._slots = Slots()
        self._places = np.zeros((0, dimension))

    def bring(self, batch: SheetBatch, group: np.ndarray, places: list[np.ndarray]) -> None:
        """Compute the layers of sheets at points of sheets of the same group, as far as they are missing.

        Args:
            batch: All sheets.
            group: Group of each, such as the piece that it belongs to, shape (sheet_count,).
            places: Points of each in whole spans, shape (n, dimension).
        """
        sheets = batch.sheets
        self._slots.keep(set(sheets))
        first = [self._slots.take(sheet, span_count(len(own))) for sheet, own in zip(sheets, places)]
        all_places = np.zeros((self._slots.capacity * SPAN, self.rows.dimension))
        all_places[: len(self._places)] = self._places
        owner = np.full(self._slots.capacity, -1)
        for number, (at, own) in enumerate(zip(first, places)):
            all_places[at * SPAN : at * SPAN + len(own)] = own
            owner[at : at + span_count(len(own))] = number
        self._places = all_places
        self.rows.place(all_places)
        used = np.flatnonzero(owner >= 0)
        wanted = np.zeros((len(sheets), len(owner)), dtype=bool)
        wanted[:, used] = group[:, None] == group[owner[used]]
        self.rows.bring(batch, wanted)

    def first_span(self, sheet: Sheet) -> int:
        """First span of the points of a sheet."""
        return self._slots.first(sheet)
