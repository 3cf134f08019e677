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
from ..cage.numbering import Numbering
from ..cage.opening import Opening
from ..cage.section import Section
from .surface import Surface


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

    section: Section
    front: float
    surface: Surface


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
        """
        if not isinstance(surface, Surface):
            raise TypeError(f"surface must be a Surface, got {type(surface).__name__}")
        self.base = surface
        """The surface before the cut."""
        self.surface = surface
        """The surface as it is now."""
        self.plane = plane
        """Plane of the cut."""
        self.wall = int(wall)
        """Number of the wall on which new points lie."""
        self.front = -np.inf
        """Coordinate s of the blade in the plane [m]."""
        self._section = Section(surface.mesh, plane, face_group=surface.triangle_solid)
        self._numbering = Numbering(self._section)
        uvs = surface.uvs
        if uvs is not None:
            above, below = uvs[self._section.node_above], uvs[self._section.node_below]
            self._node_uvs = above + self._section.node_fraction[:, None] * (below - above)

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
        return SurfaceSnapshot(self._section, self.front, self.surface)

    def rewind(self, to: SurfaceSnapshot | None = None) -> Surface:
        """Take the cut back to a snapshot, or to the surface before the cut.

        Args:
            to: A snapshot of this cut; None for before the cut.

        Returns:
            The surface as it was, the very object.

        Raises:
            ValueError: If the snapshot is of another cut. Nothing has changed then.
        """
        if to is not None and to.section is not self._section:
            raise ValueError("the snapshot is of another cut; rewind that one, or take a snapshot of this one")
        self.front, self.surface = (-np.inf, self.base) if to is None else (to.front, to.surface)
        return self.surface

    def _open_surface(self, opening: Opening) -> Surface:
        base, wall = self.base, self.wall
        kept, kept_cap, added, added_cap = self._split_triangles(opening)
        caps = _cap_triangles(opening)
        swept = np.full(self._section.node_count, 2 * wall, dtype=np.int32)
        keys = opening.created_values(swept, np.full(len(opening.tip_chords), 2 * wall + 1, dtype=np.int32))
        keys[self._numbering.plus[opening.region.swept] - base.point_count] = 2 * wall + 1
        return Surface._assembled(
            np.concatenate([base.points, opening.created_positions()]),
            np.concatenate([kept, added, caps]).astype(np.int32),
            None if base.uvs is None else np.concatenate([base.uvs, self._created_uvs(opening)]),
            np.concatenate([kept_cap, added_cap, np.full(len(caps), wall, dtype=np.int32)]),
            np.concatenate([base.point_key, keys]),
        )

    def _created_uvs(self, opening: Opening) -> np.ndarray:
        chords = opening.tip_chords
        low, high = self._section.chord_ends[chords].T
        s = self._section.node_coordinates[:, 1]
        t = ((self.front - s[low]) / (s[high] - s[low]))[:, None]
        uvs = self._node_uvs
        return opening.created_values(uvs, uvs[low] + t * (uvs[high] - uvs[low]))

    def _split_triangles(self, opening: Opening) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Triangles in the places of the old ones and further ones, each with their caps' walls."""
        base = self.base
        tip = np.full(base.triangle_count, -1)
        tip[self._section.chord_face[opening.tip_chords]] = self._numbering.tip[opening.tip_chords]
        owner = np.concatenate([opening.faces, np.array(opening.extra_face, dtype=np.int64)])
        loops = opening.first_loops + opening.extra_loops
        size = np.array([len(loop) for loop in loops], dtype=np.int64)
        parts, owners = [], []
        for corners, fan in ((3, _keep), (4, _split_quads), (6, _fan_slits)):
            which = np.flatnonzero(size == corners)
            if len(which):
                polygons = np.array([loops[i] for i in which])
                parts.append(fan(polygons, opening, tip[owner[which]]))
                owners.append(np.repeat(owner[which], corners - 2))
        triangles, owners = np.concatenate(parts), np.concatenate(owners)
        order = np.argsort(owners, kind="stable")
        triangles, owners = triangles[order], owners[order]
        is_first = np.concatenate([[True], owners[1:] != owners[:-1]])
        kept = base.triangles.astype(np.int64)
        kept[owners[is_first]] = triangles[is_first]
        return kept, base.triangle_cap, triangles[~is_first], base.triangle_cap[owners[~is_first]]


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
    turned = np.take_along_axis(polygons, (at[:, None] + np.arange(6)) % 6, axis=1)
    return turned[:, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]].reshape(-1, 3)


def _positions(polygons: np.ndarray, opening: Opening) -> np.ndarray:
    base = opening.section.mesh.vertices
    created = opening.created_positions()
    old = np.minimum(polygons, len(base) - 1)
    new = np.maximum(polygons - len(base), 0)
    return np.where((polygons < len(base))[..., None], base[old], created[new])


def _cap_triangles(opening: Opening) -> np.ndarray:
    """Triangles of both sides of the opened section, shape (triangle_count, 3)."""
    minus, plus = opening.side_vertices()
    parts = [np.zeros((0, 3), dtype=np.int64)]
    for loop in opening.region.polygons():
        corners = np.array(loop)[triangulate(opening.region.coordinates[loop])]
        parts += [minus[corners], plus[corners[:, ::-1]]]
    return np.concatenate(parts)
