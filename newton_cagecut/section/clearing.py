# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Planes and fronts moved off vertices and nodes, by as little as can be.

Section 5.2 of the paper leaves open what happens where a blade meets a vertex. Here it never does: what would come
within the tolerance keeps off.
"""

from __future__ import annotations

import numpy as np

from ..geometry import dots
from .blade import BladePlane


def clear_plane(plane: BladePlane, points: np.ndarray, tolerance: float) -> BladePlane:
    """The plane moved, by as little as can be, so that no point is within the tolerance of it.

    Args:
        plane: The plane.
        points: Points to keep off, shape (point_count, dimension) [m].
        tolerance: Distance to keep [m].
    """
    distance = plane.distance(points)
    if len(distance) == 0 or np.abs(distance).min() > tolerance:
        return plane
    return plane.shifted(_nearest_gap(distance, np.full(len(distance), 1.5 * tolerance)))


def clear_turn(plane: BladePlane, points: np.ndarray, tolerance: float) -> BladePlane:
    """The plane turned about its line ``s = 0``, by as little as can be, so that no point is within the tolerance.

    Points beside or behind that line do not count.

    Args:
        plane: The plane.
        points: Points to keep off, shape (point_count, dimension) [m].
        tolerance: Distance to keep [m].
    """
    across = plane.across
    height, ahead = plane.distance(points), dots(points - plane.origin, across)
    close = (ahead > 8.0 * tolerance) & (np.abs(height) < 0.25 * ahead)
    height, ahead = height[close], ahead[close]
    if len(height) == 0 or np.abs(height).min() > tolerance:
        return plane
    angle = _nearest_gap(np.arctan2(height, ahead), 1.5 * tolerance / ahead)
    cosine, sine = np.cos(angle), np.sin(angle)
    along = plane.direction @ plane.edge
    turned = cosine * across + sine * plane.normal
    direction = along * plane.edge + np.sqrt(1.0 - along * along) * turned
    return BladePlane(plane.origin, plane.edge, direction, cosine * plane.normal - sine * across)


def _nearest_gap(position: np.ndarray, margin: np.ndarray) -> float:
    """The value nearest to zero that keeps every position at its margin."""
    order = np.argsort(position - margin, kind="stable")
    low, high = (position - margin)[order], np.maximum.accumulate((position + margin)[order])
    lowest, highest = np.concatenate([[-np.inf], high]), np.concatenate([low, [np.inf]])
    nearest = np.clip(0.0, lowest, highest)[lowest <= highest]
    return float(nearest[np.argmin(np.abs(nearest))])


def clear_front(nodes: np.ndarray, front: float, tolerance: float) -> float:
    """The front moved on, by as little as can be, so that no node is within the tolerance of it.

    Args:
        nodes: Coordinates s of the nodes, ascending [m].
        front: Coordinate s of the front [m].
        tolerance: Distance to keep [m].
    """
    while True:
        last = int(np.searchsorted(nodes, front + tolerance)) - 1
        if last < 0 or nodes[last] <= front - tolerance or nodes[last] + tolerance <= front:
            return front
        front = float(nodes[last]) + tolerance
