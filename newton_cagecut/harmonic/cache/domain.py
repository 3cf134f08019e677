# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The domain of the walks: walls, candidate grid and faces of one cage, kept up to date as it is edited."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ...cage import Cage, CageEdit
from ...geometry import lifted
from ..faces.face_tables import FaceTables, build_face_tables
from ..launch import launch
from ..walks.marking import CHANGED_KEY, RETIRED_KEY, UNCHANGED_KEY
from ..walls.frame import UnitFrame
from ..walls.grid import CandidateGrid
from ..walls.nearest_wall import measure_distance
from ..walls.wall_triangles import MOST_GATES, Walls


@dataclass(frozen=True)
class DomainChange:
    """What an edit means for walks.

    Args:
        polygons: New pieces of wall in the unit frame, shape (k, 3) each.
        directions: Directions along which each of them is thin, shape (2, 3) each.
        first_new: First of the new wall triangles.
        key_changes: What becomes of landings with key 2 * wall + side, shape (2 * wall_count,); see ``walks.marking``.
        regrouped: Whether the pieces are other ones than before.
    """

    polygons: list[np.ndarray]
    directions: list[np.ndarray]
    first_new: int
    key_changes: np.ndarray
    regrouped: bool


@dataclass(frozen=True, eq=False)
class DomainState:
    """A domain at one time; made by ``Domain.state``."""

    cage: Cage
    walls: tuple
    grid: tuple
    faces: FaceTables
    last: tuple[CageEdit, DomainChange] | None


class Domain:
    """Walls, grid and faces of a cage on a device; several sets of coordinates can share one.

    Args:
        cage: The cage; it may have cuts already.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        distance: "grid" or "all": how the nearest wall is found.
        grid_resolution: Cells of the grid along the cage's longest side; by default, what suits the number of walls.
        device: Where to put them.
        walls: The walls as edits have left them, of which a cut cage does not tell all; by default those of its faces.
    """

    def __init__(
        self,
        cage: Cage,
        *,
        quads: str,
        distance: str,
        device: wp.context.Device,
        grid_resolution: int | None = None,
        walls: Walls | None = None,
    ) -> None:
        self.cage = cage
        self.quads = quads
        self.distance = distance
        self.device = device
        self.walls = walls or Walls(UnitFrame.of(cage.vertices), device=device)
        self.frame = self.walls.frame
        if walls is None:
            self._append(cage.vertices[cage.simplices], cage.face_wall[cage.simplex_face], cage)
        resolution = grid_resolution if distance == "grid" else 1
        self.grid = CandidateGrid(self.walls, resolution=resolution)
        self.faces = self.faces_before = build_face_tables(cage, self.frame, quads=quads, device=device)
        self._last: tuple[CageEdit, DomainChange] | None = None

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return self.cage.dimension

    @property
    def gated(self) -> bool:
        """Whether walls have become gates."""
        return self.walls.gate_count > 0

    @property
    def has_nested_faces(self) -> bool:
        """Whether any face needs a nested walk."""
        return self.faces.nested_count > 0

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

    def apply(self, edit: CageEdit) -> DomainChange:
        """Append an edit's walls and take over its faces; the same edit a second time changes nothing.

        Raises:
            ValueError: The edit starts from another cage than the present one, or walls were retired too often.
        """
        if self._last is not None and self._last[0] is edit:
            return self._last[1]
        if edit.before is not self.cage:
            raise ValueError(
                "update: the edit starts from another cage than the one held; pass every edit of a cut, in order"
            )
        if self.walls.gate_count + len(edit.retired_walls) > MOST_GATES:
            raise ValueError(
                f"the cage has been extended {MOST_GATES} times, more than walks can tell apart; make new coordinates"
            )
        first_new = self.walls.triangle_count
        if len(edit.retired_walls):
            self._append(edit.swept_simplices, edit.swept_simplex_wall, edit.cage)
            self.walls.retire(edit.retired_walls)
            self.grid.rebuild()
        else:
            for wall in np.unique(edit.swept_simplex_wall).tolist():
                corners = edit.swept_simplices[edit.swept_simplex_wall == wall]
                first = self.walls.triangle_count
                self._append(corners, np.full(len(corners), wall), edit.cage)
                self.grid.merge(first)
        self.faces_before = self.faces
        self.faces = build_face_tables(edit.cage, self.frame, quads=self.quads, device=self.device)
        change = self._change(edit, first_new)
        self.cage = edit.cage
        self._last = (edit, change)
        return change

    def state(self) -> DomainState:
        """What ``restore`` needs to come back to the present."""
        return DomainState(self.cage, self.walls.state(), self.grid.state(), self.faces, self._last)

    def restore(self, state: DomainState) -> None:
        """Come back to a state: later walls are forgotten.

        Args:
            state: A state of this domain.
        """
        self.cage, self.faces, self._last = state.cage, state.faces, state.last
        self.faces_before = state.faces
        self.walls.restore(state.walls)
        self.grid.restore(state.grid)

    def _append(self, corners: np.ndarray, walls: np.ndarray, cage: Cage) -> None:
        normals = np.array([wall.normal for wall in cage.walls])[walls]
        two_sided = np.array([wall.two_sided for wall in cage.walls])[walls]
        self.walls.append(corners, walls, normals, two_sided)

    def _change(self, edit: CageEdit, first_new: int) -> DomainChange:
        polygons = [lifted(self.frame.to_unit(polygon)) for polygon in edit.swept]
        normals = [lifted(edit.cage.walls[wall].normal) for wall in edit.swept_wall]
        along = [_directions(polygon, normal) for polygon, normal in zip(polygons, normals)]
        regrouped = _pieces_differ(edit.before, edit.cage)
        changed = np.zeros((len(edit.cage.walls), 2), dtype=bool)
        changed.reshape(-1)[np.asarray(edit.changed_keys, dtype=np.int64)] = True
        if regrouped:
            changed.reshape(-1)[_ambiguous_keys(edit.cage)] = True
        changed |= changed.any(axis=1, keepdims=True)
        changes = np.where(changed, np.uint8(CHANGED_KEY), np.uint8(UNCHANGED_KEY))
        changes[edit.retired_walls] = np.uint8(RETIRED_KEY)
        return DomainChange(polygons, along, first_new, changes.reshape(-1), regrouped)


def _directions(polygon: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Directions along which a flat piece is thin: its normal, and across its longest edge. Shape (2, 3).

    A piece in 2D is one edge, with nothing across it but its normal: there it is that edge's own direction.
    """
    edges = np.roll(polygon, -1, axis=0) - polygon
    longest = edges[np.argmax((edges**2).sum(axis=1))]
    second = longest if len(polygon) == 2 else np.cross(normal, longest)
    return np.stack([normal, second / max(np.linalg.norm(second), 1.0e-30)])


def _pieces_differ(before: Cage, after: Cage) -> bool:
    """Whether the faces that both cages have are grouped in other pieces."""
    if before.piece_count != after.piece_count:
        return True
    if after.piece_count == 1:
        return False
    shared = min(before.vertex_count, after.vertex_count)
    return not np.array_equal(before.vertex_piece[:shared], after.vertex_piece[:shared])


def _ambiguous_keys(cage: Cage) -> np.ndarray:
    """Keys whose landings had a choice of faces: those of several faces, and of two-sided walls."""
    keys = 2 * np.asarray(cage.face_wall) + np.asarray(cage.face_side)
    several = np.bincount(keys, minlength=2 * len(cage.walls)) > 1
    two_sided = np.repeat([wall.two_sided for wall in cage.walls], 2)
    return np.flatnonzero(several | two_sided)
