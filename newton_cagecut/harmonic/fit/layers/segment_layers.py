# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Single and double layers of segments in the plane with linear densities, in closed form, and their gradients.

What ``triangle_layers`` has in space, with G = -log(r) / (2 pi).
"""

from __future__ import annotations

import numpy as np
import warp as wp

wp.set_module_options({"enable_backward": False})

_HALF_PI = wp.constant(wp.float64(0.5 / np.pi))
_QUARTER = wp.constant(wp.float64(0.25))
_HALF = wp.constant(wp.float64(0.5))
_ONE = wp.constant(wp.float64(1.0))
_ZERO = wp.constant(wp.float64(0.0))
_TINY = wp.constant(wp.float64(1.0e-200))
"""Stands for a squared distance of 0, the logarithm of which multiplies nothing that is not 0."""


@wp.struct
class Segment:
    """A segment that starts at ``start`` and runs along a unit vector; ``normal`` is to its right, as it is outward."""

    start: wp.vec2d
    along: wp.vec2d
    normal: wp.vec2d
    length: wp.float64


@wp.struct
class SegmentLayers:
    """Layers of a segment's two hat functions: single ones, of charges, and double ones, of dipoles."""

    charge: wp.vec2d
    dipole: wp.vec2d


@wp.struct
class SegmentSlopes:
    """Gradients of the layers of a segment's two hat functions, a row each."""

    charge: wp.mat22d
    dipole: wp.mat22d


@wp.struct
class _View:
    """A segment as seen from a point: the places of its ends along it, from the point's foot, and the height above.

    ``near`` and ``far`` are the squared distances of its ends, ``angle`` is that which it fills, with the sign of the
    height, and ``log`` the integral of s / r^2 over it.
    """

    first: wp.float64
    last: wp.float64
    above: wp.float64
    near: wp.float64
    far: wp.float64
    angle: wp.float64
    log: wp.float64


@wp.func
def _view(panel: Segment, x: wp.vec2d) -> _View:
    view = _View()
    arm = x - panel.start
    view.above = wp.dot(panel.normal, arm)
    view.first = -wp.dot(panel.along, arm)
    view.last = view.first + panel.length
    squared = view.above * view.above
    view.near = wp.max(squared + view.first * view.first, _TINY)
    view.far = wp.max(squared + view.last * view.last, _TINY)
    if view.above != _ZERO:
        view.angle = wp.atan2(view.above * panel.length, squared + view.first * view.last)
    view.log = _HALF * wp.log(view.far / view.near)
    return view


@wp.func
def segment_layers(panel: Segment, x: wp.vec2d) -> SegmentLayers:
    """Layers of a segment's hat functions at a point; on the segment the double layer is the mean of its sides."""
    view = _view(panel, x)
    layers = SegmentLayers()
    near_log = wp.log(view.near)
    far_log = wp.log(view.far)
    mean = _HALF * (view.last * far_log - view.first * near_log) - panel.length + view.above * view.angle
    moment = _QUARTER * (view.far * (far_log - _ONE) - view.near * (near_log - _ONE))
    scale = _HALF_PI / panel.length
    layers.charge = wp.vec2d(scale * (moment - view.last * mean), scale * (view.first * mean - moment))
    layers.dipole = wp.vec2d(
        scale * (view.last * view.angle - view.above * view.log),
        scale * (view.above * view.log - view.first * view.angle),
    )
    return layers


@wp.func
def segment_slopes(panel: Segment, x: wp.vec2d) -> SegmentSlopes:
    """Gradients with respect to the point of the layers of a segment's hat functions; infinite at its ends."""
    view = _view(panel, x)
    slopes = SegmentSlopes()
    scale = _HALF_PI / panel.length
    rest = panel.length - view.above * view.angle
    angle_along = view.above / view.near - view.above / view.far
    log_along = view.first / view.near - view.last / view.far
    log_across = -angle_along
    angle_across = log_along
    for k in range(2):
        place = view.last
        sign = _ONE
        if k == 1:
            place = view.first
            sign = -_ONE
        # A hat function is sign (place - s) / length.
        across = place * view.angle - view.above * view.log
        slopes.charge[k] = (sign * scale) * (panel.along * (place * view.log - rest) - panel.normal * across)
        slopes.dipole[k] = (sign * scale) * (
            panel.along * (place * angle_along - view.angle - view.above * log_along)
            + panel.normal * (place * angle_across - view.log - view.above * log_across)
        )
    return slopes


def segment_rows(corners: np.ndarray) -> np.ndarray:
    """Segments as rows of ``Segment``.

    Args:
        corners: Ends, the side of the normals to the right on the way, shape (segment_count, 2, 2).
    """
    corners = np.asarray(corners, dtype=np.float64)
    rows = np.zeros(len(corners), dtype=Segment.numpy_dtype())
    edge = corners[:, 1] - corners[:, 0]
    length = np.sqrt((edge**2).sum(axis=1))
    along = edge / length[:, None]
    rows["start"], rows["along"], rows["length"] = corners[:, 0], along, length
    rows["normal"] = along[:, ::-1] * [1.0, -1.0]
    return rows
