# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of contact between surface points and Newton's shapes, and of forces that were given to surface points.

Each contact has a slot of its own, so that its reaction is known. Slots are in the order of points and of shapes,
whatever the order in which the pipeline has found them.
"""

from __future__ import annotations

import newton
import warp as wp

from ...elastic import PointForces
from ..body.embedding import SurfaceRows
from .contact_arrays import ContactModel, ContactSlots, ContactState, RigidResponse, SoftContacts

wp.set_module_options({"enable_backward": False})

_SLOWEST = wp.constant(1.0e-3)
"""Sliding speed below which friction is viscous [m/s]."""
_STICKING = wp.constant(1.0e-4)
"""The same of firm contacts [m/s]."""
_PUSHED_OUT = wp.constant(1.0)
"""Greatest speed at which points deeper than their radius are pushed out [m/s]."""
_FIRM = wp.constant(10.0)
"""Stiffness there, in mass of the point over the square of the time step."""
_KINEMATIC = wp.constant(int(newton.BodyFlags.KINEMATIC))


@wp.struct
class Touch:
    """One contact of a surface point."""

    row: int
    """The surface point; -1 if the contact is not the body's, or does not act."""
    rigid: int
    """The rigid body that is touched, -1 for none."""
    arm: wp.vec3
    """From its centre of mass to the place touched [m]."""
    normal: wp.vec3
    """Normal, towards the point."""
    gap: float
    """Distance between the surfaces, negative where they overlap [m]."""
    velocity: wp.vec3
    """Velocity of the point [m/s]."""
    drift: wp.vec3
    """Velocity of what it touches [m/s]."""


@wp.func
def find_touch(
    c: int,
    dt: float,
    contacts: SoftContacts,
    model: ContactModel,
    state: ContactState,
    response: RigidResponse,
    first_particle: int,
    rows: SurfaceRows,
) -> Touch:
    """What a soft contact is; it acts if its gap is closed by the end of the step."""
    touch = Touch()
    touch.row = -1
    if c >= wp.min(contacts.count[0], contacts.particle.shape[0]):
        return touch
    particle = contacts.particle[c]
    row = particle - first_particle
    if row < 0 or row >= rows.point_count[0]:
        return touch
    shape = contacts.shape[c]
    if shape < 0 or shape >= model.shape_body.shape[0]:  # of another model
        return touch
    touch.rigid = model.shape_body[shape]
    point = contacts.point[c]
    touch.drift = contacts.velocity[c]
    if touch.rigid >= 0:
        pose = state.body_q[touch.rigid]
        point = wp.transform_point(pose, contacts.point[c])
        touch.arm = point - wp.transform_point(pose, model.body_com[touch.rigid])
        twist = response.twist[touch.rigid]
        touch.drift = wp.transform_vector(pose, contacts.velocity[c])
        touch.drift += wp.spatial_top(twist) + wp.cross(wp.spatial_bottom(twist), touch.arm)
    touch.normal = contacts.normal[c]
    touch.gap = wp.dot(touch.normal, state.particle_q[particle] - point) - model.particle_radius[particle]
    touch.velocity = state.particle_qd[particle]
    closing = wp.dot(touch.normal, touch.velocity - touch.drift)
    if touch.gap < 0.0 or (model.firmness > 0.0 and touch.gap + dt * closing < 0.0):
        touch.row = row
    return touch


@wp.func
def inverse_mass(touch: Touch, model: ContactModel, state: ContactState, response: RigidResponse) -> float:
    """How much velocity a rigid body takes along the normal from an impulse on one of its contacts [1/kg]."""
    if touch.rigid < 0:
        return 0.0
    if (model.body_flags[touch.rigid] & _KINEMATIC) != 0:
        return 0.0
    turn = wp.quat_rotate_inv(wp.transform_get_rotation(state.body_q[touch.rigid]), wp.cross(touch.arm, touch.normal))
    own = model.body_inv_mass[touch.rigid] + wp.dot(turn, model.body_inv_inertia[touch.rigid] * turn)
    return response.share[touch.rigid] * float(response.count[touch.rigid]) * own


@wp.kernel(enable_backward=False)
def begin_contacts(
    vertex_mass: wp.array[float], rows: SurfaceRows, state: ContactState, first_particle: int, slots: ContactSlots
):
    """Count the forces that were given, and weigh the body."""
    i = wp.tid()
    if i == 0:
        total = float(0.0)
        for j in range(rows.vertex_count[0]):
            total += vertex_mass[j]
        slots.mass[0] = total
    count = int(0)
    if i < rows.point_count[0] and wp.length_sq(state.particle_f[first_particle + i]) > 0.0:
        count = 1
    slots.point_count[i] = count


@wp.kernel(enable_backward=False)
def count_contacts(
    dt: float,
    contacts: SoftContacts,
    model: ContactModel,
    state: ContactState,
    response: RigidResponse,
    first_particle: int,
    rows: SurfaceRows,
    slots: ContactSlots,
):
    """Count the contacts that act, by surface point and by rigid body."""
    touch = find_touch(wp.tid(), dt, contacts, model, state, response, first_particle, rows)
    if touch.row >= 0:
        wp.atomic_add(slots.point_count, touch.row, 1)
        if touch.rigid >= 0:
            wp.atomic_add(response.count, touch.rigid, 1)


