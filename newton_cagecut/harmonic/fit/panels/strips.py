# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Panels on a wall of a cut: strips along its fronts, which the densities grow towards.

Next to the front the density is like the root of 1 / distance, and smooth along the front; strips that narrow towards
it by a power of their number follow that with few panels, however the wall is shaped and however many fronts it has.
"""

from __future__ import annotations

import numpy as np

_STRIPS = 10
_POWER = 2.5
_COLUMNS_A_PANEL = 3.0
"""Strips are divided across into so many parts for the greatest length of a panel."""
_FEWEST_COLUMNS = 4
_ROUNDING, _SAME = 1e-12, 1e-9


def strip_panels(polygons: list[np.ndarray], fronts: np.ndarray, most: float) -> tuple[np.ndarray, np.ndarray]:
    """Divide convex parts of a wall into panels.

    Args:
        polygons: Their corners in the wall's plane, counterclockwise, shape (corner_count, 2) each.
        fronts: Ends of the edges along the front, with the wall to the left, shape (front_count, 2, 2).
        most: Greatest length of other panels.

    Returns:
        Positions, shape (point_count, 2), and corners of the panels, counterclockwise, shape (panel_count, 3).
    """
    parts, count = _padded(polygons)
    for normal, offset in _lines(np.concatenate(polygons), fronts, most):
        parts, count = _split(parts, count, normal, offset)
    return _fans(parts, count)


def fan_panels(polygons: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Divide convex parts of a wall without a front into panels, as few as can be.

    Args:
        polygons: Their corners in the wall's plane, counterclockwise, shape (corner_count, 2) each.

    Returns:
        What ``strip_panels`` does.
    """
    return _fans(*_padded(polygons))


def _padded(polygons: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Polygons as rows of corners, filled up, and the count of each."""
    count = np.array([len(polygon) for polygon in polygons])
    parts = np.zeros((len(polygons), count.max(), 2))
    parts[np.arange(count.max()) < count[:, None]] = np.concatenate(polygons)
    return parts, count


def _fans(parts: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of convex polygons, their corners numbered by their places."""
    fan = [(parts[:, 0], parts[:, k], parts[:, k + 1], count > k + 1) for k in range(1, parts.shape[1] - 1)]
    triangles = np.concatenate([np.stack([a, b, c], axis=1)[used] for a, b, c, used in fan])
    edge = triangles[:, 1:] - triangles[:, :1]
    area = edge[:, 0, 0] * edge[:, 1, 1] - edge[:, 0, 1] * edge[:, 1, 0]
    flat = triangles[area > _ROUNDING * area.max()].reshape(-1, 2)
    _, first, number = np.unique(np.round(flat / _SAME), axis=0, return_index=True, return_inverse=True)
    return flat[first], number.reshape(-1, 3)


def _lines(corners: np.ndarray, fronts: np.ndarray, most: float) -> list[tuple[np.ndarray, float]]:
    """Lines that divide a wall, as unit normals and offsets: strips along every front, columns across a single one."""
    along = fronts[:, 1] - fronts[:, 0]
    along = along / np.sqrt((along**2).sum(axis=1, keepdims=True))
    inward = along[:, ::-1] * [-1.0, 1.0]
    start = (inward * fronts[:, 0]).sum(axis=1)
    lines, used = [], []
    for normal, offset in zip(inward, start):
        if any(abs(offset - o) + np.abs(normal - n).sum() < 1e-6 for n, o in used):
            continue
        used.append((normal, offset))
        depth = (corners @ normal).max() - offset
        opposite = [-o - offset for n, o in zip(inward, start) if (n * normal).sum() < -1.0 + 1e-6]
        depth = min([depth, *(gap / 2.0 for gap in opposite if gap > 0.0)])
        shares = (np.arange(1, _STRIPS + bool(opposite)) / _STRIPS) ** _POWER
        lines += [(normal, offset + depth * share) for share in shares.tolist()]
    normals = np.array([normal for normal, _ in used])
    straight = np.abs(normals[0, 0] * normals[:, 1] - normals[0, 1] * normals[:, 0]).max() < 1e-6
    if straight:
        across = normals[0, ::-1] * [1.0, -1.0]
        place = corners @ across
        width = np.ptp(place)
        columns = max(_FEWEST_COLUMNS, int(np.ceil(_COLUMNS_A_PANEL * width / most)))
        shares = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, columns) / columns)
        lines += [(across, place.min() + width * share) for share in shares.tolist()]
    return lines


def _split(parts: np.ndarray, count: np.ndarray, normal: np.ndarray, offset: float) -> tuple[np.ndarray, np.ndarray]:
    """Split convex polygons along a line; rows of ``parts`` are filled up to their ``count``."""
    height = parts[..., 0] * normal[0] + parts[..., 1] * normal[1] - offset
    height[np.abs(height) < _ROUNDING] = 0.0
    used = np.arange(parts.shape[1]) < count[:, None]
    after = (np.arange(parts.shape[1]) + 1) % count[:, None]
    next_part = np.take_along_axis(parts, np.broadcast_to(after[..., None], parts.shape), axis=1)
    halves = [_half(parts, next_part, sign * height, used, after) for sign in (1.0, -1.0)]
    width = max(half[0].shape[1] for half in halves)
    padded = [np.pad(half[0], ((0, 0), (0, width - half[0].shape[1]), (0, 0))) for half in halves]
    return np.concatenate(padded), np.concatenate([half[1] for half in halves])


def _half(
    parts: np.ndarray, next_part: np.ndarray, height: np.ndarray, used: np.ndarray, after: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """What of polygons lies where the height is positive."""
    next_height = np.take_along_axis(height, after, axis=1)
    cross = used & (height * next_height < 0.0)
    share = height / np.where(cross, height - next_height, 1.0)
    found = np.stack([parts, parts + share[..., None] * (next_part - parts)], axis=2).reshape(len(parts), -1, 2)
    kept = np.stack([used & (height >= 0.0), cross], axis=2).reshape(len(parts), -1)
    order = np.argsort(~kept, axis=1, kind="stable")
    some = (used & (height > 0.0)).any(axis=1)
    count = kept.sum(axis=1)[some]
    found = np.take_along_axis(found, order[..., None], axis=1)[some, : count.max(initial=3)]
    return found, count
