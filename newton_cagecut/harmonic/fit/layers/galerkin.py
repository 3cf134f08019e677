# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Integrals of the layers of sheets with hat functions on sheets: the matrix of Galerkin's method, kept between fits.

The layers are computed at test points inside the panels, a little below them, and summed with weights.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from ...launch import launch
from .products import LANE, WIDTH
from .sheets import Sheet, SheetBatch
from .sites import SheetSites
from .slots import Slots
from .solve import System
from .spans import SPAN, Span

wp.set_module_options({"enable_backward": False, "max_unroll": 0})


@wp.struct
class TestItems:
    """Test points of nodes.

    The items of node i are ``start[i]`` to ``start[i + 1]``, each a span, a place in it and a weight.
    """

    start: wp.array[wp.int32]
    span: wp.array[wp.int32]
    place: wp.array[wp.int32]
    weight: wp.array[wp.float64]


@wp.kernel(enable_backward=False)
def _integrate(
    offset: int,
    jobs: wp.array[wp.vec4i],
    items: TestItems,
    layers: wp.array2d[Span],
    out: wp.array2d[wp.float64],
):
    """Sum layers with weights. A job is a node among the items, its row, and the first column and the end."""
    job = jobs[offset + wp.tid()]
    for column in range(job[2], job[3]):
        total = wp.float64(0.0)
        for item in range(items.start[job[0]], items.start[job[0] + 1]):
            total += items.weight[item] * wp.float64(layers[items.span[item], column][items.place[item]])
        out[job[1], column] = total


@wp.kernel(enable_backward=False)
def _gather(
    offset: int,
    rows: wp.array[wp.int32],
    columns: wp.array[wp.int32],
    integrals: wp.array2d[wp.float64],
    first_row: int,
    first_lane: int,
    lanes: int,
    out: wp.array2d[LANE],
):
    """Fill lanes of a system from rows and columns of the integrals."""
    t = offset + wp.tid()
    i = first_row + t // lanes
    lane = first_lane + t % lanes
    values = LANE()
    for c in range(WIDTH):
        column = lane * WIDTH + c
        if column < columns.shape[0]:
            values[c] = integrals[rows[i], columns[column]]
    out[i, lane] = values


@wp.kernel(enable_backward=False)
def _gather_known(
    offset: int,
    rows: wp.array[wp.int32],
    start: wp.array[wp.int32],
    columns: wp.array[wp.int32],
    integrals: wp.array2d[wp.float64],
    values: wp.array2d[wp.float64],
    first_lane: int,
    out: wp.array2d[LANE],
):
    """Fill the right-hand sides: integrals of the values and of their double layers."""
    t = offset + wp.tid()
    i = t // (out.shape[1] - first_lane)
    lane = t % (out.shape[1] - first_lane)
    total = LANE()
    for c in range(WIDTH):
        function = lane * WIDTH + c
        if function < values.shape[1]:
            own = values[i, function]
            for item in range(start[function], start[function + 1]):
                own += integrals[rows[i], columns[item]]
            total[c] = own
    out[i, first_lane + lane] = total


