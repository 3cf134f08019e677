# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A cage with all its faces moved outward."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..geometry import PolygonMesh, units

if TYPE_CHECKING:
    from .cage import Cage

_SAME = 1e-2  # singular values, of the largest, below which directions of faces around a vertex count as one
_STEEPEST = 0.2  # of the wanted distance, that a face around a vertex may get before all is scaled up


def moved_out(cage: Cage, distance: float) -> np.ndarray:
    """Move each vertex so that all faces around it move outward by a distance at least.

    Where the faces around a vertex have no more directions than the space, each moves by just the distance.

    Args:
        cage: The cage.
        distance: The distance [m].

    Returns:
        The vertices, shape (vertex_count, dimension) [m].

    Raises:
        ValueError: If no way leads out of all faces around a vertex.
    """
    mesh: PolygonMesh = cage.mesh
    normals = units(mesh.face_area_vector)
    owner, vertex = mesh.face, mesh.face_vertex
    order = np.argsort(vertex, kind="stable")
    owner, vertex = owner[order], vertex[order]
    starts = np.flatnonzero(np.r_[True, vertex[1:] != vertex[:-1], True])
    moved = cage.vertices.copy()
    for begin, end in zip(starts[:-1], starts[1:]):
        around = normals[owner[begin:end]]
        way = np.linalg.pinv(around, rcond=_SAME) @ np.ones(len(around))
        least = float((around @ way).min())
        if least < _STEEPEST:
            raise ValueError(
                f"vertex {vertex[begin]} of the cage cannot move out of all faces around it "
                f"({np.unique(owner[begin:end]).tolist()}), which fold back on each other; move it by hand"
            )
        moved[vertex[begin]] += distance * way / min(least, 1.0)
    return moved


def holding_distance(cage: Cage, points: np.ndarray, farthest: float) -> float | None:
    """Return by how much a cage must be inflated to hold points, or ``None`` where that does not help.

    Args:
        cage: The cage.
        points: Points outside it, shape (point_count, dimension) [m].
        farthest: Distance of the farthest from the cage [m].
    """
    for share in (1.05, 1.5, 2.5):
        distance = float(f"{share * farthest:.3g}")
        try:
            if cage.inflated(distance).contains(points).all():
                return distance
        except ValueError:
            break
    return None
