# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arguments that make a cage or an edit of one, checked before anything changes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def as_number(value: float, what: str) -> float:
    """A number, which may be infinite.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is nan.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a number, got {value!r}") from None
    if np.isnan(number):
        raise ValueError(f"{what} must be a number, got nan")
    return number


def as_vertices(vertices: np.ndarray) -> np.ndarray:
    """Positions of a cage's vertices, as an array of their own in float64, shape (vertex_count, dimension) [m].

    Args:
        vertices: What was passed.

    Raises:
        TypeError: If it is not numbers.
        ValueError: If it has not two or three columns.
    """
    try:
        positions = np.array(vertices, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"vertices must be numbers of shape (vertex_count, 3) or (vertex_count, 2): {error}") from None
    if positions.ndim != 2 or positions.shape[1] not in (2, 3):
        raise ValueError(f"vertices must have shape (vertex_count, 3), or (vertex_count, 2), got {positions.shape}")
    return positions


def as_loops(faces: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """The faces of a cage as flat arrays: starts, shape (face_count + 1,), and vertex ids, shape (half_edge_count,).

    Args:
        faces: What was passed.

    Raises:
        TypeError: If a face is not a sequence of integers.
    """
    loops = [np.asarray(loop) for loop in faces]
    for i, loop in enumerate(loops):
        if loop.ndim != 1 or (len(loop) and not np.issubdtype(loop.dtype, np.integer)):
            raise TypeError(f"face {i} of the cage must be a sequence of integers, got {faces[i]!r}")
    face_start = np.concatenate([[0], np.cumsum([len(loop) for loop in loops], dtype=np.int64)]).astype(np.int64)
    face_vertex = np.concatenate([*loops, np.empty(0, dtype=np.int64)]).astype(np.int64)
    return face_start, face_vertex
