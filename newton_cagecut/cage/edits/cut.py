# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progressive cuts of cages.

Sections 4 and 5.2 of the paper. A cut is a pure function: (cage before the cut, blade, depth) -> cage, with the turns
of the blade, each at its depth, as a part of the blade.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from ...geometry import as_instance, as_number
from ...section import Blade, BladePlane, Hinge, Section, clear_plane, clear_turn
from ..cage import Cage
from .cage_strip import CageStrip, StripState
from .edit import CageEdit

_LEAST_TURN_COSINE = -0.985


@dataclass(frozen=True, eq=False)
class CutState:
    """Where a cut is."""

    strips: tuple[tuple[CageStrip, float], ...]
    """Its strips, and the depth at which each of them begins [m]."""
    depth: float
    """Depth to which it was advanced, along all its turns [m]."""
    opened: StripState
    """What the last strip has opened."""

    @property
    def strip(self) -> CageStrip:
        """The present strip."""
        return self.strips[-1][0]

    @property
    def begun(self) -> float:
        """Depth at which the present strip begins [m]."""
        return self.strips[-1][1]


@dataclass(frozen=True, eq=False)
class CutSnapshot:
    """Where a cut was; made by :meth:`Cut.snapshot`."""

    identity: object
    state: CutState

    @property
    def cage(self) -> Cage:
        """The cage at the time."""
        return self.state.opened.cage


class Cut:
    """A blade on its way through a cage."""

    def __init__(self, cage: Cage, blade: Blade):
        """Begin a cut; nothing changes before :meth:`advance`.

        Args:
            cage: The cage to cut, which may have been cut before.
            blade: The blade, in the cage's rest frame.

        Raises:
            TypeError: If the arguments are not a cage and a blade.
            ValueError: If the blade is not of the cage's dimension, or starts inside the body where it may not.
        """
        as_instance(cage, Cage, "cage")
        as_instance(blade, Blade, "blade")
        if blade.dimension != cage.dimension:
            raise ValueError(
                f"the cage is of dimension {cage.dimension} and the blade of dimension {blade.dimension}; give a blade "
                f"whose vectors have {cage.dimension} numbers"
            )
        self.base = cage
        """The cage before the cut."""
        self._identity = object()
        self._blade = blade
        self._state = self._from_outside(cage)
        _warn_of_slivers(cage, BladePlane.of(blade), self.plane)

    def _from_outside(self, cage: Cage) -> CutState:
        """The state before the blade touches a cage."""
        plane = clear_plane(BladePlane.of(self._blade), cage.vertices, cage.length_tolerance)
        strip = CageStrip.from_outside(cage, plane, self._blade.window)
        return CutState(((strip, 0.0),), 0.0, strip.start)

    @property
    def depth(self) -> float:
        """Depth to which the cut was advanced, along all its turns [m]."""
        return self._state.depth

    @property
    def _strips(self) -> tuple[tuple[CageStrip, float], ...]:
        return self._state.strips

    @property
    def cage(self) -> Cage:
        """The cage as it is now."""
        return self._state.opened.cage

    @property
    def hinged(self) -> bool:
        """Whether the present plane begins at ``s = 0``, at the front of an earlier part of the cut."""
        return self._state.strip.hinged

    @property
    def plane(self) -> BladePlane:
        """The plane in which the blade moves, moved off the cage's vertices."""
        return self._state.strip.plane

    @property
    def wall(self) -> int:
        """Number of the present plane's wall in the walls of the cage, once it has begun to open."""
        return self._state.strip.wall

    @property
    def window(self) -> tuple[float, float, float] | None:
        """Heel, tip and start of a knife where they are in the plane, moved off the section's nodes; else None [m]."""
        return self.section.window

    @property
    def section(self) -> Section:
        """The present plane's section."""
        return self._state.strip.strip.section

    @property
    def front(self) -> float:
        """Coordinate s of the blade in the plane [m]."""
        return self._state.opened.front

    @property
    def length(self) -> float:
        """Depth at which the cut is complete, 0 if the blade misses the cage [m]."""
        return self._state.begun + self._state.strip.length

    @property
    def complete(self) -> bool:
        """Whether nothing is left to cut."""
        return self._state.strip.strip.is_complete(self.front)

    def advance(self, to: float) -> CageEdit:
        """Move the blade on to a depth, wherever it is now; by a length it is moved with ``cut.depth + length``.

        Args:
            to: Depth along the blade's direction, from where it first touches the cage [m]: absolute.

        Returns:
            The step from the cage as it was.

        Raises:
            TypeError: If the depth is not a number.
            ValueError: If the depth is not a number's value, or less than the depth now.
        """
        depth = as_number(to, "the depth of a cut")
        if depth < self.depth:
            raise ValueError(f"a cut never goes back: it has reached depth {self.depth:g}, asked for {depth:g}")
        now = self._state
        opened, edit = now.strip.advance(now.opened, depth - now.begun, depth)
        self._state = CutState(now.strips, depth, opened)
        return edit

    def turn(self, direction: np.ndarray) -> None:
        """Turn the blade about its present front; further steps open a further wall from there.

        Args:
            direction: Direction in which the blade moves from now on, of any length, not along the edge, shape
                (dimension,).

        Raises:
            TypeError: If the direction is not as many numbers as the space has dimensions.
            ValueError: If the direction is not finite, zero, along the edge or back into the cut, or the cut is
                complete. Nothing has changed then.
        """
        if self.complete:
            raise ValueError("the cut is complete: there is no front to turn about; begin a new cut")
        plane = self._front_plane()
        turned = plane.towards(direction)
        if np.dot(turned.across, plane.across) < _LEAST_TURN_COSINE:
            raise ValueError("the blade would turn back into its own cut; turn it by less than 170 degrees")
        self._state = self._gone_on(self.cage, turned)

    def resume(self, cage: Cage) -> None:
        """Go on in a cage that other cuts, extensions or obstacles have changed since the last step.

        Further steps open a further wall, in the same plane as far as the tolerance allows.

        Args:
            cage: The cage as it is now, made by other edits from this cut's.

        Raises:
            TypeError: If the cage is none.
            ValueError: If the cage is not one that came of this cut's, or it has grown across the cut's front line,
                beside where the cut has come. Nothing has changed then.
        """
        if as_instance(cage, Cage, "cage").walls[: len(self.cage.walls)] != self.cage.walls:
            raise ValueError("the cage did not come of this cut's: it lacks some of its walls; begin a new cut")
        now = self._state
        if self.complete:
            opened = StripState(cage, self.front, now.opened.half_edge_face)
            self._state = CutState(now.strips, now.depth, opened)
        elif not (self._is_open or self.hinged):
            self._state = self._from_outside(cage)
        else:
            self._state = self._gone_on(cage, self._front_plane())

    @property
    def _is_open(self) -> bool:
        """Whether the present plane's wall has begun to open."""
        return self.cage is not self._state.strip.base

    def _front_plane(self) -> BladePlane:
        """The present plane with its origin at the front."""
        return self.plane.at(max(self.front, 0.0) if self.hinged else self.front)

    def _gone_on(self, cage: Cage, plane: BladePlane) -> CutState:
        """The state with a strip begun at the present front, in place of one that was begun here and not opened."""
        if self._blade.window is not None and self.base.dimension == 3:
            raise ValueError(
                "a knife of finite width, or one that starts inside, neither turns nor goes on after another cut; "
                "begin a new cut"
            )
        now = self._state
        wall = now.strip.wall if self._is_open else now.strip.hinge_wall
        hinge = _find_hinge(cage, wall, self._front_plane())
        others = np.delete(cage.vertices, hinge.vertices, axis=0)
        plane = clear_turn(plane, others, cage.length_tolerance)
        replaced = self.hinged and not self._is_open and now.begun == now.depth
        strips = now.strips[:-1] if replaced else now.strips
        strip = CageStrip.from_hinge(cage, plane, hinge, wall)
        return CutState((*strips, (strip, now.depth)), now.depth, strip.start)

    def snapshot(self) -> CutSnapshot:
        """Remember where the cut is, for :meth:`rewind`; nothing is copied."""
        return CutSnapshot(self._identity, self._state)

    def rewind(self, to: float | CutSnapshot = 0.0) -> Cage:
        """Take the blade back and the cut with it: a cut is a function of its depth, so nothing of it stays.

        What other cuts did to the cage since is taken back too.

        Args:
            to: A snapshot of this cut, whose very cage comes back, or a depth, of which an equal cage is made [m].

        Returns:
            The cage, the same to the last bit as when the cut had been there on its way.

        Raises:
            TypeError: If the depth is not a number.
            ValueError: If the depth is not a number's value, negative or beyond the depth now, or the snapshot is of
                another cut. Nothing has changed then.
        """
        if isinstance(to, CutSnapshot):
            if to.identity is not self._identity:
                raise ValueError("the snapshot is of another cut; rewind that one, or take a snapshot of this one")
            self._state = to.state
            return self.cage
        depth = as_number(to, "the depth of a cut")
        if not 0.0 <= depth <= self.depth:
            raise ValueError(f"a cut is rewound to a depth between 0 and {self.depth:g}, where it is, not to {depth:g}")
        kept = tuple(item for item in self._strips if item[1] <= depth)
        strip, begun = kept[-1]
        opened = strip.advance(strip.start, depth - begun, depth)[0] if depth > begun else strip.start
        self._state = CutState(kept, depth, opened)
        return self.cage


