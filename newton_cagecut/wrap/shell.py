# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What must hold of a shell of triangles when its vertices move a little, as linear inequalities.

Each is the first-order change of a distance: along the direction between two nearest points, the moves of the one less
the moves of the other. Lengths are in units of the mesh's size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..geometry import (
    nearest_on_edges,
    nearest_on_triangles,
    simplex_distances,
    triangle_normals,
    units,
    winding_numbers,
)
from .inequalities import Inequalities
from .sampling import triangle_grid

_FACING = 0.3  # cosine between a face's normal and the way to the skin, below which they pass each other
_LOSS = 0.5  # share of a gap or a height that one step may take away, since the inequalities are of first order
_GRID_LIMIT = 16


@dataclass(frozen=True, eq=False)
class Shell:
    """A closed mesh of triangles.

    Attributes:
        vertices: Positions, shape (vertex_count, 3).
        triangles: Vertex ids, counterclockwise seen from outside, shape (triangle_count, 3).
    """

    vertices: np.ndarray
    triangles: np.ndarray

    def moved(self, moves: np.ndarray) -> Shell:
        """The shell with its vertices moved, shape (vertex_count, 3)."""
        return replace(self, vertices=self.vertices + moves)

    @property
    def corners(self) -> np.ndarray:
        """Corners of the triangles, shape (triangle_count, 3, 3)."""
        return self.vertices[self.triangles]

    @property
    def normals(self) -> np.ndarray:
        """Unit normals of the triangles, shape (triangle_count, 3)."""
        return units(triangle_normals(self.corners))

    @property
    def volume(self) -> float:
        """Enclosed volume."""
        return float(np.linalg.det(self.corners).sum() / 6.0)

    @property
    def area(self) -> float:
        """Area of the triangles."""
        return 0.5 * float(np.linalg.norm(triangle_normals(self.corners), axis=1).sum())

    @property
    def volume_growth(self) -> np.ndarray:
        """How the volume grows with each vertex's move, shape (vertex_count, 3)."""
        corners, growth = self.corners, np.zeros_like(self.vertices)
        for k in range(3):
            share = np.cross(corners[:, (k + 1) % 3], corners[:, (k + 2) % 3]) / 6.0
            np.add.at(growth, self.triangles[:, k], share)
        return growth

    @cached_property
    def edges(self) -> np.ndarray:
        """Vertex ids of the edges, shape (edge_count, 2)."""
        return np.unique(np.sort(self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)


def keep_around(rows: Inequalities, shell: Shell, points: np.ndarray, reach: float) -> None:
    """Ask that points stay inside or come inside.

    Args:
        rows: Takes the inequalities.
        shell: The shell.
        points: Points, shape (point_count, 3).
        reach: How far the shell may move.
    """
    corners = shell.corners
    distances = simplex_distances(points, corners)
    group = np.zeros(len(corners), dtype=int)
    inside = winding_numbers(points, shell.vertices, shell.triangles, group, 1)[:, 0] > 0.5
    face, distance = distances.argmin(axis=1), distances.min(axis=1)
    near = ~inside | (distance < reach)
    face, distance, sign = face[near], distance[near], np.where(inside[near], -1.0, 1.0)
    weights = nearest_on_triangles(points[near], corners[face])
    away = points[near] - np.einsum("nk,nki->ni", weights, corners[face])
    outward = np.where((distance > 0.0)[:, None], units(sign[:, None] * away, distance), shell.normals[face])
    rows.require(shell.triangles[face], weights, outward, sign * distance, soft=True)


def keep_off(rows: Inequalities, shell: Shell, skin: cKDTree, margin: float, spacing: float, reach: float) -> None:
    """Ask that the shell's faces keep a distance from the skin that they look away from.

    Args:
        rows: Takes the inequalities.
        shell: The shell.
        skin: Points of the skin.
        margin: The distance.
        spacing: Distance between the points of the shell's faces that are compared.
        reach: How far the shell may move.
    """
    face, weights = triangle_grid(shell.corners, spacing, limit=_GRID_LIMIT)
    places = np.einsum("nk,nki->ni", weights, shell.corners[face])
    distance, nearest = skin.query(places, distance_upper_bound=margin + reach)
    near = np.flatnonzero(np.isfinite(distance))
    away = units(places[near] - skin.data[nearest[near]], distance[near])
    outside = np.einsum("ni,ni->n", away, shell.normals[face[near]]) > _FACING
    near, away = near[outside], away[outside]
    rows.require(shell.triangles[face[near]], weights[near], away, margin - distance[near], soft=True)


def keep_apart(rows: Inequalities, shell: Shell, gap: float, reach: float) -> None:
    """Ask that parts of the shell that are no neighbours come no closer than a gap, or no closer than they are.

    Args:
        rows: Takes the inequalities.
        shell: The shell.
        gap: The gap.
        reach: How far the shell may move.
    """
    for vertices, weights, away in (_vertex_gaps(shell), _edge_gaps(shell)):
        distance = np.linalg.norm(away, axis=1)
        near = distance < gap + 2.0 * reach
        directions = units(away[near], distance[near])
        bounds = _allowed_loss(gap, distance[near])
        rows.require(vertices[near], weights[near], directions, bounds, soft=False)


def keep_shape(rows: Inequalities, shell: Shell, height: float) -> None:
    """Ask that the triangles' heights do not fall below a least one, or do not fall.

    Args:
        rows: Takes the inequalities.
        shell: The shell.
        height: The least height.
    """
    for k in range(3):
        vertices = np.roll(shell.triangles, -k, axis=1)
        top, start, end = (shell.vertices[vertices[:, i]] for i in range(3))
        edge = end - start
        along = np.einsum("ni,ni->n", top - start, edge) / np.einsum("ni,ni->n", edge, edge)
        upright = top - start - along[:, None] * edge
        present = np.linalg.norm(upright, axis=1)
        weights = np.stack([np.ones_like(along), along - 1.0, -along], axis=1)
        rows.require(vertices, weights, units(upright, present), _allowed_loss(height, present), soft=False)


def keep_flat(rows: Inequalities, shell: Shell, panels: Sequence[np.ndarray]) -> None:
    """Ask that the vertices of panels come into a plane each.

    Args:
        rows: Takes the inequalities.
        shell: The shell.
        panels: Triangle ids of each panel.
    """
    for panel in panels:
        vertices, weights, normal, missing = flatness(shell, panel)
        for sign in (1.0, -1.0):
            ids, directions = np.tile(vertices, (len(weights), 1)), np.tile(normal, (len(weights), 1))
            rows.require(ids, sign * weights, directions, sign * missing, soft=True)


def flatness(shell: Shell, panel: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return what makes a panel flat: to first order, weighted sums of its vertices' moves along its normal.

    Args:
        shell: The shell.
        panel: Triangle ids.

    Returns:
        The k vertices, weights of shape (k - 3, k), the normal and what the sums must be, shape (k - 3,).
    """
    vertices = np.unique(shell.triangles[panel])
    places = shell.vertices[vertices] - shell.vertices[vertices].mean(axis=0)
    x, y, normal = np.linalg.svd(places)[2]
    plane = np.stack([np.ones(len(places)), places @ x, places @ y])
    weights = np.linalg.svd(plane)[2][3:]
    return vertices, weights, normal, -weights @ (places @ normal)


def _vertex_gaps(shell: Shell) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices against triangles without them: vertex ids, weights and the vector between the nearest points."""
    vertex, face = np.nonzero((shell.triangles[None] != np.arange(len(shell.vertices))[:, None, None]).all(axis=2))
    weights = nearest_on_triangles(shell.vertices[vertex], shell.corners[face])
    away = shell.vertices[vertex] - np.einsum("nk,nki->ni", weights, shell.corners[face])
    ones = np.ones((len(vertex), 1))
    return np.column_stack([vertex, shell.triangles[face]]), np.hstack([ones, -weights]), away


def _edge_gaps(shell: Shell) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges against edges without a common vertex, as :func:`_vertex_gaps`."""
    first, second = np.triu_indices(len(shell.edges), 1)
    one, other = shell.edges[first], shell.edges[second]
    apart = (one[:, :, None] != other[:, None, :]).all(axis=(1, 2))
    one, other = one[apart], other[apart]
    s, t = nearest_on_edges(shell.vertices[one], shell.vertices[other])
    weights = np.stack([1.0 - s, s, t - 1.0, -t], axis=1)
    vertices = np.hstack([one, other])
    return vertices, weights, np.einsum("nk,nki->ni", weights, shell.vertices[vertices])


def _allowed_loss(least: float, present: np.ndarray) -> np.ndarray:
    """Least change of a length in one step: no loss below the least one, and of the rest only a share."""
    return _LOSS * np.minimum(least - present, 0.0)
