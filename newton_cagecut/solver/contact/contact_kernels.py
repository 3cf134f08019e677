# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of contact between surface points and Newton's shapes."""

from __future__ import annotations

import warp as wp

from ...elastic import PointForces
from ..body.embedding import SurfaceRows
from .contact_arrays import ContactModel, ContactState, SoftContacts

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
    points: PointForces,
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
def list_touching(rows: SurfaceRows, points: PointForces):
    """List the surface points that touch something."""
    i = wp.tid()
    if i < rows.point_count[0] and wp.trace(points.stiffness[i]) > 0.0:
        points.touched[wp.atomic_add(points.count, 0, 1)] = i
