# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a cage body is made of, as the builder hands it to the solver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...cage import Cage
from ...elastic import Material
from ...surface import Surface
from .capacity import Capacity
from .contact_material import ContactMaterial


@dataclass(frozen=True, kw_only=True)
class BodyDefinition:
    """What a cage body is made of, in the cage's rest frame; every edit of the body replaces the model's.

    Args:
        label: Name of the body.
        cage: The cage.
        surface: The embedded surface.
        material: The elastic material.
        fixed: Cage vertices that do not move, shape (vertex_count,), bool.
        walks: Walks a point.
        seed: Seed of walks and quadrature.
        quadrature_count: Wanted number of quadrature points; 0 for a body that is moved by keyframes only.
        cuttable: Whether it can be cut.
        capacity: Room for cuts.
        contact_radius: Radius of the surface points as Newton's particles [m]; None without contact.
        contact_material: Its stiffness, damping and friction.
        self_contact: Whether each of its pieces touches itself.
        pieces_touch: Whether its pieces touch each other.
        thickness: Thickness of a plane body [m]; None for a solid one.
        options: Further options of the harmonic coordinates.
        edit: Number of the edit that it is as of, 0 before the first; undoing one goes back to the number before.
        last_edit: Highest number that an edit has had.
        uncut: What it was before its first cut; None if it was never cut.
    """

    label: str
    cage: Cage
    surface: Surface
    material: Material
    fixed: np.ndarray
    walks: int
    seed: int
    quadrature_count: int
    cuttable: bool
    capacity: Capacity
    contact_radius: float | None
    contact_material: ContactMaterial
    self_contact: bool
    pieces_touch: bool
    thickness: float | None
    options: dict[str, object]
    edit: int = 0
    last_edit: int = 0
    uncut: BodyDefinition | None = None

    @property
    def before_cuts(self) -> BodyDefinition:
        """What it was before its first cut."""
        return self.uncut or self
