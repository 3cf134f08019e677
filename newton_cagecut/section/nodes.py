# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Nodes of a section: where the plane of a blade crosses edges of a mesh, or goes on from its vertices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..geometry import PolygonMesh
from .blade import BladePlane


@dataclass(frozen=True, eq=False)
class Nodes:
    """Points of a section at which its chords end, and how values get there from the mesh's vertices."""

    half_edge: np.ndarray
    """A half-edge on which each node lies, that arrives before it in its face, or that starts at it, shape (count,)."""
    vertex: np.ndarray
    """Vertex of the mesh that each node is, -1 for the others, shape (count,)."""
    position: np.ndarray
    """Positions, shape (count, dimension) [m]."""
    coordinates: np.ndarray
    """Coordinates (a, s) in the plane, shape (count, 2) [m]."""
    pinned: np.ndarray
    """Whether both sides of the cut share the node, which no edge crosses, shape (count,)."""
    above: np.ndarray
    """Vertex on the positive side of each crossed edge; for a vertex itself."""
    below: np.ndarray
    """Vertex on the negative side of each crossed edge; for a vertex itself."""
    fraction: np.ndarray
    """Place of each node between those, 0 at the positive one."""
    between: tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...] = ()
    """For pinned nodes, in the order of adding: two nodes and the place between them."""
    which: np.ndarray | None = None
    """Numbers, in the order of adding, of the nodes that are left, shape (count,); None for all."""

    @classmethod
    def on_edges(cls, mesh: PolygonMesh, plane: BladePlane, distance: np.ndarray, half_edge: np.ndarray) -> Nodes:
        """Nodes where edges cross a plane.

        Args:
            mesh: The polygons.
            plane: The plane.
            distance: Signed distance of each vertex from it, those at zero being on the positive side,
                shape (vertex_count,) [m].
            half_edge: A half-edge of each crossed edge, shape (count,).
        """
        start, end = mesh.face_vertex[half_edge], mesh.destination[half_edge]
        down = distance[start] >= 0.0
        above, below = np.where(down, start, end), np.where(down, end, start)
        top, bottom = distance[above], distance[below]
        fraction = top / (top - bottom)
        position = mesh.vertices[above] + fraction[:, None] * (mesh.vertices[below] - mesh.vertices[above])
        none, free = np.full(len(start), -1), np.zeros(len(start), dtype=bool)
        return cls(half_edge, none, position, plane.coordinates(position), free, above, below, fraction)

    @property
    def count(self) -> int:
        """Number of nodes."""
        return len(self.half_edge)

    @cached_property
    def rank(self) -> np.ndarray:
        """Place of each node in the order in which the front reaches them, shape (count,)."""
        rank = np.empty(self.count, dtype=np.int64)
        rank[np.argsort(self.coordinates[:, 1], kind="stable")] = np.arange(self.count)
        return rank

    def with_vertices(self, mesh: PolygonMesh, plane: BladePlane, corner: np.ndarray) -> Nodes:
        """The nodes and further ones at vertices on the line ``s = 0`` of the plane.

        Args:
            mesh: The polygons.
            plane: The plane.
            corner: Half-edges that start at the vertices, shape (added_count,).
        """
        vertex = mesh.face_vertex[corner]
        position = mesh.vertices[vertex]
        coordinates = plane.coordinates(position)
        coordinates[:, 1] = 0.0
        return replace(
            self._joined(corner, vertex, position, coordinates, pinned=False),
            above=np.concatenate([self.above, vertex]),
            below=np.concatenate([self.below, vertex]),
            fraction=np.concatenate([self.fraction, np.zeros(len(vertex))]),
        )

    def with_pinned(self, one: np.ndarray, other: np.ndarray, share: np.ndarray, axis: int, border: float) -> Nodes:
        """The nodes and pinned ones between two nodes each.

        Args:
            one: First nodes, shape (added_count,).
            other: Second nodes, shape (added_count,).
            share: Place between them, 0 at the first, shape (added_count,).
            axis: The coordinate that is the border's.
            border: The border's value of it [m].
        """
        share = share[:, None]
        position = self.position[one] + share * (self.position[other] - self.position[one])
        coordinates = self.coordinates[one] + share * (self.coordinates[other] - self.coordinates[one])
        coordinates[:, axis] = border
        none = np.full(len(one), -1)
        joined = self._joined(none, none, position, coordinates, pinned=True)
        return replace(joined, between=(*self.between, (one, other, share)))

    def _joined(
        self, half_edge: np.ndarray, vertex: np.ndarray, position: np.ndarray, coordinates: np.ndarray, *, pinned: bool
    ) -> Nodes:
        return replace(
            self,
            half_edge=np.concatenate([self.half_edge, half_edge]),
            vertex=np.concatenate([self.vertex, vertex]),
            position=np.concatenate([self.position, position]),
            coordinates=np.concatenate([self.coordinates, coordinates]),
            pinned=np.concatenate([self.pinned, np.full(len(vertex), pinned)]),
        )

    def only(self, which: np.ndarray) -> Nodes:
        """Some of the nodes, to which no more are added.

        Args:
            which: Their numbers, shape (kept_count,).
        """
        return replace(
            self,
            half_edge=self.half_edge[which],
            vertex=self.vertex[which],
            position=self.position[which],
            coordinates=self.coordinates[which],
            pinned=self.pinned[which],
            which=which if self.which is None else self.which[which],
        )

    def values(self, at_vertices: np.ndarray) -> np.ndarray:
        """Values at the nodes from those at the vertices, linear along edges and chords, shape (count, ...).

        Args:
            at_vertices: Values of the mesh's vertices, shape (vertex_count, ...).
        """
        above, below = at_vertices[self.above], at_vertices[self.below]
        values = above + self.fraction[:, None] * (below - above)
        for one, other, share in self.between:
            values = np.concatenate([values, values[one] + share * (values[other] - values[one])])
        return values if self.which is None else values[self.which]
