# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What an edit of the cage means for walks that are kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...cage import Cage, CageEdit
from ...geometry import lifted
from ..faces.face_tables import FaceTables
from ..walks.marking import CHANGED_KEY, RETIRED_KEY, UNCHANGED_KEY
from ..walls.frame import UnitFrame


@dataclass(frozen=True, eq=False)
class DomainChange:
    """What an edit means for walks.

    Args:
        edit: The edit.
        polygons: New pieces of wall in the unit frame, shape (k, 3) each.
        directions: Directions along which each of them is thin, shape (2, 3) each.
        first_new: First of the new wall triangles.
        key_changes: What becomes of landings with key 2 * wall + side, shape (2 * wall_count,); see ``walks.marking``.
        regrouped: Whether the pieces are other ones than before.
        faces_before: The faces before the edit.
    """

    edit: CageEdit
    polygons: list[np.ndarray]
    directions: list[np.ndarray]
    first_new: int
    key_changes: np.ndarray
    regrouped: bool
    faces_before: FaceTables

    @classmethod
    def of(cls, edit: CageEdit, frame: UnitFrame, *, first_new: int, faces_before: FaceTables) -> DomainChange:
        """Work out what an edit means.

        Args:
            edit: The edit.
            frame: The unit frame.
            first_new: First of the new wall triangles.
            faces_before: The faces before the edit.
        """
        polygons = [lifted(frame.to_unit(polygon)) for polygon in edit.swept]
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
        return cls(edit, polygons, along, first_new, changes.reshape(-1), regrouped, faces_before)


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
