# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Objects on which public calls are tried, and what a trial is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import newton
import numpy as np

import newton_cagecut as cagecut
from newton_cagecut.usd import AnimationWriter, BodyFrame
from solver_scenes import ball, box_cage, everything, make_solver, slanted_blade
from surface_shapes import sphere


class World:
    """Objects that calls are made on, small and quick to make; only what is asked for is made."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.cage, self.surface, self.blade = box_cage(), ball(), slanted_blade()
        self._made: dict[str, object] = {}

    def _once(self, name: str, make: Callable[[], object]) -> object:
        if name not in self._made:
            self._made[name] = make()
        return self._made[name]

    @property
    def points(self) -> np.ndarray:
        """Points inside the cage."""
        return np.random.default_rng(0).uniform(0.1, 0.9, size=(6, 3))

    @property
    def cut(self) -> cagecut.Cut:
        """A cut half-way through the cage."""
        return self._once("cut", lambda: _advanced(cagecut.Cut(self.cage, self.blade)))

    @property
    def coordinates(self) -> cagecut.HarmonicCoordinates:
        """Coordinates of the points."""
        return self._once("coordinates", lambda: cagecut.HarmonicCoordinates(self.cage, self.points, 8))

    @property
    def scene(self) -> tuple:
        """Model, solver and two states."""
        return self._once("scene", lambda: make_solver(walks=4, quadrature=12, surface=sphere(level=1, radius=0.4)))

    @property
    def solver(self) -> cagecut.SolverCageCut:
        """The solver of a body."""
        return self.scene[1]

    @property
    def body_cut(self) -> cagecut.BodyCut:
        """A cut of the solver's body, which has gone some way."""

        def make() -> cagecut.BodyCut:
            cut = self.solver.begin_cut(0, self.blade)
            self.solver.advance_cut(cut, 0.1, states=self.scene[2:])
            return cut

        return self._once("body_cut", make)

    @property
    def builder(self) -> newton.ModelBuilder:
        """A builder that takes bodies."""

        def make() -> newton.ModelBuilder:
            builder = newton.ModelBuilder()
            cagecut.SolverCageCut.register_custom_attributes(builder)
            return builder

        return self._once("builder", make)

    @property
    def writer(self) -> AnimationWriter:
        """A writer of animations."""
        return self._once("writer", lambda: AnimationWriter(self.folder / "out.usda"))

    def digest(self) -> dict[str, object]:
        """All that a call may change of the objects that there are."""
        found: dict[str, object] = {}
        for name, value in self._made.items():
            if name == "cut":
                found |= {"cut": id(value._state), "cage": id(value.cage)}
            elif name == "coordinates":
                found |= {"weights": value.weights.tobytes(), "of": id(value.cage), "count": value.point_count}
            elif name == "scene":
                arrays = everything(value[1], value[2:])
                found |= {f"scene {key}": array.tobytes() for key, array in arrays.items()}
            elif name == "body_cut":
                found |= {"depth": value.depth, "body cage": id(value.cut.cage)}
            elif name == "builder":
                bodies = value.custom_attributes["cagecut:definition"].values
                found |= {"particles": value.particle_count, "bodies": len(bodies or [])}
            elif name == "writer":
                found |= {"stage": value.stage.ExportToString(), "frame": value.frame}
        return found


def _advanced(cut: cagecut.Cut) -> cagecut.Cut:
    cut.advance(to=0.3)
    return cut


@dataclass(frozen=True)
class Call:
    """A public call.

    Args:
        function: What is called, of a world.
        arguments: Right arguments, of a world.
        good: Names of values in ``bad_values.VALUES`` that each argument may have too; an argument that may have any
            is left out of the trials by ``None``.
        names: Words that an error of an argument may have instead of its name.
    """

    function: Callable[[World], Callable]
    arguments: Callable[[World], dict[str, object]]
    good: dict[str, tuple[str, ...] | None] = field(default_factory=dict)
    names: dict[str, tuple[str, ...]] = field(default_factory=dict)


def kept_file(world: World) -> Path:
    """A file of the world's coordinates."""
    path = world.folder / "kept.npz"
    world.coordinates.save(path)
    return path


def box_file(world: World) -> Path:
    """The cage as a file."""
    path = world.folder / "box.obj"
    lines = [f"v {x} {y} {z}" for x, y, z in world.cage.vertices]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in world.cage.faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def frame_writer(writer: AnimationWriter) -> Callable[..., None]:
    """Writes a frame of one body, whose fields are arguments too."""
    return lambda frame, **values: writer.write_frame(frame, BodyFrame(**values))
