# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Any triangles as sheets: manifolds, closed or open, of one orientation, which only touch each other.

The paper's cuts (section 6.3) need to know which triangles stay together. At an edge of two triangles those do; at one
of more, pairs of them by their angles. Corners at a point that no such pair connects are of different sheets.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...geometry import PolygonMesh
from .fans import Fans
from .orientation import connected_parts, find_turned


@dataclass(frozen=True, eq=False)
class Sheets:
    """What makes triangles sheets."""

    turned: np.ndarray
    """Triangles that run the other way than most around them, as a mask, shape (triangle_count,)."""
    fan: np.ndarray
    """Number of the fan around its point that each corner is of, shape (triangle_count, 3)."""
    branches: np.ndarray
    """Edges that three triangles or more had, as pairs of points, shape (branch_count, 2)."""


def repeated(triangles: np.ndarray) -> np.ndarray:
    """Triangles that are there before, around the same points in the same direction, as a mask."""
    first = triangles.argmin(axis=1)
    around = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    order = np.lexsort(around.T)
    again = np.zeros(len(triangles), dtype=bool)
    again[order[1:]] = (around[order[1:]] == around[order[:-1]]).all(axis=1)
    return again


def find_sheets(mesh: PolygonMesh) -> Sheets:
    """Tell the sheets of triangles.

    Args:
        mesh: The triangles, in space.
    """
    return _Finder(mesh).sheets()


class _Finder:
    """The edges of triangles, sorted by how many triangles they have."""

    def __init__(self, mesh: PolygonMesh):
        self.mesh = mesh
        self.key, number, size = np.unique(mesh.edge_key, return_inverse=True, return_counts=True)
        self.number = number.reshape(-1)
        self.size = size[self.number]
        """Number of triangles along each half-edge, shape (half_edge_count,)."""
        two = np.flatnonzero(self.size == 2)
        self.one, self.other = two[np.argsort(self.number[two], kind="stable")].reshape(-1, 2).T

    def sheets(self) -> Sheets:
        """Put them together.

        Solids that touch along an edge are two there, unless they hang together around both of its ends.
        """
        if self._fans is None:
            fan = self._fan_of_corners(self._whole_pairs)
        else:
            fan, pairs = self._with_fans(None)
            again = self._meets_itself(fan, pairs)
            if again.any():
                fan, _ = self._with_fans(again)
        key = self.key[np.unique(self.number[self.size > 2])]
        return Sheets(self.turned, fan.reshape(-1, 3), np.stack(np.divmod(key, self.mesh.vertex_count), axis=1))

    def _with_fans(self, across: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """Number of the fan of each corner, and the pairs of edges of more than two triangles, shape (2, count)."""
        pairs = np.stack(self._fans.pairs(*self._patches, across))
        return self._fan_of_corners(np.concatenate([self._whole_pairs, pairs], axis=1)), pairs

    def _fan_of_corners(self, pairs: np.ndarray) -> np.ndarray:
        """Number of the fan of each corner, shape (half_edge_count,)."""
        (one, other), (low, high) = pairs, self._corners
        return connected_parts(
            len(low), np.concatenate([low[one], high[one]]), np.concatenate([low[other], high[other]])
        )

    def _meets_itself(self, fan: np.ndarray, pairs: np.ndarray) -> np.ndarray:
        """Whether several pairs of an edge have both ends in common, shape (edge_count,)."""
        low, high = (fan[corner[pairs[0]]] for corner in self._corners)
        edge = self._fans.edge[np.searchsorted(self._fans.half_edge, pairs[0])]
        cells, count = np.unique(np.stack([edge, low, high]), axis=1, return_counts=True)
        again = np.zeros(self._fans.count, dtype=bool)
        again[cells[0, count > 1]] = True
        return again

    @cached_property
    def turned(self) -> np.ndarray:
        """Triangles to turn, as a mask."""
        start, face = self.mesh.face_vertex, self.mesh.face
        alike = start[self.one] == start[self.other]
        return find_turned(self.mesh.face_count, face[self.one], face[self.other], alike)

    @cached_property
    def forward(self) -> np.ndarray:
        """Whether each half-edge runs from the lower to the higher point once triangles are turned."""
        return (self.mesh.face_vertex < self.mesh.destination) ^ self.turned[self.mesh.face]

    @cached_property
    def _whole_pairs(self) -> np.ndarray:
        """Half-edges of edges of two triangles that run in opposite directions, shape (2, pair_count)."""
        opposite = self.forward[self.one] != self.forward[self.other]
        return np.stack([self.one[opposite], self.other[opposite]])

    @cached_property
    def _patch(self) -> np.ndarray:
        """Patch of each triangle, of those that hang together by edges of two, shape (triangle_count,)."""
        return connected_parts(self.mesh.face_count, *self.mesh.face[self._whole_pairs])

    @cached_property
    def _patches(self) -> tuple[np.ndarray, np.ndarray]:
        """Area of each patch, and whether it has an open edge, shapes (patch_count,)."""
        area = np.bincount(self._patch, weights=np.linalg.norm(self.mesh.face_area_vector, axis=1))
        dangles = np.zeros(len(area), dtype=bool)
        dangles[self._patch[self.mesh.face[self.size == 1]]] = True
        return area, dangles

    @cached_property
    def _fans(self) -> Fans | None:
        """Edges of three triangles or more; None without any."""
        mesh, (low, high) = self.mesh, self._corners
        rows = np.flatnonzero(self.size > 2)
        if not len(rows):
            return None
        return Fans(
            half_edge=rows,
            edge=np.unique(self.number[rows], return_inverse=True)[1].reshape(-1),
            forward=self.forward[rows],
            low=mesh.vertices[mesh.face_vertex[low[rows]]],
            high=mesh.vertices[mesh.face_vertex[high[rows]]],
            apex=mesh.vertices[mesh.face_vertex[mesh.next[mesh.next[rows]]]],
            patch=self._patch[mesh.face[rows]],
        )

    @cached_property
    def _corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners of each half-edge's triangle at its lower and at its higher point, shapes (half_edge_count,)."""
        here, there = np.arange(len(self.number)), self.mesh.next
        ascending = self.mesh.face_vertex < self.mesh.destination
        return np.where(ascending, here, there), np.where(ascending, there, here)
