# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Which two of the triangles around an edge with three or more of them belong together.

Around such an edge solids follow each other: each begins at a triangle that has it ahead and ends at one that has it
behind. What makes the count of the two differ, a fin on a skin or a wall within it, is left out and stays open.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_SAME_ANGLE = 1e-7


@dataclass(frozen=True, eq=False)
class Fans:
    """Half-edges along edges that have three triangles or more, row by row."""

    half_edge: np.ndarray
    """The half-edges, shape (row_count,)."""
    edge: np.ndarray
    """Number of the edge of each, from 0, shape (row_count,)."""
    forward: np.ndarray
    """Whether each runs from the lower to the higher point, shape (row_count,)."""
    low: np.ndarray
    """Position of the lower point, shape (row_count, 3) [m]."""
    high: np.ndarray
    """Position of the higher point, shape (row_count, 3) [m]."""
    apex: np.ndarray
    """Position of the point across the edge, shape (row_count, 3) [m]."""
    patch: np.ndarray
    """Patch of each one's triangle, shape (row_count,)."""

    def pairs(
        self, area: np.ndarray, dangles: np.ndarray, across: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of half-edges that belong together.

        Args:
            area: Area of each patch, of triangles that hang together by edges of two, shape (patch_count,) [m^2].
            dangles: Whether a patch has an open edge, shape (patch_count,).
            across: Whether solids hang together at an edge instead, shape (edge_count,); nowhere by default.
        """
        kept = np.flatnonzero(~self._left_out(area, dangles)[self.patch])
        balance = np.bincount(self.edge[kept], weights=np.where(self.forward[kept], 1.0, -1.0), minlength=self.count)
        kept = kept[balance[self.edge[kept]] == 0.0]
        if not len(kept):
            return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        kept = kept[np.argsort(self.edge[kept], kind="stable")]
        angle = self._angles(kept)
        ends = self.forward[kept] if across is None else self.forward[kept] ^ across[self.edge[kept]]
        starts = np.flatnonzero(np.diff(self.edge[kept], prepend=-1))
        pairs = []
        for rows, *around in zip(*(np.split(values, starts[1:]) for values in (kept, angle, ends)), strict=True):
            pairs += [(rows[i], rows[j]) for i, j in _match_around(*around)]
        one, other = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
        return self.half_edge[one], self.half_edge[other]

    @property
    def count(self) -> int:
        """Number of edges."""
        return int(self.edge.max(initial=-1)) + 1

    def _left_out(self, area: np.ndarray, dangles: np.ndarray) -> np.ndarray:
        """Patches without which as many half-edges run forward as back along each edge, as a mask.

        They are chosen one by one, of those without which the counts differ by less: the smallest that dangles, or else
        the smallest.
        """
        out = np.zeros(len(area), dtype=bool)
        cell, row = np.unique(self.patch * self.count + self.edge, return_inverse=True)
        patch, edge = np.divmod(cell, max(1, self.count))
        share = np.bincount(row.reshape(-1), weights=np.where(self.forward, 1.0, -1.0), minlength=len(cell))
        balance = np.bincount(edge, weights=share, minlength=self.count)
        while True:
            change = np.abs(balance[edge] - share) - np.abs(balance[edge])
            gain = np.bincount(patch, weights=change, minlength=len(area))
            candidates = np.flatnonzero((gain < 0.0) & ~out)
            if not len(candidates):
                return out
            chosen = candidates[np.lexsort((area[candidates], ~dangles[candidates]))[0]]
            out[chosen] = True
            mine = patch == chosen
            balance[edge[mine]] -= share[mine]
            share[mine] = 0.0

    def _angles(self, rows: np.ndarray) -> np.ndarray:
        """Angle of the triangle of each row around its edge, shape (count,)."""
        axis = self.high[rows] - self.low[rows]
        axis /= np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-300)
        least = np.eye(3)[np.abs(axis).argmin(axis=1)]
        across = np.cross(axis, least)
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
        arm = self.apex[rows] - self.low[rows]
        up = np.einsum("ij,ij->i", np.cross(axis, across), arm)
        return np.arctan2(up, np.einsum("ij,ij->i", across, arm))


def _match_around(angle: np.ndarray, ends: np.ndarray) -> list[tuple[int, int]]:
    """Pairs of the triangle at which each solid begins and the one at which it ends, counterclockwise.

    At one angle solids end before others begin, so that those that touch along a face are two.
    """
    order = np.argsort(angle, kind="stable")
    gaps = np.diff(angle[order], append=angle[order[0]] + 2.0 * np.pi)
    order = np.roll(order, -1 - int(gaps.argmax()))
    turn = (angle[order] - angle[order[0]]) % (2.0 * np.pi)
    group = np.cumsum(np.diff(turn, prepend=turn[0]) > _SAME_ANGLE)
    order = order[np.lexsort((~ends[order], group))]
    depth = np.cumsum(np.where(ends[order], -1, 1))
    order = np.roll(order, -1 - int(depth.argmin()))
    begun, pairs = [], []
    for i in order.tolist():
        if ends[i]:
            pairs.append((begun.pop(), i))
        else:
            begun.append(i)
    return pairs