@wp.kernel(enable_backward=False)
def place_forces(rows: SurfaceRows, state: ContactState, first_particle: int, slots: ContactSlots, points: PointForces):
    """Give the forces that were given their slots, which are the first of each surface point."""
    i = wp.tid()
    count = slots.point_count[i]
    first = slots.point_first[i]
    if i == slots.point_count.shape[0] - 1:
        points.count[0] = wp.min(first + count, slots.source.shape[0])  # more than that find no slot
    slots.point_count[i] = 0
    if i < rows.point_count[0] and count > 0 and first < slots.source.shape[0]:
        force = state.particle_f[first_particle + i]
        if wp.length_sq(force) > 0.0:
            slots.point_count[i] = 1
            slots.source[first] = -1
            slots.rigid[first] = -1
            points.touched[first] = i
            points.force[first] = force
            points.stiffness[first] = wp.mat33()
            points.damping[first] = wp.mat33()
            points.drift[first] = wp.vec3()
            points.impulse[first] = wp.vec3()


@wp.kernel(enable_backward=False)
def place_contacts(
    dt: float,
    contacts: SoftContacts,
    model: ContactModel,
    state: ContactState,
    response: RigidResponse,
    first_particle: int,
    rows: SurfaceRows,
    slots: ContactSlots,
):
    """Give the contacts their slots."""
    c = wp.tid()
    touch = find_touch(c, dt, contacts, model, state, response, first_particle, rows)
    if touch.row >= 0:
        slot = slots.point_first[touch.row] + wp.atomic_add(slots.point_count, touch.row, 1)
        if slot < slots.source.shape[0]:
            slots.source[slot] = c


@wp.kernel(enable_backward=False)
def sort_contacts(contacts: SoftContacts, slots: ContactSlots):
    """Bring the contacts of each surface point into the order of their shapes."""
    i = wp.tid()
    first = slots.point_first[i]
    end = wp.min(first + slots.point_count[i], slots.source.shape[0])
    for slot in range(first + 1, end):
        moving = slots.source[slot]
        place = int(slot)
        while place > first and moving >= 0:
            before = slots.source[place - 1]
            if before < 0:
                break
            if contacts.shape[before] <= contacts.shape[moving]:
                break
            slots.source[place] = before
            place -= 1
        slots.source[place] = moving


@wp.kernel(enable_backward=False)
def fill_contacts(
    dt: float,
    contacts: SoftContacts,
    model: ContactModel,
    state: ContactState,
    response: RigidResponse,
    first_particle: int,
    rows: SurfaceRows,
    slots: ContactSlots,
    points: PointForces,
):
    """Force, stiffness and damping of each contact; see ``contact_term``."""
    slot = wp.tid()
    if slot >= points.count[0] or slots.source[slot] < 0:
        return
    c = slots.source[slot]
    touch = find_touch(c, dt, contacts, model, state, response, first_particle, rows)
    shape, normal = contacts.shape[c], touch.normal
    radius = model.particle_radius[contacts.particle[c]]
    relative = touch.velocity - touch.drift
    closing = wp.dot(normal, relative)
    sliding = relative - normal * closing
    mass = slots.mass[0] / float(points.count[0])
    material = model.particle_material
    k = 0.5 * (material[0] + model.shape_ke[shape])
    push = -k * touch.gap
    friction = 0.5 * (material[2] + model.shape_mu[shape])
    speed = wp.length(sliding)
    rubbing, drag = wp.vec3(), friction * push / wp.max(speed, _SLOWEST)
    if model.firmness > 0.0:
        firmness = model.firmness / float(points.count[0])
        ahead = wp.max(-closing, 0.0) * dt / radius
        k = wp.max(k, mass * ahead / (dt * dt) + wp.clamp(ahead - 1.0, 0.0, 1.0) * firmness)
        push = -k * touch.gap
        if touch.gap < -radius:
            push = k * radius
            k = wp.max(k, wp.max(_FIRM * mass / (dt * dt), firmness))
            push += k * wp.min(-touch.gap - radius, dt * _PUSHED_OUT)
        friction *= wp.max(push, 0.0)
        drag = friction / wp.max(speed, _STICKING)
        if speed > 2.0 * dt * friction / mass:  # too fast to be stopped in the step: the force is known
            rubbing, drag = -drag * sliding, 0.0
    give = dt * inverse_mass(touch, model, state, response)
    kd = 0.5 * (material[1] + model.shape_kd[shape])
    shrink = 1.0 / (1.0 + give * (dt * k + kd))
    if model.firmness > 0.0:  # what closes the gap by the end of the step, not before
        kd += dt * k
        k = 0.0
    along = wp.outer(normal, normal)
    across = wp.identity(3, dtype=float) - along
    slots.rigid[slot] = touch.rigid
    slots.arm[slot] = touch.arm
    points.touched[slot] = touch.row
    points.force[slot] = (shrink * push) * normal + rubbing
    points.stiffness[slot] = (shrink * k) * along
    points.damping[slot] = (shrink * kd) * along + (drag / (1.0 + give * drag)) * across
    points.drift[slot] = touch.drift
    points.impulse[slot] = wp.vec3()


@wp.kernel(enable_backward=False)
def react(
    enabled: wp.array[wp.int32],
    dt: float,
    slots: ContactSlots,
    points: PointForces,
    response: RigidResponse,
    body_f: wp.array[wp.spatial_vector],
):
    """Add what a cage body's contacts do to each rigid body, about its centre of mass."""
    rigid = wp.tid()
    if response.count[rigid] == 0 or enabled[0] == 0:
        return
    force, torque = wp.vec3(), wp.vec3()
    for slot in range(wp.min(points.count[0], slots.rigid.shape[0])):
        if points.touched[slot] >= 0 and slots.rigid[slot] == rigid:
            pull = points.impulse[slot]
            force -= pull
            torque -= wp.cross(slots.arm[slot], pull)
    body_f[rigid] = body_f[rigid] + wp.spatial_vector(force / dt, torque / dt)
