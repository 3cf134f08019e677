# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walk bounds between pairs of parallel planes: k-DOPs (Klosowski et al. 1998), axis-aligned boxes among them.

A piece of wall is bounded along more directions than the DOP has (its own normal, across its front): along those, the
walk's extent is bounded by writing the direction as a non-negative sum of the DOP's axes.
"""

import itertools

import numpy as np
import warp as wp

from .bounds_kind import RANGE, ROUNDING, UNBOUNDED, BoundsKind

wp.set_module_options({"enable_backward": False})


_MARGIN = 1.0e-5
"""Added around pieces: more than float32 rounds off where they are compared with walks."""


@wp.struct
class PieceSlabs:
    """Bounds of new pieces of wall: levels of the DOP's planes, and extents along further directions.

    ``level`` has the 2 n levels of one piece after those of another: a walk may meet it only if, for each axis k of n,
    the walk's low is at most level k and its negated high at most level n + k. Direction m of piece i is the sum over a
    of weight[i, d m + a] times the normal of half_space[i, d m + a], in dimension d; ``low[i, m]`` is the piece's least
    coordinate along it.
    """

    level: wp.array[wp.int32]
    half_space: wp.array2d[wp.int32]
    weight: wp.array2d[float]
    low: wp.array2d[float]
    count: int


def make_dop(*, dimension: int, bits: int, side: float = 1.0, diagonals: bool, corner: float = 0.0) -> BoundsKind:
    """Make the DOP of some of the axes x, x + y and x + y + z, and all that are like them.

    Args:
        dimension: 2 or 3.
        bits: Bits of a quantised plane; as many planes as fit share a word of 32.
        side: Factor of the axes like x.
        diagonals: Whether there are axes like x + y.
        corner: Factor of the axes like x + y + z; 0 for none.
    """
    axes = _axes(dimension, side, diagonals, corner)
    axis_count = len(axes)
    plane_count = 2 * axis_count
    word_count = -(-plane_count // (32 // bits))
    highest_level = (1 << bits) - 1
    quantum = 2.0 * RANGE / highest_level
    # Planes are moved outward by one of the fine levels before they are rounded: far more than float32 rounds off.
    slack = min(1.0, 2.0 * RANGE / 65535.0 / quantum)
    axis_lengths = wp.types.vector(length=axis_count, dtype=float)(*np.linalg.norm(axes, axis=1).tolist())
    Values = wp.types.vector(length=axis_count, dtype=float)
    Extents = wp.types.vector(length=plane_count, dtype=float)
    Quantized = wp.types.vector(length=word_count, dtype=wp.uint32)

    @wp.func
    def along_axes(x: wp.vec3) -> Values:
        """Coordinates of a point along the axes, in the order of ``_axes``; without a product where there is none."""
        values = Values()
        for k in range(wp.static(dimension)):
            values[k] = wp.static(side) * x[k]
        if wp.static(diagonals):
            values[wp.static(dimension)] = x[0] + x[1]
            values[wp.static(dimension + 1)] = x[0] - x[1]
            if wp.static(dimension == 3):
                values[5] = x[0] + x[2]
                values[6] = x[0] - x[2]
                values[7] = x[1] + x[2]
                values[8] = x[1] - x[2]
        if wp.static(corner > 0.0):
            values[9] = wp.static(corner) * (x[0] + x[1] + x[2])
            values[10] = wp.static(corner) * (x[0] + x[1] - x[2])
            values[11] = wp.static(corner) * (x[0] - x[1] + x[2])
            values[12] = wp.static(corner) * (x[0] - x[1] - x[2])
        return values

    @wp.func
    def level_of(bounds: Quantized, k: int) -> int:
        """Level of plane ``k``: word ``k`` modulo the number of words holds it."""
        shift = wp.uint32(wp.static(bits) * (k // wp.static(word_count)))
        return int((bounds[k % wp.static(word_count)] >> shift) & wp.uint32(wp.static(highest_level)))

    @wp.func
    def add_level(bounds: Quantized, k: int, level: int) -> Quantized:
        """Write the level of plane ``k`` where there was none."""
        word = k % wp.static(word_count)
        bounds[word] = bounds[word] | (wp.uint32(level) << wp.uint32(wp.static(bits) * (k // wp.static(word_count))))
        return bounds

    @wp.func
    def empty() -> Extents:
        """Lows and negated highs of nothing; both grow downward."""
        return Extents(UNBOUNDED)

    @wp.func
    def extend(extents: Extents, x: wp.vec3, sphere_radius: float) -> Extents:
        """Grow by a sphere."""
        values = along_axes(x)
        radii = (sphere_radius + ROUNDING) * wp.static(axis_lengths)
        for k in range(wp.static(axis_count)):
            extents[k] = wp.min(extents[k], values[k] - radii[k])
            extents[k + wp.static(axis_count)] = wp.min(extents[k + wp.static(axis_count)], -values[k] - radii[k])
        return extents

    @wp.func
    def level_below(plane: float) -> int:
        """The level outward of a plane; 0 is no plane at all, so that what lies outside of the range is held."""
        level = wp.floor((plane + wp.static(RANGE)) / wp.static(quantum) - wp.static(slack))
        return int(wp.clamp(level, 0.0, wp.static(float(highest_level))))

    @wp.func
    def quantize(extents: Extents) -> Quantized:
        """Round every plane outward."""
        result = Quantized()
        for k in range(wp.static(axis_count)):
            result = add_level(result, k, level_below(extents[k]))
            high = k + wp.static(axis_count)
            result = add_level(result, high, level_below(extents[high]))
        return result

    @wp.func
    def plane_of(bounds: Quantized, k: int) -> float:
        """Plane ``k`` that is stored."""
        level = level_of(bounds, k)
        if level == 0:
            return -UNBOUNDED
        return float(level) * wp.static(quantum) - wp.static(RANGE)

    @wp.func
    def dequantize(bounds: Quantized) -> Extents:
        """The planes that are stored."""
        extents = Extents()
        for k in range(wp.static(plane_count)):
            extents[k] = plane_of(bounds, k)
        return extents

    @wp.func
    def merge(a: Quantized, b: Quantized) -> Quantized:
        """Bounds of everything that two bounds hold: those of the union, to the bit."""
        result = Quantized()
        for k in range(wp.static(plane_count)):
            result = add_level(result, k, wp.min(level_of(a, k), level_of(b, k)))
        return result

    @wp.func
    def overlaps_piece(bounds: Quantized, pieces: PieceSlabs, i: int) -> bool:
        """Whether a walk may meet piece ``i``."""
        first = i * wp.static(plane_count)
        for k in range(wp.static(axis_count)):
            if level_of(bounds, k) > pieces.level[first + k]:
                return False
            high = k + wp.static(axis_count)
            if level_of(bounds, high) > pieces.level[first + high]:
                return False
        for m in range(pieces.low.shape[1]):
            highest = float(0.0)
            for a in range(wp.static(dimension)):
                column = wp.static(dimension) * m + a
                highest -= pieces.weight[i, column] * plane_of(bounds, pieces.half_space[i, column])
            if highest < pieces.low[i, m]:
                return False
        return True

    @wp.func
    def overlaps_any(bounds: Quantized, pieces: PieceSlabs) -> bool:
        """Whether a walk may meet any piece."""
        result = bool(False)
        for i in range(pieces.count):
            if not result:
                result = overlaps_piece(bounds, pieces, i)
        return result

    def unpack(rows: np.ndarray) -> np.ndarray:
        """Levels of walks, shape (walk_count, plane_count)."""
        planes = np.arange(plane_count)
        shift = (bits * (planes // word_count)).astype(np.uint32)
        return ((rows[:, planes % word_count] >> shift) & np.uint32(highest_level)).astype(np.uint16)

    decompose = _Decomposition(axes, dimension)

    def bound_pieces(polygons: list[np.ndarray], directions: list[np.ndarray], device: wp.Device) -> PieceSlabs:
        """Bound planar pieces; see ``BoundsKind``."""
        levels, half_spaces, weights, lows = [], [], [], []
        for polygon, along in zip(polygons, directions, strict=True):
            values = polygon @ axes.T
            # A walk's low must not exceed the piece's high, nor its negated high the negated low.
            planes = np.concatenate([values.max(axis=0), -values.min(axis=0)]) + _MARGIN
            levels.append(np.clip(np.floor((planes + RANGE) / quantum), 0, highest_level))
            both_ways = np.concatenate([along, -along])
            chosen = [decompose(direction) for direction in both_ways]
            half_spaces.append(np.concatenate([c[0] for c in chosen]))
            weights.append(np.concatenate([c[1] for c in chosen]))
            lows.append((polygon @ both_ways.T).min(axis=0) - _MARGIN)
        pieces = PieceSlabs()
        pieces.count = len(polygons)
        if polygons:
            for name, rows, dtype in (
                ("level", np.concatenate(levels), wp.int32),
                ("half_space", half_spaces, wp.int32),
                ("weight", weights, float),
                ("low", lows, float),
            ):
                setattr(pieces, name, wp.array(np.array(rows), dtype=dtype, device=device))
        return pieces

    return BoundsKind(
        Quantized, Extents, PieceSlabs, empty, extend, quantize, dequantize, merge, overlaps_any, bound_pieces, unpack
    )


def _axes(dimension: int, side: float, diagonals: bool, corner: float) -> np.ndarray:
    """A DOP's axes, shape (axis_count, 3); see ``make_dop``."""
    families = [side * np.eye(3)[:dimension]]
    if diagonals:
        pairs = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]]
        families.append(np.array(pairs[: 2 if dimension == 2 else 6], dtype=np.float64))
    if corner > 0.0:
        families.append(corner * np.array([[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]]))
    return np.concatenate(families)


class _Decomposition:
    """Directions as the tightest non-negative sums of as many half-spaces' normals as there are dimensions.

    Tight means that the weights times the normals' lengths sum to least, which bounds a sphere best. Half-space k < n
    is the low along axis k, whose normal is the negated axis; half-space k + n is the high.
    """

    def __init__(self, axes: np.ndarray, dimension: int) -> None:
        normals = np.concatenate([-axes, axes])[:, :dimension]
        groups = np.array(list(itertools.combinations(range(len(normals)), dimension)))
        bases = normals[groups].transpose(0, 2, 1)
        regular = np.abs(np.linalg.det(bases)) > 1.0e-9
        self._groups = groups[regular]
        self._inverses = np.linalg.inv(bases[regular])
        self._lengths = np.linalg.norm(normals, axis=1)[self._groups]

    def __call__(self, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Half-spaces and weights of a direction, shape (dimension,) each."""
        weights = self._inverses @ direction[: self._inverses.shape[1]]
        cost = (weights * self._lengths).sum(axis=1)
        cost[(weights < -1.0e-9).any(axis=1)] = np.inf
        best = int(np.argmin(cost))
        return self._groups[best], np.maximum(weights[best], 0.0)
