# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progressive cuts of surfaces.

Section 6.3 of the paper splits the triangles that the cut crosses. Like a cage's, a surface's cut is a pure function of
the surface before it, the plane and the front; what opens is capped, so that a closed surface stays closed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cage import BladePlane, triangulate
from ..cage.hinge import Hinge
from ..cage.numbering import Numbering
from ..cage.opening import Opening
from ..cage.section import Section
from .surface import Surface

_ON_FRONT = 1e-10
_STATE = ("base", "surface", "plane", "wall", "front", "_section", "_numbering", "_tips")


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
    """Ids of the points that have moved, shape (moved_count,)."""

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

    def __init__(self, surface: Surface, plane: BladePlane, wall: int):
        """Begin a cut; nothing changes before :meth:`advance`.

        Args:
            surface: The surface to cut, which may have been cut before.
            plane: Plane of the cage's cut.
            wall: Number of the cage's wall that this cut makes.

        Raises:
            TypeError: If the surface is not a surface.
            ValueError: If an edge of it has more than two triangles or is not consistently oriented.
        """
        if not isinstance(surface, Surface):
            raise TypeError(f"surface must be a Surface, got {type(surface).__name__}")
        surface.refuse_branches()
        self._identity = object()
        self._begin(surface, plane, wall, None)
        self._before = self.snapshot()

    def _begin(self, surface: Surface, plane: BladePlane, wall: int, hinge: Hinge | None) -> None:
        section = Section(surface.mesh, plane, face_group=surface.triangle_solid, hinge=hinge)
        self.base = surface
        """The surface before the present plane's part of the cut."""
        self.surface = surface
        """The surface as it is now."""
        self.plane = plane
        """Plane of the cut."""
        self.wall = int(wall)
        """Number of the wall on which new points lie."""
        self.front = -np.inf
        """Coordinate s of the blade in the plane [m]."""
        self._section = section
        self._numbering = Numbering(section)
        self._tips = np.zeros(0, dtype=np.int64)

    def go_on(self, plane: BladePlane, wall: int, *, surface: Surface | None = None, hinged: bool = True) -> None:
        """Follow the cage's cut into another plane, from the present front, or into a surface that others have cut.

        Args:
            plane: The plane in which the cage's cut goes on; its line ``s = 0`` is the present front.
            wall: Number of the cage's wall that it makes there.
            surface: The surface as it is now, made by other cuts of this one; the present one by default.
            hinged: Whether the plane begins at ``s = 0``; not so where the cage's cut had not begun to open.

        Raises:
            ValueError: If the section does not close at the front. Nothing has changed then.
        """
        surface = surface or self.surface
        if not hinged:
            self._begin(surface, plane, wall, None)
            return
        on_front = np.zeros(surface.point_count, dtype=bool)
        on_front[self._tips] = True
        flat, key = surface.triangles, surface.triangle_key
        shared = np.isin(np.arange(surface.point_count), flat[key == 2 * self.wall])
        shared &= np.isin(np.arange(surface.point_count), flat[key == 2 * self.wall + 1])
        candidates = np.flatnonzero(shared)
        s = self.plane.coordinates(surface.points[candidates])[:, 1]
        limit = _ON_FRONT * np.ptp(surface.points, axis=0).max()
        on_front[candidates[np.abs(s - self.front) <= limit]] = True
        self._begin(surface, plane, wall, Hinge.of(surface.mesh, key, self.wall, on_front))
        self.front = 0.0

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
        self.front = front
        before = self.surface
        opening = Opening(self._section, self._numbering, front)
        self._tips = self._numbering.tip[opening.tip_chords]
        if opening.created_count:
            self.surface = self._open_surface(opening)
        common = before.point_count
        moved = np.flatnonzero((before.points != self.surface.points[:common]).any(axis=1))
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
        kept, added, owner = self._split_triangles(opening)
        caps, side = _cap_triangles(opening)
        swept = np.full(self._section.node_count, 2 * wall, dtype=np.int32)
        keys = opening.created_values(swept, np.full(len(opening.tip_chords), 2 * wall + 1, dtype=np.int32))
        plus = self._numbering.plus[opening.region.swept] - base.point_count
        keys[plus[plus >= 0]] = 2 * wall + 1
        return Surface._assembled(
            np.concatenate([base.points, opening.created_positions()]),
            np.concatenate([kept, added, caps]).astype(np.int32),
            self._carried(opening, base.uvs),
            None if base.normals is None else _unit(self._carried(opening, base.normals)),
            np.concatenate([base.triangle_cap, base.triangle_cap[owner], np.full(len(caps), wall, dtype=np.int32)]),
            np.concatenate([base.cap_side, base.cap_side[owner], side]),
            np.concatenate([base.point_key, keys]),
        )

    def _carried(self, opening: Opening, values: np.ndarray | None) -> np.ndarray | None:
        """Values of all points from those of the points before, linear along edges and chords."""
        if values is None:
            return None
        section, chords = self._section, opening.tip_chords
        above, below = values[section.node_above], values[section.node_below]
        at_nodes = above + section.node_fraction[:, None] * (below - above)
        low, high = section.chord_ends[chords].T
        s = section.node_coordinates[:, 1]
        t = ((self.front - s[low]) / (s[high] - s[low]))[:, None]
        at_tips = at_nodes[low] + t * (at_nodes[high] - at_nodes[low])
        return np.concatenate([values, opening.created_values(at_nodes, at_tips)])

    def _split_triangles(self, opening: Opening) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Triangles in the places of the old ones, further ones, and the old one of each of those."""
        base = self.base
        tip = np.full(base.triangle_count, -1)
        tip[self._section.chord_face[opening.tip_chords]] = self._numbering.tip[opening.tip_chords]
        owner = np.concatenate([opening.faces, np.array(opening.extra_face, dtype=np.int64)])
        loops = opening.first_loops + opening.extra_loops
        size = np.array([len(loop) for loop in loops], dtype=np.int64)
        parts, owners = [], []
        for corners, fan in ((3, _keep), (4, _split_quads), (5, _fan_slits), (6, _fan_slits)):
            which = np.flatnonzero(size == corners)
            if len(which):
                polygons = np.array([loops[i] for i in which])
                parts.append(fan(polygons, opening, tip[owner[which]]))
                owners.append(np.repeat(owner[which], corners - 2))
        triangles, owners = np.concatenate(parts), np.concatenate(owners)
        order = np.argsort(owners, kind="stable")
        triangles, owners = triangles[order], owners[order]
        is_first = np.concatenate([[True], owners[1:] != owners[:-1]])
        kept = opening.face_vertex.reshape(-1, 3).copy()
        kept[owners[is_first]] = triangles[is_first]
        return kept, triangles[~is_first], owners[~is_first]


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)


def _keep(polygons: np.ndarray, opening: Opening, tip: np.ndarray) -> np.ndarray:
    return polygons


def _split_quads(polygons: np.ndarray, opening: Opening, tip: np.ndarray) -> np.ndarray:
    """Quads, which are convex, split along their shorter diagonals; two triangles each, one after the other."""
    points = _positions(polygons, opening)
    across = np.linalg.norm(points[:, [0, 1]] - points[:, [2, 3]], axis=2)
    turned = np.where((across[:, 0] <= across[:, 1])[:, None], polygons, np.roll(polygons, -1, axis=1))
    return turned[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)


def _fan_slits(polygons: np.ndarray, opening: Opening, tip: np.ndarray) -> np.ndarray:
    """Slit triangles, which their tips see whole, as fans around the tips."""
    at = (polygons == tip[:, None]).argmax(axis=1)
    count = polygons.shape[1]
    turned = np.take_along_axis(polygons, (at[:, None] + np.arange(count)) % count, axis=1)
    return turned[:, [[0, k, k + 1] for k in range(1, count - 1)]].reshape(-1, 3)


def _positions(polygons: np.ndarray, opening: Opening) -> np.ndarray:
    base = opening.section.mesh.vertices
    created = opening.created_positions()
    old = np.minimum(polygons, len(base) - 1)
    new = np.maximum(polygons - len(base), 0)
    return np.where((polygons < len(base))[..., None], base[old], created[new])


def _cap_triangles(opening: Opening) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of both sides of the opened section, shape (triangle_count, 3), and the side of each."""
    minus, plus = opening.side_vertices()
    parts, sides = [np.zeros((0, 3), dtype=np.int64)], [np.zeros(0, dtype=np.int8)]
    for loop in opening.region.polygons():
        corners = np.array(loop)[triangulate(opening.region.coordinates[loop])]
        parts += [minus[corners], plus[corners[:, ::-1]]]
        sides += [np.full(len(corners), side, dtype=np.int8) for side in (0, 1)]
    return np.concatenate(parts), np.concatenate(sides)
