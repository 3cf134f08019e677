# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What one edit did to a cage: an advance of a cut, an obstacle put in, a face moved outward.

Section 5.2 of the paper lists what the weights' update has to know of a cut: faces being split, the sides of the cut,
the newly swept polygon, vertices created or displaced. Section 8 names extending and obstructing edits besides.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...section import BladePlane
from ..pieces import CagePiece, pieces_of

if TYPE_CHECKING:
    from ..cage import Cage


@dataclass(frozen=True, eq=False)
class CageEdit:
    """One step: the cage before and after, and how they differ."""

    before: Cage
    """The cage before the step."""
    cage: Cage
    """The cage after the step."""
    swept: tuple[np.ndarray, ...]
    """Polygons of new wall, counterclockwise about their wall's normal, each of shape (corner_count, 3) [m].

    In 2D they are segments with their wall's normal on their right, each of shape (2, 2).
    """
    swept_wall: np.ndarray
    """Wall of each of them, ascending, shape (polygon_count,)."""
    swept_simplices: np.ndarray
    """The same as triangles, or as the segments that they are, shape (simplex_count, dimension, dimension) [m]."""
    swept_simplex_wall: np.ndarray
    """Wall of each simplex, ascending, shape (simplex_count,)."""
    created: np.ndarray
    """Ids of the vertices that are new, shape (created_count,)."""
    moved: np.ndarray
    """Ids of the vertices that have moved, shape (moved_count,)."""
    source_faces: np.ndarray
    """For the created, then the moved vertices: a face of ``before`` that holds their position, shape (count,).

    It is -1 for those inside the body: at the corners of the front of a knife of finite width, at every tip in 2D and
    on an obstacle; and for those outside of it, where a face has moved outward.
    """
    retired_walls: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    """Walls that bound the cage no longer, ascending, shape (retired_count,); no face of ``cage`` is on them."""
    wall: int = -1
    """Number of a cut's wall in ``cage.walls``, which have it as soon as something is open; -1 for other edits."""
    plane: BladePlane | None = None
    """Plane of a cut."""
    front: float = np.nan
    """Coordinate s of a cut's blade in the plane [m]."""
    depth: float = np.nan
    """Depth of a cut from where the blade first touches [m]."""
    complete: bool = True
    """Whether nothing is left to cut."""

    @property
    def is_empty(self) -> bool:
        """Whether the step changed nothing."""
        return self.cage is self.before

    @cached_property
    def pieces(self) -> tuple[CagePiece, ...]:
        """The pieces that the cage is in after the step, with what belongs to each."""
        return pieces_of(self.cage)

    @property
    def components(self) -> tuple[CagePiece, ...]:
        """Earlier name of ``pieces``; a cage's components are its connected sets of faces, cavities included."""
        return self.pieces

    @cached_property
    def separated(self) -> bool:
        """Whether a piece came off in this step."""
        if self.is_empty or self.before.component_count == self.cage.component_count == 1:
            return False
        return self.cage.piece_count > self.before.piece_count

    @cached_property
    def _same(self) -> np.ndarray:
        """Whether a face number stands for the same polygon before and after, shape (max face_count,)."""
        old, new = self.before, self.cage
        same = np.zeros(max(old.face_count, new.face_count), dtype=bool)
        if self.is_empty:
            same[:] = True
            return same
        count = min(old.face_count, new.face_count)
        alike = (old.mesh.face_size[:count] == new.mesh.face_size[:count]) & (
            old.face_key[:count] == new.face_key[:count]
        )
        half = np.flatnonzero(np.append(alike, np.zeros(new.face_count - count, dtype=bool))[new.mesh.face])
        face = new.mesh.face[half]
        vertex = new.mesh.face_vertex[half]
        has_moved = np.zeros(new.vertex_count, dtype=bool)
        has_moved[self.moved] = True
        counterpart = old.mesh.face_vertex[half - new.mesh.face_start[face] + old.mesh.face_start[face]]
        differs = (counterpart != vertex) | has_moved[vertex]
        same[:count] = alike
        same[face[differs]] = False
        return same

    @cached_property
    def changed_faces(self) -> np.ndarray:
        """Faces of ``cage`` that are new, differ or have a moved vertex, ascending, shape (changed_count,)."""
        return np.flatnonzero(~self._same[: self.cage.face_count])

    @cached_property
    def changed_keys(self) -> np.ndarray:
        """Keys of which some face was added, removed or changed, ascending, shape (key_count,)."""
        before = np.flatnonzero(~self._same[: self.before.face_count])
        return np.union1d(self.before.face_key[before], self.cage.face_key[self.changed_faces])


def swept_faces(cage: Cage, faces: np.ndarray, walls: np.ndarray) -> dict[str, tuple[np.ndarray, ...] | np.ndarray]:
    """Whole faces as the pieces of wall that an edit sweeps.

    Args:
        cage: A cage that has the faces.
        faces: The faces, shape (count,).
        walls: Wall that each of them adds to, shape (count,).

    Returns:
        The fields of :class:`CageEdit` that tell of what was swept.
    """
    mesh, order = cage.mesh, np.argsort(walls, kind="stable")
    rows = [np.flatnonzero(cage.simplex_face == face) for face in faces[order].tolist()]
    return {
        "swept": tuple(
            mesh.vertices[mesh.face_vertex[mesh.face_start[face] : mesh.face_start[face + 1]]]
            for face in faces[order].tolist()
        ),
        "swept_wall": walls[order],
        "swept_simplices": mesh.vertices[cage.simplices[np.concatenate(rows)]],
        "swept_simplex_wall": np.repeat(walls[order], [len(row) for row in rows]),
    }
