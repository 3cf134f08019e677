# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progressive cuts of surfaces.

Section 6.3 of the paper splits the triangles that the cut crosses. Like a cage's, a surface's cut is a pure function of
the surface before it, the plane and the front; what opens is capped, so that a closed surface stays closed. A flat mesh
is cut as the open mesh in space that it is, by the plane that stands on the blade's line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..geometry import units
from ..section import BladePlane, ClippedSection, Hinge, Numbering, Opening, Section, clear_front
from .splitting import cap_triangles, split_triangles
from .surface import Surface

_ON_FRONT = 1e-10
_ROUNDING = 1e-13
_STATE = (
    "base",
    "surface",
    "plane",
    "wall",
    "front",
    "_reach",
    "_offset",
    "_offset_ahead",
    "_section",
    "_numbering",
    "_tips",
    "_tip_wall",
)


@dataclass(frozen=True, eq=False)
class SurfaceEdit:
    """One step of a surface's cut."""

    before: Surface
    """The surface before the step."""
    surface: Surface
    """The surface after the step."""
    created: np.ndarray
    """Ids of the points that are new, shape (created_count,)."""
    moved: np.ndarray
    """Ids of the points that have moved or changed sides, shape (moved_count,)."""

    @property
    def is_empty(self) -> bool:
        """Whether the step changed nothing."""
        return self.surface is self.before


@dataclass(frozen=True, eq=False)
class SurfaceSnapshot:
    """Where a surface's cut was; made by :meth:`SurfaceCut.snapshot`."""

    identity: object
    present: tuple


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
        self._begin(surface, plane, wall, window=window)
        self._before = self.snapshot()

    def _begin(
        self,
        surface: Surface,
        plane: BladePlane,
        wall: int,
        *,
        hinge: Hinge | None = None,
        window: tuple[float, float, float] | None = None,
        offset: np.ndarray | None = None,
    ) -> None:
        plane = plane.in_space()
        self._offset = np.zeros(3) if offset is None else offset
        self._offset_ahead = float(plane.coordinates((plane.origin + self._offset)[None])[0, 1])
        plane = replace(plane, origin=plane.origin + self._offset)
        size = np.ptp(surface.points, axis=0).max()
        rounding = {"tolerance": _ROUNDING * size}
        section = Section(surface.mesh, plane, face_group=surface.triangle_solid, hinge=hinge, **rounding)
        if window is not None:
            section = ClippedSection(section, *window, tolerance=0.0)
        self.base = surface
        """The surface before the present plane's part of the cut."""
        self.surface = surface
        """The surface as it is now."""
        self.plane = plane
        """Plane of the cut, in space."""
        self.wall = int(wall)
        """Number of the wall on which new points lie."""
        self.front = -np.inf
        """Coordinate s of the blade in the plane [m]."""
        self._reach = -np.inf
        self._tolerance = _ON_FRONT * size
        self._section = section
        self._numbering = Numbering(section)
        self._tips = np.zeros(0, dtype=np.int64) if hinge is None else hinge.vertices
        self._tip_wall = self.wall

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
        surface = surface or self.surface
        if not hinged:
            self._begin(surface, plane, wall, window=window)
            return
        front_wall, key = self._tip_wall, surface.triangle_key
        on_front = np.zeros(surface.point_count, dtype=bool)
        on_front[self._tips] = True
        shared = np.isin(np.arange(surface.point_count), surface.triangles[key == 2 * front_wall])
        shared &= np.isin(np.arange(surface.point_count), surface.triangles[key == 2 * front_wall + 1])
        candidates = np.flatnonzero(shared)
        s = self.plane.coordinates(surface.mesh.vertices[candidates])[:, 1]
        on_front[candidates[np.abs(s - self._reach) <= self._tolerance]] = True
        offset = self._offset
        if np.isfinite(self.front):
            offset = offset + (self._reach - self.front) * self.plane.direction
        self._begin(surface, plane, wall, hinge=Hinge.of(surface.mesh, key, front_wall, on_front), offset=offset)
        self.front = self._reach = 0.0
        self._tip_wall = front_wall

    def advance(self, front: float) -> SurfaceEdit:
        """Open the surface up to the front.

        Args:
            front: Coordinate s of the blade in the plane, as in :attr:`~newton_cagecut.cage.CageEdit.front` [m].

        Returns:
            The step from the surface as it was.

        Raises:
            ValueError: If the front is not a number or goes back.
        """
        front = float(front)
        if np.isnan(front):
            raise ValueError("the front of a cut must be a number, got nan")
        if front < self.front:
            raise ValueError(f"a cut never goes back: it has reached {self.front:g}, asked for {front:g}")
        if front > self.front:
            # Tips keep off points and edges of the mesh, so that it is plain in which triangle each of them lies.
            nodes = np.sort(self._section.node_coordinates[:, 1])
            self._reach = max(self._reach, clear_front(nodes, front - self._offset_ahead, self._tolerance))
        self.front = front
        before = self.surface
        opening = Opening(self._section, self._numbering, self._reach)
        if opening.created_count:
            self._tips, self._tip_wall = self._numbering.tip[opening.tip_chords], self.wall
            self.surface = self._open_surface(opening)
        common = before.point_count
        differs = (before.points != self.surface.points[:common]).any(axis=1)
        moved = np.flatnonzero(differs | (before.point_key != self.surface.point_key[:common]))
        created = np.arange(common, self.surface.point_count)
        if len(created) == len(moved) == 0:
            self.surface = before
        return SurfaceEdit(before, self.surface, created, moved)

    def snapshot(self) -> SurfaceSnapshot:
        """Remember where the cut is, for :meth:`rewind`; nothing is copied."""
        return SurfaceSnapshot(self._identity, tuple(getattr(self, name) for name in _STATE))

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
        for name, value in zip(_STATE, to.present, strict=True):
            setattr(self, name, value)
        return self.surface

    def _open_surface(self, opening: Opening) -> Surface:
        base, wall = self.base, self.wall
        kept, added, owner = split_triangles(opening)
        caps, side = cap_triangles(opening)
        keys = np.full(opening.created_count, 2 * wall + 1, dtype=np.int32)
        minus, plus = (ids[opening.region.labels] for ids in opening.side_vertices())
        keys[minus[minus != plus] - base.point_count] = 2 * wall
        return Surface._assembled(
            np.concatenate([base.points, opening.created_positions()[:, : base.dimension]]),
            np.concatenate([kept, added, caps]).astype(np.int32),
            self._carried(opening, base.uvs),
            None if base.normals is None else units(self._carried(opening, base.normals)),
            np.concatenate([base.triangle_cap, base.triangle_cap[owner], np.full(len(caps), wall, dtype=np.int32)]),
            np.concatenate([base.cap_side, base.cap_side[owner], side]),
            np.concatenate([base.point_key, keys]),
        )

    def _carried(self, opening: Opening, values: np.ndarray | None) -> np.ndarray | None:
        """Values of all points from those of the points before, linear along edges and chords."""
        if values is None:
            return None
        section, chords = self._section, opening.tip_chords
        at_nodes = section.node_values(values)
        low, high = section.chord_ends[chords].T
        s = section.node_coordinates[:, 1]
        t = ((self._reach - s[low]) / (s[high] - s[low]))[:, None]
        at_tips = at_nodes[low] + t * (at_nodes[high] - at_nodes[low])
        return np.concatenate([values, opening.created_values(at_nodes, at_tips)])
