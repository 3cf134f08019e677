# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progressive cuts of surfaces.

Section 6.3 of the paper splits the triangles that the cut crosses. Like a cage's, a surface's cut is a pure function of
the surface before it, the plane and the front; what opens is capped, so that a closed surface stays closed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..geometry import as_number
from ..section import BladePlane, Hinge
from .open_surface import open_surface
from .surface import Surface
from .surface_strip import SurfaceStrip


@dataclass(frozen=True, eq=False)
class SurfaceEdit:
    """One step of a surface's cut."""

    before: Surface
    """The surface before the step."""
    surface: Surface
    """The surface after the step."""
    created: np.ndarray
    """Ids of the sites that are new, shape (created_count,)."""
    moved: np.ndarray
    """Ids of the sites that have moved or changed sides, shape (moved_count,)."""

    @property
    def is_empty(self) -> bool:
        """Whether the step changed nothing."""
        return self.surface is self.before


@dataclass(frozen=True, eq=False)
class SurfaceCutState:
    """Where a surface's cut is."""

    strip: SurfaceStrip
    """The present plane's part of it."""
    surface: Surface
    """The surface."""
    front: float = -np.inf
    """Coordinate s of the blade in the plane [m]."""
    reach: float = -np.inf
    """Coordinate s up to which the strip is open [m]."""
    tips: np.ndarray | None = None
    """Sites at the tips, shape (tip_count,); None before there are some."""
    tip_wall: int = -1
    """Wall of the cut's sides that meet at the tips."""

    @classmethod
    def before(cls, strip: SurfaceStrip) -> SurfaceCutState:
        """The state before a strip opens that begins outside.

        Args:
            strip: The strip.
        """
        return cls(strip, strip.base, tip_wall=strip.wall)


@dataclass(frozen=True, eq=False)
class SurfaceSnapshot:
    """Where a surface's cut was; made by :meth:`SurfaceCut.snapshot`."""

    identity: object
    state: SurfaceCutState


