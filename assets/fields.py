# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Functions of space that are negative inside a shape and roughly the distance near its skin [m].

Points have shape ``(n, 3)``, values ``(n,)``. The smooth union is the exponential one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def ball(points: np.ndarray, centre: Sequence[float], radius: float) -> np.ndarray:
    """Return the distance to a ball."""
    return np.linalg.norm(points - centre, axis=1) - radius


def ellipsoid(points: np.ndarray, centre: Sequence[float], radii: Sequence[float]) -> np.ndarray:
    """Return roughly the distance to an ellipsoid along the axes: its implicit function over that one's gradient."""
    scaled = (points - centre) / radii
    level = np.linalg.norm(scaled, axis=1)
    slope = np.linalg.norm(scaled / radii, axis=1)
    return level * (level - 1.0) / np.maximum(slope, 1e-9)


def cone(
    points: np.ndarray, start: Sequence[float], end: Sequence[float], start_radius: float, end_radius: float
) -> np.ndarray:
    """Return the distance to a segment, less a radius that changes evenly along it."""
    axis = np.subtract(end, start)
    share = np.clip((points - start) @ axis / (axis @ axis), 0.0, 1.0)
    gap = points - start - share[:, None] * axis
    return np.sqrt(np.einsum("ij,ij->i", gap, gap)) - (start_radius + (end_radius - start_radius) * share)


def box(points: np.ndarray, centre: Sequence[float], half: Sequence[float], rounding: float) -> np.ndarray:
    """Return the distance to a box along the axes, of the half sides given, whose edges are rounded."""
    beyond = np.abs(points - centre) - np.subtract(half, rounding)
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return outside + np.minimum(beyond.max(axis=1), 0.0) - rounding


def slab(across: np.ndarray, along: np.ndarray, reach: float, half: float, rounding: float) -> np.ndarray:
    """Return the distance to what is within ``reach`` across and within ``half`` along an axis, its rim rounded."""
    return box(np.stack([across, along], axis=1), (0.0, 0.0), (reach, half), rounding)


def union(parts: Sequence[np.ndarray], blend: float) -> np.ndarray:
    """Return the smooth union of shapes, that melt into one another over about a length.

    Args:
        parts: Their functions [m].
        blend: That length [m].
    """
    sharpness = 4.0 / blend
    return -np.logaddexp.reduce(-sharpness * np.stack(parts), axis=0) / sharpness
