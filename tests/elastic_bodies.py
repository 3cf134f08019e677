# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Rectangles and boxes whose harmonic coordinates are bilinear and trilinear and therefore exact."""

import numpy as np
import pytest
import warp as wp

from newton_cagecut.elastic import Material, ReducedSystem, make_point_forces

DT = 1.0 / 60.0
SIZE = np.array([0.2, 0.3, 0.5])
THICKNESS = 0.1
STILL = np.zeros(3)

both_dimensions = pytest.mark.parametrize("dimension", [2, 3], ids=["2d", "3d"])


class Body:
    """A rectangle or a box cut into cells, its system and its state on the CPU; the last axis points up."""

    def __init__(
        self,
        dimension=3,
        cells=(1, 1, 1),
        points=5,
        spare=2,
        fix_top=False,
        rotation=None,
        offset=0.0,
        thickness=THICKNESS,
        **options,
    ):
        material = Material(**{k: options.pop(k) for k in tuple(options) if k in Material.__dataclass_fields__})
        self.dimension, self.material = dimension, material
        self.turn = np.eye(3) if rotation is None else rotation
        size, cells = SIZE[-dimension:], cells[-dimension:]
        axes = [np.linspace(0.0, length, n + 1) for length, n in zip(size, cells)]
        self.vertices = grid(axes)
        self.points = grid([(np.arange(points * n) + 0.5) * length / (points * n) for length, n in zip(size, cells)])
        hats = [hat_functions(self.points[:, d], axes[d]) for d in range(dimension)]
        self.weights = outer_products([values for values, _ in hats])
        gradients = [outer_products([hats[d][int(d == k)] for d in range(dimension)]) for k in range(dimension)]
        self.gradients = as_vectors(np.stack(gradients, axis=-1))
        self.thickness = thickness if dimension == 2 else None
        self.volume = size.prod() * (self.thickness or 1.0)
        self.volumes = np.full(len(self.points), self.volume / len(self.points))
        self.fixed = (self.vertices[:, -1] > size[-1] - 1e-6) & fix_top
        self.count = len(self.vertices)
        self.rest = self.to_world(self.vertices) + offset
        self.system = ReducedSystem(
            as_array(padded(self.rest, spare), wp.vec3),
            as_array(np.pad(self.weights, ((0, 0), (0, spare))), float),
            as_array(np.pad(self.gradients, ((0, 0), (0, spare), (0, 0))), wp.vec3),
            self.volumes,
            material,
            as_array([self.count], int),
            fixed=as_array(padded(self.fixed, spare), int),
            rotation=as_array(self.turn[None], wp.mat33),
            thickness=self.thickness,
            **options,
        )
        self.x = wp.clone(self.system.rest)
        self.v = wp.zeros_like(self.x)

    def to_world(self, vectors):
        """Vectors of the rest frame, with as many components as the body has dimensions, in the world."""
        return as_vectors(vectors) @ self.turn.T

    def random(self, seed, scale=1.0):
        """Normally distributed vectors in the body's space, one a vertex."""
        return self.to_world(scale * np.random.default_rng(seed).normal(size=(self.count, self.dimension)))

    @property
    def up(self):
        """Unit vector along the body's last axis, in the world."""
        return self.to_world(np.eye(self.dimension)[-1])

    @property
    def gravity(self):
        """Gravity along the body's last axis."""
        return -9.81 * self.up

    def place(self, positions=None, velocities=None):
        """Set the state of the vertices in use."""
        for target, values in ((self.x, positions), (self.v, velocities)):
            if values is not None:
                target.assign(padded(values, target.shape[0] - self.count))
        return self

    def run(self, steps, gravity=STILL, dt=DT, spring=None, **options):
        """Take steps in place."""
        gravity = as_array([gravity], wp.vec3)
        for _ in range(steps):
            if spring is not None:
                options["points"] = spring.aim()
            self.system.step(self.x, self.v, self.x, self.v, dt, gravity=gravity, **options)
        return self

    @property
    def positions(self):
        """Positions of the vertices in use, float64."""
        return self.x.numpy()[: self.count].astype(np.float64)

    @property
    def velocities(self):
        """Velocities of the vertices in use, float64."""
        return self.v.numpy()[: self.count].astype(np.float64)

    @property
    def heights(self):
        """Positions along the last axis."""
        return self.positions @ self.up

    def deformation(self, displacement):
        """F at the quadrature points, in the rest frame, shape (point_count, 3, 3), for displacements in the world."""
        return np.eye(3) + np.einsum("jc,qjd->qcd", displacement @ self.turn, self.gradients)

    def momentum(self):
        """Linear momentum."""
        return self.system.vertex_mass.numpy()[: self.count].astype(np.float64) @ self.velocities

    def angular_momentum(self):
        """Angular momentum about the origin, with the consistent mass matrix."""
        mass = self.system.mass.numpy()[: self.count, : self.count].astype(np.float64)
        return np.cross(self.positions, mass @ self.velocities).sum(axis=0)

    def energy(self):
        """Elastic and kinetic energy together."""
        return sum(self.system.energy(self.x, self.v))


class Spring:
    """Forces on points: an implicit spring that pulls vertex 0 from where it is to a target."""

    def __init__(self, body, stiffness, target):
        self.body, self.stiffness, self.target = body, stiffness, np.asarray(target)
        self.points = make_point_forces(as_array(np.eye(1, body.x.shape[0]), float), 0, 1)
        self.points.count.fill_(1)
        self.points.stiffness.assign([stiffness * np.eye(3)])

    def aim(self):
        """The points, with the force at the body's present position."""
        self.points.force.assign([self.stiffness * (self.target - self.body.positions[0])])
        return self.points


def grid(axes):
    """All points of a grid, shape (point_count, dimension)."""
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))


def hat_functions(x, axis):
    """Linear hat functions of an axis and their derivatives."""
    spacing = axis[1] - axis[0]
    t = (x[:, None] - axis) / spacing
    return np.clip(1.0 - np.abs(t), 0.0, 1.0), np.where(np.abs(t) < 1.0, -np.sign(t), 0.0) / spacing


def outer_products(factors):
    """Products of one function an axis at each point, shape (point_count, product of the functions' counts)."""
    product = np.ones((len(factors[0]), 1))
    for factor in factors:
        product = (product[:, :, None] * factor[:, None, :]).reshape(len(factor), -1)
    return product


def as_vectors(values):
    """Three components, the missing ones 0."""
    values = np.asarray(values, dtype=np.float64)
    return np.pad(values, [(0, 0)] * (values.ndim - 1) + [(0, 3 - values.shape[-1])])


def as_array(values, dtype):
    """A Warp array on the CPU."""
    return wp.array(values, dtype=dtype, device="cpu")


def padded(values, spare):
    """Rows of zeros appended."""
    values = np.asarray(values)
    return np.pad(values, ((0, spare),) + ((0, 0),) * (values.ndim - 1))
