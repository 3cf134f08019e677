# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Boxes, as cages and as what is in them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from newton_cagecut import Cage


def box_quads(size: Sequence[float], counts: Sequence[int] = (1, 1, 1)) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (n, 3) [m] and the outward quads (m, 4) of a box around the origin.

    Args:
        size: Its edges [m].
        counts: Parts of each edge.
    """
    numbers: dict[tuple[int, ...], int] = {}
    quads = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, counts[axis]):
            for i, j in np.ndindex(counts[a], counts[b]):
                corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                quad = []
                for u, v in corners if side else corners[::-1]:
                    place = [0, 0, 0]
                    place[axis], place[a], place[b] = side, u, v
                    quad.append(numbers.setdefault(tuple(place), len(numbers)))
                quads.append(quad)
    places = np.array(list(numbers)) / counts - 0.5
    return places * size, np.array(quads)


def box_cage(size: Sequence[float], counts: Sequence[int] = (1, 1, 1)) -> Cage:
    """Return a box around the origin as a cage; the arguments are those of :func:`box_quads`."""
    points, quads = box_quads(size, counts)
    return Cage(points, [tuple(map(int, quad)) for quad in quads])


def box_mesh(size: Sequence[float], counts: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
    """Return the points and the triangles (2 m, 3) of a box; the arguments are those of :func:`box_quads`."""
    points, quads = box_quads(size, counts)
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
