# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arrays of the user that belong to points, corners or triangles of a surface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

PLACES = ("point", "corner", "triangle")
"""What the rows of an array may belong to; a corner array has a row of three for each triangle."""

_KINDS = "biuf"


@dataclass(frozen=True, eq=False)
class Attributes:
    """Arrays by name: shapes (point_count, ...), (triangle_count, 3, ...) and (triangle_count, ...)."""

    point: Mapping[str, np.ndarray] = field(default_factory=dict)
    """Arrays of points."""
    corner: Mapping[str, np.ndarray] = field(default_factory=dict)
    """Arrays of corners."""
    triangle: Mapping[str, np.ndarray] = field(default_factory=dict)
    """Arrays of triangles."""

    @classmethod
    def of(cls, data: Mapping[str, object] | None, point_count: int, triangle_count: int) -> Attributes:
        """Check arrays, and tell from their shapes what they belong to.

        Args:
            data: Arrays by name, or pairs of "point", "corner" or "triangle" and an array; None for none.
            point_count: Number of points.
            triangle_count: Number of triangles.

        Raises:
            TypeError: If it is no mapping of names, or an array is not of numbers.
            ValueError: If a shape is of none of the three, or could be of two.
        """
        if data is None:
            return cls()
        if not isinstance(data, Mapping):
            raise TypeError(f"data must be a dictionary of arrays by name, got {type(data).__name__}")
        found: dict[str, dict[str, np.ndarray]] = {place: {} for place in PLACES}
        for name, value in data.items():
            if not (isinstance(name, str) and name):
                raise TypeError(f"the names of data must be strings, got {name!r}")
            place, array = _placed(name, value, point_count, triangle_count)
            array.setflags(write=False)
            found[place][name] = array
        return cls(**found)

    def __bool__(self) -> bool:
        return bool(self.point or self.corner or self.triangle)

    def merged(self) -> Mapping[str, np.ndarray]:
        """All arrays by name, read-only."""
        return MappingProxyType({**self.point, **self.corner, **self.triangle})

    def mapped(
        self,
        *,
        point: Callable[[np.ndarray], np.ndarray],
        corner: Callable[[np.ndarray], np.ndarray],
        triangle: Callable[[np.ndarray], np.ndarray],
    ) -> Attributes:
        """The arrays, each put through what is done to those of its place; the results cannot be written to."""
        parts = {}
        for place, change in (("point", point), ("corner", corner), ("triangle", triangle)):
            parts[place] = {name: change(array) for name, array in getattr(self, place).items()}
            for array in parts[place].values():
                array.setflags(write=False)
        return Attributes(**parts)


def mixed(values: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Sums of rows of values, weighted; of whole numbers and flags those of the largest share.

    Args:
        values: Shape (..., count, *width).
        shares: Weights that sum to one, shape (..., count).

    Returns:
        Shape (..., *width), of the values' type.
    """
    axis = shares.ndim - 1
    wide = shares.reshape(shares.shape + (1,) * (values.ndim - shares.ndim))
    if values.dtype.kind != "f":
        return np.take_along_axis(values, wide.argmax(axis=axis, keepdims=True), axis=axis).squeeze(axis)
    return (wide * values).sum(axis=axis).astype(values.dtype)


def _placed(name: str, value: object, point_count: int, triangle_count: int) -> tuple[str, np.ndarray]:
    what = f"data {name!r}"
    heads = {"point": (point_count,), "corner": (triangle_count, 3), "triangle": (triangle_count,)}
    wanted = None
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], str):
        wanted, value = value
        if wanted not in heads:
            raise ValueError(f"{what} belongs to {wanted!r}; it can be to 'point', 'corner' or 'triangle'")
    try:
        array = np.array(value)
    except ValueError as error:
        raise TypeError(f"{what} must be an array of numbers: {error}") from None
    if array.dtype.kind not in _KINDS:
        raise TypeError(f"{what} must be an array of numbers, got {array.dtype}")
    fits = [place for place, head in heads.items() if array.shape[: len(head)] == head]
    if wanted is None and array.ndim > 2 and "corner" in fits:
        fits.remove("triangle")  # vectors of corners are common, matrices of triangles are not
    shapes = (
        f"({point_count}, ...) of points, ({triangle_count}, 3, ...) of corners or ({triangle_count}, ...) of triangles"
    )
    if wanted is not None:
        if wanted not in fits:
            raise ValueError(f"{what} must have the shape {heads[wanted]} and more of its {wanted}s, got {array.shape}")
        return wanted, array
    if not fits:
        raise ValueError(f"{what} must have the shape {shapes}; got {array.shape}")
    if len(fits) > 1:
        raise ValueError(
            f"{what} of shape {array.shape} could belong to each {' or '.join(fits)}; say which: ({fits[0]!r}, array)"
        )
    return fits[0], array
