# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Compiling and loading every kernel that a scene can need, before it starts.

Kernels are compiled when they are first launched, which would stall a scene in its first step, its first contact and
its first cut. So everything that a scene does is done once beforehand, on a few points and on states of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import newton
import numpy as np

from ..harmonic import warm_up_coordinates
from .body.simulated_body import SimulatedBody
from .progress_bars import run_parts

Step = Callable[[newton.State, newton.State, newton.Contacts | None], None]


def warm_up(model: newton.Model, bodies: Sequence[SimulatedBody], step: Step, *, progress: bool | None) -> None:
    """Launch what weights, cuts, surfaces, collisions and steps launch; the bodies stay as they are.

    Args:
        model: The model.
        bodies: Its bodies; of those that need the same kernels, one is run.
        step: A step of the solver, from a state to another one, with contacts.
        progress: Whether to show a bar; None for in a terminal.
    """
    parts = [(f"weights and cuts of {body.label}", partial(_warm_up_weights, body)) for body in _unlike(bodies)]
    parts += [("collisions and steps", partial(_warm_up_steps, model, bodies, step))]
    run_parts(parts, "kernels", shown=progress)


def _unlike(bodies: Sequence[SimulatedBody]) -> list[SimulatedBody]:
    """One body for each set of kernels."""
    found: dict[tuple, SimulatedBody] = {}
    for body in bodies:
        definition = body.definition
        faces = tuple(np.unique(body.cage.mesh.face_size).tolist())
        features = (body.is_plane, body.system is not None, definition.cuttable, faces, repr(definition.options))
        found.setdefault(features, body)
    return list(found.values())


def _warm_up_weights(body: SimulatedBody) -> None:
    definition = body.definition
    warm_up_coordinates(
        body.cage,
        definition.surface.points,
        gradients=body.system is not None,
        cuttable=definition.cuttable,
        device=body.device,
        seed=definition.seed,
        **definition.options,
    )


def _warm_up_steps(model: newton.Model, bodies: Sequence[SimulatedBody], step: Step) -> None:
    state, other, contacts = model.state(), model.state(), None
    if model.shape_count and model.particle_count:
        pipeline = newton.CollisionPipeline(model)
        contacts = pipeline.contacts()
        pipeline.collide(state, contacts)
    step(state, other, contacts)
    step(other, other, None)
    for body in bodies:
        body.energy(state)
        body.surface_points(state)
