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


@wp.func
def at_surface_point(i: int, values: wp.array[wp.vec3], rows: SurfaceRows) -> wp.vec3:
    """A field of vertex values at a surface point."""
    total = wp.vec3()
    for j in range(rows.vertex_count[0]):
        total += rows.weights[rows.first_row + i, j] * values[j]
    return total


@wp.kernel(enable_backward=False)
def embed(
    enabled: wp.array[wp.int32],
    vertices: wp.array[wp.vec3],
    rows: SurfaceRows,
    points: wp.array[wp.vec3],
):
    """Sum a vertex field with the weights of each surface point."""
    i = wp.tid()
    if i < rows.point_count[0] and enabled[0] != 0:
        points[i] = at_surface_point(i, vertices, rows)


@wp.kernel(enable_backward=False)
def copy_sites(point_site: wp.array[wp.int32], sites: wp.array[wp.vec3], points: wp.array[wp.vec3]):
    """Put each point where its site is."""
    i = wp.tid()
    points[i] = sites[point_site[i]]


class SeamPoints:
    """Positions of all points of a surface with seams, from those of its sites."""

    def __init__(self) -> None:
        self._surface: Surface | None = None

    def points_of(self, surface: Surface, sites: wp.array) -> wp.array:
        """Positions of a surface's points, an array that the next call overwrites, shape (point_count,) [m].

        Args:
            surface: The surface, with seams.
            sites: Positions of its sites, shape (site_count,) [m].
        """
        if surface is not self._surface:
            self._surface = surface
            self._point_site = wp.array(surface.point_site.astype(np.int32), dtype=wp.int32, device=sites.device)
            self._points = wp.empty(surface.point_count, dtype=wp.vec3, device=sites.device)
        inputs = [self._point_site, sites, self._points]
        wp.launch(copy_sites, dim=surface.point_count, inputs=inputs, device=sites.device)
        return self._points
