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
        layers: Adds single layers of hat functions to the columns of their nodes, in panels that have some, and takes
            double layers of given densities from the columns that these belong to.
        slopes: The same for the gradients, a row an axis.
    """

    Vector: type
    Nodes: type
    make_panels: object
    make_far_panels: object
    layers: wp.Kernel
    slopes: wp.Kernel


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
    def layers(
        offset: int,
        panels: wp.array[Panel],
        far: wp.array[FarPanel],
        nodes: wp.array[Nodes],
        start: wp.array[wp.int32],
        column: wp.array[wp.int32],
        density: wp.array[Vector],
        points: wp.array[Vector],
        unknown: wp.array2d[wp.float64],
        known: wp.array2d[wp.float64],
    ):
        i = offset + wp.tid()
        for j in range(panels.shape[0]):
            own = layers_at(panels, far, j, points[i])
            node = nodes[j]
            # Read, add, write: "+=" on an array element would be atomic.
            if node[0] >= 0:
                for k in range(wp.static(dimension)):
                    before = unknown[i, node[k]]
                    unknown[i, node[k]] = before + own.charge[k]
            for item in range(start[j], start[j + 1]):
                before = known[i, column[item]]
                known[i, column[item]] = before - wp.dot(density[item], own.dipole)

    @wp.kernel(enable_backward=False)
    def slopes(
        offset: int,
        panels: wp.array[Panel],
        far: wp.array[FarPanel],
        nodes: wp.array[Nodes],
        start: wp.array[wp.int32],
        column: wp.array[wp.int32],
        density: wp.array[Vector],
        points: wp.array[Vector],
        unknown: wp.array2d[wp.float64],
        known: wp.array2d[wp.float64],
    ):
        i = offset + wp.tid()
        for j in range(panels.shape[0]):
            own = slopes_at(panels, far, j, points[i])
            node = nodes[j]
            if node[0] >= 0:
                for k in range(wp.static(dimension)):
                    for axis in range(wp.static(dimension)):
                        before = unknown[i * wp.static(dimension) + axis, node[k]]
                        unknown[i * wp.static(dimension) + axis, node[k]] = before + own.charge[k, axis]
            for item in range(start[j], start[j + 1]):
                slope = density[item] * own.dipole
                for axis in range(wp.static(dimension)):
                    before = known[i * wp.static(dimension) + axis, column[item]]
                    known[i * wp.static(dimension) + axis, column[item]] = before - slope[axis]

    return LayerRows(Vector, Nodes, make_panels, make_far_panels, layers, slopes)
