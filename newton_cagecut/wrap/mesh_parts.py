# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The components of a mesh, each to be wrapped alone, and shells put together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..geometry import winding_numbers
from .broaden import broaden
from .sampling import spread_points

Triangles = tuple[np.ndarray, np.ndarray]

_WELD = 1e-6  # of the diagonal: points that are nearer are one
_LEAST_GAP = 0.01  # beside the offsets, of the diagonal: what shells keep between them
_SPACING = 0.004  # between points of the parts that are compared


def parts_apart(
    points: np.ndarray, triangles: np.ndarray, *, offset: float, face_count: int, size: float
) -> tuple[list[Triangles], float]:
    """Return the connected components of a mesh, those within another with it, and the least distance of two.

    Args:
        points: Points in a box with a diagonal of 1, shape (point_count, 3).
        triangles: Point ids, shape (triangle_count, 3).
        offset: What a cage keeps from the mesh.
        face_count: Faces of the cage.
        size: Diagonal of the mesh, for texts [m].

    Raises:
        ValueError: There are more than the faces are enough for, or two are nearer than cages around each can be.
    """
    label = _triangle_labels(points, triangles)
    count = int(label.max()) + 1
    label = _with_inner(points, triangles, label, count)
    names = np.unique(label)
    if 4 * len(names) > face_count:
        raise ValueError(
            f"the mesh has {len(names)} components that lie apart, each of which needs 4 faces: ask for at least "
            f"{4 * len(names)} faces, or leave out separate"
        )
    gap, least = np.inf, 2.0 * offset + _LEAST_GAP
    skins = [spread_points(points, triangles[label == name], _SPACING) for name in names]
    trees = [cKDTree(skin) for skin in skins]
    for i in range(len(names)):
        for j in range(i):
            distance = float(trees[i].query(skins[j])[0].min())
            if distance < least:
                first, second = (int(triangles[label == names[k]].min()) for k in (j, i))
                raise ValueError(
                    f"the components of points {first} and {second} of the mesh come within {size * distance:.4g} m "
                    f"of each other, too near for cages that keep {size * offset:.4g} m from each "
                    f"({size * least:.4g} m are needed); take a smaller offset, or leave out separate"
                )
            gap = min(gap, distance)
    return [broaden(*_part(points, triangles[label == name])) for name in names], gap


def joined_shells(shells: Sequence[Triangles]) -> Triangles:
    """Return meshes as one.

    Args:
        shells: Vertices and triangles of each.
    """
    start = np.cumsum([0, *(len(vertices) for vertices, _ in shells)])
    vertices = np.concatenate([vertices for vertices, _ in shells])
    return vertices, np.concatenate([triangles + offset for (_, triangles), offset in zip(shells, start)])


def _part(points: np.ndarray, triangles: np.ndarray) -> Triangles:
    used, corner = np.unique(triangles, return_inverse=True)
    return points[used], corner.reshape(-1, 3)


def _triangle_labels(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Number of each triangle's component, by the places of its points."""
    pairs = cKDTree(points).query_pairs(_WELD, output_type="ndarray")
    edges = np.concatenate([triangles[:, :2], triangles[:, 1:], pairs])
    graph = coo_matrix((np.ones(len(edges), dtype=bool), tuple(edges.T)), shape=(len(points),) * 2)
    return np.unique(connected_components(graph, directed=False)[1][triangles[:, 0]], return_inverse=True)[1]


def _with_inner(points: np.ndarray, triangles: np.ndarray, label: np.ndarray, count: int) -> np.ndarray:
    """Labels of components, those inside another with that one's."""
    firsts = points[triangles[np.unique(label, return_index=True)[1], 0]]
    winding = winding_numbers(firsts, points, triangles, label, count)
    inside = np.abs(winding) > 0.5
    np.fill_diagonal(inside, False)
    return connected_components(coo_matrix(inside), directed=False)[1][label]
