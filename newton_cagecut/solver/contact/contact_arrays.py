# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Warp structs of contact: what Newton's pipeline found, what it was found against, and what a body makes of it."""

from __future__ import annotations

import newton
import warp as wp

from ..body.contact_material import ContactMaterial


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
    body_inv_mass: wp.array[float]
    """Inverse mass, one a rigid body [1/kg]."""
    body_inv_inertia: wp.array[wp.mat33]
    """Inverse inertia about the centre of mass in its frame, one a rigid body [1/(kg m^2)]."""
    body_flags: wp.array[wp.int32]
    """Newton's flags, one a rigid body."""
    firmness: float
    """Stiffness that Young's modulus gives to all points together, of a body with firm contacts; otherwise 0 [N/m]."""


@wp.struct
class ContactState:
    """What of a state contact depends on."""

    particle_q: wp.array[wp.vec3]
    """Positions, one a particle [m]."""
    particle_qd: wp.array[wp.vec3]
    """Velocities, one a particle [m/s]."""
    particle_f: wp.array[wp.vec3]
    """Forces that were given, one a particle [N]."""
    body_q: wp.array[wp.transform]
    """Poses, one a rigid body [m]."""


@wp.struct
class ContactSlots:
    """What a body's contacts are with, one row a slot of its forces on points."""

    point_count: wp.array[wp.int32]
    """Number of forces, one a surface point."""
    point_first: wp.array[wp.int32]
    """Slot of the first, one a surface point."""
    source: wp.array[wp.int32]
    """The soft contact; -1 for a force that was given to a particle."""
    rigid: wp.array[wp.int32]
    """The rigid body that is touched; -1 for none."""
    arm: wp.array[wp.vec3]
    """From its centre of mass to the place touched [m]."""
    mass: wp.array[float]
    """Mass of the body, shape (1,) [kg]."""


@wp.struct
class RigidResponse:
    """How rigid bodies give way, one row each."""

    twist: wp.array[wp.spatial_vector]
    """Twist about the centre of mass that is expected without further contact [m/s, rad/s]."""
    share: wp.array[float]
    """How much of what its mass tells it gives way, 0 for a body that is held."""
    count: wp.array[wp.int32]
    """Number of contacts with cage bodies."""


def make_contact_slots(points: int, slots: int) -> ContactSlots:
    """Slots that hold nothing yet, on the scoped device.

    Args:
        points: Number of surface points.
        slots: Number of slots.
    """
    found = ContactSlots()
    found.point_count, found.point_first = (wp.zeros(points, dtype=wp.int32) for _ in range(2))
    found.source, found.rigid = (wp.zeros(slots, dtype=wp.int32) for _ in range(2))
    found.arm, found.mass = wp.zeros(slots, dtype=wp.vec3), wp.zeros(1, dtype=float)
    return found


def soft_contacts(contacts: newton.Contacts) -> SoftContacts:
    """The soft contacts of a collision pipeline."""
    found = SoftContacts()
    found.count = contacts.soft_contact_count
    found.particle, found.shape = contacts.soft_contact_particle, contacts.soft_contact_shape
    found.point, found.velocity = contacts.soft_contact_body_pos, contacts.soft_contact_body_vel
    found.normal = contacts.soft_contact_normal
    return found


def contact_model(model: newton.Model, material: ContactMaterial, firmness: float) -> ContactModel:
    """What contact of a body reads of a model, as it is now.

    Args:
        model: The model.
        material: The body's own contact material.
        firmness: See ``ContactModel`` [N/m].
    """
    found = ContactModel()
    found.firmness = firmness
    found.particle_radius = model.particle_radius
    shared = (model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu)
    own = (material.stiffness, material.damping, material.friction)
    found.particle_material = wp.vec3(*(there if mine is None else mine for mine, there in zip(own, shared)))
    found.shape_ke, found.shape_kd = model.shape_material_ke, model.shape_material_kd
    found.shape_mu = model.shape_material_mu
    found.shape_body, found.body_com, found.body_flags = model.shape_body, model.body_com, model.body_flags
    found.body_inv_mass, found.body_inv_inertia = model.body_inv_mass, model.body_inv_inertia
    return found


def contact_state(state: newton.State) -> ContactState:
    """What contact reads of a state."""
    found = ContactState()
    found.particle_q, found.particle_qd, found.particle_f = state.particle_q, state.particle_qd, state.particle_f
    found.body_q = state.body_q
    return found
