# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Counter-based randomness: any step of any walk can be drawn alone.

The hash is pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 9(3), 2020). Its four words are
the seed, the query point, the walk and the step, so a walk is a function of the walls and the seed, and running it
again retraces it (paper, section 4.2).
"""

from __future__ import annotations

import warp as wp

NESTED_STREAM = wp.constant(wp.uint32(0x9E3779B9))
"""Added to the seed for the walks on a face, so that they share no number with the walks in the volume."""

GATE_STREAM = wp.constant(wp.uint32(0x85EBCA6B))
"""Added to the seed, times a gate's number and one, for the part of a walk behind that gate."""

_UNIT = wp.constant(1.0 / 16777216.0)
_TWO_PI = wp.constant(6.283185307179586)


@wp.func
def pcg4d(seed: wp.uint32, point: wp.uint32, walk: wp.uint32, step: wp.uint32) -> wp.vec4ui:
    """Hash four counters to four independent 32-bit words."""
    a = seed * wp.uint32(1664525) + wp.uint32(1013904223)
    b = point * wp.uint32(1664525) + wp.uint32(1013904223)
    c = walk * wp.uint32(1664525) + wp.uint32(1013904223)
    d = step * wp.uint32(1664525) + wp.uint32(1013904223)
    a = a + b * d
    b = b + c * a
    c = c + a * b
    d = d + b * c
    a = a ^ (a >> wp.uint32(16))
    b = b ^ (b >> wp.uint32(16))
    c = c ^ (c >> wp.uint32(16))
    d = d ^ (d >> wp.uint32(16))
    a = a + b * d
    b = b + c * a
    c = c + a * b
    d = d + b * c
    return wp.vec4ui(a, b, c, d)


@wp.func
def unit_float(word: wp.uint32) -> float:
    """Map a word to the centre of one of 2^24 equal intervals of (0, 1)."""
    return (float(word >> wp.uint32(8)) + 0.5) * _UNIT


@wp.func
def direction_on_sphere(seed: wp.uint32, point: wp.uint32, walk: wp.uint32, step: wp.uint32) -> wp.vec3:
    """Draw a uniform unit vector in 3D."""
    words = pcg4d(seed, point, walk, step)
    z = 1.0 - 2.0 * unit_float(words[0])
    angle = _TWO_PI * unit_float(words[1])
    radius = wp.sqrt(wp.max(0.0, 1.0 - z * z))
    return wp.vec3(radius * wp.cos(angle), radius * wp.sin(angle), z)


@wp.func
def direction_on_circle(seed: wp.uint32, point: wp.uint32, walk: wp.uint32, step: wp.uint32) -> wp.vec2:
    """Draw a uniform unit vector in 2D."""
    words = pcg4d(seed, point, walk, step)
    angle = _TWO_PI * unit_float(words[0])
    return wp.vec2(wp.cos(angle), wp.sin(angle))


@wp.func
def direction_in_plane(seed: wp.uint32, point: wp.uint32, walk: wp.uint32, step: wp.uint32) -> wp.vec3:
    """Draw a uniform unit vector of the plane z = 0."""
    direction = direction_on_circle(seed, point, walk, step)
    return wp.vec3(direction[0], direction[1], 0.0)


def make_direction(dimension: int) -> wp.Function:
    """The function (seed, point, walk, step) -> uniform unit vector in a dimension; 2D is the plane z = 0."""
    return direction_on_sphere if dimension == 3 else direction_in_plane
