# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Scenes of contact: an elastic cube of 0.2 m and 8 kg, its points on the cage, and what it touches."""

from __future__ import annotations

from dataclasses import dataclass, field

import newton
import numpy as np
import warp as wp

import newton_cagecut as cagecut
from cage_shapes import box

SIDE = 0.2
"""Side of the cube [m]."""
MASS = 8.0
"""Mass of the cube [kg]."""
RADIUS = 0.004
"""Contact radius of its points [m]."""


def cube_surface(cells: int = 4) -> cagecut.Surface:
    """The surface of the cube, on a grid, next to the walls of its cage."""
    grid = np.stack(np.meshgrid(*[np.arange(cells + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    number = {tuple(place): i for i, place in enumerate(grid.tolist()) if 0 in place or cells in place}
    order = {old: new for new, old in enumerate(number.values())}
    triangles = []
    for axis in range(3):
        across = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        for side in (0, cells):
            for i in range(cells):
                for j in range(cells):
                    corner = i * across[0] + j * across[1] + side * np.eye(3, dtype=int)[axis]
                    loop = [corner, corner + across[0], corner + across[0] + across[1], corner + across[1]]
                    a, b, c, d = (order[number[tuple(place.tolist())]] for place in loop[:: 1 if side else -1])
                    triangles += [(a, b, c), (a, c, d)]
    inset = 1.0e-3 * SIDE
    points = inset + (SIDE - 2.0 * inset) / cells * grid[list(number.values())]
    return cagecut.Surface(points, np.array(triangles))


def cube_cage(*, refined: bool = False) -> cagecut.Cage:
    """The cage of the cube: a box, or one with vertices on its edges and faces too."""
    cage = cagecut.Cage(SIDE * box().vertices, box().faces)
    return cage.refine() if refined else cage


def add_cube(builder: newton.ModelBuilder, height: float, *, refined: bool = False, **options) -> int:
    """Add the cube, its lower side at a height."""
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cage = cube_cage(refined=refined)
    defaults = {
        "material": cagecut.Material(young=1.0e6, density=1000.0, damping=0.01),
        "xform": wp.transform((0.0, 0.0, height)),
        "contact_radius": RADIUS,
        "walks": 32,
        "quadrature": 60,
        "cuttable": False,
    }
    return cagecut.add_cage_body(builder, cage, cube_surface(), **{**defaults, **options})


@dataclass
class Scene:
    """A model with its solvers, stepped as the guide says."""

    builder: newton.ModelBuilder
    gap: float = 0.02
    rigid: type | None = None
    options: dict = field(default_factory=dict)
    dt: float = 1.0 / 60.0

    def __post_init__(self) -> None:
        self.model = self.builder.finalize(device="cpu")
        self.solver = cagecut.SolverCageCut(self.model, foreign="keep", **self.options)
        self.other = None if self.rigid is None else self.rigid(self.model)
        self.pipeline = newton.CollisionPipeline(self.model, soft_contact_gap=self.gap)
        self.contacts = self.pipeline.contacts()
        self.state, self.after, self.between = (self.model.state() for _ in range(3))

    def step(self, steps: int = 1, *, before=None) -> None:
        """Step, the soft solver first; ``before`` is called with the state before each."""
        for _ in range(steps):
            self.state.clear_forces()
            if before is not None:
                before(self.state)
            self.pipeline.collide(self.state, self.contacts)
            self.solver.step(self.state, self.after, None, self.contacts, self.dt)
            if self.other is not None:
                self.contacts.soft_contact_count.zero_()
                self.other.step(self.state, self.between, None, self.contacts, self.dt)
                wp.copy(self.after.body_q, self.between.body_q)
                wp.copy(self.after.body_qd, self.between.body_qd)
            self.state, self.after = self.after, self.state

    def vertices(self, name: str = "particle_q") -> np.ndarray:
        """Positions or velocities of the cube's cage."""
        body = self.solver.bodies[0]
        return getattr(self.state, name)[body.vertices].numpy()[: body.cage.vertex_count].astype(float)

    def velocity(self) -> np.ndarray:
        """Velocity of the cube's centre of mass, which is the mean of the corners' [m/s]."""
        return self.vertices("particle_qd").mean(axis=0)

    def lowest(self) -> float:
        """Depth of the lowest surface point's sphere below zero, negative above it [m]."""
        points, _ = self.solver.surface(self.state)
        return RADIUS - float(points[:, 2].min())
