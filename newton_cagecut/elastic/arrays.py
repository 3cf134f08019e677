# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Warp structs of a reduced system: what a body is between edits, what a step works on, and what it solves.

Each holds the arrays of one body, so that a kernel takes a few structs and not a dozen arrays.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from .stiffness import Stiffness

HELD = wp.constant(1)
DRIVEN = wp.constant(2)
"""Values of ``BodyArrays.fixed``."""

CPU_WIDTH = 8
"""Points that lie side by side in a vector on a CPU; see ``solve/lanes.py``."""
MODULI_COUNT = 45
"""Entries of a symmetric 9x9 matrix."""


def padded_count(count: int) -> int:
    """A count rounded up to full vectors."""
    return -(-count // CPU_WIDTH) * CPU_WIDTH


@wp.func
def matrix_of(values: wp.array2d[float], q: int) -> wp.mat33:
    """The 3x3 matrix in a column, row after row."""
    matrix = wp.mat33()
    for b in range(3):
        for c in range(3):
            matrix[b, c] = values[3 * b + c, q]
    return matrix


@wp.func
def put_matrix(values: wp.array2d[float], q: int, matrix: wp.mat33):
    """Write a 3x3 matrix to a column."""
    for b in range(3):
        for c in range(3):
            values[3 * b + c, q] = matrix[b, c]


_CLUSTER_VERTICES = 3
"""There is room for a cluster of points for so many vertices; a piece has more."""


@wp.struct
class BodyArrays:
    """What a body is between edits; a step only reads it. The number of vertices includes the spare ones."""

    vertex_count: wp.array[int]
    """Number of vertices in use, shape (1,)."""
    fixed: wp.array[int]
    """0 for free vertices, ``HELD`` for those that a step does not move, ``DRIVEN`` for those that it moves at their
    given velocity, one a vertex."""
    rest: wp.array[wp.vec3]
    """Rest positions, one a vertex [m]."""
    rotation: wp.array[wp.mat33]
    """Rotation from the gradients' frame to that of the rest positions, shape (1,)."""
    normal: wp.array[wp.vec3d]
    """Unit normal of a plane body's plane, shape (1,); none of a solid one."""
    piece: wp.array[int]
    """The piece that a vertex belongs to, one a vertex."""
    piece_count: wp.array[int]
    """Number of pieces, shape (1,)."""
    material: wp.array[wp.vec4d]
    """Lame's constants mu and lambda [Pa], damping [s] and density [kg/m^3], shape (1,)."""
    weights: wp.array2d[float]
    """Weights at the quadrature points, one a point and vertex."""
    point_gradients: wp.array2d[wp.vec3]
    """Gradients of the weights, one a point and vertex [1/m]."""
    point_volumes: wp.array[float]
    """Volumes, one a point [m^3]."""
    clusters: wp.array[int]
    """The cluster that a row is of, one a row; none if strain is not averaged."""
    softened: wp.array[wp.vec2d]
    """Lame's constants mu and lambda of the material at the points, one a cluster [Pa]; likewise."""
    gradients: wp.array2d[wp.vec3]
    """Gradients that strain is taken with, of the points, then of the clusters, one a row and vertex [1/m]."""
    volumes: wp.array[float]
    """Volumes, one a row [m^3]."""
    anchors: wp.array[int]
    """The vertex of greatest weight, one a row."""
    mass: wp.array2d[float]
    """Mass matrix, one a pair of vertices [kg]."""
    vertex_mass: wp.array[float]
    """Sums of the mass matrix's rows, one a vertex [kg]."""
    stabilizing_stiffness: wp.array2d[float]
    """Stabilising stiffness over mu, one a pair of vertices [m]."""
    stabilizing_mass: wp.array2d[float]
    """Stabilising mass over the density, one a pair of vertices [m^3]."""


FORCE, STIFFNESS, DAMPING = wp.constant(0), wp.constant(1), wp.constant(2)
"""Scales of forces on points, of their stiffness and of their damping in the system."""
ELASTIC_FORCE, ELASTIC_STIFFNESS = wp.constant(3), wp.constant(4)
"""Scales of the stress and of the stiffness of the body itself, its damping included."""
DAMPING_SHARE, START_SHARE = wp.constant(5), wp.constant(6)
"""Share of the damping in that stiffness, and the factor of the forces at the start of the step."""
TIME_STEP, STAGE_TIME = wp.constant(7), wp.constant(8)
"""The time step and the scale of the stage [s]."""
TARGET_VELOCITY, TARGET_REACHED = wp.constant(9), wp.constant(10)
VELOCITY_KEPT, VELOCITY_REACHED = wp.constant(11), wp.constant(12)
"""Factors of the stage's target and of its velocity; see ``stages/scheme.py``."""
TOUCHED = wp.constant(13)
"""Number of points that further forces act on in the step."""
END_TIME, IMPULSE_SHARE = wp.constant(14), wp.constant(15)
"""When the stage ends, counted from the start of the step, and how long a force at its end acts in the step [s]."""
JOINED = wp.constant(16)
"""Whether pieces push each other, so that none chooses alone how much of a solution it takes."""
SCALE_COUNT = 17


@wp.struct
class StepArrays:
    """What a step works on."""

    scales: wp.array[wp.float64]
    """Factors of the step and of its present stage; see ``FORCE`` and what follows it."""
    displacement: wp.array[wp.vec3]
    """Displacements from rest before the step, one a vertex [m]."""
    lag: wp.array[wp.vec3]
    """What the first guess lacks of free fall, one a vertex [m/s]."""
    predicted: wp.array[wp.vec3]
    """Velocities with the first guess, later those after the solve, one a vertex [m/s]."""
    stiffnesses: wp.array[Stiffness]
    """Stiffness times volume and time scale, one a point."""
    moduli: wp.array2d[float]
    """The same as symmetric 9x9 matrices, one a column; see ``solve/lanes.py``, also of those below."""
    blocks: wp.array2d[wp.mat33]
    """The same for the assembled matrix, one a point and pair of components; none where it is not assembled."""
    tensions: wp.array2d[float]
    """Stress, or its change with a direction, times volume and time scale, one a column."""
    strain: wp.array2d[float]
    """Gradient of the displacement, one a column."""
    drift: wp.array2d[float]
    """Gradient of what ``predicted`` holds, one a column."""
    change: wp.array2d[float]
    """Gradient of the solution, one a column."""
    rates: wp.array[float]
    """Size of the change of F in the step, one a point."""
    limit: wp.array[wp.vec4]
    """Mean velocity [m/s], and the factor on velocities relative to it, shape (1,)."""


@wp.struct
class LinearSystem:
    """A symmetric positive definite system of 3-vectors, one a row; what the matrix does is the solver's to ask.

    Rows from the count on, and fixed ones, keep their part of ``solution``.
    """

    row_count: wp.array[int]
    """Number of rows in use, shape (1,)."""
    fixed: wp.array[int]
    """Nonzero for rows that keep their value."""
    normal: wp.array[wp.vec3d]
    """Unit normal of the plane that changes of the solution stay in, shape (1,); none if they are free."""
    solution: wp.array[wp.vec3]
    """The first guess, then the solution."""
    residual: wp.array[wp.vec3]
    """Right-hand side minus matrix times ``solution``."""
    kept: wp.array[wp.vec3]
    """The residual without the quadrature's part, at the start of a solve."""
    blocks: wp.array[wp.mat33]
    """The matrix's diagonal blocks, then their inverses, where no factor conditions the solve."""


def make_body_arrays(
    rest: wp.array,
    weights: wp.array,
    gradients: wp.array,
    volumes: wp.array | np.ndarray,
    vertex_count: wp.array,
    *,
    fixed: wp.array | None,
    rotation: wp.array | None,
    piece: wp.array | None,
    plane: bool,
    averaged: bool = False,
) -> BodyArrays:
    """The arrays of a body: those given, in place, and zeros for the others; see ``ReducedSystem``.

    Raises:
        TypeError: If an array has the wrong type.
        ValueError: If an array has the wrong shape or lies on another device than ``rest``.
    """
    capacity, points = rest.shape[0], weights.shape[0]
    body = BodyArrays()
    with wp.ScopedDevice(rest.device):
        given = {
            "rest": rest,
            "weights": weights,
            "gradients": gradients,
            "volumes": volumes if isinstance(volumes, wp.array) else wp.array(volumes, dtype=float),
            "vertex_count": vertex_count,
            "fixed": fixed if fixed is not None else wp.zeros(capacity, dtype=int),
            "rotation": rotation if rotation is not None else wp.array([np.eye(3)], dtype=wp.mat33),
            "piece": piece if piece is not None else wp.zeros(capacity, dtype=int),
        }
        _check(given)
        for name, array in given.items():
            setattr(body, {"gradients": "point_gradients", "volumes": "point_volumes"}.get(name, name), array)
        rows = points + (max(capacity // _CLUSTER_VERTICES, 1) if averaged else 0)
        body.gradients, body.volumes = body.point_gradients, body.point_volumes
        if averaged:
            body.gradients = wp.zeros((rows, capacity), dtype=wp.vec3)
            body.volumes = wp.zeros(rows, dtype=float)
            body.clusters = wp.zeros(rows, dtype=int)
            body.softened = wp.zeros(rows - points, dtype=wp.vec2d)
        if plane:
            body.normal = wp.zeros(1, dtype=wp.vec3d)
        body.piece_count = wp.ones(1, dtype=int)
        body.material = wp.zeros(1, dtype=wp.vec4d)
        body.anchors = wp.zeros(rows, dtype=int)
        body.vertex_mass = wp.zeros(capacity, dtype=float)
        for name in ("mass", "stabilizing_stiffness", "stabilizing_mass"):
            setattr(body, name, wp.zeros((capacity, capacity), dtype=float))
    return body


def make_step_arrays(body: BodyArrays) -> StepArrays:
    """Scratch for the steps of a body."""
    capacity, points = body.rest.shape[0], body.volumes.shape[0]
    step = StepArrays()
    with wp.ScopedDevice(body.rest.device):
        step.scales = wp.zeros(SCALE_COUNT, dtype=wp.float64)
        for name in ("displacement", "lag", "predicted"):
            setattr(step, name, wp.zeros(capacity, dtype=wp.vec3))
        step.stiffnesses = wp.zeros(points, dtype=Stiffness)
        columns = padded_count(points)
        step.moduli = wp.zeros((MODULI_COUNT, columns), dtype=float)
        for name in ("tensions", "strain", "drift", "change"):
            setattr(step, name, wp.zeros((9, columns), dtype=float))
        step.rates = wp.zeros(points, dtype=float)
        step.limit = wp.zeros(1, dtype=wp.vec4)
    return step


def make_linear_system(body: BodyArrays) -> LinearSystem:
    """The system of a body's steps, all zero."""
    capacity = body.fixed.shape[0]
    system = LinearSystem()
    system.row_count, system.fixed, system.normal = body.vertex_count, body.fixed, body.normal
    with wp.ScopedDevice(body.fixed.device):
        system.solution, system.residual, system.kept = (wp.zeros(capacity, dtype=wp.vec3) for _ in range(3))
        system.blocks = wp.zeros(capacity, dtype=wp.mat33)
    return system


def _check(given: dict[str, wp.array]) -> None:
    """Check types, shapes and devices of the arrays of a body."""
    capacity, points, device = given["rest"].shape[0], given["weights"].shape[0], given["rest"].device
    expected = {
        "rest": (wp.vec3, (capacity,)),
        "weights": (wp.float32, (points, capacity)),
        "gradients": (wp.vec3, (points, capacity)),
        "volumes": (wp.float32, (points,)),
        "vertex_count": (wp.int32, (1,)),
        "fixed": (wp.int32, (capacity,)),
        "rotation": (wp.mat33, (1,)),
        "piece": (wp.int32, (capacity,)),
    }
    for name, (dtype, shape) in expected.items():
        array = given[name]
        if array.dtype != dtype:
            raise TypeError(f"ReducedSystem {name} has the type {array.dtype.__name__}; it must be {dtype.__name__}.")
        if array.shape != shape:
            raise ValueError(f"ReducedSystem {name} has the shape {array.shape}; it must be {shape}.")
        if array.device != device:
            raise ValueError(f"ReducedSystem {name} lies on {array.device}; rest lies on {device}.")
