# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What every kind of walk bounds offers, and the range in which all of them are quantised."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import warp as wp

RANGE = 2.25
"""Coordinates are quantised in [-RANGE, RANGE]: the unit frame's box, its diagonals x + y, and room around them."""

UNBOUNDED = wp.constant(1.0e30)
"""Stands for a bound that lies outside of the range: a walk that reaches there may meet anything."""

ROUNDING = wp.constant(4.0e-6)
"""Added to every sphere's radius, in the unit frame."""


@dataclass(frozen=True, eq=False)
class BoundsKind:
    """One kind of bounding volume of a walk, in one dimension: types, Warp functions and one host function.

    Args:
        Quantized: Warp vector that is stored for a walk, a level a component.
        Extents: Warp vector that a walk keeps in registers.
        PieceBounds: Warp struct with the bounds of new pieces of wall. A walk whose level ``first_component`` exceeds
            its ``first_limit`` meets none of them, which settles most walks with one comparison.
        empty: ``() -> Extents``, the volume of nothing.
        extend: ``(Extents, wp.vec3, float) -> Extents``, grow by a sphere and a rounding margin.
        quantize: ``(Extents) -> Quantized``, round outward.
        dequantize: ``(Quantized) -> Extents``, the volume that is stored.
        merge: ``(Quantized, Quantized) -> Quantized``, a volume that holds both.
        load: ``(levels, walk) -> Quantized``, from levels of shape (size, walk_count): those of one component lie side
            by side, so that a test which one component decides reads no other.
        store: ``(levels, walk, Quantized)``, the other way.
        overlaps_any: ``(levels, walk, PieceBounds) -> bool``, whether a walk's volume may meet any piece.
        bound_pieces: ``(polygons, directions, device) -> PieceBounds``: corners of each planar piece in the unit frame,
            shape (k, 3) each, and further directions to bound each along, both ways, shape (m, 3) each. In the plane
            pieces are segments, of two corners with z = 0.
    """

    Quantized: type
    Extents: type
    PieceBounds: object
    empty: wp.Function
    extend: wp.Function
    quantize: wp.Function
    dequantize: wp.Function
    merge: wp.Function
    load: wp.Function
    store: wp.Function
    overlaps_any: wp.Function
    bound_pieces: Callable[[list[np.ndarray], list[np.ndarray], wp.Device], object]

    @property
    def byte_count(self) -> int:
        """Bytes a walk."""
        return wp.types.type_size_in_bytes(self.Quantized)

    @property
    def level_type(self) -> type:
        """Warp's unsigned integer for one level."""
        return self.Quantized._wp_scalar_type_

    def empty_levels(self, walk_count: int, device: wp.Device) -> wp.array:
        """Reserve the levels of walks, shape (size, walk_count)."""
        return wp.empty((self.Quantized._length_, walk_count), dtype=self.level_type, device=device)


def make_access(Quantized: type, level_type: type) -> tuple[wp.Function, wp.Function]:
    """Make the functions ``load`` and ``store`` of a kind; see ``BoundsKind``."""
    size = Quantized._length_

    @wp.func
    def load(levels: wp.array2d[level_type], walk: int) -> Quantized:
        result = Quantized()
        for k in range(wp.static(size)):
            result[k] = levels[k, walk]
        return result

    @wp.func
    def store(levels: wp.array2d[level_type], walk: int, bounds: Quantized):
        for k in range(wp.static(size)):
            levels[k, walk] = bounds[k]

    return load, store
