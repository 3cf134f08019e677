# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Rows of vectors: unit vectors, dot products, normals."""

from __future__ import annotations

import numpy as np


def units(vectors: np.ndarray, length: np.ndarray | None = None, *, least: float = 0.0) -> np.ndarray:
    """Vectors over their lengths; those without length stay as they are, shape (..., dimension).

    Args:
        vectors: Vectors, shape (..., dimension).
        length: Their lengths where they are known, shape (...,).
        least: Length up to which a vector counts as having none.
    """
    if length is None:
        length = np.linalg.norm(vectors, axis=-1)
    return vectors / np.where(length > least, length, 1.0)[..., None]


def dots(vectors: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Dot products by element-wise arithmetic, the same to the last bit wherever a vector stands, shape (count,).

    Args:
        vectors: Vectors, shape (count, dimension).
        axis: The vector to multiply with, shape (dimension,), of two or three numbers.
    """
    total = vectors[:, 0] * axis[0] + vectors[:, 1] * axis[1]
    return total if len(axis) == 2 else total + vectors[:, 2] * axis[2]


def triangle_normals(corners: np.ndarray) -> np.ndarray:
    """Normals of triangles, twice as long as their areas are large, shape (triangle_count, 3).

    Args:
        corners: Triangles, shape (triangle_count, 3, 3).
    """
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
