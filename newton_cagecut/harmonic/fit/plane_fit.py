# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Harmonic coordinates of a polygon in the plane by layers on its edges, slits and holes included."""

from __future__ import annotations

import numpy as np
import warp as wp

from .layers.density_fit import ChargePanels, DensityFit, DipolePanels

_EXTENT = 0.25
"""Half the greatest extent of a polygon in the frame of its fit: single layers in the plane need one well below 1."""
_SAME = 1e-7
"""Distance below which ends coincide, relative to the polygon's extent."""


class PlaneFit:
    """Harmonic coordinates of a polygon.

    Args:
        edges: Ends of the edges, with the inside to the left, shape (edge_count, 2, 2). A slit's edges run there and
            back; they need not end at the same places.
        columns: Which function is 1 at each end, shape (edge_count, 2).
        column_count: Number of functions.
        panels: Panels of an edge.
        device: Where to compute.
    """

    def __init__(
        self, edges: np.ndarray, columns: np.ndarray, column_count: int, device: wp.context.Device, *, panels: int = 16
    ) -> None:
        low, high = edges.min(axis=(0, 1)), edges.max(axis=(0, 1))
        self._center, self._scale = (low + high) / 2.0, 2.0 * _EXTENT / (high - low).max()
        edges = (edges - self._center) * self._scale
        self._edges, self._columns = edges, columns
        part, first, last = _uncovered(edges)
        self._shares = _graded_shares(*_gradings(edges, columns), panels)
        share = self._shares[part]
        share = first[:, None] + (last - first)[:, None] * share
        start, step = edges[part, 0], edges[part, 1] - edges[part, 0]
        place = start[:, None] + share[:, :, None] * step[:, None]
        node = np.arange(share.size).reshape(share.shape)
        charges = ChargePanels(
            np.stack([place[:, :-1], place[:, 1:]], axis=2).reshape(-1, 2, 2),
            np.stack([node[:, :-1], node[:, 1:]], axis=2).reshape(-1, 2),
        )
        owner = np.repeat(part, panels)
        along = edges[owner, 1] - edges[owner, 0]
        offset = charges.test_points - edges[owner, 0][:, None]
        at = (offset * along[:, None]).sum(axis=2) / (along**2).sum(axis=1)[:, None]
        values = np.zeros((*at.shape, column_count))
        row, point = np.indices(at.shape)
        values[row, point, columns[owner, 0][:, None]] = 1.0 - at
        values[row, point, columns[owner, 1][:, None]] = at
        dipoles = DipolePanels(
            edges, 2 * np.arange(len(edges) + 1), columns.reshape(-1), np.tile(np.eye(2), (len(edges), 1))
        )
        self._fit = DensityFit(charges, dipoles, values, device)

    def panels(self) -> tuple[np.ndarray, np.ndarray]:
        """Panels of all edges, slits on both sides.

        Returns:
            Ends of the panels, shape (panel_count, 2, 2), and the edge of each, ascending.
        """
        edges = self._edges / self._scale + self._center
        place = edges[:, :1] + self._shares[:, :, None] * (edges[:, 1:] - edges[:, :1])
        ends = np.stack([place[:, :-1], place[:, 1:]], axis=2)
        return ends.reshape(-1, 2, 2), np.repeat(np.arange(len(edges)), ends.shape[1])

    def values(self, points: np.ndarray) -> np.ndarray:
        """Coordinates of points inside or on an edge, shape (point_count, column_count).

        On a slit a point counts for the edge that comes first.
        """
        points = (points - self._center) * self._scale
        values = self._fit.values(points)
        on_edge, edge, share = nearest_edges(self._edges, points)
        rows, edge, share = np.flatnonzero(on_edge), edge[on_edge], share[on_edge]
        values[rows] = 0.0
        values[rows, self._columns[edge, 0]] = 1.0 - share
        values[rows, self._columns[edge, 1]] += share
        return values

    def gradients(self, points: np.ndarray) -> np.ndarray:
        """Their gradients, shape (point_count, column_count, 2)."""
        return self._fit.gradients((points - self._center) * self._scale) * self._scale


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
