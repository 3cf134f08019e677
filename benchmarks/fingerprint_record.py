# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Digests of cages, edits, surfaces and coordinates, step by step."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np

from newton_cagecut import Cage, CageEdit, HarmonicCoordinates, Surface, UpdateStats

_LENGTH = 16  # hexadecimal digits of a digest that are kept


class Record:
    """Digests of the results of one sequence, in steps.

    Args:
        integers: Whether to keep the results that are integers only.
    """

    def __init__(self, *, integers: bool) -> None:
        self.integers = integers
        self.steps: dict[str, dict[str, str]] = {}

    def begin(self, step: str) -> None:
        """Begin a step, to which what is added belongs.

        Args:
            step: Its name, which no other has.

        Raises:
            ValueError: There is such a step.
        """
        if step in self.steps:
            raise ValueError(f"there is a step {step!r} already")
        self.steps[step] = {}

    def add(self, **values: object) -> None:
        """Add results to the step; a tuple of arrays gives one digest.

        Args:
            values: Arrays, numbers, texts or None, or tuples of them, by name.
        """
        digests = self.steps[next(reversed(self.steps))]
        for name, value in values.items():
            parts = [np.asarray(part) for part in (value if isinstance(value, tuple) else (value,))]
            if not self.integers or all(part.dtype.kind in "biu" for part in parts):
                digests[name.replace("_", " ")] = digest(parts)

    def add_steps(self, other: Record) -> None:
        """Add all that another record has, all its steps in one digest of each name."""
        found: dict[str, list[np.ndarray]] = {}
        for digests in other.steps.values():
            for name, value in digests.items():
                found.setdefault(name, []).append(np.asarray(value))
        self.steps[next(reversed(self.steps))] |= {name: digest(parts) for name, parts in found.items()}

    @property
    def summary(self) -> dict[str, dict[str, str]]:
        """All results of each step in one digest, to be compared where space counts."""
        return {
            step: {"all": digest([np.asarray(part) for item in sorted(digests.items()) for part in item])}
            for step, digests in self.steps.items()
        }

    def add_cage(self, cage: Cage) -> None:
        """Add a cage."""
        self.add(
            topology=flat(cage.faces),
            face_keys=cage.face_key,
            simplices=(cage.simplices, cage.simplex_face),
            pieces=(cage.face_piece, cage.vertex_piece),
            vertices=cage.vertices,
            walls=tuple(np.concatenate([wall.origin, wall.normal, *wall.axes]) for wall in cage.walls),
            volumes=cage.piece_volumes,
        )

    def add_edit(self, edit: CageEdit) -> None:
        """Add an edit, with the cage that it leaves."""
        self.add_cage(edit.cage)
        self.add(
            created=edit.created,
            moved=edit.moved,
            source_faces=edit.source_faces,
            retired_walls=edit.retired_walls,
            changes=(edit.changed_faces, edit.changed_keys),
            outcome=(edit.is_empty, edit.complete, edit.separated, edit.wall),
            swept_walls=(edit.swept_wall, edit.swept_simplex_wall),
            swept=(*edit.swept, edit.swept_simplices),
            front=(edit.front, edit.depth),
        )

    def add_surface(self, surface: Surface, cage: Cage) -> None:
        """Add a surface at rest, with what the walls of its cage give its caps."""
        self.add(
            triangles=surface.triangles,
            caps=(surface.triangle_cap, surface.cap_side),
            point_keys=surface.point_key,
            surface_points=surface.points,
            uvs=surface.uvs,
            normals=surface.normals,
            corner_uvs=surface.corner_uvs(cage.walls),
        )
        if surface.dimension == 3:
            self.add(corner_normals=surface.corner_normals(cage.walls))

    def add_coordinates(self, coordinates: HarmonicCoordinates) -> None:
        """Add weights, gradients and the cached walks, which are floats or depend on them."""
        self.add(
            weights=coordinates.weights,
            gradients=coordinates.gradients,
            degrees=coordinates.degrees,
            lowest_weights=coordinates.lowest_weights,
            bounds=coordinates.bounds,
            removed_points=coordinates.removed_points,
            **{f"landing_{name}": values for name, values in coordinates.landings.items()},
        )

    def add_stats(self, stats: UpdateStats) -> None:
        """Add the counts of an update."""
        self.add(
            walks=(stats.walk_count, stats.checked, stats.rewalked, stats.on_face, stats.resumed, stats.capped),
            resolved_points=stats.resolved_points,
            lowest_weight=stats.lowest_weight,
        )


def flat(loops: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """Return the lengths of loops, and all of them one after the other.

    Args:
        loops: The loops.
    """
    return np.array([len(loop) for loop in loops]), np.concatenate(loops).astype(np.int64)


def digest(arrays: Sequence[np.ndarray]) -> str:
    """Return the digest of arrays, of which integers of any width are alike.

    Args:
        arrays: The arrays.
    """
    found = hashlib.sha256()
    for array in arrays:
        if array.dtype.kind in "biu":
            array = array.astype(np.int64)
        content = str(array).encode() if array.dtype.kind in "OU" else np.ascontiguousarray(array).tobytes()
        found.update(f"{array.dtype.kind}{array.dtype.itemsize}{array.shape}".encode() + content)
    return found.hexdigest()[:_LENGTH]
