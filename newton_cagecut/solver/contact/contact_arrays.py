# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Warp structs of contact: what Newton's pipeline found, what it was found against, and what a body makes of it."""

from __future__ import annotations

import newton
import warp as wp


@wp.struct
class SoftContacts:
    """Newton's soft contacts, one row a contact of a particle with a shape."""

    count: wp.array[wp.int32]
    """Number of contacts found, which may be more than there are rows, shape (1,)."""
    particle: wp.array[wp.int32]
    """The particle."""
    shape: wp.array[wp.int32]
    """The shape."""
    point: wp.array[wp.vec3]
    """Point on the shape, in its rigid body's frame [m]."""
    velocity: wp.array[wp.vec3]
    """The point's velocity relative to its rigid body, in its frame [m/s]."""
    normal: wp.array[wp.vec3]
    """Normal in the world, from the shape to the particle."""


@wp.struct
class ContactModel:
    """What of a model contact depends on. Materials are stiffness [N/m], damping [N s/m] and friction."""

    particle_radius: wp.array[float]
    """Radius, one a particle [m]."""
    particle_material: wp.vec3
    """Stiffness, damping and friction of the particles."""
    shape_ke: wp.array[float]
    """Stiffness, one a shape."""
    shape_kd: wp.array[float]
    """Damping, one a shape."""
    shape_mu: wp.array[float]
    """Friction, one a shape."""
    shape_body: wp.array[wp.int32]
    """Rigid body, one a shape; -1 for none."""
    body_com: wp.array[wp.vec3]
    """Centre of mass in its frame, one a rigid body [m]."""


@wp.struct
class ContactState:
    """What of a state contact depends on."""

    particle_q: wp.array[wp.vec3]
    """Positions, one a particle [m]."""
    particle_qd: wp.array[wp.vec3]
    """Velocities, one a particle [m/s]."""
    body_q: wp.array[wp.transform]
    """Poses, one a rigid body [m]."""
    body_qd: wp.array[wp.spatial_vector]
    """Twists about the centre of mass, one a rigid body [m/s, rad/s]."""


def soft_contacts(contacts: newton.Contacts) -> SoftContacts:
    """The soft contacts of a collision pipeline."""
    found = SoftContacts()
    found.count = contacts.soft_contact_count
    found.particle, found.shape = contacts.soft_contact_particle, contacts.soft_contact_shape
    found.point, found.velocity = contacts.soft_contact_body_pos, contacts.soft_contact_body_vel
    found.normal = contacts.soft_contact_normal
    return found


def contact_model(model: newton.Model) -> ContactModel:
    """What contact reads of a model, as it is now."""
    found = ContactModel()
    found.particle_radius = model.particle_radius
    found.particle_material = wp.vec3(model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu)
    found.shape_ke, found.shape_kd = model.shape_material_ke, model.shape_material_kd
    found.shape_mu = model.shape_material_mu
    found.shape_body, found.body_com = model.shape_body, model.body_com
    return found


def contact_state(state: newton.State) -> ContactState:
    """What contact reads of a state."""
    found = ContactState()
    found.particle_q, found.particle_qd = state.particle_q, state.particle_qd
    found.body_q, found.body_qd = state.body_q, state.body_qd
    return found
