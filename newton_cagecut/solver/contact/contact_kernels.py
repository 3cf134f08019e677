# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of contact between surface points and Newton's shapes."""

from __future__ import annotations

import warp as wp

from ..body.embedding import SurfaceRows, at_surface_point
from .contact_arrays import ContactModel, ContactState, SoftContacts, TouchedPoints

wp.set_module_options({"enable_backward": False})

_SLOWEST = wp.constant(1.0e-3)
"""Sliding speed below which friction is viscous [m/s]."""


@wp.kernel(enable_backward=False)
def collect_contacts(
    contacts: SoftContacts,
    model: ContactModel,
    state: ContactState,
    first_particle: int,
    rows: SurfaceRows,
    points: TouchedPoints,
):
    """Penalty force, stiffness and damping of one soft contact, added to its surface point."""
    c = wp.tid()
    if c >= wp.min(contacts.count[0], contacts.particle.shape[0]):
        return
    particle = contacts.particle[c]
    row = particle - first_particle
    if row < 0 or row >= rows.point_count[0]:
        return
    shape = contacts.shape[c]
    if shape < 0 or shape >= model.shape_body.shape[0]:  # of another model
        return
    rigid = model.shape_body[shape]
    point = contacts.point[c]
    velocity = contacts.velocity[c]
    if rigid >= 0:
        pose = state.body_q[rigid]
        point = wp.transform_point(pose, contacts.point[c])
        arm = point - wp.transform_point(pose, model.body_com[rigid])
        twist = state.body_qd[rigid]
        velocity = wp.transform_vector(pose, contacts.velocity[c])
        velocity += wp.spatial_top(twist) + wp.cross(wp.spatial_bottom(twist), arm)
    normal = contacts.normal[c]
    depth = wp.dot(normal, state.particle_q[particle] - point) - model.particle_radius[particle]
    if depth >= 0.0:
        return
    k = 0.5 * (model.particle_material[0] + model.shape_ke[shape])
    push = -k * depth
    along = wp.outer(normal, normal)
    relative = state.particle_qd[particle] - velocity
    sliding = relative - normal * wp.dot(normal, relative)
    drag = 0.5 * (model.particle_material[2] + model.shape_mu[shape]) * push / wp.max(wp.length(sliding), _SLOWEST)
    kd = 0.5 * (model.particle_material[1] + model.shape_kd[shape])
    resist = kd * along + drag * (wp.identity(3, dtype=float) - along)
    wp.atomic_add(points.force, row, push * normal + resist * velocity)
    wp.atomic_add(points.stiffness, row, k * along)
    wp.atomic_add(points.damping, row, resist)


@wp.kernel(enable_backward=False)
def list_touching(rows: SurfaceRows, points: TouchedPoints):
    """List the surface points that touch something."""
    i = wp.tid()
    if i < rows.point_count[0] and wp.trace(points.stiffness[i]) > 0.0:
        points.touching[wp.atomic_add(points.touching_count, 0, 1)] = i


@wp.kernel(enable_backward=False)
def find_contact_residual(
    scales: wp.vec3,
    guess: wp.array[wp.vec3],
    earlier: wp.array[wp.vec3],
    rows: SurfaceRows,
    points: TouchedPoints,
):
    """Residual and system block of each touching point; scales of force, stiffness and damping."""
    slot = wp.tid()
    if slot < points.touching_count[0]:
        i = points.touching[slot]
        block = scales[1] * points.stiffness[i] + scales[2] * points.damping[i]
        force = points.force[i] + points.damping[i] * at_surface_point(i, earlier, rows)
        points.system[slot] = block
        points.product[slot] = scales[0] * force - block * at_surface_point(i, guess, rows)


@wp.kernel(enable_backward=False)
def find_contact_product(direction: wp.array[wp.vec3], rows: SurfaceRows, points: TouchedPoints):
    """System block times a direction at each touching point."""
    slot = wp.tid()
    if slot < points.touching_count[0]:
        points.product[slot] = points.system[slot] * at_surface_point(points.touching[slot], direction, rows)


@wp.func
def pulled_back(j: int, rows: SurfaceRows, points: TouchedPoints) -> wp.vec3:
    """Residuals or products of the touching points, summed with their weights of a vertex."""
    total = wp.vec3()
    for slot in range(points.touching_count[0]):
        total += rows.weights[rows.first_row + points.touching[slot], j] * points.product[slot]
    return total


@wp.kernel(enable_backward=False)
def add_contact_residual(
    fixed: wp.array[wp.int32],
    rows: SurfaceRows,
    points: TouchedPoints,
    residual: wp.array[wp.vec3],
    blocks: wp.array[wp.mat33],
):
    """Pull residual and diagonal blocks back to a vertex."""
    j = wp.tid()
    if j < rows.vertex_count[0] and fixed[j] == 0:
        block = wp.mat33()
        for slot in range(points.touching_count[0]):
            w = rows.weights[rows.first_row + points.touching[slot], j]
            block += (w * w) * points.system[slot]
        blocks[j] = blocks[j] + block
        residual[j] = residual[j] + pulled_back(j, rows, points)


@wp.kernel(enable_backward=False)
def add_contact_product(
    fixed: wp.array[wp.int32], rows: SurfaceRows, points: TouchedPoints, product: wp.array[wp.vec3]
):
    """Pull a product back to a vertex."""
    j = wp.tid()
    if j < rows.vertex_count[0] and fixed[j] == 0:
        product[j] = product[j] + pulled_back(j, rows, points)
