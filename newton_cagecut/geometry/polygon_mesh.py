# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Polygons, or in the plane segments, as flat arrays with half-edges.

Section 5.2 of the paper manages the topology of a cut with half-edges; this is that structure, shared by
cages and by the embedded surface. Nothing in it loops over faces in Python. The boundary of a plane cage is made of
segments: faces of two corners, of which the first half-edge runs along the segment and the second back.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .lift import lifted

_NO_VOLUME = 1e-12


class PolygonMesh:
    """Polygons over shared vertices, with their half-edges.

    Half-edge ``h`` is a position of :attr:`face_vertex`: it starts at ``face_vertex[h]`` and ends at the next
    vertex of the same loop.
    """

    def __init__(self, vertices: np.ndarray, face_start: np.ndarray, face_vertex: np.ndarray):
        """Take over the arrays; nothing is copied or checked.

        Args:
            vertices: Positions, shape (vertex_count, dimension) [m].
            face_start: First half-edge of each face and the end of the last, shape (face_count + 1,).
            face_vertex: Vertex at which each half-edge starts, shape (half_edge_count,).
        """
        self.vertices = vertices
        self.face_start = face_start
        self.face_vertex = face_vertex

    @classmethod
    def of_triangles(cls, points: np.ndarray, triangles: np.ndarray) -> PolygonMesh:
        """Triangles in space; those of the plane lie at z = 0.

        Args:
            points: Positions, shape (point_count, dimension) [m].
            triangles: Point ids, shape (triangle_count, 3).
        """
        start = np.arange(0, 3 * len(triangles) + 1, 3)
        return cls(lifted(points), start, triangles.reshape(-1).astype(np.int64))

    def extended(self, vertices: np.ndarray, face_size: np.ndarray, face_vertex: np.ndarray) -> PolygonMesh:
        """The mesh with further vertices and faces behind its own.

        Args:
            vertices: Positions of the further vertices, shape (count, dimension) [m].
            face_size: Number of corners of each further face, shape (face_count,).
            face_vertex: Vertex at which each of their half-edges starts, in the new numbering, shape (corner_count,).
        """
        return PolygonMesh(
            np.concatenate([self.vertices, vertices]),
            np.concatenate([self.face_start, self.face_start[-1] + np.cumsum(face_size)]),
            np.concatenate([self.face_vertex, face_vertex]),
        )

    @property
    def dimension(self) -> int:
        """Dimension of the space; in 2D the faces are segments."""
        return self.vertices.shape[1]

    @property
    def vertex_count(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def face_count(self) -> int:
        """Number of faces."""
        return len(self.face_start) - 1

    @cached_property
    def face_size(self) -> np.ndarray:
        """Number of corners of each face, shape (face_count,)."""
        return np.diff(self.face_start)

    @cached_property
    def face(self) -> np.ndarray:
        """Face of each half-edge, shape (half_edge_count,)."""
        return np.repeat(np.arange(self.face_count), self.face_size)

    @cached_property
    def next(self) -> np.ndarray:
        """The half-edge that follows in the same loop, shape (half_edge_count,)."""
        following = np.arange(1, len(self.face_vertex) + 1)
        following[self.face_start[1:] - 1] = self.face_start[:-1]
        return following

    @cached_property
    def destination(self) -> np.ndarray:
        """Vertex at which each half-edge ends, shape (half_edge_count,)."""
        return self.face_vertex[self.next]

    @cached_property
    def edge_key(self) -> np.ndarray:
        """One number for each undirected edge, equal for its half-edges, shape (half_edge_count,)."""
        low = np.minimum(self.face_vertex, self.destination).astype(np.int64)
        high = np.maximum(self.face_vertex, self.destination).astype(np.int64)
        return low * self.vertex_count + high

    @cached_property
    def twin(self) -> np.ndarray:
        """The half-edge that runs back along the same edge, -1 where not just one does, shape (half_edge_count,)."""
        order = np.argsort(self.edge_key, kind="stable")
        key = self.edge_key[order]
        twin = np.full(len(key), -1, dtype=np.int64)
        same = np.concatenate([key[1:] == key[:-1], [False]])
        before = np.concatenate([[False], same[:-1]])
        first = np.flatnonzero(same & ~before & ~np.concatenate([same[1:], [False]]))
        one, other = order[first], order[first + 1]
        opposite = self.face_vertex[one] != self.face_vertex[other]
        one, other = one[opposite], other[opposite]
        twin[one], twin[other] = other, one
        return twin

    @cached_property
    def edges(self) -> np.ndarray:
        """Pairs of vertices that some half-edge joins, lower first, shape (pair_count, 2)."""
        return np.stack(np.divmod(np.unique(self.edge_key), self.vertex_count), axis=1)

    @cached_property
    def edge_count(self) -> int:
        """Number of undirected edges, half-edges without a twin counting as one each."""
        return (len(self.twin) + int(np.count_nonzero(self.twin < 0))) // 2

    @cached_property
    def corner_offset(self) -> np.ndarray:
        """Each corner relative to the first corner of its face, shape (half_edge_count, dimension) [m]."""
        return self.vertices[self.face_vertex] - self.vertices[self.face_vertex[self.face_start[:-1]]][self.face]

    @cached_property
    def face_area_vector(self) -> np.ndarray:
        """Normal of each face times its area, or its length in 2D, shape (face_count, dimension) [m^2 or m].

        The inside lies behind a polygon that is counterclockwise, and to the left of a segment.
        """
        offset = self.corner_offset
        if self.dimension == 2:
            return offset[1::2, ::-1] * [1.0, -1.0]
        return 0.5 * np.add.reduceat(np.cross(offset, offset[self.next]), self.face_start[:-1], axis=0)

    @cached_property
    def face_volume(self) -> np.ndarray:
        """Signed volume, in 2D area, of the cone from the mean vertex over each face, shape (face_count,) [m^d]."""
        first = self.vertices[self.face_vertex[self.face_start[:-1]]] - self.vertices.mean(axis=0)
        return np.einsum("ij,ij->i", first, self.face_area_vector) / self.dimension

    @cached_property
    def vertex_component(self) -> np.ndarray:
        """Connected component of each vertex, numbered by their lowest vertices, shape (vertex_count,)."""
        label = np.arange(self.vertex_count)
        start, end = self.face_vertex, self.destination
        while True:
            lowest = np.minimum(label[start], label[end])
            updated = label.copy()
            np.minimum.at(updated, label[start], lowest)
            np.minimum.at(updated, label[end], lowest)
            while not np.array_equal(updated, updated[updated]):
                updated = updated[updated]
            updated = updated[label]
            if np.array_equal(updated, label):
                return np.unique(label, return_inverse=True)[1].reshape(-1)
            label = updated

    @cached_property
    def face_component(self) -> np.ndarray:
        """Connected component of each face, shape (face_count,)."""
        return self.vertex_component[self.face_vertex[self.face_start[:-1]]]

    @cached_property
    def component_count(self) -> int:
        """Number of connected components."""
        return int(self.vertex_component.max()) + 1 if self.vertex_count else 0

    @cached_property
    def component_volumes(self) -> np.ndarray:
        """Enclosed volume, in 2D area, of each component, shape (component_count,) [m^d]."""
        return np.bincount(self.face_component, weights=self.face_volume, minlength=self.component_count)

    @cached_property
    def component_outward(self) -> np.ndarray:
        """Whether each component encloses a volume from outside, shape (component_count,).

        Cavities do not, nor do the two coincident sides of a cut that lies wholly inside.
        """
        bulk = np.bincount(self.face_component, weights=np.abs(self.face_volume), minlength=self.component_count)
        return self.component_volumes > _NO_VOLUME * bulk

    @cached_property
    def fan(self) -> np.ndarray:
        """Number of the fan of half-edges around a vertex that each half-edge starts, shape (half_edge_count,).

        A manifold vertex has one fan. Only meaningful on a closed mesh.
        """
        turn = self.next[self.twin]
        label = np.arange(len(turn))
        for _ in range(max(1, int(len(turn)).bit_length())):
            label = np.minimum(label, label[turn])
            turn = turn[turn]
        return label

    def loops(self) -> tuple[tuple[int, ...], ...]:
        """The faces as tuples of vertex ids."""
        flat = self.face_vertex.tolist()
        start = self.face_start.tolist()
        return tuple(tuple(flat[start[i] : start[i + 1]]) for i in range(self.face_count))
