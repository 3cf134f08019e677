# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Sums of tabulated residuals over the landings of walks, a thread a point.

For weights the residuals themselves are summed, and their squares. For gradients they are summed as they come, times
the directions in which the walks set out: with radius r of a walk's first sphere, in dimension d, the residual's
gradient is d / r times the mean of that product (Sawhney and Crane 2020; paper, section 6.1).
"""

from functools import cache

import numpy as np
import warp as wp

from ..faces.face_tables import FaceTables, plane_point
from ..walks.landing import KEY_MASK, landing_type, point_functions
from ..walks.random import make_direction
from .layers.products import LANE

wp.set_module_options({"enable_backward": False})

TERMS = {2: 3, 3: 6}
"""Terms of a quadratic function: squares and products of hat functions."""
_OUTER, _INNER = 0.816847572980459, 0.108103018168070
NODES = {
    2: np.array([[0.9, 0.1], [0.5, 0.5], [0.1, 0.9]]),
    3: np.concatenate(
        [(0.5 - 0.5 * own) * np.ones((3, 3)) + (1.5 * own - 0.5) * np.eye(3) for own in (_OUTER, _INNER)]
    ),
}
"""Inner points of panels, by their hat functions; the values there determine a quadratic function."""


@wp.struct
class ResidualCell:
    """A panel: the values of its hat functions at a point of its wall's plane are ``base`` + ``slope`` * point."""

    base: wp.vec3d
    slope: wp.types.matrix(shape=(3, 2), dtype=wp.float64)


@wp.struct
class ResidualTable:
    """Residuals on all faces.

    The panels of face f are cells ``start[f]`` to ``start[f + 1]``. ``terms`` holds what each term of a cell's
    quadratic function counts for every cage vertex, the terms of a cell in consecutive rows.
    """

    start: wp.array[wp.int32]
    cells: wp.array[ResidualCell]
    terms: wp.array2d[LANE]


@wp.struct
class ResidualSums:
    """Sums over the walks of points, a row a point, eight vertices a lane.

    ``sums`` are those of the residuals, ``squares`` of their squares. ``flux_x`` and so on are those of the residuals
    times a component of the walks' first directions, ``directions`` those of the directions.
    """

    sums: wp.array2d[LANE]
    squares: wp.array2d[LANE]
    flux_x: wp.array2d[LANE]
    flux_y: wp.array2d[LANE]
    flux_z: wp.array2d[LANE]
    directions: wp.array[wp.vec3d]


def empty_sums(count: int, lanes: int, device: wp.Device, *, slopes: bool) -> ResidualSums:
    """Sums of nothing.

    Args:
        count: Number of points.
        lanes: Lanes of a row.
        device: Where to put them.
        slopes: Whether those that gradients need are there.
    """
    out = ResidualSums()
    for name in ("sums", "squares"):
        setattr(out, name, wp.zeros((count, lanes), dtype=LANE, device=device))
    for name in ("flux_x", "flux_y", "flux_z"):
        setattr(out, name, wp.zeros((count if slopes else 0, lanes), dtype=LANE, device=device))
    out.directions = wp.zeros(count if slopes else 0, dtype=wp.vec3d, device=device)
    return out


@cache
def make_residual_kernel(dimension: int, *, slopes: bool) -> wp.Kernel:
    """Make the kernel that sums residuals over the landings of points.

    Args:
        dimension: 2 or 3.
        slopes: Whether to sum what gradients need.
    """
    Landings = landing_type(dimension)
    to_space = point_functions(dimension)[0]
    direction = make_direction(dimension)

    @wp.func
    def hats_at(cell: ResidualCell, x: wp.vec2) -> wp.vec3d:
        return cell.base + cell.slope * wp.vec2d(wp.float64(x[0]), wp.float64(x[1]))

    @wp.func
    def least(hats: wp.vec3d) -> wp.float64:
        if wp.static(dimension == 2):
            return wp.min(hats[0], hats[1])
        else:
            return wp.min(wp.min(hats[0], hats[1]), hats[2])

    @wp.func
    def cell_at(table: ResidualTable, face: int, x: wp.vec2) -> int:
        """The cell of a face that a point lies in, or next to."""
        best = table.start[face]
        depth = wp.float64(-1.0e300)
        for cell in range(table.start[face], table.start[face + 1]):
            own = least(hats_at(table.cells[cell], x))
            if own > depth:
                best = cell
                depth = own
                if own >= wp.float64(0.0):
                    break
        return best

    @wp.func
    def residual_at(table: ResidualTable, row: int, lane: int, hats: wp.vec3d) -> LANE:
        residual = LANE()
        for k in range(wp.static(dimension)):
            residual += hats[k] * hats[k] * table.terms[row + k, lane]
        for k in range(wp.static(TERMS[dimension] - dimension)):
            product = hats[k] * hats[(k + 1) % wp.static(dimension)]
            residual += product * table.terms[row + wp.static(dimension) + k, lane]
        return residual

    @wp.kernel(enable_backward=False, module="unique")
    def sum_residuals(
        offset: int,
        points: wp.array[wp.int32],
        walks: int,
        first_point: int,
        seed: wp.uint32,
        faces: FaceTables,
        landings: Landings,
        table: ResidualTable,
        out: ResidualSums,
    ):
        i = offset + wp.tid()
        for number in range(walks):
            walk = (points[i] - first_point) * walks + number
            x = plane_point(faces, (landings.key[walk] & KEY_MASK) // 2, to_space(landings.point[walk]))
            cell = cell_at(table, landings.face[walk], x)
            hats = hats_at(table.cells[cell], x)
            row = cell * wp.static(TERMS[dimension])
            normal = wp.vec3d()
            if wp.static(slopes):
                normal = wp.vec3d(direction(seed, wp.uint32(points[i]), wp.uint32(number), wp.uint32(0)))
                out.directions[i] = out.directions[i] + normal
            for lane in range(out.sums.shape[1]):
                # Read, add, write: "+=" on an array element would be atomic.
                residual = residual_at(table, row, lane, hats)
                total = out.sums[i, lane]
                out.sums[i, lane] = total + residual
                total = out.squares[i, lane]
                out.squares[i, lane] = total + wp.cw_mul(residual, residual)
                if wp.static(slopes):
                    total = out.flux_x[i, lane]
                    out.flux_x[i, lane] = total + normal[0] * residual
                    total = out.flux_y[i, lane]
                    out.flux_y[i, lane] = total + normal[1] * residual
                    total = out.flux_z[i, lane]
                    out.flux_z[i, lane] = total + normal[2] * residual

    return sum_residuals
