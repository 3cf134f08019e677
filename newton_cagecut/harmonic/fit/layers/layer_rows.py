# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers of sheets of panels at spans of points, and their gradients: kernels for space and for the plane."""

from functools import cache
from typing import NamedTuple

import warp as wp

from .far_segments import (
    FarSegment,
    far_segment_layers,
    far_segment_rows,
    far_segment_slopes,
    view_far_segment,
)
from .far_triangles import (
    FarTriangle,
    far_triangle_layers,
    far_triangle_rows,
    far_triangle_slopes,
    view_far_triangle,
)
from .segment_layers import Segment, segment_layers, segment_rows, segment_slopes
from .spans import SPAN, Span, WideSpan
from .triangle_layers import Triangle, triangle_layers, triangle_rows, triangle_slopes

# Loops stay loops: unrolled they are no faster here, and take thirty times as long to compile.
_OPTIONS = {"enable_backward": False, "max_unroll": 0}
wp.set_module_options(_OPTIONS)


@wp.struct
class SheetRange:
    """Panels of a sheet, and the columns of its layers.

    The panels are ``first`` to ``last``, their densities start at ``first_item``. Columns ``column`` on hold the single
    layers of the sheet's ``charge_count`` hat functions, then the double layers of its ``dipole_count`` functions.
    """

    first: int
    last: int
    first_item: int
    column: int
    charge_count: int
    dipole_count: int


class LayerRows(NamedTuple):
    """Types and kernels of one dimension.

    Args:
        Panels: Type of what all panels are.
        panel_types: Types of its arrays, by name.
        panel_rows: Corners of panels -> rows of the type for closed forms.
        far_rows: Corners of panels -> rows of the type for far panels.
        layers: The layers of sheets at spans of points, a thread a pair.
        slopes: Their gradients, a row an axis.
    """

    Panels: type
    panel_types: dict
    panel_rows: object
    far_rows: object
    layers: wp.Kernel
    slopes: wp.Kernel


