# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What an opened section makes of a surface: split triangles, caps, attributes carried over.

Section 6.3 of the paper. Attributes of new points are linear along the edges and chords on which they lie. Triangles
are split by the sites of their corners; at seams a new site gets a point for each side.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..geometry import units
from ..section import Opening
from .attributes import mixed
from .carrying import carried
from .corner_shares import CornerShares
from .splitting import cap_triangles, split_triangles
from .surface import Surface

_BESIDE = 1e-9
"""Distance up to which an old site and a new one lie at one place, of the size of the surface."""


def open_surface(base: Surface, opening: Opening, wall: int) -> Surface:
    """The surface that a section opened up to a front leaves.

    Args:
        base: The surface before the cut.
        opening: The section opened.
        wall: Number of the wall on which new points lie.
    """
    return _OpenSurface(base, opening).surface(wall)


class _OpenSurface:
    """The parts of an opened surface."""

    def __init__(self, base: Surface, opening: Opening):
        self.base, self.opening = base, opening
        kept, added, owner = split_triangles(opening)
        self.caps, self.cap_side = cap_triangles(opening)
        self.skin = np.concatenate([kept, added])
        """Sites of the triangles but for the new caps, shape (skin_count, 3)."""
        self.owner = np.concatenate([np.arange(len(kept)), owner])
        """Triangle of the base that each was part of, shape (skin_count,)."""

    def surface(self, wall: int) -> Surface:
        """Put the surface together.

        Args:
            wall: Number of the wall on which new points lie.
        """
        base, opening = self.base, self.opening
        keys = np.full(opening.vertices.count, 2 * wall + 1, dtype=np.int32)
        minus, plus = (ids[opening.region.labels] for ids in opening.vertices.sides)
        keys[minus[minus != plus] - base.site_count] = 2 * wall
        new_points, triangles, source = self._points()
        placed = opening.vertices.positions[:, : base.dimension]
        normals = self._point_values(base.normals, source)
        caps, sides = np.full(len(self.caps), wall, dtype=np.int32), self.cap_side
        return Surface._assembled(
            points=np.concatenate([base.points, placed[new_points - base.site_count]]),
            triangles=triangles,
            point_site=None if base.point_site is None else np.concatenate([base.point_site, new_points]),
            sites=np.concatenate([base.site_points, placed]),
            site_key=np.concatenate([self._old_keys(keys, placed, minus[minus == plus]), keys]),
            uvs=self._point_values(base.uvs, source),
            own_corner_uvs=None if base.own_corner_uvs is None else self._corner_values(base.own_corner_uvs),
            normals=None if normals is None else units(normals),
            triangle_cap=np.concatenate([base.triangle_cap[self.owner], caps]),
            cap_side=np.concatenate([base.cap_side[self.owner], sides]),
            is_parted=base.is_parted,
            attributes=base.attributes.mapped(
                point=lambda values: self._point_values(values, source),
                corner=self._corner_values,
                triangle=self._triangle_values,
            ),
        )

    def _old_keys(self, keys: np.ndarray, placed: np.ndarray, tips: np.ndarray) -> np.ndarray:
        """Keys of the old sites: one in the blade's plane is on the wall as the new site beside it is.

        Args:
            keys: Keys of the new sites.
            placed: Where they are [m].
            tips: New sites at the tips, which are on both sides.
        """
        base, old = self.base, self.base.site_key.copy()
        sided = np.ones(len(keys), dtype=bool)
        sided[tips - base.site_count] = False
        pairs = np.concatenate([self.skin[:, [i, j]] for i in range(3) for j in range(3) if i != j])
        pairs = pairs[(pairs[:, 0] < base.site_count) & (pairs[:, 1] >= base.site_count)]
        pairs = pairs[(old[pairs[:, 0]] < 0) & sided[pairs[:, 1] - base.site_count]]
        distances = np.linalg.norm(base.site_points[pairs[:, 0]] - placed[pairs[:, 1] - base.site_count], axis=1)
        site, new = pairs[distances <= _BESIDE * np.ptp(base.site_points, axis=0).max()].T
        old[site] = keys[new - base.site_count]
        return old

    @cached_property
    def _changed(self) -> np.ndarray:
        """Triangles of the skin of which a corner is another site than before."""
        return np.flatnonzero((self.skin != self.base.site_triangles[self.owner]).any(axis=1))

    @cached_property
    def _shares(self) -> np.ndarray:
        """Shares of the corners of each changed triangle's owner in its own corners, shape (changed_count, 3, 3)."""
        corners = self.base.site_triangles[self.owner[self._changed]]
        vertex = self.skin[self._changed].reshape(-1)
        return CornerShares.of(self.opening).at(vertex, np.repeat(corners, 3, axis=0)).reshape(-1, 3, 3)

    def _points(self) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray] | None]:
        """Points that are new, as sites, all triangles by points, and where the new ones come from.

        The last is None without seams; else the new points that lie on the skin, counted from 0, a triangle of the base
        in which each of them lies, and the shares of its corners. The first new points are one for each new site, in
        their order, so that they keep their numbers while the cut goes on.
        """
        base = self.base
        created = np.arange(base.site_count, base.site_count + self.opening.vertices.count)
        if base.point_site is None:
            return created, np.concatenate([self.skin, self.caps]).astype(np.int32), None
        triangles = base.triangles[self.owner].astype(np.int64)
        owners = triangles[self._changed]
        site, share = self.skin[self._changed].reshape(-1), self._shares.reshape(-1, 3)
        around = np.repeat(owners, 3, axis=0)
        point = around[np.arange(len(site)), share.argmax(axis=1)]
        new = np.flatnonzero(site >= base.site_count)
        low = np.where(share[new] > 0.0, around[new], base.point_count).min(axis=1)
        high = np.where(share[new] > 0.0, around[new], -1).max(axis=1)
        keys, first, number = np.unique(
            np.stack([site[new], low, high], axis=1), axis=0, return_index=True, return_inverse=True
        )
        is_first = np.concatenate([[True], keys[1:, 0] != keys[:-1, 0]]) if len(keys) else np.zeros(0, dtype=bool)
        place = keys[:, 0] - base.site_count
        place[~is_first] = len(created) + np.arange(np.count_nonzero(~is_first))
        point[new] = base.point_count + place[number.reshape(-1)]
        triangles[self._changed] = point.reshape(-1, 3)
        caps = np.where(
            self.caps < base.site_count,
            base.site_point[np.minimum(self.caps, base.site_count - 1)],
            self.caps - base.site_count + base.point_count,
        )
        owner = np.repeat(self.owner[self._changed], 3)[new[first]]
        everything = np.concatenate([triangles, caps]).astype(np.int32)
        return np.concatenate([created, keys[~is_first, 0]]), everything, (place, owner, share[new[first]])

    def _point_values(
        self, values: np.ndarray | None, source: tuple[np.ndarray, np.ndarray, np.ndarray] | None
    ) -> np.ndarray | None:
        """Values of all points from those of the points before."""
        if values is None:
            return None
        base = self.base
        if source is None:
            return np.concatenate([values, carried(self.opening, values)])
        place, owner, shares = source
        new = carried(self.opening, values[base.site_point])
        more = max(0, int(place.max(initial=-1)) + 1 - len(new))
        new = np.concatenate([new, np.zeros((more, *values.shape[1:]), dtype=values.dtype)])
        new[place] = mixed(values[base.triangles[owner]], shares)
        return np.concatenate([values, new])

    def _corner_values(self, values: np.ndarray) -> np.ndarray:
        """Values of all corners from those of the corners before; of the new caps zero."""
        skin = values[self.owner]
        before = values[self.owner[self._changed]]
        skin[self._changed] = np.stack([mixed(before, self._shares[:, k]) for k in range(3)], axis=1)
        return np.concatenate([skin, np.zeros((len(self.caps), *values.shape[1:]), dtype=values.dtype)])

    def _triangle_values(self, values: np.ndarray) -> np.ndarray:
        """Values of all triangles from those before; of the new caps zero."""
        return np.concatenate([values[self.owner], np.zeros((len(self.caps), *values.shape[1:]), dtype=values.dtype)])
