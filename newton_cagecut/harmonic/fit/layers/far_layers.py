# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Layers of panels that are far away, by a few points of each: closed forms cost several times as much there.

A panel is far from ``_FAR`` times its radius on; what is left out of its layers is then about 1e-5 of them.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from .segment_layers import SegmentLayers, SegmentSlopes
from .triangle_layers import CORNERS, TriangleLayers, TriangleSlopes

wp.set_module_options({"enable_backward": False})

_FAR = {2: 6.0, 3: 3.0}
"""Distance of a panel's centre from which it is far, in units of its corners' greatest distance, by dimension."""

# A rule for triangles that is exact to degree 4: three points near the corners and three near the middles of the edges.
_NEAR_CORNER, _NEAR_EDGE = 0.816847572980459, 0.108103018168070
_CORNER_WEIGHT, _EDGE_WEIGHT = 0.109951743655322, 0.223381589678011
_CORNER_BASE = wp.constant(wp.float64(_CORNER_WEIGHT * (1.0 - _NEAR_CORNER) / 2.0))
_CORNER_RISE = wp.constant(wp.float64(_CORNER_WEIGHT * (3.0 * _NEAR_CORNER - 1.0) / 2.0))
_EDGE_BASE = wp.constant(wp.float64(_EDGE_WEIGHT * (1.0 - _NEAR_EDGE) / 2.0))
_EDGE_RISE = wp.constant(wp.float64(_EDGE_WEIGHT * (3.0 * _NEAR_EDGE - 1.0) / 2.0))
# Gauss's rule of three points for segments.
_GAUSS = 0.5 + np.sqrt(0.15)
_END_NEAR = wp.constant(wp.float64(5.0 / 18.0 * _GAUSS))
_END_FAR = wp.constant(wp.float64(5.0 / 18.0 * (1.0 - _GAUSS)))
_MIDDLE = wp.constant(wp.float64(4.0 / 18.0))
_ONE = wp.constant(wp.float64(1.0))
_TWO = wp.constant(wp.float64(2.0))
_THREE = wp.constant(wp.float64(3.0))
_HALF = wp.constant(wp.float64(0.5))


@wp.struct
class FarTriangle:
    """A triangle as seen from afar.

    ``squared`` is the squared distance of its centre from which it is far, ``scale`` its area over 4 pi. The points
    ``outer`` lie near the corners, ``inner`` near the middles of the opposite edges.
    """

    center: wp.vec3d
    normal: wp.vec3d
    outer: CORNERS
    inner: CORNERS
    squared: wp.float64
    scale: wp.float64


@wp.struct
class FarSegment:
    """A segment as seen from afar; ``scale`` is its length over 2 pi, ``points`` lie near its ends."""

    center: wp.vec2d
    normal: wp.vec2d
    points: wp.mat22d
    squared: wp.float64
    scale: wp.float64


@wp.func
def far_triangle_layers(panel: FarTriangle, x: wp.vec3d) -> TriangleLayers:
    """What ``triangle_layers`` gives, for a triangle far away."""
    near = wp.vec3d()
    edge = wp.vec3d()
    near_cube = wp.vec3d()
    edge_cube = wp.vec3d()
    for k in range(3):
        near[k] = _ONE / wp.length(x - panel.outer[k])
        edge[k] = _ONE / wp.length(x - panel.inner[k])
        near_cube[k] = near[k] * near[k] * near[k]
        edge_cube[k] = edge[k] * edge[k] * edge[k]
    layers = TriangleLayers()
    base = _CORNER_BASE * (near[0] + near[1] + near[2]) + _EDGE_BASE * (edge[0] + edge[1] + edge[2])
    cube = _CORNER_BASE * (near_cube[0] + near_cube[1] + near_cube[2])
    cube += _EDGE_BASE * (edge_cube[0] + edge_cube[1] + edge_cube[2])
    above = panel.scale * wp.dot(panel.normal, x - panel.center)
    for k in range(3):
        layers.charge[k] = panel.scale * (base + _CORNER_RISE * near[k] + _EDGE_RISE * edge[k])
        layers.dipole[k] = above * (cube + _CORNER_RISE * near_cube[k] + _EDGE_RISE * edge_cube[k])
    return layers


@wp.func
def far_triangle_slopes(panel: FarTriangle, x: wp.vec3d) -> TriangleSlopes:
    """What ``triangle_slopes`` gives, for a triangle far away."""
    slopes = TriangleSlopes()
    base_charge = wp.vec3d()
    base_dipole = wp.vec3d()
    above = wp.dot(panel.normal, x - panel.center)
    for k in range(3):
        for part in range(2):
            arm = x - panel.outer[k]
            base = _CORNER_BASE
            rise = _CORNER_RISE
            if part == 1:
                arm = x - panel.inner[k]
                base = _EDGE_BASE
                rise = _EDGE_RISE
            squared = wp.length_sq(arm)
            cube = panel.scale / (squared * wp.sqrt(squared))
            charge = -cube * arm
            dipole = cube * (panel.normal - (_THREE * above / squared) * arm)
            base_charge += base * charge
            base_dipole += base * dipole
            slopes.charge[k] = slopes.charge[k] + rise * charge
            slopes.dipole[k] = slopes.dipole[k] + rise * dipole
    for k in range(3):
        slopes.charge[k] = slopes.charge[k] + base_charge
        slopes.dipole[k] = slopes.dipole[k] + base_dipole
    return slopes


