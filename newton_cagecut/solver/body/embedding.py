# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The embedded surface in the world: each point is the weighted sum of the cage's vertices (paper, equation 1)."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...surface import Surface

wp.set_module_options({"enable_backward": False})


@wp.struct
class SurfaceRows:
    """The rows of a body's surface points among its coordinates' points."""

    weights: wp.array2d[float]
    """Weights of all points, one a point and vertex."""
    first_row: int
    """Row of the surface's first point."""
    point_count: wp.array[wp.int32]
    """Number of surface points, shape (1,)."""
    vertex_count: wp.array[wp.int32]
    """Number of vertices in use, shape (1,)."""


def make_surface_rows(
    weights: wp.array, first_row: int, *, point_count: wp.array, vertex_count: wp.array
) -> SurfaceRows:
    """The rows of a body's surface points; the arrays are used in place."""
    rows = SurfaceRows()
    rows.weights, rows.first_row = weights, first_row
    rows.point_count, rows.vertex_count = point_count, vertex_count
    return rows


@wp.kernel(enable_backward=False)
def embed(vertices: wp.array[wp.vec3], rows: SurfaceRows, points: wp.array[wp.vec3]):
    """Sum a vertex field with the weights of each surface point."""
    i = wp.tid()
    if i < rows.point_count[0]:
        total = wp.vec3()
        for j in range(rows.vertex_count[0]):
            total += rows.weights[rows.first_row + i, j] * vertices[j]
        points[i] = total


Motion = wp.types.vector(length=8, dtype=wp.float32)
"""Position and velocity of a vertex, each with a zero after it: one vector of a CPU."""


@wp.kernel(enable_backward=False)
def join_motion(positions: wp.array[wp.vec3], velocities: wp.array[wp.vec3], motion: wp.array[Motion]):
    """Put position and velocity of each vertex together."""
    i = wp.tid()
    x, v = positions[i], velocities[i]
    motion[i] = Motion(x[0], x[1], x[2], 0.0, v[0], v[1], v[2], 0.0)


@wp.kernel(enable_backward=False)
def embed_motion(
    enabled: wp.array[wp.int32],
    motion: wp.array[Motion],
    rows: SurfaceRows,
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
):
    """Positions and velocities of the surface points, in four sums that do not wait for each other."""
    i = wp.tid()
    if i >= rows.point_count[0] or enabled[0] == 0:
        return
    row, count = rows.first_row + i, rows.vertex_count[0]
    m0, m1, m2, m3 = Motion(), Motion(), Motion(), Motion()
    fours = count / 4
    for four in range(fours):
        j = 4 * four
        m0 += rows.weights[row, j] * motion[j]
        m1 += rows.weights[row, j + 1] * motion[j + 1]
        m2 += rows.weights[row, j + 2] * motion[j + 2]
        m3 += rows.weights[row, j + 3] * motion[j + 3]
    for j in range(4 * fours, count):
        m0 += rows.weights[row, j] * motion[j]
    total = (m0 + m1) + (m2 + m3)
    positions[i] = wp.vec3(total[0], total[1], total[2])
    velocities[i] = wp.vec3(total[4], total[5], total[6])


@wp.kernel(enable_backward=False)
def copy_sites(point_site: wp.array[wp.int32], sites: wp.array[wp.vec3], points: wp.array[wp.vec3]):
    """Put each point where its site is."""
    i = wp.tid()
    points[i] = sites[point_site[i]]


class SeamPoints:
    """Positions of all points of a surface with seams or sheets that touch, from those of its sites."""

    def __init__(self) -> None:
        self._surface: Surface | None = None

    def points_of(self, surface: Surface, sites: wp.array) -> wp.array:
        """Positions of a surface's points, an array that the next call overwrites, shape (point_count,) [m].

        Args:
            surface: The surface, with seams or sheets that touch.
            sites: Positions of its sites, shape (site_count,) [m].
        """
        if surface is not self._surface:
            self._surface = surface
            self._point_site = wp.array(surface.point_place.astype(np.int32), dtype=wp.int32, device=sites.device)
            self._points = wp.empty(surface.point_count, dtype=wp.vec3, device=sites.device)
        inputs = [self._point_site, sites, self._points]
        wp.launch(copy_sites, dim=surface.point_count, inputs=inputs, device=sites.device)
        return self._points
