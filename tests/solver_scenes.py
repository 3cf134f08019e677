# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Small scenes for the solver's tests."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from cage_shapes import box
from plane_shapes import square
from surface_shapes import disk, sphere

SIZE = 1.0
"""Side of the cages [m]."""
UPRIGHT = wp.quat_from_axis_angle(wp.vec3(1.0, 0.0, 0.0), 0.5 * np.pi)
"""Turns a plane body upright: its second axis points along the world's third."""

both_dimensions = pytest.mark.parametrize("dimension", [2, 3])


def ball(dimension: int = 3) -> cagecut.Surface:
    """A ball inside the box cage, or a disk in the square one."""
    return sphere(level=2, radius=0.4) if dimension == 3 else disk(radius=0.4)


def box_cage(dimension: int = 3) -> cagecut.Cage:
    """A box of side 1 m, or a square."""
    return box() if dimension == 3 else square()


def corners(axis: int, side: float, dimension: int = 3) -> np.ndarray:
    """Vertices of the cage on one of its sides; axis -1 points up, in the world too."""
    return np.flatnonzero(box_cage(dimension).vertices[:, axis] == side)


def make_solver(
    *,
    gravity: float = 0.0,
    builder: newton.ModelBuilder | None = None,
    dimension: int = 3,
    surface: cagecut.Surface | None = None,
    **options,
):
    """Model, solver and two states of a ball in a box, or of a disk in a square that stands upright.

    Args:
        gravity: Gravity along z [m/s^2].
        builder: A builder with more in it.
        dimension: Dimension of the body.
        surface: What is in the cage; the ball by default.
        options: Options of ``add_cage_body``.
    """
    builder = builder or newton.ModelBuilder(gravity=(0.0, 0.0, gravity))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    defaults = {"walks": 32, "quadrature": 60, "material": cagecut.Material(young=1.0e4, damping=0.02)}
    if dimension == 2:
        defaults["xform"] = wp.transform((0.0, 0.0, 0.0), UPRIGHT)
    cagecut.add_cage_body(builder, box_cage(dimension), surface or ball(dimension), **{**defaults, **options})
    model = builder.finalize(device="cpu")
    return model, cagecut.SolverCageCut(model), model.state(), model.state()


def run(solver: cagecut.SolverCageCut, states, steps: int, *, dt: float = 1.0 / 60.0, contacts=None):
    """Step, swapping the states; returns them in their new order."""
    state_in, state_out = states
    for _ in range(steps):
        state_in.clear_forces()
        solver.step(state_in, state_out, None, contacts, dt)
        state_in, state_out = state_out, state_in
    return state_in, state_out


def vertex_rows(solver: cagecut.SolverCageCut, state: newton.State, field: str = "particle_q") -> np.ndarray:
    """Positions or velocities of the vertices in use of the first body."""
    body = solver.bodies[0]
    return getattr(state, field)[body.vertices].numpy()[: body.cage.vertex_count].astype(np.float64)


def slanted_blade(dimension: int = 3) -> cagecut.Blade:
    """A blade that crosses the box, or the square, at an angle."""
    if dimension == 2:
        return cagecut.Blade([0.45, 0.5], [0.2, -1.0])
    return cagecut.Blade([0.45, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0])


def simulated(solver: cagecut.SolverCageCut, row: int = 0):
    """What is inside of a body, for tests that look at its arrays."""
    return solver._simulated[row]


def everything(solver: cagecut.SolverCageCut, states) -> dict[str, np.ndarray]:
    """All arrays that an edit may touch."""
    body, model = simulated(solver), solver.model
    arrays = {"rest": body.rest, "fixed": body.fixed, "count": body.vertex_count, "mass": body.system.mass}
    arrays |= {"volumes": body.system.volumes, "flags": model.particle_flags, "particle_mass": model.particle_mass}
    arrays |= {
        f"state_{i}_{name}": getattr(s, name) for i, s in enumerate(states) for name in ("particle_q", "particle_qd")
    }
    values = {name: array.numpy().copy() for name, array in arrays.items()}
    coordinates = body.coordinates
    values |= {
        "weights": coordinates.weights_array.numpy().copy(),
        "gradients": coordinates.gradients,
        **coordinates.landings,
    }
    surface = body.surface
    values |= {
        name: getattr(surface, name) for name in ("points", "triangles", "triangle_cap", "cap_side", "point_key")
    }
    return {
        **values,
        "bounds": coordinates.bounds,
        "loops": np.concatenate(body.cage.faces),
        "keys": body.cage.face_key,
    }


def assert_same(before: dict[str, np.ndarray], after: dict[str, np.ndarray]) -> None:
    """Compare all arrays bit for bit."""
    for name in before:
        np.testing.assert_array_equal(after[name], before[name], err_msg=name)
