# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Edits of bodies between steps that are no cuts: material, fixed vertices, and the undoing of all cuts.

All of them write in place, so a captured graph stays valid, and all or nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import warp as wp

from ...elastic import Material
from ...harmonic import Journal
from .. import body_arguments as arguments
from ..body.definition import BodyDefinition
from ..body.simulated_body import SimulatedBody


def set_material(body: SimulatedBody, material: Material) -> None:
    """Change the constants of a body's material, with its masses.

    Args:
        body: The body.
        material: The material, of the same constitutive model.

    Raises:
        TypeError: It is no material.
        ValueError: Its model is another one, or the body was edited through another solver.
    """
    material = arguments.as_material(material)
    body.require_own_edits()
    before = body.definition.material
    if material.model != before.model:
        raise ValueError(
            f"{body.label} was added with the material model {before.model!r}, not {material.model!r}; the constants "
            "can be changed, the model needs a new builder and solver"
        )
    with Journal() as journal:
        if body.system is not None:
            journal.when_taken_back(lambda: _put_material(body, before))
        body.keep_definition(journal)
        if body.system is not None:
            _put_material(body, material)
        body.define(replace(body.definition, material=material))


def set_fixed(body: SimulatedBody, fixed: np.ndarray | Sequence[int] | None) -> None:
    """Change which cage vertices are fixed; the others are released.

    Args:
        body: The body.
        fixed: Indices, or a mask over all vertices that the cage has now; None for none.

    Raises:
        TypeError: It is neither.
        ValueError: It names a vertex that is not there, or the body was edited through another solver.
    """
    mask = arguments.as_fixed(fixed, body.cage.vertex_count)
    body.require_own_edits()
    with Journal() as journal:
        journal.keep(body.fixed)
        body.keep_definition(journal)
        body.fixed.assign(body.padded(mask))
        body.define(replace(body.definition, fixed=mask))


def take_over(body: SimulatedBody) -> None:
    """Take material and fixed vertices from the model, where another solver has changed them.

    Args:
        body: The body.

    Raises:
        ValueError: The other solver has cut the body, or its material is of another model.
    """
    definition = body.model.cagecut.definition[body.row]
    if definition is body.definition:
        return
    body.require_own_edits()
    set_material(body, definition.material)
    set_fixed(body, definition.fixed)


def undo_cuts(body: SimulatedBody) -> None:
    """Undo all cuts of a body: it is as it was added, but for its material and which vertices are fixed.

    The weights are computed again the first time, and kept for the next.

    Args:
        body: The body.

    Raises:
        ValueError: The body was edited through another solver.
    """
    body.require_own_edits()
    if body.definition.uncut is None:
        return
    if body.uncut is None:
        sample, coordinates = body.fresh(body.definition.uncut)
        body.uncut = sample, body.coordinates.snapshot(of=coordinates)
    sample, snapshot = body.uncut
    before = body.definition.uncut
    with Journal() as journal:
        body.keep(journal, ())
        body.coordinates.restore(snapshot, journal=journal)
        body.quadrature = sample
        _undo_arrays(body, before)
        body.refresh()
        body.commit_edit(0, ())


def _undo_arrays(body: SimulatedBody, before: BodyDefinition) -> None:
    """Bring back rest positions, start velocities, counts, surface and volumes."""
    model, count = body.model, before.cage.vertex_count
    rest, fixed = body.rest.numpy().copy(), body.fixed.numpy().copy()
    rest[count:], fixed[count:] = rest[0], 0
    velocities = model.particle_qd[body.vertices].numpy().copy()
    velocities[count:] = velocities[0]
    body.rest.assign(rest)
    body.fixed.assign(fixed)
    body.vertex_count.fill_(count)
    wp.copy(model.particle_q[body.vertices], body.rest)
    model.particle_qd[body.vertices].assign(velocities)
    if body.has_contact:
        model.particle_flags[body.surface_particles].zero_()
        first = body.to_world(before.surface.site_points[:1]).astype(np.float32)[0]
        model.particle_q[body.surface_particles].fill_(wp.vec3(*map(float, first)))
        model.particle_qd[body.surface_particles].fill_(wp.vec3(*map(float, velocities[0])))
    body.set_surface(before.surface)
    if body.system is not None:
        body.system.volumes.assign(body.quadrature.volumes.astype(np.float32))


def _put_material(body: SimulatedBody, material: Material) -> None:
    """Hand a material on to the system, and the masses to the model."""
    body.system.set_material(material)
    body.show_masses()
