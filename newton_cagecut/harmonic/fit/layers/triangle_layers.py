# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Single and double layers of flat triangles with linear densities, in closed form, and their gradients.

With G = 1 / (4 pi r) the single layer of a density f is the integral of f(y) G(x, y), the double layer that of
f(y) dG/dn_y(x, y). Both are given for the three hat functions of a triangle, that are 1 at one corner; a constant
density is their sum. The double layer of a closed surface with outward normals and density 1 is -1 inside.
"""

from __future__ import annotations

import numpy as np
import warp as wp

wp.set_module_options({"enable_backward": False})

_QUARTER_PI = wp.constant(wp.float64(0.25 / np.pi))
_HALF = wp.constant(wp.float64(0.5))
_ONE = wp.constant(wp.float64(1.0))
_TWO = wp.constant(wp.float64(2.0))
_ZERO = wp.constant(wp.float64(0.0))
_TINY = wp.constant(wp.float64(1.0e-200))
_TINY_ROOT = wp.constant(wp.float64(1.0e-100))
"""Stands for a distance of 0, from an edge or a corner, the logarithm of which multiplies nothing that is not 0."""

CORNERS = wp.types.matrix(shape=(3, 3), dtype=wp.float64)


@wp.struct
class Triangle:
    """A triangle with what its layers need, counterclockwise about ``normal``.

    Edge e runs from corner e to the next, along ``along`` (a row an edge), and ``outward`` is normal to it in the
    plane. ``height`` holds each corner's height over the opposite edge, ``cosine`` the products of the outward normals
    of edges 0 and 1, 1 and 2, 2 and 0.
    """

    corner: CORNERS
    along: CORNERS
    outward: CORNERS
    normal: wp.vec3d
    length: wp.vec3d
    height: wp.vec3d
    cosine: wp.vec3d


@wp.struct
class TriangleLayers:
    """Layers of a triangle's three hat functions: single ones, of charges, and double ones, of dipoles."""

    charge: wp.vec3d
    dipole: wp.vec3d


@wp.struct
class TriangleSlopes:
    """Gradients of the layers of a triangle's three hat functions, a row each."""

    charge: CORNERS
    dipole: CORNERS


@wp.struct
class _Seen:
    """A triangle as seen from a point.

    ``arm`` runs from the corners to the point, ``reach`` is how long they are, ``start`` the place of an edge's first
    corner along it, from the point's foot, ``off`` how far the foot lies inside of the edge; ``log`` the integral of
    1 / r over the edge, ``angle`` the solid angle with the sign of ``above``, the height over the plane.
    """

    arm: CORNERS
    reach: wp.vec3d
    start: wp.vec3d
    off: wp.vec3d
    log: wp.vec3d
    above: wp.float64
    angle: wp.float64


@wp.func
def _beyond(place: wp.float64, reach: wp.float64, squared: wp.float64) -> wp.float64:
    """Sum of a place and its reach, without cancellation where place is negative."""
    if place > _ZERO:
        return reach + place
    return squared / (reach - place)


@wp.func
def _seen(panel: Triangle, x: wp.vec3d) -> _Seen:
    seen = _Seen()
    for k in range(3):
        seen.arm[k] = x - panel.corner[k]
        seen.reach[k] = wp.max(wp.length(seen.arm[k]), _TINY_ROOT)
    a = seen.arm[0]
    b = seen.arm[1]
    c = seen.arm[2]
    seen.above = wp.dot(panel.normal, a)
    for e in range(3):
        seen.off[e] = -wp.dot(panel.outward[e], seen.arm[e])
        seen.start[e] = -wp.dot(panel.along[e], seen.arm[e])
        squared = wp.max(seen.off[e] * seen.off[e] + seen.above * seen.above, _TINY)
        last = _beyond(seen.start[e] + panel.length[e], seen.reach[(e + 1) % 3], squared)
        seen.log[e] = wp.log(last / _beyond(seen.start[e], seen.reach[e], squared))
    volume = seen.above * panel.length[0] * panel.height[2]
    base = seen.reach[0] * seen.reach[1] * seen.reach[2]
    base += wp.dot(a, b) * seen.reach[2] + wp.dot(b, c) * seen.reach[0] + wp.dot(c, a) * seen.reach[1]
    if volume != _ZERO:
        seen.angle = _TWO * wp.atan2(volume, base)
    return seen


@wp.func
def _across(panel: Triangle, opposite: int, values: wp.vec3d) -> wp.float64:
    """Sum over the edges of the values, times the cosine between their outward normals and that of one of them."""
    after = (opposite + 1) % 3
    before = (opposite + 2) % 3
    return values[opposite] + panel.cosine[opposite] * values[after] + panel.cosine[before] * values[before]


