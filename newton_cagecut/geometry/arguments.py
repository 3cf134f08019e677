# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arguments as arrays and numbers of their own, or an error that says what is wrong, where, and what it must be."""

from __future__ import annotations

import operator
from collections.abc import Sequence

import numpy as np

_COUNTS = {2: "two numbers", 3: "three numbers"}


def as_number(value: float, what: str, *, limits: tuple[float, float] | None = None) -> float:
    """A number, which may be infinite where there are no limits.

    Args:
        value: What was passed.
        what: What it is, for the error.
        limits: The least and the greatest number that it may be.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is nan or not within the limits.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a number, got {value!r}") from None
    _check_within(number, what, limits)
    if np.isnan(number):
        raise ValueError(f"{what} must be a number, got nan")
    return number


def as_length(value: float, what: str) -> float:
    """A positive, finite length [m].

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is not positive or not finite.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a length [m], got {value!r}") from None
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"{what} must be positive, got {number} m")
    return number


def as_index(value: int, what: str, *, limits: tuple[int, int] | None = None) -> int:
    """An integer.

    Args:
        value: What was passed.
        what: What it is, for the error.
        limits: The least and the greatest integer that it may be.

    Raises:
        TypeError: If it is not an integer.
        ValueError: If it is not within the limits.
    """
    try:
        index = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} must be an integer, got {value!r}") from None
    _check_within(index, what, limits)
    return index


def as_vector(value: np.ndarray, what: str, *, dimension: int | None = None) -> np.ndarray:
    """A vector of finite numbers, shape (dimension,).

    Args:
        value: What was passed.
        what: What it is, for the error.
        dimension: How many numbers there must be, as the origin that comes with it has; None for an origin itself, of
            two or three.

    Raises:
        TypeError: If it is not numbers.
        ValueError: If they are too many, too few or not finite.
    """
    try:
        vector = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        numbers = _COUNTS.get(dimension, "three numbers, or two in the plane")
        raise TypeError(f"{what} must be {numbers}, got {value!r}") from None
    if not np.isfinite(vector).all():
        raise ValueError(f"{what} is not finite: {vector.tolist()}")
    if vector.shape not in ([(2,), (3,)] if dimension is None else [(dimension,)]):
        shape = "(3,), or (2,) in the plane" if dimension is None else f"({dimension},), as its origin has"
        raise ValueError(f"{what} must have shape {shape}, got {vector.shape}")
    return vector


def as_points(values: np.ndarray, what: str, *, rows: str, widths: tuple[int, ...]) -> np.ndarray:
    """Rows of numbers, shape (count, width); they may be not finite.

    Args:
        values: What was passed.
        what: What it is, for the error.
        rows: Name of the number of rows, for the error.
        widths: Numbers that a row may have.

    Raises:
        TypeError: If it is not numbers.
        ValueError: If it is no table of a width.
    """
    shape = ", or ".join(f"({rows}, {width})" for width in widths)
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{what} must be numbers of shape {shape}: {error}") from None
    if array.ndim != 2 or array.shape[1] not in widths:
        raise ValueError(f"{what} must have shape {shape}, got {array.shape}")
    return array


def check_finite(rows: np.ndarray, what: str) -> None:
    """Check that all numbers of a table are finite.

    Args:
        rows: The table, shape (count, width).
        what: What it is, for the error.

    Raises:
        ValueError: If one is not.
    """
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if len(bad):
        raise ValueError(f"{what}: row {bad[0]} is not finite: {rows[bad[0]].tolist()}")


def as_integers(values: np.ndarray, what: str, *, shape: tuple[int | str, ...]) -> np.ndarray:
    """Integers of a shape, as they are.

    Args:
        values: What was passed.
        what: What it is, for the error.
        shape: The shape, with a name in the place of a number that may be any but 0.

    Raises:
        TypeError: If it is not integers.
        ValueError: If it has another shape.
    """
    array = np.asarray(values)
    if not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"{what} must be integers, got {array.dtype}")
    fits = len(array.shape) == len(shape)
    fits = fits and all(have > 0 if isinstance(want, str) else have == want for have, want in zip(array.shape, shape))
    if not fits:
        wanted = ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "")
        raise ValueError(f"{what} must have shape ({wanted}), got {array.shape}")
    return array


def as_loops(loops: Sequence[Sequence[int]], of: str) -> tuple[np.ndarray, np.ndarray]:
    """Faces as flat arrays: starts, shape (face_count + 1,), and vertex ids, shape (half_edge_count,).

    Args:
        loops: What was passed.
        of: What has the faces, for the error.

    Raises:
        TypeError: If a face is not a sequence of integers.
    """
    arrays = [np.asarray(loop) for loop in loops]
    for i, loop in enumerate(arrays):
        if loop.ndim != 1 or (len(loop) and not np.issubdtype(loop.dtype, np.integer)):
            raise TypeError(f"face {i} of {of} must be a sequence of integers, got {loops[i]!r}")
    face_start = np.concatenate([[0], np.cumsum([len(loop) for loop in arrays], dtype=np.int64)]).astype(np.int64)
    face_vertex = np.concatenate([*arrays, np.empty(0, dtype=np.int64)]).astype(np.int64)
    return face_start, face_vertex


def _check_within(number: float, what: str, limits: tuple[float, float] | None) -> None:
    if limits is not None and not limits[0] <= number <= limits[1]:
        raise ValueError(f"{what} must lie between {limits[0]} and {limits[1]}, got {number}")
