# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The face of a cage that a point on it belongs to."""

from __future__ import annotations

import numpy as np

from ...cage import Cage
from ...geometry import simplex_distances

_CHUNK = 1 << 12


def nearest_faces(cage: Cage, points: np.ndarray, keys: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The nearest face of each point, of those on its wall and side where a key names them, and its distance.

    Args:
        cage: The cage.
        points: Rest positions [m], shape (point_count, dimension).
        keys: Key 2 * wall + side, negative for any, shape (point_count,).

    Returns:
        Faces, shape (point_count,), and distances [m], shape (point_count,).
    """
    corners = cage.vertices[cage.simplices]
    key = cage.face_key[cage.simplex_face]
    face, distance = np.zeros(len(points), dtype=np.int64), np.zeros(len(points))
    for first in range(0, len(points), _CHUNK):
        some = slice(first, first + _CHUNK)
        found = simplex_distances(points[some], corners)
        other = (keys[some, None] >= 0) & (keys[some, None] != key)
        other &= (keys[some, None] == key).any(axis=1, keepdims=True)
        found[other] = np.inf
        nearest = found.argmin(axis=1)
        face[some], distance[some] = cage.simplex_face[nearest], found[np.arange(len(nearest)), nearest]
    return face, distance
