# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What of a cut's back is not covered by its front, as seen by each piece of the cage.

Where both sides of a cut belong to one piece, one sheet of charges stands for both. Where a later cut has taken one of
them off, each side has charges of its own.
"""

from __future__ import annotations

import numpy as np

from ....cage import Cage

_NOTHING = 1e-9
"""Share of a face's area below which a part of it is nothing."""


def uncovered_parts(cage: Cage) -> dict[int, list[np.ndarray]]:
    """Faces on the back of a cut that faces of the same piece cover from the front, and what of them is left.

    Args:
        cage: The cage.

    Returns:
        For each such face the convex parts that nothing covers, in the face's plane and counterclockwise, shape
        (corner_count, 2) each.
    """
    wall, side, piece = np.asarray(cage.face_wall), np.asarray(cage.face_side), cage.face_piece
    triangles = _plane_triangles(cage)
    found = {}
    for face in np.flatnonzero(side == 1).tolist():
        front = np.flatnonzero((wall == wall[face]) & (side == 0) & (piece == piece[face])).tolist()
        if cage.piece_count == 1:
            found[face] = []
        elif front:
            own = triangles[cage.triangle_face == face]
            rest = list(own)
            for triangle in np.concatenate([triangles[cage.triangle_face == other] for other in front]):
                rest = _without(rest, triangle[::-1] * [1.0, -1.0])
            least = _NOTHING * sum(_area(part) for part in own)
            rest = [part for part in rest if _area(part) > least]
            if sum(_area(part) for part in rest) < sum(_area(part) for part in own) - least:
                found[face] = rest
    return found


def _plane_triangles(cage: Cage) -> np.ndarray:
    """Triangles of the faces in their planes, shape (triangle_count, 3, 2)."""
    wall = [cage.walls[wall] for wall in cage.face_wall]
    origin = np.array([w.origin for w in wall])[cage.triangle_face]
    axes = np.array([w.axes for w in wall])[cage.triangle_face]
    offset = cage.vertices[cage.triangles] - origin[:, None]
    place = np.stack([(offset * axes[:, None, k]).sum(axis=2) for k in range(2)], axis=2)
    place[..., 1] *= (1 - 2 * np.asarray(cage.face_side))[cage.triangle_face][:, None]
    return place


def _area(polygon: np.ndarray) -> float:
    x, y = (polygon - polygon[0]).T
    return float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def _without(polygons: list[np.ndarray], triangle: np.ndarray) -> list[np.ndarray]:
    """Convex polygons without a triangle, as convex polygons."""
    left = []
    for polygon in polygons:
        rest = polygon
        for a, b in zip(triangle, np.roll(triangle, -1, axis=0)):
            along = b - a
            height = along[0] * (rest[:, 1] - a[1]) - along[1] * (rest[:, 0] - a[0])
            outside = _clipped(rest, -height)
            rest = _clipped(rest, height)
            if len(outside) > 2:
                left.append(outside)
            if len(rest) < 3:
                break
    return left


def _clipped(polygon: np.ndarray, height: np.ndarray) -> np.ndarray:
    """What of a convex polygon lies where the height of its corners is positive."""
    found = []
    for k in range(len(polygon)):
        here, there = height[k - 1], height[k]
        if here * there < 0.0:
            found.append(polygon[k - 1] + here / (here - there) * (polygon[k] - polygon[k - 1]))
        if there >= 0.0:
            found.append(polygon[k])
    return np.array(found) if height.max() > 0.0 else np.zeros((0, 2))
