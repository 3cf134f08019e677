# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The bodies that are tried: boxes side by side, the cages around them, and the surfaces in those."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...cage import Cage

_SIDES = {
    (0, 0): ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)),
    (0, 1): ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)),
    (1, 0): ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)),
    (1, 1): ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)),
    (2, 0): ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)),
    (2, 1): ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
}
"""Corners of each side of a box, by axis and end, counterclockwise from outside."""


@dataclass(frozen=True)
class Blocks:
    """Boxes of a grid.

    Args:
        axes: Where the grid's planes are along each axis [m], ascending.
        filled: Which boxes there are, as a mask over the grid.
    """

    axes: tuple[np.ndarray, np.ndarray, np.ndarray]
    filled: np.ndarray

    def cage(self) -> Cage:
        """The boxes' outer sides as quads; vertices in the order of x, y, z."""
        faces = []
        for (axis, end), corners in _SIDES.items():
            padded = np.pad(self.filled, 1)
            beside = np.roll(padded, 1 if end == 0 else -1, axis=axis)[1:-1, 1:-1, 1:-1]
            for cell in np.argwhere(self.filled & ~beside):
                faces.append([tuple(cell + corner) for corner in corners])
        used = sorted({corner for face in faces for corner in face})
        number = {corner: index for index, corner in enumerate(used)}
        vertices = [[axis[i] for axis, i in zip(self.axes, corner, strict=True)] for corner in used]
        return Cage(np.array(vertices, dtype=float), [tuple(number[corner] for corner in face) for face in faces])

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Which points (n, 3) [m], none of them on a plane of the grid, are in a box."""
        cells = [np.searchsorted(axis, points[:, i]) - 1 for i, axis in enumerate(self.axes)]
        return self.filled[tuple(cells)]


def bar(segments: int, size: tuple[float, float, float]) -> Blocks:
    """A bar along x from the origin, its cross-section centred, in segments.

    Args:
        segments: Number of segments.
        size: Length, width along y and height along z [m].
    """
    length, width, height = size
    stations = np.linspace(0.0, length, segments + 1)
    return Blocks((stations, _around(width), _around(height)), np.ones((segments, 1, 1), dtype=bool))


def bracket(segments: int, leg: float, thickness: float) -> Blocks:
    """An L: a leg along x, and one up z from its end.

    Args:
        segments: Segments of each leg, its corner not counted.
        leg: Length of a leg, its corner not counted [m].
        thickness: Width and height of a leg [m].
    """
    along = np.append(np.linspace(0.0, leg, segments + 1), leg + thickness)
    up = np.concatenate([[0.0], thickness + np.linspace(0.0, leg, segments + 1)])
    filled = np.zeros((segments + 1, 1, segments + 1), dtype=bool)
    filled[:, 0, 0] = filled[-1, 0, :] = True
    return Blocks((along, _around(thickness), up), filled)


def surface_in(cage: Cage, share: float = 0.9) -> tuple[np.ndarray, np.ndarray]:
    """A surface like a cage, shrunk towards the middle of its box.

    Args:
        cage: The cage, star-shaped about that middle.
        share: Size of the surface, of the cage's.

    Returns:
        Points (n, 3) [m] and triangles (m, 3).
    """
    middle = cage.vertices.mean(axis=0)
    return middle + share * (cage.vertices - middle), np.asarray(cage.simplices, dtype=np.int32)


def _around(width: float) -> np.ndarray:
    return np.array([-0.5 * width, 0.5 * width])
