# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The arguments of a surface, checked."""

from __future__ import annotations

import numpy as np

from ..geometry import as_floats, as_integers, as_number, as_points, check_finite
from .preparing.welding import WELD

_FLAT = 1e-13


def check_flat(corners: np.ndarray, normals: np.ndarray | None) -> None:
    """Refuse triangles that are clockwise, and normals; corners have the shape (triangle_count, 3, 2)."""
    if normals is not None:
        raise ValueError("a flat surface has no normals of its own; leave them out")
    (ax, ay), (bx, by) = np.moveaxis(corners[:, 1:] - corners[:, :1], 0, -1)
    bad = np.flatnonzero(ax * by - ay * bx < -_FLAT * np.ptp(corners, axis=(0, 1)).max() ** 2)
    if len(bad):
        raise ValueError(
            f"triangle {bad[0]} of the flat surface is clockwise ({len(bad)} in all); reverse the order of its points"
        )


def as_rows(values: np.ndarray, name: str, widths: tuple[int, ...]) -> np.ndarray:
    """Rows of finite numbers of the surface."""
    array = as_points(values, f"{name} of the surface", rows="point_count", widths=widths)
    check_finite(array, f"{name} of the surface")
    return array


def as_point_values(values: np.ndarray | None, name: str, width: int, count: int) -> np.ndarray | None:
    """Rows of finite numbers, one a point, or None."""
    if values is None:
        return None
    array = as_rows(values, name, (width,))
    if len(array) != count:
        raise ValueError(f"the surface has {count} points but {len(array)} {name}; give each one")
    return array


def as_uvs(
    values: np.ndarray | None, point_count: int, triangle_count: int
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Texture coordinates of points, or of corners."""
    if values is None:
        return None, None
    array = as_floats(values, "uvs of the surface must be numbers")
    if array.ndim != 3:
        return as_point_values(array, "uvs", 2, point_count), None
    if array.shape != (triangle_count, 3, 2):
        raise ValueError(
            f"uvs of the corners of {triangle_count} triangles must have shape ({triangle_count}, 3, 2), got "
            f"{array.shape}"
        )
    return None, as_rows(array.reshape(-1, 2), "uvs", (2,)).reshape(-1, 3, 2)


def as_weld(weld: float | None, points: np.ndarray) -> float:
    """Distance up to which ends of open edges are joined [m]."""
    if weld is None:
        return WELD * float(np.ptp(points, axis=0).max(initial=0.0))
    return as_number(weld, "weld of the surface")


def as_triangles(values: np.ndarray, point_count: int) -> np.ndarray:
    """Triangles, whose points are there."""
    array = as_integers(values, "triangles of the surface", shape=("triangle_count", 3))
    bad = np.flatnonzero(((array < 0) | (array >= point_count)).any(axis=1))
    if len(bad):
        raise ValueError(
            f"triangle {bad[0]} of the surface is {array[bad[0]].tolist()}, but there are only {point_count} points"
        )
    return array.astype(np.int32)


def as_labels(values: np.ndarray | None, name: str, count: int) -> np.ndarray:
    """Whole numbers, one a row; -1 for None."""
    if values is None:
        return np.full(count, -1, dtype=np.int32)
    return as_integers(values, f"{name} of the surface", shape=(count,)).astype(np.int32)