def items_of(sheets: list[Sheet], first_spans: list[int], device: wp.context.Device) -> TestItems:
    """Test points of the nodes of sheets, one sheet after the other.

    Args:
        sheets: The sheets.
        first_spans: The first span of the test points of each.
        device: Where to put them.
    """
    tests = [sheet.test for sheet in sheets]
    length = [len(row) for _, row, _ in tests]
    row = np.concatenate([row for _, row, _ in tests])
    start = [own[:-1] + first for (own, *_), first in zip(tests, np.cumsum([0, *length]))]
    items = TestItems()
    items.start = _ints(np.append(np.concatenate(start), len(row)), device)
    items.span, items.place = _ints(np.repeat(first_spans, length) + row // SPAN, device), _ints(row % SPAN, device)
    items.weight = wp.array(np.concatenate([weight for *_, weight in tests]), dtype=wp.float64, device=device)
    return items


def integrate(jobs: np.ndarray, items: TestItems, layers: wp.array, out: wp.array) -> None:
    """Sum layers at test points with weights.

    Args:
        jobs: For each a node among the items, its row of the integrals, and the first and the end of the columns,
            shape (job_count, 4).
        items: The test points.
        layers: Layers at spans of these points.
        out: The integrals, where the columns of a job are written.
    """
    inputs = [wp.array(jobs.astype(np.int32), dtype=wp.vec4i, device=out.device), items, layers, out]
    launch(_integrate, len(jobs), inputs, device=out.device, smallest_chunk=64)


class Galerkin:
    """Integrals between sheets.

    Args:
        dimension: Dimension of the space.
        device: Where to put them.
    """

    def __init__(self, dimension: int, device: wp.context.Device) -> None:
        self.device = device
        self._sites = SheetSites(dimension, device)
        self._slots = Slots()
        self._integrals = wp.zeros((0, 0), dtype=wp.float64, device=device)
        self._sheets: list[Sheet] = []
        self._done = np.zeros((0, 0), dtype=bool)

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return 8 * self._integrals.size + self._sites.rows.byte_count

    def bring(self, batch: SheetBatch, group: np.ndarray) -> None:
        """Compute the integrals between sheets of the same group, as far as they are missing.

        Args:
            batch: All sheets.
            group: Group of each, shape (sheet_count,).
        """
        sheets = batch.sheets
        self._sites.bring(batch, group, [sheet.test_places for sheet in sheets])
        self._slots.keep(set(sheets))
        for sheet in sheets:
            self._slots.take(sheet, sheet.node_count)
        shape = self._slots.capacity, self._sites.rows.matrix.shape[1]
        if shape[0] > self._integrals.shape[0] or shape[1] > self._integrals.shape[1]:
            self._grow(shape)
        before = {sheet: number for number, sheet in enumerate(self._sheets)}
        old = np.array([before.get(sheet, -1) for sheet in sheets])
        done = np.zeros((len(sheets), len(sheets)), dtype=bool)
        kept = np.flatnonzero(old >= 0)
        done[np.ix_(kept, kept)] = self._done[np.ix_(old[kept], old[kept])]
        wanted = group[:, None] == group
        self._integrate(sheets, np.argwhere(wanted & ~done))
        self._sheets, self._done = sheets, done | wanted

    def fill(self, sheets: list[Sheet], system: System, columns: list[np.ndarray], *, known: int) -> None:
        """Set up the equations of some sheets.

        Args:
            sheets: The sheets, in order.
            system: Where to; its right-hand sides are functions.
            columns: The function that each function of a sheet is.
            known: Rows and columns that are there already and stay as they are, whole blocks of them.
        """
        rows = np.concatenate([self._slots.first(sheet) + np.arange(sheet.node_count) for sheet in sheets])
        layers = self._sites.rows.columns(sheets)
        ends = np.cumsum([sheet.column_count for sheet in sheets])
        charged = np.concatenate(
            [end - sheet.column_count + np.arange(sheet.node_count) for end, sheet in zip(ends, sheets)]
        )
        dipoles = np.setdiff1d(np.arange(len(layers)), charged)
        function = np.concatenate(columns)
        order = np.argsort(function, kind="stable")
        start = np.searchsorted(function[order], np.arange(system.column_count + 1))
        values = np.zeros((len(rows), system.column_count))
        first = 0
        for sheet, own in zip(sheets, columns):
            at = np.arange(first, first + sheet.node_count)
            np.add.at(values, (at[:, None], own), sheet.tested_values)
            first += sheet.node_count
        at = _ints(rows, self.device)
        inputs = [at, _ints(layers[charged], self.device), self._integrals]
        matrix, lanes, known_lanes = system.matrix, system.first_lane, known // WIDTH
        beside = lanes - known_lanes
        right = [known, 0, lanes, matrix]
        launch(_gather, (len(rows) - known) * lanes, [*inputs, *right], device=self.device, smallest_chunk=256)
        right = [0, known_lanes, beside, matrix]
        launch(_gather, known * beside, [*inputs, *right], device=self.device, smallest_chunk=256)
        inputs = [at, _ints(start, self.device), _ints(layers[dipoles][order], self.device), self._integrals]
        inputs += [wp.array(values, dtype=wp.float64, device=self.device), lanes, matrix]
        launch(_gather_known, len(rows) * (matrix.shape[1] - lanes), inputs, device=self.device, smallest_chunk=64)

    def _integrate(self, sheets: list[Sheet], pairs: np.ndarray) -> None:
        """Sum up what the layers at test points come to for pairs of sheets."""
        nodes = np.array([sheet.node_count for sheet in sheets])
        pairs = pairs[nodes[pairs[:, 0]] > 0]
        if not len(pairs):
            return
        tested = np.unique(pairs[:, 0]).tolist()
        first_node = np.zeros(len(sheets), dtype=np.int64)
        first_node[tested] = np.cumsum([0, *nodes[tested][:-1]])
        first_spans = [self._sites.first_span(sheets[number]) for number in tested]
        items = items_of([sheets[number] for number in tested], first_spans, self.device)
        test, layer = np.repeat(pairs, nodes[pairs[:, 0]], axis=0).T
        count = nodes[pairs[:, 0]]
        within = np.arange(len(test)) - np.repeat(np.cumsum(count) - count, count)
        slots = np.array([self._slots.first(sheet) for sheet in sheets])
        column = np.array(self._sites.rows.first_columns(sheets))[layer]
        end = column + np.array([sheet.column_count for sheet in sheets])[layer]
        jobs = np.stack([first_node[test] + within, slots[test] + within, column, end], axis=1)
        integrate(jobs, items, self._sites.rows.matrix, self._integrals)

    def _grow(self, shape: tuple[int, int]) -> None:
        shape = tuple(max(new, old) for new, old in zip(shape, self._integrals.shape))
        integrals = wp.empty(shape, dtype=wp.float64, device=self.device)
        if self._integrals.size:
            wp.copy(integrals[: self._integrals.shape[0], : self._integrals.shape[1]], self._integrals)
        self._integrals = integrals


def _ints(numbers: np.ndarray, device: wp.context.Device) -> wp.array:
    return wp.array(np.ascontiguousarray(numbers, dtype=np.int32), dtype=wp.int32, device=device)
