# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The rays of a picture: camera, lamp and half-sphere."""

from __future__ import annotations

import warp as wp

wp.set_module_options({"enable_backward": False})

SUBPIXELS = wp.constant(2)
FAR = wp.constant(1.0e6)
HASH_0 = wp.constant(wp.uint32(0x8DA6B343))
HASH_1 = wp.constant(wp.uint32(0xD8163841))
HASH_2 = wp.constant(wp.uint32(0xCB1AB31F))
HASH_3 = wp.constant(wp.uint32(0x7FEB352D))
HASH_4 = wp.constant(wp.uint32(0x846CA68B))
LAMP_SPREAD = wp.constant(0.11)
LAMP_COLOR = wp.constant(wp.vec3(2.1, 1.93, 1.7))
SKY_COLOR = wp.constant(wp.vec3(0.50, 0.58, 0.70))
FLOOR_COLOR = wp.constant(wp.vec3(0.26, 0.23, 0.21))


@wp.struct
class Look:
    """The camera, the light and the surroundings of a picture."""

    eye: wp.vec3
    forward: wp.vec3
    right: wp.vec3
    up: wp.vec3
    target: wp.vec3
    lamp: wp.vec3
    near: wp.vec3
    horizon: wp.vec3
    ground: float
    scale: float
    ray_count: int


@wp.func
def hash_pixel(x: wp.uint32, y: wp.uint32, z: wp.uint32) -> float:
    """Return a number in [0, 1) that looks random."""
    h = x * HASH_0 ^ y * HASH_1 ^ z * HASH_2
    h = (h ^ (h >> wp.uint32(16))) * HASH_3
    h = (h ^ (h >> wp.uint32(15))) * HASH_4
    h = h ^ (h >> wp.uint32(16))
    return float(h >> wp.uint32(8)) / 16777216.0


@wp.func
def fraction(x: float) -> float:
    """Return the part of ``x`` behind the point."""
    return x - wp.floor(x)


@wp.func
def around(axis: wp.vec3, radius: float, turn: float, height: float) -> wp.vec3:
    """Return ``height * axis`` plus a vector across it of length ``radius``, turned by ``turn`` full circles."""
    helper = wp.vec3(1.0, 0.0, 0.0)
    if wp.abs(axis[0]) > 0.7:
        helper = wp.vec3(0.0, 1.0, 0.0)
    side = wp.normalize(wp.cross(axis, helper))
    angle = 6.2831853 * turn
    return axis * height + (side * wp.cos(angle) + wp.cross(axis, side) * wp.sin(angle)) * radius


@wp.func
def is_hidden(mesh: wp.uint64, start: wp.vec3, direction: wp.vec3, reach: float) -> float:
    """Return 1 where a ray meets the mesh within ``reach``, else 0."""
    if wp.mesh_query_ray_anyhit(mesh, start, direction, reach):
        return 1.0
    return 0.0


@wp.func
def lit(mesh: wp.uint64, look: Look, point: wp.vec3, flat: wp.vec3, normal: wp.vec3, u: float, v: float) -> wp.vec3:
    """Return the light that a white surface sends back: the lamp, and the sky and the floor that it sees."""
    start = point + flat * (1.0e-3 * look.scale)
    count = look.ray_count
    shadow = float(0.0)
    open_sky = float(0.0)
    for k in range(count):
        a = fraction(u + (float(k) + 0.5) / float(count))
        b = fraction(v + 0.618034 * float(k))
        spread = LAMP_SPREAD * wp.sqrt(a)
        shadow += is_hidden(mesh, start, wp.normalize(around(look.lamp, spread, b, 1.0)), FAR)
        ray = around(flat, wp.sqrt(a), b, wp.sqrt(1.0 - a))
        open_sky += 1.0 - is_hidden(mesh, start, ray, 2.0 * look.scale)
    shadow = shadow / float(count)
    open_sky = open_sky / float(count)
    facing = wp.max(wp.dot(normal, look.lamp), 0.0)
    upward = 0.5 + 0.5 * normal[2]
    ambient = SKY_COLOR * upward + FLOOR_COLOR * (1.0 - upward)
    return LAMP_COLOR * (facing * (1.0 - shadow)) + ambient * open_sky


