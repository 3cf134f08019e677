# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers of segments in the plane that are far away, by three points of each; what ``far_triangles`` has in space."""

from __future__ import annotations

import numpy as np
import warp as wp

from .spans import Span, WideSpan, inverse, logarithm, offset_from

_FAR = 6.0
"""Distance of a segment's centre from which it is far, in units of half its length."""

# Gauss's rule of three points.
_GAUSS = 0.5 + np.sqrt(0.15)
_END_NEAR = wp.constant(wp.float32(5.0 / 18.0 * _GAUSS))
_END_FAR = wp.constant(wp.float32(5.0 / 18.0 * (1.0 - _GAUSS)))
_MIDDLE = wp.constant(wp.float32(4.0 / 18.0))


@wp.struct
class FarSegment:
    """A segment as seen from afar.

    ``squared`` is the squared distance of its centre from which it is far, ``scale`` its length over 2 pi. Its points
    lie at the centre and at ``arm`` on both sides of it, backward and forward.
    """

    center: wp.vec2d
    normal: wp.vec2
    arm: wp.vec2
    squared: float
    scale: float


@wp.struct
class FarSegmentView:
    """A far segment as seen from the points of a span.

    ``place_x`` and so on run from its centre to the points, ``above`` is how high they are over its line, ``first``,
    ``last`` and ``squared`` are the squared distances from the segment's points.
    """

    place_x: Span
    place_y: Span
    above: Span
    first: Span
    last: Span
    squared: Span


@wp.struct
class SegmentSpan:
    """Layers of a segment's two hat functions at the points of a span, or a component of their gradients."""

    charge_0: Span
    charge_1: Span
    dipole_0: Span
    dipole_1: Span


@wp.func
def view_far_segment(panel: FarSegment, places: wp.array2d[WideSpan], span: int) -> FarSegmentView:
    """A segment as seen from the points of a span, whose coordinates are a row of the places."""
    view = FarSegmentView()
    x = offset_from(places[span, 0], panel.center[0])
    y = offset_from(places[span, 1], panel.center[1])
    view.place_x = x
    view.place_y = y
    view.squared = wp.cw_mul(x, x) + wp.cw_mul(y, y)
    view.above = panel.normal[0] * x + panel.normal[1] * y
    before_x = x + Span(panel.arm[0])
    before_y = y + Span(panel.arm[1])
    view.first = wp.cw_mul(before_x, before_x) + wp.cw_mul(before_y, before_y)
    after_x = x - Span(panel.arm[0])
    after_y = y - Span(panel.arm[1])
    view.last = wp.cw_mul(after_x, after_x) + wp.cw_mul(after_y, after_y)
    return view


@wp.func
def far_segment_layers(panel: FarSegment, view: FarSegmentView) -> SegmentSpan:
    """Layers of the hat functions of a segment far away."""
    out = SegmentSpan()
    down = -0.5 * panel.scale
    first = down * logarithm(view.first)
    last = down * logarithm(view.last)
    middle = (down * _MIDDLE) * logarithm(view.squared)
    out.charge_0 = _END_NEAR * first + _END_FAR * last + middle
    out.charge_1 = _END_FAR * first + _END_NEAR * last + middle
    above = panel.scale * view.above
    first = inverse(view.first)
    last = inverse(view.last)
    middle = _MIDDLE * inverse(view.squared)
    out.dipole_0 = wp.cw_mul(above, _END_NEAR * first + _END_FAR * last + middle)
    out.dipole_1 = wp.cw_mul(above, _END_FAR * first + _END_NEAR * last + middle)
    return out


@wp.func
def far_segment_slopes(panel: FarSegment, view: FarSegmentView, axis: int) -> SegmentSpan:
    """Components along an axis of the gradients of the layers of a segment far away."""
    place = view.place_x
    if axis == 1:
        place = view.place_y
    arm = panel.arm[axis]
    normal = panel.normal[axis]
    first = panel.scale * inverse(view.first)
    last = panel.scale * inverse(view.last)
    middle = panel.scale * inverse(view.squared)
    to_first = wp.cw_mul(first, place + Span(arm))
    to_last = wp.cw_mul(last, place - Span(arm))
    to_middle = wp.cw_mul(middle, place)
    out = SegmentSpan()
    out.charge_0 = -(_END_NEAR * to_first + _END_FAR * to_last + _MIDDLE * to_middle)
    out.charge_1 = -(_END_FAR * to_first + _END_NEAR * to_last + _MIDDLE * to_middle)
    twice = (2.0 / panel.scale) * view.above
    at_first = normal * first - wp.cw_mul(wp.cw_mul(twice, first), to_first)
    at_last = normal * last - wp.cw_mul(wp.cw_mul(twice, last), to_last)
    at_middle = normal * middle - wp.cw_mul(wp.cw_mul(twice, middle), to_middle)
    out.dipole_0 = _END_NEAR * at_first + _END_FAR * at_last + _MIDDLE * at_middle
    out.dipole_1 = _END_FAR * at_first + _END_NEAR * at_last + _MIDDLE * at_middle
    return out


def far_segment_rows(corners: np.ndarray) -> np.ndarray:
    """Segments as rows of ``FarSegment``.

    Args:
        corners: Ends, the side of the normals to the right on the way, shape (segment_count, 2, 2).
    """
    corners = np.asarray(corners, dtype=np.float64)
    rows = np.zeros(len(corners), dtype=FarSegment.numpy_dtype())
    edge = corners[:, 1] - corners[:, 0]
    length = np.sqrt((edge**2).sum(axis=1))
    rows["center"] = corners[:, 0] + 0.5 * edge
    rows["normal"] = edge[:, ::-1] * [1.0, -1.0] / length[:, None]
    rows["arm"] = (_GAUSS - 0.5) * edge
    rows["scale"], rows["squared"] = length * (0.5 / np.pi), _FAR**2 * 0.25 * length**2
    return rows
