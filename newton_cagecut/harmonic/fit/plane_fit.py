# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Harmonic coordinates of a polygon in the plane by layers on its edges, slits and holes included."""

from __future__ import annotations

import numpy as np
import warp as wp

from .layers.density_fit import DensityFit
from .layers.elimination import solve_each
from .layers.galerkin import Galerkin, integrate, items_of
from .layers.products import multiply_spans
from .layers.sheet_rows import own_layers
from .layers.sheets import Sheet, SheetBatch, test_points_of
from .layers.spans import SPAN, in_spans

_EXTENT = 0.25
"""Half the greatest extent of a polygon in the frame of its fit: single layers in the plane need one well below 1."""
_SAME = 1e-7
"""Distance below which ends coincide, relative to the polygon's extent."""


class Outline:
    """Edges of a polygon with functions on them that are linear on each, in a frame of its own.

    Args:
        edges: Ends of the edges, with the inside to the left, shape (edge_count, 2, 2). A slit's edges run there and
            back; they need not end at the same places.
        columns: Which function is 1 at each end, shape (edge_count, 2).
        panels: Panels of an edge.
    """

    def __init__(self, edges: np.ndarray, columns: np.ndarray, *, panels: int = 16) -> None:
        low, high = edges.min(axis=(0, 1)), edges.max(axis=(0, 1))
        self._center, self.scale = (low + high) / 2.0, 2.0 * _EXTENT / (high - low).max()
        self.edges, self.columns, self._panels = self.to_frame(edges), columns, panels
        self._shares = _graded_shares(*_gradings(self.edges, columns), panels)

    def to_frame(self, points: np.ndarray) -> np.ndarray:
        """Points in the outline's frame, shape (..., 2)."""
        return (points - self._center) * self.scale

    def panels(self) -> tuple[np.ndarray, np.ndarray]:
        """Panels of all edges, slits on both sides.

        Returns:
            Ends of the panels, shape (panel_count, 2, 2), and the edge of each, ascending.
        """
        edges = self.edges / self.scale + self._center
        place = edges[:, :1] + self._shares[:, :, None] * (edges[:, 1:] - edges[:, :1])
        ends = np.stack([place[:, :-1], place[:, 1:]], axis=2)
        return ends.reshape(-1, 2, 2), np.repeat(np.arange(len(edges)), ends.shape[1])

    def sheets(self) -> tuple[list[Sheet], list[np.ndarray]]:
        """A sheet an edge, with the functions of each of its ends."""
        corners, nodes, values, owner = self._charges()
        sheets = []
        for edge, ends in enumerate(self.edges):
            own = owner == edge
            _, number = np.unique(nodes[own], return_inverse=True)
            sheets.append(Sheet(corners[own], number.reshape(-1, 2), ends[None], np.eye(2)[None], values[own]))
        return sheets, list(self.columns)

    def sheet(self) -> Sheet:
        """One sheet with all functions."""
        corners, nodes, values, owner = self._charges()
        functions = int(self.columns.max()) + 1
        density, found = np.zeros((len(self.edges), 2, functions)), np.zeros((*values.shape[:2], functions))
        for end in range(2):
            density[np.arange(len(self.edges)), end, self.columns[:, end]] = 1.0
            row, point = np.indices(values.shape[:2])
            found[row, point, self.columns[owner, end][:, None]] = values[:, :, end]
        return Sheet(corners, nodes, self.edges, density, found)

    def put_on_edges(self, points: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Values, with those of points on edges as they are there; on a slit those of the edge that comes first.

        Args:
            points: Points in the outline's frame, shape (n, 2).
            values: What the functions are inside, shape (n, function_count); overwritten.
        """
        on_edge, edge, share = nearest_edges(self.edges, points)
        rows, edge, share = np.flatnonzero(on_edge), edge[on_edge], share[on_edge]
        values[rows] = 0.0
        values[rows, self.columns[edge, 0]] = 1.0 - share
        values[rows, self.columns[edge, 1]] += share
        return values

    def _charges(self) -> tuple[np.ndarray, ...]:
        """Ends and nodes of the panels with charges, functions of both ends at test points, and the edge of each."""
        edges = self.edges
        part, first, last = _uncovered(edges)
        share = first[:, None] + (last - first)[:, None] * self._shares[part]
        start, step = edges[part, 0], edges[part, 1] - edges[part, 0]
        place = start[:, None] + share[:, :, None] * step[:, None]
        node = np.arange(share.size).reshape(share.shape)
        corners = np.stack([place[:, :-1], place[:, 1:]], axis=2).reshape(-1, 2, 2)
        nodes = np.stack([node[:, :-1], node[:, 1:]], axis=2).reshape(-1, 2)
        owner = np.repeat(part, self._panels)
        along = edges[owner, 1] - edges[owner, 0]
        offset = test_points_of(corners) - edges[owner, 0][:, None]
        at = (offset * along[:, None]).sum(axis=2) / (along**2).sum(axis=1)[:, None]
        return corners, nodes, np.stack([1.0 - at, at], axis=2), owner


class PlaneFit:
    """Harmonic coordinates of a polygon.

    Args:
        edges: See ``Outline``.
        columns: See ``Outline``.
        column_count: Number of functions.
        device: Where to compute.
        panels: Panels of an edge.
    """

    def __init__(
        self, edges: np.ndarray, columns: np.ndarray, column_count: int, device: wp.context.Device, *, panels: int = 16
    ) -> None:
        self.outline = Outline(edges, columns, panels=panels)
        sheets, functions = self.outline.sheets()
        self._batch, galerkin = SheetBatch(sheets, device), Galerkin(2, device)
        galerkin.bring(self._batch, np.zeros(len(sheets), dtype=np.int64))
        self._fit = DensityFit(sheets, functions, column_count, galerkin)

    def values(self, points: np.ndarray) -> np.ndarray:
        """Coordinates of points inside or on an edge, shape (point_count, column_count).

        On a slit a point counts for the edge that comes first.
        """
        return self.outline.put_on_edges(self.outline.to_frame(points), self.inside(points))

    def inside(self, points: np.ndarray) -> np.ndarray:
        """Coordinates of points inside, however near to an edge, shape (point_count, column_count)."""
        return self._fit.at(self.outline.to_frame(points), self._batch)

    def gradients(self, points: np.ndarray) -> np.ndarray:
        """Their gradients, shape (point_count, column_count, 2)."""
        return self._fit.at(self.outline.to_frame(points), self._batch, slopes=True) * self.outline.scale


class OutlineFits:
    """The functions of many outlines, each inside of its own.

    Args:
        outlines: The outlines, at least one.
        device: Where to compute.
    """

    def __init__(self, outlines: list[Outline], device: wp.context.Device) -> None:
        self._outlines = outlines
        sheets = [outline.sheet() for outline in outlines]
        self._batch = SheetBatch(sheets, device)
        layers, first = own_layers(self._batch, [sheet.test_places for sheet in sheets])
        nodes = np.array([sheet.node_count for sheet in sheets])
        number = np.arange(nodes.sum())
        end = np.repeat([sheet.column_count for sheet in sheets], nodes)
        integrals = wp.empty((len(number), layers.shape[1]), dtype=wp.float64, device=device)
        jobs = np.stack([number, number, np.zeros_like(end), end], axis=1)
        integrate(jobs, items_of(sheets, first[:-1].tolist(), device), layers, integrals)
        rows = np.split(integrals.numpy(), np.cumsum(nodes)[:-1])
        matrices = [row[:, : sheet.node_count] for row, sheet in zip(rows, sheets)]
        known = [
            sheet.tested_values + row[:, sheet.node_count : sheet.column_count] for row, sheet in zip(rows, sheets)
        ]
        densities = solve_each(matrices, known, device)
        right = np.zeros((sum(sheet.column_count for sheet in sheets), max(sheet.function_count for sheet in sheets)))
        self._first = np.cumsum([0, *(sheet.column_count for sheet in sheets)])
        for at, density, sheet in zip(self._first, densities, sheets):
            right[at : at + sheet.node_count, : sheet.function_count] = density
            own = np.arange(sheet.function_count)
            right[at + sheet.node_count + own, own] = -1.0
        self._right = right

    def values(self, numbers: list[int], points: list[np.ndarray]) -> list[np.ndarray]:
        """The functions of outlines at points inside or on an edge.

        Args:
            numbers: The outlines.
            points: Points of each, shape (n, 2) each, n above 0.

        Returns:
            Values, shape (n, function_count) each.
        """
        outlines = [self._outlines[number] for number in numbers]
        sheets = [self._batch.sheets[number] for number in numbers]
        points = [outline.to_frame(own) for outline, own in zip(outlines, points)]
        layers, spans = own_layers(self._batch.chosen(numbers), [in_spans(own) for own in points])
        count = np.diff(spans)
        length = [sheet.column_count for sheet in sheets]
        # Layers of every outline start at column 0.
        columns = np.concatenate([np.arange(own) for own in length])
        right = np.concatenate([self._right[self._first[number] : self._first[number + 1]] for number in numbers])
        end = np.cumsum(length)
        jobs = np.stack([np.arange(spans[-1]), np.repeat(end - length, count), np.repeat(end, count)], axis=1)
        found = np.split(multiply_spans(jobs, layers, columns, right).astype(np.float64), SPAN * spans[1:-1])
        return [
            outline.put_on_edges(own, rows[: len(own), : sheet.function_count])
            for outline, own, rows, sheet in zip(outlines, points, found, sheets)
        ]


def polygon_edges(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Edges and columns of a polygon of one loop, as ``PlaneFit`` takes them.

    Args:
        corners: Corners, counterclockwise, shape (corner_count, 2).
    """
    after = np.roll(np.arange(len(corners)), -1)
    return np.stack([corners, corners[after]], axis=1), np.stack([np.arange(len(corners)), after], axis=1)


def nearest_edges(edges: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which points lie on edges, but for rounding, the nearest edge of each, and the share of it where that is.

    Args:
        edges: Ends of edges, shape (edge_count, 2, 2).
        points: Points, shape (point_count, 2).
    """
    along = edges[:, 1] - edges[:, 0]
    offset = points[:, None] - edges[:, 0]
    share = np.clip((offset * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
    squared = ((offset - share[:, :, None] * along) ** 2).sum(axis=2)
    edge = squared.argmin(axis=1)
    rows = np.arange(len(points))
    return squared[rows, edge] < (_SAME * np.ptp(edges, axis=(0, 1)).max()) ** 2, edge, share[rows, edge]


def _uncovered(edges: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parts of edges, of each slit those of one side: edge, and the shares of it where a part starts and ends."""
    along = edges[:, 1] - edges[:, 0]
    squared = (along**2).sum(axis=1)
    offset = edges[None] - edges[:, None, :1]  # of every edge's ends from an edge's start
    place = (offset * along[:, None, None]).sum(axis=3) / squared[:, None, None]
    across = offset[..., 0] * along[:, None, None, 1] - offset[..., 1] * along[:, None, None, 0]
    on_line = (np.abs(across) < _SAME * np.sqrt(squared)[:, None, None]).all(axis=2)
    back = on_line & (place[..., 1] < place[..., 0])
    parts = []
    margin = _SAME / np.sqrt(squared)
    for e in range(len(edges)):
        # Sides of a slit are told by the order of the edges: a later one gives way where it runs back along another.
        holes = [(place[e, f, 1], place[e, f, 0]) for f in range(e) if back[e, f]]
        first = 0.0
        for low, high in sorted(holes):
            if low > first + margin[e] and first < 1.0 - margin[e]:
                parts.append((e, first, min(low, 1.0)))
            first = max(first, high)
        if first < 1.0 - margin[e]:
            parts.append((e, first, 1.0))
    edge, first, last = (np.array(column) for column in zip(*parts))
    return edge.astype(np.int64), first, last


def _gradings(edges: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Powers with which panels shrink towards the start and the end of each edge, by the angles there, shape (2, n).

    A corner of the angle a has a density like the distance to the power pi / a - 1.
    """
    along = edges[:, 1] - edges[:, 0]
    angle = np.full((2, len(edges)), np.pi)
    after = columns[:, 1][:, None] == columns[:, 0][None]
    for e, f in zip(*np.nonzero(after)):
        cross = along[e, 0] * along[f, 1] - along[e, 1] * along[f, 0]
        turn = np.arctan2(cross, (along[e] * along[f]).sum())
        inner = np.pi - turn if abs(abs(turn) - np.pi) > 1e-6 else 2.0 * np.pi
        angle[1, e] = angle[0, f] = inner
    return np.clip(2.5 * angle / np.pi, 2.0, 5.0)


def _graded_shares(start: np.ndarray, end: np.ndarray, panels: int) -> np.ndarray:
    """Shares of an edge at which its panels end, shape (edge_count, panels + 1)."""
    even = np.linspace(0.0, 1.0, panels + 1)
    rise, fall = even ** start[:, None], (1.0 - even) ** end[:, None]
    return rise / (rise + fall)
