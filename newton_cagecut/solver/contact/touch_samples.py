# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Samples of a surface: its points, and a lattice inside of caps and large triangles.

Caps have points on their rim only, whose nearest places on the other side may be its side walls.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_LARGE = 2.0
"""Area from which on a triangle has a lattice, in squares of the spacing."""
_FINEST = 16
"""Most divisions of a triangle's sides."""
_LEAST = 0.02
"""Least area of a sample, in squares of the spacing."""


class TouchSamples(NamedTuple):
    """Samples on triangles."""

    triangle: np.ndarray
    """The triangle, shape (sample_count,)."""
    place: np.ndarray
    """Barycentric coordinates, shape (sample_count, 3)."""
    area: np.ndarray
    """Area [m^2], shape (sample_count,)."""


def touch_samples(points: np.ndarray, triangles: np.ndarray, caps: np.ndarray, room: int) -> TouchSamples:
    """Samples of a surface, about an edge apart; farther apart where there is no room for them.

    Args:
        points: Points of the surface [m], shape (n, 3).
        triangles: Triangles, shape (m, 3).
        caps: Which of them close the surface along a cut, shape (m,), bool.
        room: Greatest number of samples, at least that of points and of cap triangles together.
    """
    corners = points[triangles]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    spacing = float(np.median(np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)))
    while True:
        inner = np.flatnonzero(caps | (area > _LARGE * spacing**2))
        divisions = np.clip(np.ceil(np.sqrt(2.0 * area[inner]) / spacing), 1, _FINEST).astype(int)
        used, first = np.unique(triangles, return_index=True)
        if len(used) + int((divisions**2).sum()) <= room or divisions.max(initial=1) == 1:
            break
        spacing *= 1.25
    share = np.zeros(len(points))
    outer = np.setdiff1d(np.arange(len(triangles)), inner)
    np.add.at(share, triangles[outer].ravel(), np.repeat(area[outer] / 3.0, 3))
    found = [TouchSamples(first // 3, np.eye(3)[first % 3], np.maximum(share[used], _LEAST * spacing**2))]
    for triangle, count in zip(inner.tolist(), divisions.tolist()):
        place = _lattice(count)
        found.append(
            TouchSamples(np.full(len(place), triangle), place, np.full(len(place), area[triangle] / len(place)))
        )
    triangle, place, size = (np.concatenate(parts) for parts in zip(*found))
    return TouchSamples(triangle[:room], place[:room], size[:room])


def _lattice(count: int) -> np.ndarray:
    """Centres of the equal triangles that a triangle is divided into, barycentric, shape (count^2, 3)."""
    up = [((i + 1 / 3) / count, (j + 1 / 3) / count) for i in range(count) for j in range(count - i)]
    down = [((i + 2 / 3) / count, (j + 2 / 3) / count) for i in range(count - 1) for j in range(count - 1 - i)]
    place = np.array(up + down)
    return np.column_stack([1.0 - place.sum(axis=1), place])
