# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arguments as arrays of their own, or an error that says what is wrong, where, and what they must be."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .arguments import is_number, shown

_COUNTS = {2: "two numbers", 3: "three numbers"}


def as_floats(values: object, wanted: str) -> np.ndarray:
    """Numbers as a new array of float64, of any shape.

    Args:
        values: What was passed.
        wanted: What they are and must be, for the error.

    Raises:
        TypeError: If they are not numbers, or rows differ in length.
    """
    try:
        array = np.asarray(values)
        if array.dtype.kind == "O" and array.size and all(is_number(value) for value in array.flat):
            return array.astype(np.float64)
        if array.dtype.kind in "iuf":
            return np.array(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    raise TypeError(f"{wanted}, got {shown(values)}")


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
    vector = as_floats(value, f"{what} must be {_COUNTS.get(dimension, 'three numbers, or two in the plane')}")
    if not np.isfinite(vector).all():
        raise ValueError(f"{what} is not finite: {vector.tolist()}")
    if vector.shape not in ([(2,), (3,)] if dimension is None else [(dimension,)]):
        shape = "(3,), or (2,) in the plane" if dimension is None else f"({dimension},), as its origin has"
        raise ValueError(f"{what} must have shape {shape}, got {vector.shape}")
    return vector


def as_numbers(values: Sequence[float], what: str, count: int, *, kind: str) -> np.ndarray:
    """Finite numbers, shape (count,).

    Args:
        values: What was passed.
        what: What they are, for the error.
        count: How many there must be.
        kind: What they must be, for the error.

    Raises:
        TypeError: If they are not as many numbers.
        ValueError: If one is not finite.
    """
    array = as_floats(values, f"{what} must be {kind}")
    if array.shape != (count,):
        raise TypeError(f"{what} must be {kind}, got {shown(values)}")
    if not np.isfinite(array).all():
        raise ValueError(f"{what} is not finite: {array.tolist()}")
    return array


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
    array = as_floats(values, f"{what} must be numbers of shape {shape}")
    if array.ndim != 2 or array.shape[1] not in widths:
        raise ValueError(f"{what} must have shape {shape}, got {array.shape}")
    return array


def check_finite(rows: np.ndarray, what: str, *, row: str = "row") -> None:
    """Check that all numbers of a table are finite.

    Args:
        rows: The table, shape (count, width).
        what: What it is, for the error.
        row: What a row of it is, for the error.

    Raises:
        ValueError: If one is not.
    """
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if len(bad):
        raise ValueError(f"{what}: {row} {bad[0]} is not finite: {rows[bad[0]].tolist()}")


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
    array = _as_array(values, f"{what} must be integers")
    if not np.issubdtype(array.dtype, np.integer):
        got = shown(values) if array.dtype.kind in "OSU" else array.dtype
        raise TypeError(f"{what} must be integers, got {got}")
    fits = len(array.shape) == len(shape)
    fits = fits and all(have > 0 if isinstance(want, str) else have == want for have, want in zip(array.shape, shape))
    if not fits:
        wanted = ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "")
        raise ValueError(f"{what} must have shape ({wanted}), got {array.shape}")
    return array


def as_indices(values: Sequence[int], what: str, *, of: str, limit: int | None = None) -> np.ndarray:
    """Indices in a row, shape (count,), int64; none is good too.

    Args:
        values: What was passed.
        what: What they are, for the error.
        of: What they count, one of it, for the error.
        limit: How many there are; None where that is not known.

    Raises:
        TypeError: If they are not integers.
        ValueError: If they are not in a row, or one is negative or beyond the limit.
    """
    array = _as_array(values, f"{what} must be integers")
    if array.shape == (0,):
        return np.zeros(0, dtype=np.int64)
    array = as_integers(values, what, shape=("n",))
    wrong = array[(array < 0) | (array >= (np.iinfo(np.int64).max if limit is None else limit))]
    if len(wrong):
        there = "they count from 0" if limit is None else f"there are {limit}, counted from 0"
        raise ValueError(f"{what}: {wrong[0]} is no {of}; {there}")
    return array.astype(np.int64)


def as_loops(loops: Sequence[Sequence[int]], of: str) -> tuple[np.ndarray, np.ndarray]:
    """Faces as flat arrays: starts, shape (face_count + 1,), and vertex ids, shape (half_edge_count,).

    Args:
        loops: What was passed.
        of: What has the faces, for the error.

    Raises:
        TypeError: If it is no sequence, or a face is not a sequence of integers.
    """
    is_row = hasattr(loops, "__iter__") and getattr(loops, "ndim", 2) > 0
    if not is_row or isinstance(loops, str | bytes | dict | type):
        raise TypeError(f"faces of {of} must be a sequence of faces, each one of integers, got {shown(loops)}")
    loops = list(loops)
    arrays = [_as_array(loop, f"face {i} of {of} must be a sequence of integers") for i, loop in enumerate(loops)]
    for i, loop in enumerate(arrays):
        if loop.ndim != 1 or (len(loop) and not np.issubdtype(loop.dtype, np.integer)):
            raise TypeError(f"face {i} of {of} must be a sequence of integers, got {shown(loops[i])}")
    face_start = np.concatenate([[0], np.cumsum([len(loop) for loop in arrays], dtype=np.int64)]).astype(np.int64)
    face_vertex = np.concatenate([*arrays, np.empty(0, dtype=np.int64)]).astype(np.int64)
    return face_start, face_vertex


def _as_array(values: object, wanted: str) -> np.ndarray:
    """An array of whatever was passed, if it is one at all."""
    try:
        return np.asarray(values)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{wanted}, got {shown(values)}") from None