def _warn_of_slivers(cage: Cage, wanted: BladePlane, plane: BladePlane) -> None:
    """Warn of faces in whose planes a blade was put, if it was moved into the body behind them."""
    mesh = cage.mesh
    far = np.abs(wanted.distance(cage.vertices))[mesh.face_vertex]
    in_plane = np.maximum.reduceat(far, mesh.face_start[:-1]) <= cage.length_tolerance
    inward = np.array([wall.normal for wall in cage.walls])[cage.face_wall] @ plane.normal
    inward *= 1.0 - 2.0 * cage.face_side
    depth = -inward * float((plane.origin - wanted.origin) @ plane.normal)
    slivers = np.flatnonzero(in_plane & (depth > 0.0))
    if len(slivers):
        warnings.warn(
            f"the blade lies in the plane of face {slivers[0]} of the cage and would cut off a sliver "
            f"{depth[slivers[0]]:.2g} m thick behind it; move the blade along its normal, into the body or out of it",
            stacklevel=3,
        )


def _find_hinge(cage: Cage, wall: int | None, plane: BladePlane) -> Hinge:
    """Where both sides of a wall meet on the line ``s = 0`` of a plane."""
    mesh, tolerance = cage.mesh, 0.5 * cage.length_tolerance
    if wall is None:
        return Hinge(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))
    key = cage.face_key[mesh.face]
    on_front = np.abs(plane.coordinates(cage.vertices)[:, 1]) <= tolerance
    on_front &= np.abs(plane.distance(cage.vertices)) <= tolerance
    for side in (0, 1):
        used = np.zeros(cage.vertex_count, dtype=bool)
        used[mesh.face_vertex[key == 2 * wall + side]] = True
        on_front &= used
    return Hinge.of(mesh, cage.face_key, wall, on_front)
