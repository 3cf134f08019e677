# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A cage of any number of faces, on which growth is measured."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from ...cage import Cage


def armed_ball(face_count: int) -> Cage:
    """A ball with eight arms of triangles, of the number of faces or one less.

    It is the shape for which section 7 of the paper times its cuts.

    Args:
        face_count: Wanted number of faces.
    """
    count = face_count // 2 + 2
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * np.arange(count)
    level = np.sqrt(1.0 - height**2)
    directions = np.stack([level * np.cos(turn), level * np.sin(turn), height], axis=1)
    triangles = ConvexHull(directions).simplices
    a, b, c = (directions[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0.0
    triangles[inward] = triangles[inward, ::-1]
    radius = 0.5 + 0.5 * np.cos(4.0 * np.arctan2(directions[:, 1], directions[:, 0])) ** 2 * level**2
    return Cage(radius[:, None] * directions, triangles)


def inner_points(cage: Cage, count: int) -> np.ndarray:
    """Return uniform points inside a cage [m], shape ``(count, 3)``."""
    rng = np.random.default_rng(1)
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    found = np.zeros((0, 3))
    while len(found) < count:
        points = rng.uniform(low, high, (4 * count, 3))
        found = np.concatenate([found, points[cage.contains(points)]])
    return found[:count]
