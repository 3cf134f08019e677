# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a cage body is made of, as the builder hands it to the solver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...cage import Cage
from ...elastic import Material
from ...surface import Surface


@dataclass(frozen=True, kw_only=True)
class Capacity:
    """Room that a body reserves for cuts. Arrays never grow afterwards, so captured CUDA graphs stay valid.

    Args:
        vertices: Vertices of the cage.
        surface_points: Points of the embedded surface, those along seams counting as one.
        surface_triangles: Triangles of the embedded surface, caps included.
    """

    vertices: int
    surface_points: int
    surface_triangles: int

    @classmethod
    def for_cuts(cls, cage: Cage, surface: Surface) -> Capacity:
        """Room for several cuts through all of a body."""
        point_count, triangle_count = surface.site_count, surface.triangle_count
        spare_points = 1024 + point_count // 2
        return cls(
            vertices=4 * cage.vertex_count + 64,
            surface_points=point_count + spare_points,
            surface_triangles=triangle_count + 4 * spare_points,
        )

    @classmethod
    def without_cuts(cls, cage: Cage, surface: Surface) -> Capacity:
        """No room to spare."""
        return cls(
            vertices=cage.vertex_count,
            surface_points=surface.site_count,
            surface_triangles=surface.triangle_count,
        )

    def require(self, cage: Cage, surface: Surface) -> None:
        """Refuse a cage and a surface that do not fit.

        Raises:
            ValueError: Something does not fit; the message names the capacity to raise.
        """
        needed = {
            "vertices": cage.vertex_count,
            "surface_points": surface.site_count,
            "surface_triangles": surface.triangle_count,
        }
        for name, count in needed.items():
            if count > getattr(self, name):
                raise ValueError(
                    f"{count} {name.replace('_', ' ')} are needed, room was reserved for {getattr(self, name)}: "
                    f"raise capacity={name}=... in add_cage_body"
                )


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
        thickness: Thickness of a plane body [m]; None for a solid one.
        options: Further options of the harmonic coordinates.
        edit: Number of the edit that it is as of, 0 before the first; undoing one goes back to the number before.
        last_edit: Highest number that an edit has had.
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
    thickness: float | None
    options: dict[str, object]
    edit: int = 0
    last_edit: int = 0
