# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walk bounds between pairs of parallel planes: k-DOPs (Klosowski et al. 1998), axis-aligned boxes among them.

A piece of wall is bounded along more directions than the DOP has (its own normal, across its front): along those, the
walk's extent is bounded by writing the direction as a non-negative sum of the DOP's axes.
"""

import itertools

import numpy as np
import warp as wp

from .kind import RANGE, ROUNDING, UNBOUNDED, BoundsKind, make_access

wp.set_module_options({"enable_backward": False})


@wp.struct
class PieceSlabs:
    """Bounds of new pieces of wall, a row each: the DOP's planes, and extents along further directions.

    ``limit`` has the last level of each of the DOP's half-spaces that meets the piece, the lows along the axes, then
    the highs; ``order`` lists them, those that most walks fail first. ``first_component`` and ``first_limit`` are a
    half-space for all pieces together. Direction m of piece i is the sum over a of
    weight[i, d m + a] times the normal of half-space[i, d m + a], with the dimension d; ``low[i, m]`` is the piece's
    least coordinate along it.
    """

    limit: wp.array2d[wp.int32]
    order: wp.array2d[wp.int32]
    half_space: wp.array2d[wp.int32]
    weight: wp.array2d[float]
    low: wp.array2d[float]
    first_component: int
    first_limit: int
    count: int


def make_dop(axes: np.ndarray, dimension: int, level_type: type) -> BoundsKind:
    """Make the DOP of some axes.

    Args:
        axes: Axes, of any lengths, along which the unit frame's box lies within the range; shape (axis_count, 3).
        dimension: 2 or 3.
        level_type: Warp's unsigned integer for one quantised plane.
    """
    axis_count = len(axes)
    plane_count = 2 * axis_count
    highest_level = float(np.iinfo(wp.dtype_to_numpy(level_type)).max)
    quantum = 2.0 * RANGE / highest_level
    # Planes are moved outward by one of the fine levels before they are rounded: far more than float32 rounds off.
    slack = min(1.0, 2.0 * RANGE / 65535.0 / quantum)
    axis_matrix = wp.types.matrix(shape=(axis_count, 3), dtype=float)(*axes.reshape(-1).tolist())
    axis_lengths = wp.types.vector(length=axis_count, dtype=float)(*np.linalg.norm(axes, axis=1).tolist())
    Extents = wp.types.vector(length=plane_count, dtype=float)
    Quantized = wp.types.vector(length=plane_count, dtype=level_type)

    @wp.func
    def empty() -> Extents:
        """Lows and negated highs of nothing; both grow downward."""
        return Extents(UNBOUNDED)

    @wp.func
    def extend(extents: Extents, x: wp.vec3, sphere_radius: float) -> Extents:
        """Grow by a sphere."""
        values = wp.static(axis_matrix) * x
        radii = (sphere_radius + ROUNDING) * wp.static(axis_lengths)
        for k in range(wp.static(axis_count)):
            extents[k] = wp.min(extents[k], values[k] - radii[k])
            extents[k + wp.static(axis_count)] = wp.min(extents[k + wp.static(axis_count)], -values[k] - radii[k])
        return extents

    @wp.func
    def quantize(extents: Extents) -> Quantized:
        """Round every plane outward; level 0 is no plane at all, so that what lies outside of the range is held."""
        result = Quantized()
        for k in range(wp.static(plane_count)):
            level = wp.floor((extents[k] + wp.static(RANGE)) / wp.static(quantum) - wp.static(slack))
            result[k] = level_type(int(wp.clamp(level, 0.0, wp.static(highest_level))))
        return result

    @wp.func
    def plane_of(level: level_type) -> float:
        """The plane that a level stands for."""
        number = int(level)
        if number == 0:
            return -UNBOUNDED
        return float(number) * wp.static(quantum) - wp.static(RANGE)

    @wp.func
    def dequantize(bounds: Quantized) -> Extents:
        """The planes that are stored."""
        extents = Extents()
        for k in range(wp.static(plane_count)):
            extents[k] = plane_of(bounds[k])
        return extents

    @wp.func
    def merge(a: Quantized, b: Quantized) -> Quantized:
        """Bounds of everything that two bounds hold: those of the union, to the bit."""
        return wp.min(a, b)

    load, store = make_access(Quantized, level_type)

    @wp.func
    def overlaps_piece(levels: wp.array2d[level_type], walk: int, pieces: PieceSlabs, i: int) -> bool:
        """Whether a walk may meet piece ``i``."""
        for r in range(wp.static(plane_count)):
            k = pieces.order[i, r]
            if int(levels[k, walk]) > pieces.limit[i, k]:
                return False
        for m in range(pieces.low.shape[1]):
            highest = float(0.0)
            for a in range(wp.static(dimension)):
                k = pieces.half_space[i, wp.static(dimension) * m + a]
                highest -= pieces.weight[i, wp.static(dimension) * m + a] * plane_of(levels[k, walk])
            if highest < pieces.low[i, m]:
                return False
        return True

    @wp.func
    def overlaps_any(levels: wp.array2d[level_type], walk: int, pieces: PieceSlabs) -> bool:
        """Whether a walk may meet any piece."""
        result = bool(False)
        for i in range(pieces.count):
            if not result:
                result = overlaps_piece(levels, walk, pieces, i)
        return result

    decompose = _Decomposition(axes, dimension)

    def bound_pieces(polygons: list[np.ndarray], directions: list[np.ndarray], device: wp.Device) -> PieceSlabs:
        """Bound planar pieces; see ``BoundsKind``."""
        limits, orders, half_spaces, weights, lows = [], [], [], [], []
        for polygon, along in zip(polygons, directions, strict=True):
            values = polygon @ axes.T
            # Half-space k of a walk begins at its plane p; the piece ends at r: they are apart where p > r.
            reach = np.concatenate([values.max(axis=0), -values.min(axis=0)]) + 1.0e-5
            limits.append(np.clip(np.floor((reach + RANGE) / quantum) + 1.0, 0.0, highest_level))
            # Most walks stay around the middle: the half-spaces that the piece is farthest out of decide first.
            orders.append(np.argsort(reach / np.tile(np.linalg.norm(axes, axis=1), 2), kind="stable"))
            both_ways = np.concatenate([along, -along])
            chosen = [decompose(direction) for direction in both_ways]
            half_spaces.append(np.concatenate([c[0] for c in chosen]))
            weights.append(np.concatenate([c[1] for c in chosen]))
            lows.append((polygon @ both_ways.T).min(axis=0) - 1.0e-5)
        pieces = PieceSlabs()
        pieces.count = len(polygons)
        if polygons:
            for name, rows in (("limit", limits), ("order", orders), ("half_space", half_spaces)):
                setattr(pieces, name, wp.array(np.array(rows, dtype=np.int32), dtype=wp.int32, device=device))
            together = np.max(limits, axis=0)
            pieces.first_component = int(np.argmin(together))
            pieces.first_limit = int(together[pieces.first_component])
            for name, rows in (("weight", weights), ("low", lows)):
                setattr(pieces, name, wp.array(np.array(rows, dtype=np.float32), dtype=float, device=device))
        return pieces

    functions = (empty, extend, quantize, dequantize, merge, load, store, overlaps_any)
    return BoundsKind(Quantized, Extents, PieceSlabs, *functions, bound_pieces)


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
