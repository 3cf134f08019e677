# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walls, candidate grid and faces of one cage: all that walks and their landings see."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import warp as wp

from ...cage import Cage, CageEdit
from ..faces.face_tables import FaceTables, build_face_tables
from ..fit.boundary_fit import BoundaryFit
from ..fit.fit_memory import FitMemory
from ..fit.residual_sums import ResidualTable
from ..fit.residuals import build_residuals
from ..launch import launch
from ..walls.frame import UnitFrame
from ..walls.grid import CandidateGrid
from ..walls.nearest_wall import measure_distance
from ..walls.walls import MOST_GATES, Walls
from .domain_change import DomainChange


@dataclass(frozen=True, eq=False)
class DomainState:
    """Walls, grid and faces of one cage; an edit makes another state and never writes to this one.

    Args:
        cage: The cage.
        grid: The walls, indexed.
        faces: The cage's faces.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        distance: "grid" or "all": how the nearest wall is found.
        change: What the edit that led here means for walks; None at first.
        memory: What the last fit of any of these states has left for the next one.
    """

    cage: Cage
    grid: CandidateGrid
    faces: FaceTables
    quads: str
    distance: str
    memory: FitMemory
    change: DomainChange | None = None

    @classmethod
    def of(
        cls,
        cage: Cage,
        *,
        quads: str,
        distance: str,
        grid_resolution: int | None,
        device: wp.context.Device,
        walls: Walls | None = None,
    ) -> DomainState:
        """The first state; for the arguments see ``Domain``."""
        if walls is None:
            triangles = _triangles(cage, cage.vertices[cage.simplices], cage.face_wall[cage.simplex_face])
            walls = Walls.of_triangles(UnitFrame.of(cage.vertices), *triangles, device=device)
        grid = CandidateGrid(walls, resolution=grid_resolution if distance == "grid" else 1)
        faces = build_face_tables(cage, walls.frame, quads=quads, device=device)
        return cls(cage, grid, faces, quads, distance, FitMemory(cage.dimension, device))

    @property
    def walls(self) -> Walls:
        """The walls."""
        return self.grid.walls

    @property
    def frame(self) -> UnitFrame:
        """The unit frame: that of the cage before any edit."""
        return self.walls.frame

    @property
    def device(self) -> wp.context.Device:
        """Where everything is."""
        return self.walls.device

    @cached_property
    def fit(self) -> BoundaryFit:
        """The fit of the cage's coordinates, made when it is first asked for."""
        return BoundaryFit(self.cage, quads=self.quads, device=self.device, memory=self.memory)

    @cached_property
    def residuals(self) -> ResidualTable:
        """What the fit leaves over on the faces, evaluated when it is first asked for."""
        return build_residuals(self.fit, self.frame, self.device)

    def forgetful(self) -> DomainState:
        """This state, with a fit that is made without anything that earlier ones have left."""
        return replace(self, memory=FitMemory(self.cage.dimension, self.device))

    def pieces_of(self, points: np.ndarray) -> np.ndarray:
        """Piece of the cage that each rest position lies in; all 0 while there is one. Shape (n,)."""
        if self.cage.piece_count == 1:
            return np.zeros(len(points), dtype=np.int32)
        return np.asarray(self.cage.piece_of(points), dtype=np.int32)

    def distance_to_walls(self, points: np.ndarray) -> np.ndarray:
        """Distance of rest positions [m] to the nearest wall [m], shape (n,)."""
        unit = wp.array(self.frame.to_space(points), dtype=wp.vec3, device=self.device)
        distance = wp.empty(len(points), dtype=float, device=self.device)
        launch(measure_distance, len(points), [self.walls.data, self.grid.cells, unit, distance], device=self.device)
        return distance.numpy() * self.frame.half_side

    def after(self, edit: CageEdit) -> DomainState:
        """The state that an edit of the cage leads to.

        Args:
            edit: The edit.

        Raises:
            ValueError: The edit starts from another cage, or walls were retired too often.
        """
        if edit.before is not self.cage:
            raise ValueError(
                "update: the edit starts from another cage than the one held; pass every edit of a cut, in order"
            )
        if self.walls.gate_count + len(edit.retired_walls) > MOST_GATES:
            raise ValueError(
                f"the cage has been extended {MOST_GATES} times, more than walks can tell apart; make new coordinates"
            )
        faces = build_face_tables(edit.cage, self.frame, quads=self.quads, device=self.device)
        first_new = self.walls.triangle_count
        change = DomainChange.of(edit, self.frame, first_new=first_new, faces_before=self.faces)
        return replace(self, cage=edit.cage, grid=self._grid_after(edit), faces=faces, change=change)

    def _grid_after(self, edit: CageEdit) -> CandidateGrid:
        grid, wall = self.grid, edit.swept_simplex_wall
        if len(edit.retired_walls):
            # Gates have opened a way out of the old box.
            walls = self.walls.appended(*_triangles(edit.cage, edit.swept_simplices, wall)).retired(edit.retired_walls)
            return CandidateGrid(walls, resolution=grid.resolution)
        for one in np.unique(wall).tolist():
            corners = edit.swept_simplices[wall == one]
            walls = grid.walls.appended(*_triangles(edit.cage, corners, np.full(len(corners), one)))
            grid = grid.merged(walls, grid.walls.triangle_count)
        return grid


def _triangles(cage: Cage, corners: np.ndarray, walls: np.ndarray) -> tuple[np.ndarray, ...]:
    """Triangles of a cage's walls: corners, walls, normals and whether walks land on both sides."""
    normals = np.array([wall.normal for wall in cage.walls])[walls]
    two_sided = np.array([wall.two_sided for wall in cage.walls])[walls]
    return corners, walls, normals, two_sided
