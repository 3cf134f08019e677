# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Coarsens a closed triangle mesh so that every step contains the one before.

Progressive hulls (Sander, Gu, Gortler, Hoppe, Snyder, "Silhouette clipping", 2000): an edge collapses to the point
that is outside the planes of all triangles around it and adds the least volume, a linear program in three unknowns.
"""

from __future__ import annotations

import heapq
from itertools import combinations

import numpy as np

_SLACK = 1e-9  # of the mesh's size: how far inside a plane a solution may be
_SHAPE = 0.1  # weight of the edge lengths in the cost, against needles


class ProgressiveHull:
    """A mesh that coarsens edge by edge and never loses volume.

    Args:
        points: Vertices, shape ``(n, 3)``.
        triangles: Outward triangles of a closed mesh, shape ``(m, 3)``.
        reach: How far a new vertex may lie from the middle of its edge, in lengths of the mesh's bounding box.
    """

    def __init__(self, points: np.ndarray, triangles: np.ndarray, *, reach: float = 0.1):
        self.points = [np.array(point) for point in points]
        self.triangles = {i: tuple(int(v) for v in triangle) for i, triangle in enumerate(triangles)}
        self.size = float(np.linalg.norm(np.ptp(points, axis=0)))
        self.reach = reach * self.size
        self.around: dict[int, set[int]] = {v: set() for v in range(len(points))}
        for i, triangle in self.triangles.items():
            for v in triangle:
                self.around[v].add(i)
        self.version = dict.fromkeys(self.around, 0)
        self.queued: dict[tuple[int, int], tuple[int, int]] = {}
        self.queue: list[tuple[float, int, int, int, int, tuple[float, ...]]] = []
        for a, b in sorted({(min(e), max(e)) for t in self.triangles.values() for e in _edges(t)}):
            self._push(a, b)

    def coarsen(self, face_count: int) -> tuple[np.ndarray, list[tuple[int, ...]]]:
        """Collapse edges until ``face_count`` triangles are left, and return vertices and faces."""
        while len(self.triangles) > face_count and self.queue:
            _, a, b, version_a, version_b, place = heapq.heappop(self.queue)
            if b not in self._neighbours(a):
                continue
            if (self.version[a], self.version[b]) == (version_a, version_b):
                self._collapse(a, b, np.array(place))
            elif self.queued[a, b] == (version_a, version_b):
                self._push(a, b)  # its surroundings have changed since
        used = sorted(self.around)
        rank = {v: i for i, v in enumerate(used)}
        faces = [tuple(rank[v] for v in self.triangles[i]) for i in sorted(self.triangles)]
        return np.array([self.points[v] for v in used]), faces

    def _neighbours(self, vertex: int) -> set[int]:
        """Return the vertices that share an edge with ``vertex``; none where it is gone."""
        return {v for i in self.around.get(vertex, ()) for v in self.triangles[i]} - {vertex}

    def _push(self, a: int, b: int) -> None:
        """Queue the collapse of an edge where there is a place for it."""
        self.queued[a, b] = (self.version[a], self.version[b])
        if len(self._neighbours(a) & self._neighbours(b)) != 2:
            return
        best = self._best_place(a, b)
        if best is not None:
            cost, place = best
            entry = (cost, a, b, self.version[a], self.version[b], tuple(place))
            heapq.heappush(self.queue, entry)

    def _best_place(self, a: int, b: int) -> tuple[float, np.ndarray] | None:
        """Return the cost and the place of the vertex that an edge collapses to."""
        touched = sorted(self.around[a] | self.around[b])
        corners = np.array([[self.points[v] for v in self.triangles[i]] for i in touched])
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        middle = 0.5 * (self.points[a] + self.points[b])
        offsets = np.einsum("ij,ij->i", normals, corners[:, 0] - middle)
        rim = [self._rim_edge(i, a, b) for i in touched if not {a, b} <= set(self.triangles[i])]
        ends = np.array([[self.points[u], self.points[v]] for u, v in rim]) - middle
        growth = np.cross(ends[:, 0], ends[:, 1]).sum(axis=0) / 6.0
        place = _least(growth, normals, offsets, _SLACK * self.size)
        if place is None or np.linalg.norm(place) > self.reach or _flips(ends, place, normals):
            return None
        lengths = np.linalg.norm(ends[:, 0] - place, axis=1)
        before = np.linalg.det(corners - middle).sum() / 6.0
        return float(growth @ place - before + _SHAPE * (lengths**3).mean()), place + middle

    def _rim_edge(self, triangle: int, a: int, b: int) -> tuple[int, int]:
        """Return the edge of a triangle opposite to the one of ``a`` and ``b`` that it holds."""
        return next((u, v) for u, v in _edges(self.triangles[triangle]) if not {u, v} & {a, b})

    def _collapse(self, a: int, b: int, place: np.ndarray) -> None:
        """Collapse edge ``a b`` into ``a`` at ``place``."""
        for i in self.around[a] & self.around[b]:
            for v in self.triangles[i]:
                if v not in (a, b):
                    self.around[v].discard(i)
            del self.triangles[i]
        both = self.around.pop(b) ^ self.around[a]
        self.around[a] = {i for i in both if i in self.triangles}
        for i in self.around[a]:
            self.triangles[i] = tuple(a if v == b else v for v in self.triangles[i])
        self.points[a] = place
        ring = self._neighbours(a)
        for v in sorted(ring | {a}):
            self.version[v] += 1
        for u, v in sorted({(min(e), max(e)) for i in self.around[a] for e in _edges(self.triangles[i])}):
            self._push(u, v)


def _edges(triangle: tuple[int, int, int]) -> tuple[tuple[int, int], ...]:
    """Return the three directed edges of a triangle."""
    a, b, c = triangle
    return (a, b), (b, c), (c, a)


def _least(growth: np.ndarray, normals: np.ndarray, offsets: np.ndarray, slack: float) -> np.ndarray | None:
    """Return the x of least ``growth @ x`` with ``normals @ x >= offsets``, at a corner of that region."""
    triples = np.array(list(combinations(range(len(normals)), 3)))
    matrix = normals[triples]
    regular = np.abs(np.linalg.det(matrix)) > 1e-4
    if not regular.any():
        return None
    corners = np.linalg.solve(matrix[regular], offsets[triples[regular]][..., None])[..., 0]
    feasible = (corners @ normals.T >= offsets - slack).all(axis=1)
    if not feasible.any():
        return None
    corners = corners[feasible]
    return corners[(corners @ growth).argmin()]


def _flips(ends: np.ndarray, place: np.ndarray, normals: np.ndarray) -> bool:
    """Tell whether a new triangle has no area or looks against the old ones."""
    new = np.cross(ends[:, 1] - ends[:, 0], place - ends[:, 0])
    area = np.linalg.norm(new, axis=1)
    longest = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) ** 2
    if (area < 0.05 * longest).any():
        return True
    return bool(((new / area[:, None]) @ normals.mean(axis=0) < -0.3).any())
