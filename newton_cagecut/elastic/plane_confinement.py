# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Plane bodies: what keeps their vertices in the plane through their rest positions.

Plane strain is the solid's elasticity (paper, section 6.1) with the third direction of F held at the identity's. A
plane body's vertices are points of the world, and its plane may be tilted. Velocities and their changes are taken into
the plane in float64, and positions are put back to it after each step, so that rounding does not add up: what is left
out of the plane is one rounding to float32, and nothing at all in a plane that is normal to an axis of the world.
"""

from __future__ import annotations

import warp as wp

from .arrays import BodyArrays, LinearSystem, StepArrays

wp.set_module_options({"enable_backward": False})

NEGLIGIBLE = wp.constant(wp.float64(1.0e-6))
"""Component of a unit normal that is rounding of the float32 rotation: 0, for exact planes normal to an axis."""


@wp.func
def in_plane(vector: wp.vec3, normal: wp.vec3d) -> wp.vec3:
    """The part of a vector that lies in the plane."""
    exact = wp.vec3d(vector)
    return wp.vec3(exact - wp.dot(normal, exact) * normal)


@wp.func
def inverse_in_plane(matrix: wp.mat33d, normal: wp.vec3d) -> wp.mat33d:
    """Inverse of what a positive definite matrix does in the plane; zero along the normal."""
    across = wp.outer(normal, normal)
    project = wp.identity(3, dtype=wp.float64) - across
    return project * wp.inverse(project * matrix * project + wp.trace(matrix) * across) * project


@wp.kernel(enable_backward=False)
def find_normal(body: BodyArrays):
    """Unit normal of the plane: the third axis of the rest frame, in the world."""
    axis = wp.normalize(wp.mat33d(body.rotation[0]) * wp.vec3d(wp.float64(0.0), wp.float64(0.0), wp.float64(1.0)))
    for k in range(3):
        if wp.abs(axis[k]) < NEGLIGIBLE:
            axis[k] = wp.float64(0.0)
    body.normal[0] = wp.normalize(axis)


@wp.kernel(enable_backward=False)
def confine_start(body: BodyArrays, step: StepArrays, system: LinearSystem):
    """Take the first guess of a step, and the velocities that it predicts, into the plane."""
    i = wp.tid()
    system.solution[i] = in_plane(system.solution[i], body.normal[0])
    step.predicted[i] = in_plane(step.predicted[i], body.normal[0])


@wp.kernel(enable_backward=False)
def confine_velocities(body: BodyArrays, step: StepArrays):
    """Take the velocities after the solve into the plane."""
    i = wp.tid()
    step.predicted[i] = in_plane(step.predicted[i], body.normal[0])


@wp.kernel(enable_backward=False)
def confine_end(body: BodyArrays, positions: wp.array[wp.vec3], velocities: wp.array[wp.vec3]):
    """Take the velocities of a step's end into the plane, and put the positions back to it."""
    i = wp.tid()
    if i < body.vertex_count[0]:
        normal = body.normal[0]
        velocities[i] = in_plane(velocities[i], normal)
        exact = wp.vec3d(positions[i])
        height = wp.dot(normal, exact - wp.vec3d(body.rest[i]))
        positions[i] = wp.vec3(exact - height * normal)
