# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""How far a whole triangle mesh stays from the faces of a cage.

Section 3 of the paper embeds the mesh in the cage. Its vertices may all lie inside and a triangle still leave, past a
concave edge of the cage; so the distance is that of triangles from triangles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import near_pairs, plane_gaps, triangle_distances
from .inside import boundary_distances

if TYPE_CHECKING:
    from ..cage import Cage

_SAMPLE = 4096  # points that bound the distance from above, before triangles are compared


def mesh_clearance(cage: Cage, points: np.ndarray, triangles: np.ndarray) -> float:
    """Least distance between a triangle mesh and the faces of a cage, zero where they cross [m].

    With all points inside the cage, a positive distance says that the whole mesh is.

    Args:
        cage: The cage, in space.
        points: Points of the mesh, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
    """
    corners = np.asarray(points, dtype=np.float64)[triangles]
    sample = corners[:: max(1, len(corners) // _SAMPLE), 0]
    least = float(boundary_distances(cage, sample).min())
    faces = cage.vertices[cage.triangles]
    for row, column in near_pairs(corners, faces, least):
        near = plane_gaps(corners[row], faces[column]) <= least
        if near.any():
            least = min(least, float(triangle_distances(corners[row[near]], faces[column[near]]).min()))
    return least
