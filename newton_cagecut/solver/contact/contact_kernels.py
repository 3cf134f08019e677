# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of contact between surface points and Newton's shapes."""

from __future__ import annotations

import warp as wp

wp.set_module_options({"enable_backward": False})

_SLOWEST = wp.constant(1.0e-3)
"""Sliding speed below which friction is viscous [m/s]."""


@wp.kernel(enable_backward=False)
def collect_contacts(
    contact_count: wp.array[wp.int32],
    contact_particle: wp.array[wp.int32],
    contact_shape: wp.array[wp.int32],
    contact_body_pos: wp.array[wp.vec3],
    contact_body_vel: wp.array[wp.vec3],
    contact_normal: wp.array[wp.vec3],
    first_particle: int,
    point_count: wp.array[wp.int32],
    particle_q: wp.array[wp.vec3],
    particle_qd: wp.array[wp.vec3],
    particle_radius: wp.array[float],
    body_q: wp.array[wp.transform],
    body_qd: wp.array[wp.spatial_vector],
    body_com: wp.array[wp.vec3],
    shape_body: wp.array[wp.int32],
    shape_ke: wp.array[float],
    shape_kd: wp.array[float],
    shape_mu: wp.array[float],
    material: wp.vec3,
    force: wp.array[wp.vec3],
    stiffness: wp.array[wp.mat33],
    damping: wp.array[wp.mat33],
):
    """Penalty force, stiffness and damping of one soft contact, added to its surface point."""
    c = wp.tid()
    if c >= wp.min(contact_count[0], contact_particle.shape[0]):
        return
    particle = contact_particle[c]
    row = particle - first_particle
    if row < 0 or row >= point_count[0]:
        return
    shape = contact_shape[c]
    rigid = shape_body[shape]
    point = contact_body_pos[c]
    velocity = contact_body_vel[c]
    if rigid >= 0:
        pose = body_q[rigid]
        point = wp.transform_point(pose, contact_body_pos[c])
        arm = point - wp.transform_point(pose, body_com[rigid])
        twist = body_qd[rigid]
        velocity = wp.transform_vector(pose, contact_body_vel[c])
        velocity += wp.spatial_top(twist) + wp.cross(wp.spatial_bottom(twist), arm)
    normal = contact_normal[c]
    depth = wp.dot(normal, particle_q[particle] - point) - particle_radius[particle]
    if depth >= 0.0:
        return
    k = 0.5 * (material[0] + shape_ke[shape])
    push = -k * depth
    along = wp.outer(normal, normal)
    sliding = (particle_qd[particle] - velocity) - normal * wp.dot(normal, particle_qd[particle] - velocity)
    drag = 0.5 * (material[2] + shape_mu[shape]) * push / wp.max(wp.length(sliding), _SLOWEST)
    resist = 0.5 * (material[1] + shape_kd[shape]) * along + drag * (wp.identity(3, dtype=float) - along)
    wp.atomic_add(force, row, push * normal + resist * velocity)
    wp.atomic_add(stiffness, row, k * along)
    wp.atomic_add(damping, row, resist)


@wp.kernel(enable_backward=False)
def list_touching(
    point_count: wp.array[wp.int32],
    stiffness: wp.array[wp.mat33],
    touching: wp.array[wp.int32],
    touching_count: wp.array[wp.int32],
):
    """List the surface points that touch something."""
    i = wp.tid()
    if i < point_count[0] and wp.trace(stiffness[i]) > 0.0:
        touching[wp.atomic_add(touching_count, 0, 1)] = i


@wp.func
def gather_at_point(weights: wp.array2d[float], row: int, vertex_count: int, values: wp.array[wp.vec3]) -> wp.vec3:
    """A vertex field at a surface point."""
    total = wp.vec3()
    for j in range(vertex_count):
        total += weights[row, j] * values[j]
    return total


@wp.kernel(enable_backward=False)
def find_contact_residual(
    touching: wp.array[wp.int32],
    touching_count: wp.array[wp.int32],
    weights: wp.array2d[float],
    first_row: int,
    vertex_count: wp.array[wp.int32],
    dt: float,
    predicted: wp.array[wp.vec3],
    force: wp.array[wp.vec3],
    stiffness: wp.array[wp.mat33],
    damping: wp.array[wp.mat33],
    system: wp.array[wp.mat33],
    product: wp.array[wp.vec3],
):
    """Residual and system block of each touching point."""
    slot = wp.tid()
    if slot >= touching_count[0]:
        return
    i = touching[slot]
    block = dt * dt * stiffness[i] + dt * damping[i]
    velocity = gather_at_point(weights, first_row + i, vertex_count[0], predicted)
    system[slot] = block
    product[slot] = dt * force[i] - block * velocity


@wp.kernel(enable_backward=False)
def scatter_contact_residual(
    touching: wp.array[wp.int32],
    touching_count: wp.array[wp.int32],
    weights: wp.array2d[float],
    first_row: int,
    vertex_count: wp.array[wp.int32],
    fixed: wp.array[wp.int32],
    system: wp.array[wp.mat33],
    product: wp.array[wp.vec3],
    residual: wp.array[wp.vec3],
    blocks: wp.array[wp.mat33],
):
    """Pull residual and diagonal blocks back to a vertex."""
    j = wp.tid()
    if j >= vertex_count[0] or fixed[j] != 0:
        return
    total = wp.vec3()
    block = wp.mat33()
    for slot in range(touching_count[0]):
        w = weights[first_row + touching[slot], j]
        total += w * product[slot]
        block += (w * w) * system[slot]
    residual[j] = residual[j] + total
    blocks[j] = blocks[j] + block


@wp.kernel(enable_backward=False)
def find_contact_product(
    touching: wp.array[wp.int32],
    touching_count: wp.array[wp.int32],
    weights: wp.array2d[float],
    first_row: int,
    vertex_count: wp.array[wp.int32],
    direction: wp.array[wp.vec3],
    system: wp.array[wp.mat33],
    product: wp.array[wp.vec3],
):
    """System block times a direction at each touching point."""
    slot = wp.tid()
    if slot < touching_count[0]:
        product[slot] = system[slot] * gather_at_point(weights, first_row + touching[slot], vertex_count[0], direction)


@wp.kernel(enable_backward=False)
def scatter_contact_product(
    touching: wp.array[wp.int32],
    touching_count: wp.array[wp.int32],
    weights: wp.array2d[float],
    first_row: int,
    vertex_count: wp.array[wp.int32],
    fixed: wp.array[wp.int32],
    product: wp.array[wp.vec3],
    result: wp.array[wp.vec3],
):
    """Pull a product back to a vertex."""
    j = wp.tid()
    if j >= vertex_count[0] or fixed[j] != 0:
        return
    total = wp.vec3()
    for slot in range(touching_count[0]):
        total += weights[first_row + touching[slot], j] * product[slot]
    result[j] = result[j] + total