class SurfaceCut:
    """A cut on its way through a surface."""

    def __init__(
        self, surface: Surface, plane: BladePlane, wall: int, *, window: tuple[float, float, float] | None = None
    ):
        """Begin a cut; nothing changes before :meth:`advance`.

        Args:
            surface: The surface to cut, which may have been cut before.
            plane: Plane of the cage's cut, of the surface's dimension.
            wall: Number of the cage's wall that this cut makes.
            window: Heel, tip and start of the cage's cut, where they are in the plane; None for a blade without [m].

        Raises:
            TypeError: If the surface is not a surface.
            ValueError: If the plane is of another dimension, or an edge of the surface has more than two triangles or
                is not consistently oriented.
        """
        if not isinstance(surface, Surface):
            raise TypeError(f"surface must be a Surface, got {type(surface).__name__}")
        if surface.dimension != plane.dimension:
            raise ValueError(
                f"the surface is of dimension {surface.dimension} and the cut's plane of dimension {plane.dimension}"
            )
        surface.refuse_branches()
        self._identity = object()
        self._state = SurfaceCutState.before(SurfaceStrip.of(surface, plane, wall, window=window))
        self._before = self.snapshot()

    @property
    def base(self) -> Surface:
        """The surface before the present plane's part of the cut."""
        return self._state.strip.base

    @property
    def surface(self) -> Surface:
        """The surface as it is now."""
        return self._state.surface

    @property
    def plane(self) -> BladePlane:
        """Plane of the cut, in space."""
        return self._state.strip.plane

    @property
    def wall(self) -> int:
        """Number of the wall on which new points lie."""
        return self._state.strip.wall

    @property
    def front(self) -> float:
        """Coordinate s of the blade in the plane [m]."""
        return self._state.front

    def go_on(
        self,
        plane: BladePlane,
        wall: int,
        *,
        surface: Surface | None = None,
        hinged: bool = True,
        window: tuple[float, float, float] | None = None,
    ) -> None:
        """Follow the cage's cut into another plane, from the present front, or into a surface that others have cut.

        Args:
            plane: The plane in which the cage's cut goes on; its line ``s = 0`` is the present front.
            wall: Number of the cage's wall that it makes there.
            surface: The surface as it is now, made by other cuts of this one; the present one by default.
            hinged: Whether the plane begins at ``s = 0``; not so where the cage's cut had not begun to open.
            window: Heel, tip and start of the cage's cut there, of a knife that had not begun to open [m].

        Raises:
            ValueError: If the section does not close at the front. Nothing has changed then.
        """
        now, surface = self._state, surface or self.surface
        if not hinged:
            self._state = SurfaceCutState.before(SurfaceStrip.of(surface, plane, wall, window=window))
            return
        hinge = _find_hinge(now, surface)
        offset = now.strip.offset
        if np.isfinite(now.front):
            offset = offset + (now.reach - now.front) * now.strip.plane.direction
        strip = SurfaceStrip.of(surface, plane, wall, hinge=hinge, offset=offset)
        self._state = SurfaceCutState(strip, surface, 0.0, 0.0, hinge.vertices, now.tip_wall)

    def advance(self, front: float) -> SurfaceEdit:
        """Open the surface up to the front.

        Args:
            front: Coordinate s of the blade in the plane, as in :attr:`~newton_cagecut.cage.CageEdit.front` [m].

        Returns:
            The step from the surface as it was.

        Raises:
            TypeError: If the front is not a number.
            ValueError: If the front is not a number's value or goes back.
        """
        front, now = as_number(front, "the front of a cut"), self._state
        if front < now.front:
            raise ValueError(f"a cut never goes back: it has reached {now.front:g}, asked for {front:g}")
        strip, before = now.strip, now.surface
        reach = max(now.reach, strip.reach_at(front)) if front > now.front else now.reach
        opening = strip.strip.opened(reach)
        after = replace(now, front=front, reach=reach)
        if opening.vertices.count:
            tips = opening.vertices.numbering.tip[opening.vertices.tip_chords]
            opened = open_surface(strip.base, opening, strip.wall)
            after = replace(after, surface=opened, tips=tips, tip_wall=strip.wall)
        created, moved = _changed_sites(before, after.surface)
        if len(created) == len(moved) == 0:
            after = replace(after, surface=before)
        self._state = after
        return SurfaceEdit(before, after.surface, created, moved)

    def snapshot(self) -> SurfaceSnapshot:
        """Remember where the cut is, for :meth:`rewind`; nothing is copied."""
        return SurfaceSnapshot(self._identity, self._state)

    def rewind(self, to: SurfaceSnapshot | None = None) -> Surface:
        """Take the cut back to a snapshot, or to the surface before the cut.

        Args:
            to: A snapshot of this cut; None for before the cut.

        Returns:
            The surface as it was, the very object.

        Raises:
            ValueError: If the snapshot is of another cut. Nothing has changed then.
        """
        to = self._before if to is None else to
        if to.identity is not self._identity:
            raise ValueError("the snapshot is of another cut; rewind that one, or take a snapshot of this one")
        self._state = to.state
        return self.surface


def _changed_sites(before: Surface, after: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Sites that are new, and those that have moved or changed sides."""
    common = before.site_count
    differs = (before.site_points != after.site_points[:common]).any(axis=1)
    differs |= before.site_key != after.site_key[:common]
    return np.arange(common, after.site_count), np.flatnonzero(differs)


def _find_hinge(now: SurfaceCutState, surface: Surface) -> Hinge:
    """The front of a cut in a surface that others may have cut since."""
    key, count = surface.triangle_key, surface.site_count
    on_front = np.zeros(count, dtype=bool)
    if now.tips is not None:
        on_front[now.tips] = True
    shared = np.ones(count, dtype=bool)
    for side in (0, 1):
        shared &= np.isin(np.arange(count), surface.site_triangles[key == 2 * now.tip_wall + side])
    candidates = np.flatnonzero(shared)
    s = now.strip.plane.coordinates(surface.mesh.vertices[candidates])[:, 1]
    on_front[candidates[np.abs(s - now.reach) <= now.strip.strip.tolerance]] = True
    return Hinge.of(surface.mesh, key, now.tip_wall, on_front)
