# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Where rows get their bodies from: bars that are built once, or the bodies of a scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import newton
import numpy as np

from ...cage import Cage
from ...elastic import Material
from ...solver import SolverCageCut, add_cage_body
from ..scenes.building import built, definitions_in
from .shapes import Blocks, bar, bracket, surface_in
from .trial import Trial

WALKS, QUADRATURE = 64, 60
BAR = (1.0, 0.2, 0.2)
CUBE = (0.4, 0.4, 0.4)
BRACKET = (0.6, 0.2)
"""Length of a leg, and its width and height [m]."""
_CONTACT = 1.0e6
"""Stiffness of the ground under a point [N/m]."""


class Workbench:
    """Makes the bodies of the rows.

    Args:
        quick: Whether the run is the quick one.
        scene: Adds the bodies of a scene to a builder; bars without it.
    """

    def __init__(self, *, quick: bool, scene: Callable[[newton.ModelBuilder], None] | None = None) -> None:
        self.quick, self.scene = quick, scene
        self._trials: dict[object, Trial] = {}

    def bar(
        self,
        material: Material,
        *,
        segments: int = 2,
        size: tuple[float, float, float] = BAR,
        gravity: Sequence[float] = (0.0, 0.0, 0.0),
        fixed: Callable[[np.ndarray], np.ndarray] | None = None,
        ground: bool = False,
        cuttable: bool = False,
        walks: int = WALKS,
        quadrature: int = QUADRATURE,
        strain: str = "points",
        key: str = "",
        **options: object,
    ) -> Trial:
        """A bar at rest, or as it was added; bodies that cannot be cut are built once and used again.

        Args:
            material: Its material.
            segments: Segments along its length.
            size: Length, width and height [m].
            gravity: Gravity [m/s^2].
            fixed: Tells which vertices, given as (n, 3) [m], are fixed.
            ground: Whether it falls on a plane, which its surface touches.
            cuttable: Whether it can be cut.
            walks: Walks a point.
            quadrature: Quadrature points.
            strain: The solver's strain.
            key: Tells bars apart that differ in ``fixed`` or ``options`` only.
            options: Further options of ``add_cage_body``.
        """
        which = (segments, size, tuple(gravity), ground, walks, quadrature, strain, key)
        options |= {"gravity": gravity, "fixed": fixed, "ground": ground, "walks": walks, "quadrature": quadrature}
        options["strain"] = strain

        def build() -> Trial:
            cage = bar(segments, size).cage()
            return _trial(cage, surface_in(cage), material, cuttable=cuttable, **options)

        return self._again(material, None if cuttable else which, build)

    def bracket(
        self,
        material: Material,
        segments: int,
        *,
        fixed: Callable[[np.ndarray], np.ndarray],
        walks: int,
        quadrature: int,
        strain: str = "points",
    ) -> Trial:
        """An L at rest, its legs as in ``BRACKET``.

        Args:
            material: Its material.
            segments: Segments of each leg.
            fixed: Tells which vertices, given as (n, 3) [m], are fixed.
            walks: Walks a point.
            quadrature: Quadrature points.
            strain: The solver's strain.
        """

        def build() -> Trial:
            blocks = bracket(segments, *BRACKET)
            leg = Blocks((blocks.axes[0][[0, -2]], blocks.axes[1], blocks.axes[2][:2]), np.ones((1, 1, 1), dtype=bool))
            options = {"fixed": fixed, "walks": walks, "quadrature": quadrature, "cuttable": False, "strain": strain}
            return _trial(blocks.cage(), surface_in(leg.cage()), material, **options)

        return self._again(material, ("bracket", segments, walks, quadrature, strain), build)

    def subject(self, material: Material) -> Trial:
        """The bodies of the scene, or a bar, as they were built, of a material."""
        if self.scene is None:
            return self.bar(material)

        def build() -> Trial:
            builder = built(self.scene)
            for index, definition in definitions_in(builder).items():
                builder.custom_attributes["cagecut:definition"].values[index] = replace(definition, material=material)
            return Trial(builder)

        return self._again(material, "scene", build)

    def _again(self, material: Material, key: object | None, build: Callable[[], Trial]) -> Trial:
        """The trial of a key and the material's model, built if it is not there, or always without a key."""
        which = None if key is None else (key, material.model)
        trial = self._trials.get(which) if which is not None else None
        if trial is None:
            trial = build()
            if which is not None:
                self._trials[which] = trial
        trial.set_material(material)
        trial.reset()
        return trial


def _trial(
    cage: Cage,
    surface: tuple[np.ndarray, np.ndarray],
    material: Material,
    *,
    gravity: Sequence[float] = (0.0, 0.0, 0.0),
    fixed: Callable[[np.ndarray], np.ndarray] | None = None,
    ground: bool = False,
    strain: str = "points",
    **options: object,
) -> Trial:
    """A body alone, or above a plane that its surface touches."""
    builder = newton.ModelBuilder(gravity=tuple(map(float, gravity)))
    SolverCageCut.register_custom_attributes(builder)
    if ground:
        builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(ke=_CONTACT, mu=0.5))
        options.setdefault("contact_radius", 0.01)
    held = None if fixed is None else fixed(cage.vertices)
    add_cage_body(builder, cage, surface, fixed=held, material=material, **options)
    trial = Trial(builder, collide=ground, strain=strain)
    trial.model.soft_contact_ke = _CONTACT
    return trial