@cache
def make_layer_rows(dimension: int) -> LayerRows:
    """Make the kernels of a dimension.

    Args:
        dimension: 2 or 3.
    """
    plane = dimension == 2
    if plane:
        Panel, FarPanel = Segment, FarSegment
        view_far, far_layers, far_slopes = view_far_segment, far_segment_layers, far_segment_slopes
        near_layers, near_slopes = segment_layers, segment_slopes
        panel_rows, far_rows = segment_rows, far_segment_rows
        Vector, Nodes = wp.vec2d, wp.vec2i
    else:
        Panel, FarPanel = Triangle, FarTriangle
        view_far, far_layers, far_slopes = view_far_triangle, far_triangle_layers, far_triangle_slopes
        near_layers, near_slopes = triangle_layers, triangle_slopes
        panel_rows, far_rows = triangle_rows, far_triangle_rows
        Vector, Nodes = wp.vec3d, wp.vec3i

    @wp.struct
    class Panels:
        """Panels of all sheets.

        ``nodes`` are those of a panel's charges within its sheet, -1 without; ``item`` is where its densities start
        among those of its sheet, -1 without, and ``density`` holds their values at its corners.
        """

        near: wp.array[Panel]
        far: wp.array[FarPanel]
        nodes: wp.array[Nodes]
        item: wp.array[wp.int32]
        density: wp.array[Vector]

    @wp.func
    def point_of(places: wp.array2d[WideSpan], span: int, c: int) -> Vector:
        point = Vector()
        for axis in range(wp.static(dimension)):
            point[axis] = places[span, axis][c]
        return point

    @wp.func
    def add(out: wp.array2d[Span], row: int, column: int, value: Span):
        # Read, add, write: "+=" on an array element would be atomic.
        before = out[row, column]
        out[row, column] = before + value

    @wp.func
    def clear(sheet: SheetRange, row: int, out: wp.array2d[Span]):
        for k in range(sheet.charge_count + sheet.dipole_count):
            out[row, sheet.column + k] = Span()

    @wp.kernel(enable_backward=False, module="unique", module_options=_OPTIONS)
    def layers(
        offset: int,
        tasks: wp.array[wp.vec2i],
        sheets: wp.array[SheetRange],
        panels: Panels,
        places: wp.array2d[WideSpan],
        out: wp.array2d[Span],
    ):
        task = tasks[offset + wp.tid()]
        sheet = sheets[task[0]]
        span = task[1]
        clear(sheet, span, out)
        for j in range(sheet.first, sheet.last):
            far = panels.far[j]
            view = view_far(far, places, span)
            near = bool(wp.min(view.squared) < far.squared)
            node = panels.nodes[j]
            item = panels.item[j]
            sums = far_layers(far, view)
            charge_0 = sums.charge_0
            charge_1 = sums.charge_1
            dipole_0 = sums.dipole_0
            dipole_1 = sums.dipole_1
            charge_2 = Span()
            dipole_2 = Span()
            if wp.static(not plane):
                charge_2 = sums.charge_2
                dipole_2 = sums.dipole_2
            if near:
                for c in range(SPAN):
                    if view.squared[c] < far.squared:
                        own = near_layers(panels.near[j], point_of(places, span, c))
                        charge_0[c] = float(own.charge[0])
                        charge_1[c] = float(own.charge[1])
                        dipole_0[c] = float(own.dipole[0])
                        dipole_1[c] = float(own.dipole[1])
                        if wp.static(not plane):
                            charge_2[c] = float(own.charge[2])
                            dipole_2[c] = float(own.dipole[2])
            if node[0] >= 0:
                add(out, span, sheet.column + node[0], charge_0)
                add(out, span, sheet.column + node[1], charge_1)
                if wp.static(not plane):
                    add(out, span, sheet.column + node[2], charge_2)
            if item >= 0:
                for k in range(sheet.dipole_count):
                    density = panels.density[sheet.first_item + item + k]
                    total = float(density[0]) * dipole_0 + float(density[1]) * dipole_1
                    if wp.static(not plane):
                        total += float(density[2]) * dipole_2
                    add(out, span, sheet.column + sheet.charge_count + k, total)

    @wp.kernel(enable_backward=False, module="unique", module_options=_OPTIONS)
    def slopes(
        offset: int,
        tasks: wp.array[wp.vec2i],
        sheets: wp.array[SheetRange],
        panels: Panels,
        places: wp.array2d[WideSpan],
        out: wp.array2d[Span],
    ):
        task = tasks[offset + wp.tid()]
        sheet = sheets[task[0]]
        span = task[1]
        for axis in range(wp.static(dimension)):
            clear(sheet, span * wp.static(dimension) + axis, out)
        for j in range(sheet.first, sheet.last):
            far = panels.far[j]
            view = view_far(far, places, span)
            near = bool(wp.min(view.squared) < far.squared)
            node = panels.nodes[j]
            item = panels.item[j]
            for axis in range(wp.static(dimension)):
                row = span * wp.static(dimension) + axis
                sums = far_slopes(far, view, axis)
                charge_0 = sums.charge_0
                charge_1 = sums.charge_1
                dipole_0 = sums.dipole_0
                dipole_1 = sums.dipole_1
                charge_2 = Span()
                dipole_2 = Span()
                if wp.static(not plane):
                    charge_2 = sums.charge_2
                    dipole_2 = sums.dipole_2
                if near:
                    for c in range(SPAN):
                        if view.squared[c] < far.squared:
                            own = near_slopes(panels.near[j], point_of(places, span, c))
                            charge_0[c] = float(own.charge[0, axis])
                            charge_1[c] = float(own.charge[1, axis])
                            dipole_0[c] = float(own.dipole[0, axis])
                            dipole_1[c] = float(own.dipole[1, axis])
                            if wp.static(not plane):
                                charge_2[c] = float(own.charge[2, axis])
                                dipole_2[c] = float(own.dipole[2, axis])
                if node[0] >= 0:
                    add(out, row, sheet.column + node[0], charge_0)
                    add(out, row, sheet.column + node[1], charge_1)
                    if wp.static(not plane):
                        add(out, row, sheet.column + node[2], charge_2)
                if item >= 0:
                    for k in range(sheet.dipole_count):
                        density = panels.density[sheet.first_item + item + k]
                        total = float(density[0]) * dipole_0 + float(density[1]) * dipole_1
                        if wp.static(not plane):
                            total += float(density[2]) * dipole_2
                        add(out, row, sheet.column + sheet.charge_count + k, total)

    types = {"near": Panel, "far": FarPanel, "nodes": Nodes, "item": wp.int32, "density": Vector}
    return LayerRows(Panels, types, panel_rows, far_rows, layers, slopes)
