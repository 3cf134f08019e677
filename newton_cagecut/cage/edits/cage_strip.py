# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Strips of a cage's cut, each in a plane of its own.

Sections 4 and 5.2 of the paper. A strip is a pure function: (cage before it, plane, depth) -> cage.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...section import BladePlane, Hinge, Strip
from ..wall import Wall, cut_wall
from .edit import CageEdit
from .open_cage import changed_vertices, open_cage, swept_polygons

if TYPE_CHECKING:
    from ..cage import Cage


@dataclass(frozen=True, eq=False)
class StripState:
    """What a strip has opened."""

    cage: Cage
    """The cage."""
    front: float
    """Coordinate s of the front [m]."""
    half_edge_face: np.ndarray
    """Face of the cage that walks each half-edge of the cage before the strip, shape (half_edge_count,)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CageStrip:
    """One plane's part of a cage's cut."""

    base: Cage
    """The cage before the strip."""
    strip: Strip
    """The strip of its faces."""
    first: float
    """Coordinate s of depth zero [m]."""
    hinged: bool = False
    """Whether the strip begins at ``s = 0``."""
    hinge_wall: int | None = None
    """Wall of which the front is the strip's hinge, where that has begun to open."""

    @classmethod
    def from_outside(cls, base: Cage, plane: BladePlane, window: tuple[float, float, float] | None) -> CageStrip:
        """A strip that begins where the blade first touches a cage.

        Args:
            base: The cage.
            plane: The plane.
            window: Heel, tip and start of the blade, which bound coordinates a, a and s [m].

        Raises:
            ValueError: If the blade starts inside the body where it may not.
        """
        strip = _strip(base, plane, None, window)
        return cls(base=base, strip=strip, first=float(strip.fronts[0]) if strip.touches else 0.0)

    @classmethod
    def from_hinge(cls, base: Cage, plane: BladePlane, hinge: Hinge, hinge_wall: int | None) -> CageStrip:
        """A strip that goes on from the front of another, at ``s = 0``.

        Args:
            base: The cage.
            plane: The plane.
            hinge: The front.
            hinge_wall: Wall of the strip before, where that has begun to open.

        Raises:
            ValueError: If the section does not close at the hinge.
        """
        strip = _strip(base, plane, hinge, None)
        return cls(base=base, strip=strip, first=0.0, hinged=True, hinge_wall=hinge_wall)

    @property
    def plane(self) -> BladePlane:
        """The plane."""
        return self.strip.plane

    @property
    def wall(self) -> int:
        """Number of the strip's wall in the walls of the cage, once it has begun to open."""
        return len(self.base.walls)

    @cached_property
    def _opened_wall(self) -> Wall:
        return cut_wall(self.plane)

    @property
    def length(self) -> float:
        """Depth at which the strip is complete [m]."""
        return max(0.0, float(self.strip.fronts[-1]) - self.first) if self.strip.touches else 0.0

    @property
    def start(self) -> StripState:
        """The strip before it opens."""
        return StripState(self.base, self._front_at(0.0), self.base.mesh.face)

    def _front_at(self, depth: float) -> float:
        """Coordinate of the front at a depth, moved on by the tolerance where it would pass too close to a node."""
        if not self.strip.touches:
            return 0.0
        tolerance = self.strip.tolerance
        if depth <= 0.0:
            return self.first - tolerance
        return self.strip.clear_front(min(self.first + depth, float(self.strip.fronts[-1]) + tolerance))

    def advance(self, state: StripState, to: float, depth: float) -> tuple[StripState, CageEdit]:
        """Open the strip further.

        Args:
            state: What is open.
            to: Depth in the strip [m].
            depth: Depth in the whole cut, for the record [m].

        Returns:
            What is open then, and the step.
        """
        front = self._front_at(to)
        if front == state.front or not self.strip.touches:
            return self._stay(state, front, depth)
        opening = self.strip.opened(front)
        swept = self.strip.swept(opening, state.front)
        if len(opening.vertices.tip_chords) == 0 and not swept.reached.any():
            return self._stay(state, front, depth)
        cage = open_cage(self.base, opening, self._opened_wall)
        edit = CageEdit(
            before=state.cage,
            cage=cage,
            **swept_polygons(swept, self.wall),
            **changed_vertices(state.cage, cage, opening, swept, state.half_edge_face),
            **self._reached(front, depth),
        )
        return StripState(cage, front, opening.faces.half_edge_face), edit

    def _stay(self, state: StripState, front: float, depth: float) -> tuple[StripState, CageEdit]:
        none, dimension = np.zeros(0, dtype=np.int64), self.base.dimension
        edit = CageEdit(
            before=state.cage,
            cage=state.cage,
            swept=(),
            swept_wall=none,
            swept_simplices=np.zeros((0, dimension, dimension)),
            swept_simplex_wall=none,
            created=none,
            moved=none,
            source_faces=none,
            **self._reached(front, depth),
        )
        return StripState(state.cage, front, state.half_edge_face), edit

    def _reached(self, front: float, depth: float) -> dict[str, object]:
        """The fields of an edit that tell where the blade is."""
        complete = self.strip.is_complete(front)
        return {"wall": self.wall, "plane": self.plane, "front": front, "depth": depth, "complete": complete}


def _strip(base: Cage, plane: BladePlane, hinge: Hinge | None, window: tuple[float, float, float] | None) -> Strip:
    tolerance = base.length_tolerance
    common = {"hinge": hinge, "window": window, "tolerance": tolerance}
    if base.dimension == 2:
        return Strip.of_segments(base.mesh, plane, vertex_piece=base.vertex_piece, **common)
    return Strip.of_polygons(base.mesh, plane, window_tolerance=tolerance, **common)