@wp.func
def backdrop(look: Look, direction: wp.vec3) -> wp.vec3:
    """Return the colour behind everything."""
    t = wp.clamp(direction[2] * 1.6 + 0.05, 0.0, 1.0)
    return look.horizon * (1.0 - t) + look.near * t


@wp.func
def ground_color(mesh: wp.uint64, look: Look, point: wp.vec3, direction: wp.vec3, u: float, v: float) -> wp.vec3:
    """Return the colour of the ground, which fades into the backdrop."""
    up = wp.vec3(0.0, 0.0, 1.0)
    away = wp.length(point - look.target) / look.scale
    fade = wp.exp(-0.16 * wp.max(away - 0.6, 0.0))
    own = wp.cw_mul(look.near * 1.35, lit(mesh, look, point, up, up, u, v))
    return own * fade + backdrop(look, wp.vec3(direction[0], direction[1], 0.0)) * (1.0 - fade)


@wp.func
def trace(
    mesh: wp.uint64,
    normals: wp.array[wp.vec3],
    colors: wp.array[wp.vec3],
    look: Look,
    direction: wp.vec3,
    u: float,
    v: float,
) -> wp.vec3:
    """Return the colour that comes back along a ray from the eye."""
    ground_distance = float(FAR)
    if wp.abs(direction[2]) > 1.0e-6:
        t = (look.ground - look.eye[2]) / direction[2]
        if t > 0.0:
            ground_distance = t
    hit = wp.mesh_query_ray(mesh, look.eye, direction, wp.min(ground_distance, FAR))
    if not hit.result:
        if ground_distance < FAR:
            return ground_color(mesh, look, look.eye + direction * ground_distance, direction, u, v)
        return backdrop(look, direction)
    corner = 3 * hit.face
    w = 1.0 - hit.u - hit.v
    normal = wp.normalize(normals[corner] * hit.u + normals[corner + 1] * hit.v + normals[corner + 2] * w)
    color = colors[corner] * hit.u + colors[corner + 1] * hit.v + colors[corner + 2] * w
    flat = wp.normalize(hit.normal)
    if wp.dot(flat, direction) > 0.0:
        flat = -flat
    if wp.dot(normal, flat) < 0.0:
        normal = -normal
    point = look.eye + direction * hit.t
    light = lit(mesh, look, point, flat, normal, u, v)
    halfway = wp.normalize(look.lamp - direction)
    gloss = wp.pow(wp.max(wp.dot(normal, halfway), 0.0), 42.0) * 0.22 * light[0]
    rim = wp.pow(1.0 - wp.max(-wp.dot(normal, direction), 0.0), 4.0) * 0.22
    return wp.cw_mul(color, light) + wp.vec3(gloss, gloss, gloss) + wp.cw_mul(SKY_COLOR, light) * rim


@wp.kernel(enable_backward=False)
def render_rows(
    mesh: wp.uint64,
    normals: wp.array[wp.vec3],
    colors: wp.array[wp.vec3],
    look: Look,
    first_row: int,
    pixels: wp.array2d[wp.vec3],
):
    """Write the mean colour of the samples of each pixel, from ``first_row`` on."""
    i, column = wp.tid()
    row = first_row + i
    height = float(pixels.shape[0])
    width = float(pixels.shape[1])
    total = wp.vec3(0.0, 0.0, 0.0)
    for sample in range(SUBPIXELS * SUBPIXELS):
        u = hash_pixel(wp.uint32(column), wp.uint32(row), wp.uint32(2 * sample))
        v = hash_pixel(wp.uint32(column), wp.uint32(row), wp.uint32(2 * sample + 1))
        x = float(column) + (float(sample % SUBPIXELS) + u) / float(SUBPIXELS)
        y = float(row) + (float(sample // SUBPIXELS) + v) / float(SUBPIXELS)
        across = (2.0 * x - width) / height
        along = 1.0 - 2.0 * y / height
        direction = wp.normalize(look.forward + look.right * across + look.up * along)
        total += trace(mesh, normals, colors, look, direction, fraction(u + 0.31), fraction(v + 0.57))
    pixels[row, column] = total / float(SUBPIXELS * SUBPIXELS)
