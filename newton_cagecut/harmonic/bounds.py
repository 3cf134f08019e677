# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Bounds of whole walks: 18-DOPs, 36 bytes a walk, and their test against a new piece of cut.

A walk is kept as it is when none of its spheres meets the new wall (paper, section 4.1). Its k-DOP (Klosowski et al.
1998) holds every sphere, the last one included, plus a rounding margin, and is quantised outward to 16 bits a plane.
The test is conservative: it may send a walk to be walked again for nothing, never the other way round.

A piece of cut is bounded along more directions than the DOP has (the plane's own normal, the front): along those, the
walk's extent is bounded by writing the direction as a non-negative sum of the DOP's axes.
"""

from __future__ import annotations

import itertools

import numpy as np
import warp as wp

wp.set_module_options({"enable_backward": False})

AXIS_COUNT = 9
AXES = np.array(
    [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]],
    dtype=np.float64,
)
"""The DOP's axes, not normalised: sums and differences of coordinates are exact enough and cost no products."""

_AXIS_LENGTHS = np.linalg.norm(AXES, axis=1)
_RANGE = 2.25
_LEVELS = 65535

_QUANTUM = wp.constant(2.0 * _RANGE / _LEVELS)
_LOWEST = wp.constant(-_RANGE)
_ROUNDING = wp.constant(4.0e-6)

Extents = wp.types.vector(length=2 * AXIS_COUNT, dtype=float)
"""Extents along the axes: the lows, then the negated highs, so that both grow downward."""

QuantizedExtents = wp.types.vector(length=2 * AXIS_COUNT, dtype=wp.uint16)

DIAGONAL = wp.constant(1.4142135623730951)


@wp.func
def empty_extents() -> Extents:
    """Extents of nothing."""
    extents = Extents()
    for k in range(wp.static(2 * AXIS_COUNT)):
        extents[k] = 1.0e30
    return extents


@wp.func
def extend_axis(extents: Extents, axis: int, value: float, radius: float) -> Extents:
    """Grow along one axis by an interval."""
    extents[axis] = wp.min(extents[axis], value - radius)
    extents[axis + 9] = wp.min(extents[axis + 9], -value - radius)
    return extents


@wp.func
def extend(extents: Extents, x: wp.vec3, sphere_radius: float) -> Extents:
    """Grow by a sphere."""
    radius = sphere_radius + _ROUNDING
    diagonal = DIAGONAL * radius
    extents = extend_axis(extents, 0, x[0], radius)
    extents = extend_axis(extents, 1, x[1], radius)
    extents = extend_axis(extents, 2, x[2], radius)
    extents = extend_axis(extents, 3, x[0] + x[1], diagonal)
    extents = extend_axis(extents, 4, x[0] - x[1], diagonal)
    extents = extend_axis(extents, 5, x[0] + x[2], diagonal)
    extents = extend_axis(extents, 6, x[0] - x[2], diagonal)
    extents = extend_axis(extents, 7, x[1] + x[2], diagonal)
    extents = extend_axis(extents, 8, x[1] - x[2], diagonal)
    return extents


@wp.func
def quantize(extents: Extents) -> QuantizedExtents:
    """Round outward to 16 bits a plane."""
    result = QuantizedExtents()
    for k in range(wp.static(2 * AXIS_COUNT)):
        level = wp.floor((extents[k] - _LOWEST) / _QUANTUM) - 1.0
        result[k] = wp.uint16(int(wp.clamp(level, 0.0, 65535.0)))
    return result


@wp.func
def dequantize(level: wp.uint16) -> float:
    """The plane that a level stands for."""
    return _LOWEST + float(int(level)) * _QUANTUM


@wp.struct
class PieceBounds:
    """Bounds of new pieces of cut, a row each: quantised DOP and extents along further directions.

    Direction m of piece i is sum_a weight[i, 3 m + a] * plane[i, 3 m + a] over three of the DOP's 18 half-spaces;
    ``low[i, m]`` is the piece's least coordinate along it.
    """

    extents: wp.array[QuantizedExtents]
    plane: wp.array2d[wp.int32]
    weight: wp.array2d[float]
    low: wp.array2d[float]
    count: int


@wp.func
def overlaps_piece(bounds: QuantizedExtents, pieces: PieceBounds, i: int) -> bool:
    """Whether a walk's DOP may meet piece ``i``."""
    piece = pieces.extents[i]
    for k in range(wp.static(AXIS_COUNT)):
        # low_walk <= high_piece and low_piece <= high_walk, with negated highs: low + (-high) <= 0
        if dequantize(bounds[k]) + dequantize(piece[k + 9]) > 0.0:
            return False
        if dequantize(piece[k]) + dequantize(bounds[k + 9]) > 0.0:
            return False
    for m in range(pieces.low.shape[1]):
        highest = float(0.0)
        for a in range(3):
            k = pieces.plane[i, 3 * m + a]
            highest -= pieces.weight[i, 3 * m + a] * dequantize(bounds[k])
        if highest < pieces.low[i, m]:
            return False
    return True


@wp.func
def overlaps_any(bounds: QuantizedExtents, pieces: PieceBounds) -> bool:
    """Whether a walk's DOP may meet any piece."""
    result = bool(False)
    for i in range(pieces.count):
        if not result:
            result = overlaps_piece(bounds, pieces, i)
    return result


def bound_pieces(polygons: list[np.ndarray], directions: list[np.ndarray], device: wp.context.Device) -> PieceBounds:
    """Bound convex or other planar pieces for the test against walks.

    Args:
        polygons: Corners of each piece in the unit frame, shape (k, 3) each.
        directions: Further directions to bound each piece along, both ways, shape (m, 3) each.
        device: Where to put them.
    """
    extents, planes, weights, lows = [], [], [], []
    for polygon, along in zip(polygons, directions, strict=True):
        values = polygon @ AXES.T
        rows = np.concatenate([values.min(axis=0), -values.max(axis=0)]) - 1.0e-6
        extents.append(np.clip(np.floor((rows + _RANGE) / (2.0 * _RANGE / _LEVELS)) - 1.0, 0, _LEVELS))
        both_ways = np.concatenate([along, -along])
        chosen = [_decompose(direction) for direction in both_ways]
        planes.append(np.concatenate([c[0] for c in chosen]))
        weights.append(np.concatenate([c[1] for c in chosen]))
        lows.append((polygon @ both_ways.T).min(axis=0) - 1.0e-5)
    pieces = PieceBounds()
    pieces.count = len(polygons)
    if polygons:
        pieces.extents = wp.array(np.array(extents, dtype=np.uint16), dtype=QuantizedExtents, device=device)
        pieces.plane = wp.array(np.array(planes, dtype=np.int32), dtype=wp.int32, device=device)
        pieces.weight = wp.array(np.array(weights, dtype=np.float32), dtype=float, device=device)
        pieces.low = wp.array(np.array(lows, dtype=np.float32), dtype=float, device=device)
    return pieces


def _decompose(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The tightest non-negative combination of three half-space normals that gives ``direction``.

    Tight means that the weights times the normals' lengths sum to least, which bounds a sphere best.
    """
    weights = np.einsum("tij,j->ti", _TRIPLE_INVERSES, direction)
    cost = np.einsum("ti,ti->t", weights, _TRIPLE_LENGTHS)
    cost[(weights < -1.0e-9).any(axis=1)] = np.inf
    best = int(np.argmin(cost))
    return _TRIPLES[best], np.maximum(weights[best], 0.0)


def _independent_triples() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    half_spaces = np.concatenate([-AXES, AXES])
    lengths = np.concatenate([_AXIS_LENGTHS, _AXIS_LENGTHS])
    triples = np.array(list(itertools.combinations(range(2 * AXIS_COUNT), 3)))
    bases = half_spaces[triples].transpose(0, 2, 1)
    regular = np.abs(np.linalg.det(bases)) > 1.0e-9
    return triples[regular], np.linalg.inv(bases[regular]), lengths[triples[regular]]


_TRIPLES, _TRIPLE_INVERSES, _TRIPLE_LENGTHS = _independent_triples()