@wp.func
def _layers(panel: Triangle, seen: _Seen) -> TriangleLayers:
    layers = TriangleLayers()
    constant = wp.dot(seen.off, seen.log) - seen.above * seen.angle
    mean = wp.vec3d()  # of the distance along each edge, times its length
    for e in range(3):
        squared = seen.off[e] * seen.off[e] + seen.above * seen.above
        end = seen.start[e] + panel.length[e]
        mean[e] = _HALF * (end * seen.reach[(e + 1) % 3] - seen.start[e] * seen.reach[e] + squared * seen.log[e])
    for k in range(3):
        o = (k + 1) % 3
        scale = _QUARTER_PI / panel.height[k]
        layers.charge[k] = scale * (seen.off[o] * constant - _across(panel, o, mean))
        layers.dipole[k] = scale * (seen.off[o] * seen.angle + seen.above * _across(panel, o, seen.log))
    return layers


@wp.func
def triangle_layers(panel: Triangle, x: wp.vec3d) -> TriangleLayers:
    """Layers of a triangle's hat functions at a point.

    On the triangle itself the single layer is continuous, and the double layer is the mean of its two sides.
    """
    return _layers(panel, _seen(panel, x))


@wp.func
def triangle_slopes(panel: Triangle, x: wp.vec3d) -> TriangleSlopes:
    """Gradients with respect to the point of the layers of a triangle's hat functions; infinite on its edges."""
    seen = _seen(panel, x)
    layers = _layers(panel, seen)
    slopes = TriangleSlopes()
    turn = wp.vec3d()  # gradient of the solid angle
    log_slope = CORNERS()
    for e in range(3):
        f = (e + 1) % 3
        normal = wp.cross(seen.arm[e], seen.arm[f])
        product = seen.reach[e] * seen.reach[f]
        cosine = wp.dot(seen.arm[e], seen.arm[f])
        both = product + cosine
        if cosine < _ZERO:
            both = wp.max(wp.length_sq(normal), _TINY) / (product - cosine)
        turn -= normal * ((seen.reach[e] + seen.reach[f]) / (product * both))
        log_slope[e] = -(seen.arm[e] / seen.reach[e] + seen.arm[f] / seen.reach[f]) * (panel.length[e] / both)
    constant = wp.dot(seen.off, seen.log) - seen.above * seen.angle
    for k in range(3):
        o = (k + 1) % 3
        scale = _QUARTER_PI / panel.height[k]
        change = wp.vec3d()
        border = wp.vec3d()
        for e in range(3):
            f = (e + 1) % 3
            cosine = _ONE
            if f == o:
                cosine = panel.cosine[e]
            elif e != o:
                cosine = panel.cosine[o]
            change += log_slope[e] * cosine
            if e != o:  # the hat function is 1 at corner k, where the edge ends or starts, and 0 on edge o
                at_start = _ONE
                rise = -_ONE / panel.length[e]
                if f == k:
                    at_start = _ZERO
                    rise = _ONE / panel.length[e]
                along = (at_start - rise * seen.start[e]) * seen.log[e] + rise * (seen.reach[f] - seen.reach[e])
                border += panel.outward[e] * along
        slopes.charge[k] = (
            -_QUARTER_PI * border - panel.outward[o] * (scale * constant) - panel.normal * layers.dipole[k]
        )
        slopes.dipole[k] = scale * (
            turn * seen.off[o]
            - panel.outward[o] * seen.angle
            + panel.normal * _across(panel, o, seen.log)
            + change * seen.above
        )
    return slopes


def triangle_rows(corners: np.ndarray) -> np.ndarray:
    """Triangles as rows of ``Triangle``.

    Args:
        corners: Corners, counterclockwise about the normals, shape (triangle_count, 3, 3).
    """
    corners = np.asarray(corners, dtype=np.float64)
    rows = np.zeros(len(corners), dtype=Triangle.numpy_dtype())
    edge = np.roll(corners, -1, axis=1) - corners
    length = np.sqrt((edge**2).sum(axis=2))
    area_vector = np.cross(edge[:, 0], edge[:, 1])
    doubled = np.sqrt((area_vector**2).sum(axis=1))
    normal = area_vector / doubled[:, None]
    along = edge / length[:, :, None]
    outward = np.cross(along, normal[:, None])
    rows["corner"], rows["along"], rows["outward"], rows["normal"] = corners, along, outward, normal
    rows["length"] = length
    rows["height"] = doubled[:, None] / np.roll(length, -1, axis=1)
    rows["cosine"] = (outward * np.roll(outward, -1, axis=1)).sum(axis=2)
    return rows
