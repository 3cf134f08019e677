# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walk bounds by one sphere, grown sphere by sphere: the paper's "1-Sphere" (section 7), small and loose.

A sphere bound has no axes, so pieces of wall are bounded by boxes along directions of their own.
"""

import numpy as np
import warp as wp

from .kind import RANGE, ROUNDING, UNBOUNDED, BoundsKind, make_access

wp.set_module_options({"enable_backward": False})

_LEVELS = wp.constant(65535.0)
_QUANTUM = wp.constant(2.0 * RANGE / 65535.0)
_LOWEST = wp.constant(-RANGE)
_SHARE = wp.constant(1.0e-6)
"""Margin for the rounding of one growth, and of the distance from a piece, relative to the lengths."""


@wp.struct
class PieceBoxes:
    """Bounds of new pieces of wall, a row each: extents along three orthonormal axes, shape (piece_count, 3) each."""

    axis: wp.array2d[wp.vec3]
    low: wp.array2d[float]
    high: wp.array2d[float]
    first_component: int
    first_limit: int
    count: int


@wp.func
def enclose(extents: wp.vec4, x: wp.vec3, radius: float) -> wp.vec4:
    """The least sphere that holds two spheres; the first is centre and radius, which is negative for no sphere."""
    own = extents[3]
    center = wp.vec3(extents[0], extents[1], extents[2])
    offset = x - center
    distance = wp.length(offset)
    if own >= 0.0 and distance + radius <= own:
        return extents
    if own < 0.0 or distance + own <= radius:
        return wp.vec4(x[0], x[1], x[2], radius)
    grown = 0.5 * (distance + own + radius)
    center += offset * ((grown - own) / distance)
    return wp.vec4(center[0], center[1], center[2], grown + _SHARE * (1.0 + grown + wp.length(center)))


@wp.func
def empty() -> wp.vec4:
    """No sphere."""
    return wp.vec4(0.0, 0.0, 0.0, -1.0)


@wp.func
def extend(extents: wp.vec4, x: wp.vec3, sphere_radius: float) -> wp.vec4:
    """Grow by a sphere."""
    return enclose(extents, x, sphere_radius + ROUNDING)


def make_sphere(dimension: int) -> BoundsKind:
    """Make the sphere, or in the plane the circle, that holds a walk.

    Args:
        dimension: 2 or 3.
    """
    Quantized = wp.types.vector(length=dimension + 1, dtype=wp.uint16)

    @wp.func
    def quantize(extents: wp.vec4) -> Quantized:
        """Round the centre, and the radius up by as much and one level more; 0 is no sphere, the last level all."""
        result = Quantized()
        if extents[3] >= 0.0:
            moved = float(0.0)
            for k in range(wp.static(dimension)):
                level = wp.clamp(wp.floor((extents[k] - _LOWEST) / _QUANTUM + 0.5), 0.0, _LEVELS)
                result[k] = wp.uint16(int(level))
                off = extents[k] - (_LOWEST + level * _QUANTUM)
                moved += off * off
            radius = wp.ceil((extents[3] + wp.sqrt(moved)) * (1.0 + _SHARE) / _QUANTUM) + 1.0
            result[wp.static(dimension)] = wp.uint16(int(wp.clamp(radius, 1.0, _LEVELS)))
        return result

    @wp.func
    def dequantize(bounds: Quantized) -> wp.vec4:
        """The sphere that is stored."""
        radius = int(bounds[wp.static(dimension)])
        if radius == 0:
            return empty()
        result = wp.vec4()
        for k in range(wp.static(dimension)):
            result[k] = _LOWEST + float(int(bounds[k])) * _QUANTUM
        result[3] = float(radius) * _QUANTUM
        if radius == int(_LEVELS):
            result[3] = UNBOUNDED
        return result

    @wp.func
    def merge(a: Quantized, b: Quantized) -> Quantized:
        """A sphere that holds two; it depends on how a walk's spheres were shared out between them."""
        if b[wp.static(dimension)] == wp.uint16(0):
            return a
        if a[wp.static(dimension)] == wp.uint16(0):
            return b
        other = dequantize(b)
        return quantize(enclose(dequantize(a), wp.vec3(other[0], other[1], other[2]), other[3]))

    load, store = make_access(Quantized, wp.uint16)

    @wp.func
    def overlaps_any(levels: wp.array2d[wp.uint16], walk: int, pieces: PieceBoxes) -> bool:
        """Whether a walk may meet any piece."""
        sphere = dequantize(load(levels, walk))
        center = wp.vec3(sphere[0], sphere[1], sphere[2])
        reach = sphere[3] * (1.0 + _SHARE)
        result = bool(False)
        for i in range(pieces.count):
            away = float(0.0)
            for m in range(3):
                value = wp.dot(pieces.axis[i, m], center)
                off = wp.max(wp.max(pieces.low[i, m] - value, value - pieces.high[i, m]), 0.0)
                away += off * off
            if reach >= 0.0 and away <= reach * reach:
                result = True
        return result

    functions = (empty, extend, quantize, dequantize, merge, load, store, overlaps_any)
    return BoundsKind(Quantized, wp.vec4, PieceBoxes, *functions, _bound_pieces)


def _bound_pieces(polygons: list[np.ndarray], directions: list[np.ndarray], device: wp.Device) -> PieceBoxes:
    """Bound planar pieces; see ``BoundsKind``."""
    pieces = PieceBoxes()
    pieces.count = len(polygons)
    pieces.first_limit = int(_LEVELS)  # no component of a sphere decides alone
    if polygons:
        axes = [np.linalg.qr(along.T, mode="complete")[0].T for along in directions]
        values = [polygon @ axis.T for polygon, axis in zip(polygons, axes, strict=True)]
        pieces.axis = wp.array(np.array(axes, dtype=np.float32), dtype=wp.vec3, device=device)
        for name, rows in (
            ("low", [value.min(axis=0) - 1.0e-5 for value in values]),
            ("high", [value.max(axis=0) + 1.0e-5 for value in values]),
        ):
            setattr(pieces, name, wp.array(np.array(rows, dtype=np.float32), dtype=float, device=device))
    return pieces
