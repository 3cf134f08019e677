# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What every panel does at every point: rows of numbers that the densities are multiplied with, a thread a row."""

from functools import cache
from typing import NamedTuple

import warp as wp

from .far_layers import (
    FarSegment,
    FarTriangle,
    far_segment_layers,
    far_segment_slopes,
    far_triangle_layers,
    far_triangle_slopes,
    make_far_segments,
    make_far_triangles,
)
from .segment_layers import Segment, SegmentLayers, SegmentSlopes, make_segments, segment_layers, segment_slopes
from .triangle_layers import Triangle, TriangleLayers, TriangleSlopes, make_triangles, triangle_layers, triangle_slopes

wp.set_module_options({"enable_backward": False})


class LayerRows(NamedTuple):
    """Types and kernels of one dimension.

    Args:
        Vector: Type of a point.
        Nodes: Type of a panel's nodes.
        make_panels: corners, device -> panels.
        make_far_panels: corners, device -> panels as seen from afar.
        charges: Adds the single layers of hat functions to the columns of their nodes.
        charge_slopes: The same for the gradients, a row an axis.
        dipoles: Takes double layers of given densities from the columns that they belong to.
        dipole_slopes: The same for the gradients, a row an axis.
    """

    Vector: type
    Nodes: type
    make_panels: object
    make_far_panels: object
    charges: wp.Kernel
    charge_slopes: wp.Kernel
    dipoles: wp.Kernel
    dipole_slopes: wp.Kernel


@cache
def make_layer_rows(dimension: int) -> LayerRows:
    """Make the kernels of a dimension.

    Args:
        dimension: 2 or 3.
    """
    if dimension == 2:
        Panel, FarPanel, Layers, Slopes = Segment, FarSegment, SegmentLayers, SegmentSlopes
        near_layers, far_layers = segment_layers, far_segment_layers
        near_slopes, far_slopes = segment_slopes, far_segment_slopes
        make_panels, make_far_panels = make_segments, make_far_segments
        Vector, Nodes = wp.vec2d, wp.vec2i
    else:
        Panel, FarPanel, Layers, Slopes = Triangle, FarTriangle, TriangleLayers, TriangleSlopes
        near_layers, far_layers = triangle_layers, far_triangle_layers
        near_slopes, far_slopes = triangle_slopes, far_triangle_slopes
        make_panels, make_far_panels = make_triangles, make_far_triangles
        Vector, Nodes = wp.vec3d, wp.vec3i

    @wp.func
    def layers_at(panels: wp.array[Panel], far: wp.array[FarPanel], j: int, x: Vector) -> Layers:
        layers = Layers()
        if wp.length_sq(x - far[j].center) > far[j].squared:
            layers = far_layers(far[j], x)
        else:
            layers = near_layers(panels[j], x)
        return layers

    @wp.func
    def slopes_at(panels: wp.array[Panel], far: wp.array[FarPanel], j: int, x: Vector) -> Slopes:
        slopes = Slopes()
        if wp.length_sq(x - far[j].center) > far[j].squared:
            slopes = far_slopes(far[j], x)
        else:
            slopes = near_slopes(panels[j], x)
        return slopes

    @wp.kernel(enable_backward=False)
    def charges(
        offset: int,
        panels: wp.array[Panel],
        far: wp.array[FarPanel],
        nodes: wp.array[Nodes],
        points: wp.array[Vector],
        rows: wp.array2d[wp.float64],
    ):
        i = offset + wp.tid()
        for j in range(panels.shape[0]):
            layers = layers_at(panels, far, j, points[i])
            node = nodes[j]
            for k in range(wp.static(dimension)):
                rows[i, node[k]] += layers.charge[k]

    @wp.kernel(enable_backward=False)
    def charge_slopes(
        offset: int,
        panels: wp.array[Panel],
        far: wp.array[FarPanel],
        nodes: wp.array[Nodes],
        points: wp.array[Vector],
        rows: wp.array2d[wp.float64],
    ):
        i = offset + wp.tid()
        for j in range(panels.shape[0]):
            slopes = slopes_at(panels, far, j, points[i])
            node = nodes[j]
            for k in range(wp.static(dimension)):
                for axis in range(wp.static(dimension)):
                    rows[i * wp.static(dimension) + axis, node[k]] += slopes.charge[k, axis]

    @wp.kernel(enable_backward=False)
    def dipoles(
        offset: int,
        panels: wp.array[Panel],
        far: wp.array[FarPanel],
        start: wp.array[wp.int32],
        column: wp.array[wp.int32],
        density: wp.array[Vector],
        points: wp.array[Vector],
        rows: wp.array2d[wp.float64],
    ):
        i = offset + wp.tid()
        for j in range(panels.shape[0]):
            layers = layers_at(panels, far, j, points[i])
            for item in range(start[j], start[j + 1]):
                rows[i, column[item]] -= wp.dot(density[item], layers.dipole)

    @wp.kernel(enable_backward=False)
    def dipole_slopes(
        offset: int,
        panels: wp.array[Panel],
        far: wp.array[FarPanel],
        start: wp.array[wp.int32],
        column: wp.array[wp.int32],
        density: wp.array[Vector],
        points: wp.array[Vector],
        rows: wp.array2d[wp.float64],
    ):
        i = offset + wp.tid()
        for j in range(panels.shape[0]):
            slopes = slopes_at(panels, far, j, points[i])
            for item in range(start[j], start[j + 1]):
                slope = density[item] * slopes.dipole
                for axis in range(wp.static(dimension)):
                    rows[i * wp.static(dimension) + axis, column[item]] -= slope[axis]

    return LayerRows(Vector, Nodes, make_panels, make_far_panels, charges, charge_slopes, dipoles, dipole_slopes)
