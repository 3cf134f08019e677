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
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..geometry import PolygonMesh
from .fans import Fans
from .orientation import find_turned


@dataclass(frozen=True, eq=False)
class Sheets:
    """What makes triangles sheets."""

    turned: np.ndarray
    """Triangles that run the other way than most around them, as a mask, shape (triangle_count,)."""
    fan: np.ndarray
    """Number of the fan around its point that each corner is of, shape (triangle_count, 3)."""
    branches: np.ndarray
    """Edges that three triangles or more had, as pairs of points, shape (branch_count, 2)."""


def is_manifold(mesh: PolygonMesh) -> bool:
    """Whether no edge has more than two triangles, and none two that run along it alike."""
    _, size = np.unique(mesh.edge_key, return_counts=True)
    return bool(size.max(initial=0) <= 2) and int(np.count_nonzero(size == 2)) * 2 == np.count_nonzero(mesh.twin >= 0)


def repeated(triangles: np.ndarray) -> np.ndarray:
    """Triangles that are there before, around the same points in the same direction, as a mask."""
    first = triangles.argmin(axis=1)
    around = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    again = np.ones(len(triangles), dtype=bool)
    again[np.unique(around, axis=0, return_index=True)[1]] = False
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
        """Put them together."""
        one, other = np.concatenate([self._whole_pairs, self._fan_pairs], axis=1)
        corners = 3 * self.mesh.face_count
        low, high = self._corners
        start, end = np.concatenate([low[one], high[one]]), np.concatenate([low[other], high[other]])
        graph = coo_array((np.ones(len(start), dtype=bool), (start, end)), shape=(corners, corners))
        fan = connected_components(graph, directed=False)[1].reshape(-1, 3)
        key = self.key[np.unique(self.number[self.size > 2])]
        return Sheets(self.turned, fan, np.stack(np.divmod(key, self.mesh.vertex_count), axis=1))

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

    @property
    def _fan_pairs(self) -> np.ndarray:
        """Half-edges that belong together of edges of more triangles, shape (2, pair_count)."""
        mesh = self.mesh
        rows = np.flatnonzero(self.size > 2)
        if not len(rows):
            return np.zeros((2, 0), dtype=np.int64)
        one, other = mesh.face[self._whole_pairs]
        graph = coo_array((np.ones(len(one), dtype=bool), (one, other)), shape=(mesh.face_count, mesh.face_count))
        count, patch = connected_components(graph, directed=False)
        dangles = np.zeros(count, dtype=bool)
        dangles[patch[mesh.face[self.size == 1]]] = True
        area = np.bincount(patch, weights=np.linalg.norm(mesh.face_area_vector, axis=1), minlength=count)
        low, high = self._corners
        fans = Fans(
            half_edge=rows,
            edge=np.unique(self.number[rows], return_inverse=True)[1].reshape(-1),
            forward=self.forward[rows],
            low=mesh.vertices[mesh.face_vertex[low[rows]]],
            high=mesh.vertices[mesh.face_vertex[high[rows]]],
            apex=mesh.vertices[mesh.face_vertex[mesh.next[mesh.next[rows]]]],
            patch=patch[mesh.face[rows]],
        )
        return np.stack(fans.pairs(area, dangles))

    @cached_property
    def _corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners of each half-edge's triangle at its lower and at its higher point, shapes (half_edge_count,)."""
        here, there = np.arange(len(self.number)), self.mesh.next
        ascending = self.mesh.face_vertex < self.mesh.destination
        return np.where(ascending, here, there), np.where(ascending, there, here)