@wp.func
def far_segment_layers(panel: FarSegment, x: wp.vec2d) -> SegmentLayers:
    """What ``segment_layers`` gives, for a segment far away."""
    first = wp.length_sq(x - panel.points[0])
    last = wp.length_sq(x - panel.points[1])
    middle = wp.length_sq(x - panel.center)
    log_first = -_HALF * wp.log(first)
    log_last = -_HALF * wp.log(last)
    log_middle = -_HALF * _MIDDLE * wp.log(middle)
    above = panel.scale * wp.dot(panel.normal, x - panel.center)
    layers = SegmentLayers()
    layers.charge = panel.scale * wp.vec2d(
        _END_NEAR * log_first + _END_FAR * log_last + log_middle,
        _END_FAR * log_first + _END_NEAR * log_last + log_middle,
    )
    layers.dipole = above * wp.vec2d(
        _END_NEAR / first + _END_FAR / last + _MIDDLE / middle, _END_FAR / first + _END_NEAR / last + _MIDDLE / middle
    )
    return layers


@wp.func
def far_segment_slopes(panel: FarSegment, x: wp.vec2d) -> SegmentSlopes:
    """What ``segment_slopes`` gives, for a segment far away."""
    slopes = SegmentSlopes()
    above = wp.dot(panel.normal, x - panel.center)
    for part in range(3):
        arm = x - panel.center
        near = _MIDDLE
        far = _MIDDLE
        if part == 0:
            arm = x - panel.points[0]
            near = _END_NEAR
            far = _END_FAR
        if part == 1:
            arm = x - panel.points[1]
            near = _END_FAR
            far = _END_NEAR
        squared = wp.length_sq(arm)
        charge = -(panel.scale / squared) * arm
        dipole = (panel.scale / squared) * (panel.normal - (_TWO * above / squared) * arm)
        slopes.charge[0] = slopes.charge[0] + near * charge
        slopes.charge[1] = slopes.charge[1] + far * charge
        slopes.dipole[0] = slopes.dipole[0] + near * dipole
        slopes.dipole[1] = slopes.dipole[1] + far * dipole
    return slopes


def make_far_triangles(corners: np.ndarray, device: wp.context.Devicelike) -> wp.array:
    """Put triangles on a device as ``FarTriangle``.

    Args:
        corners: Corners, counterclockwise about the normals, shape (triangle_count, 3, 3).
        device: Where to put them.
    """
    corners = np.asarray(corners, dtype=np.float64)
    rows = np.zeros(len(corners), dtype=FarTriangle.numpy_dtype())
    center = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0
    area_vector = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.sqrt((area_vector**2).sum(axis=1))
    # A point is what its corner has more than the others, plus an equal share of all.
    total = 3.0 * center[:, None]
    rows["outer"] = (1.5 * _NEAR_CORNER - 0.5) * corners + (0.5 - 0.5 * _NEAR_CORNER) * total
    rows["inner"] = (1.5 * _NEAR_EDGE - 0.5) * corners + (0.5 - 0.5 * _NEAR_EDGE) * total
    rows["center"], rows["normal"], rows["scale"] = center, area_vector / area[:, None], area * (0.25 / np.pi)
    rows["squared"] = _FAR[3] ** 2 * ((corners - center[:, None]) ** 2).sum(axis=2).max(axis=1)
    return wp.array(rows, dtype=FarTriangle, device=device)


def make_far_segments(corners: np.ndarray, device: wp.context.Devicelike) -> wp.array:
    """Put segments on a device as ``FarSegment``.

    Args:
        corners: Ends, the side of the normals to the right on the way, shape (segment_count, 2, 2).
        device: Where to put them.
    """
    corners = np.asarray(corners, dtype=np.float64)
    rows = np.zeros(len(corners), dtype=FarSegment.numpy_dtype())
    edge = corners[:, 1] - corners[:, 0]
    length = np.sqrt((edge**2).sum(axis=1))
    rows["center"] = corners[:, 0] + 0.5 * edge
    rows["normal"] = edge[:, ::-1] * [1.0, -1.0] / length[:, None]
    rows["points"] = corners[:, :1] + np.array([1.0 - _GAUSS, _GAUSS])[:, None] * edge[:, None]
    rows["scale"], rows["squared"] = length * (0.5 / np.pi), _FAR[2] ** 2 * 0.25 * length**2
    return wp.array(rows, dtype=FarSegment, device=device)
