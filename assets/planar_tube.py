# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tubes of planar quads along a curve.

A chain of rings: the sides of each link are planes through the edges of the ring before, tilted towards a wanted ring,
and the next ring is where they meet that ring's plane. So every quad is planar, and the rings follow the wanted ones.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def planar_tube(first: np.ndarray, wanted: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return the rings after ``first``, each joined to the one before by planar quads.

    Args:
        first: Corners of the ring that the tube starts from, shape ``(m, 3)``.
        wanted: Corners of the rings to come near to, counterclockwise seen from the tube's end, each ``(m, 3)``.
    """
    rings = [first]
    for target in wanted:
        start, centre = rings[-1], target.mean(axis=0)
        following = np.roll(target, -1, axis=0)
        normal = np.cross(target - centre, following - centre).sum(axis=0)
        middle = 0.5 * (target + following)
        side = np.cross(np.roll(start, -1, axis=0) - start, middle - start)
        planes = np.stack([np.roll(side, 1, axis=0), side, np.broadcast_to(normal, side.shape)], axis=1)
        heights = np.einsum(
            "mki,mki->mk", planes, np.stack([start, start, np.broadcast_to(centre, side.shape)], axis=1)
        )
        rings.append(np.linalg.solve(planes, heights[..., None])[..., 0])
    return rings[1:]


def tube_faces(rings: Sequence[Sequence[int]]) -> list[tuple[int, ...]]:
    """Return the quads between vertices of rings, outward where the rings are counterclockwise seen from the end."""
    return [
        (a, b, d, c)
        for ring, following in zip(rings, rings[1:])
        for a, b, c, d in zip(ring, (*ring[1:], ring[0]), following, (*following[1:], following[0]))
    ]
