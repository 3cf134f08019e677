# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The arrays of a surface while they are made fit to be cut.

The paper's embedded mesh (section 6.3) is closed and a manifold; what users bring has seams, doubled triangles, fans
and walls within. Points keep their numbers throughout.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...geometry import PolygonMesh
from ..attributes import Attributes
from ..surface_arguments import as_labels, as_point_values, as_triangles, as_uvs, as_weld, check_flat
from .manifold_sheets import find_sheets, repeated
from .parting import Parting
from .repairs import Repairs
from .welding import weld_seams


class Draft:
    """A surface's arrays, named as there."""

    def __init__(
        self,
        *,
        points: np.ndarray,
        triangles: np.ndarray,
        uvs: np.ndarray | None,
        normals: np.ndarray | None,
        triangle_cap: np.ndarray | None,
        point_key: np.ndarray | None,
        data: Mapping[str, object] | None,
    ):
        """Check arguments of a surface; they are those of :class:`~newton_cagecut.surface.Surface`.

        Raises:
            TypeError: If something is not numbers, or the triangles not integers.
            ValueError: If a shape, a value or an index is wrong; the text names the culprit.
        """
        self.points = points
        self.triangles = as_triangles(triangles, len(points))
        if points.shape[1] == 2:
            check_flat(points[self.triangles], normals)
        self.uvs, self.own_corner_uvs = as_uvs(uvs, len(points), len(self.triangles))
        self.normals = as_point_values(normals, "normals", 3, len(points))
        self.attributes = Attributes.of(data, len(points), len(self.triangles))
        self.triangle_cap = as_labels(triangle_cap, "triangle_cap", len(self.triangles))
        self.cap_side = np.zeros(len(self.triangles), dtype=np.int8)
        self.site_key = as_labels(point_key, "point_key", len(points))
        self.site_points, self.point_site = points, None
        self.is_parted = False
        self.repairs = Repairs()
        self._number = np.arange(len(self.triangles))

    @property
    def arrays(self) -> dict[str, object]:
        """The arrays by the names that a surface has for them."""
        return {name: value for name, value in vars(self).items() if name not in ("_number", "repairs")}

    def prepare(self, weld: float | None) -> None:
        """Leave out what is no triangle, join seams, and make sheets of the triangles, unless cuts were made before.

        Args:
            weld: Distance up to which ends of open edges lie on each other [m].
        """
        whole = (self.triangles != np.roll(self.triangles, 1, axis=1)).all(axis=1)
        self._leave_out(~whole, "uses a point twice and is left out", "use a point twice and are left out")
        if len(whole) and not whole.any():
            raise ValueError("no triangle of the surface has three different points; there is no surface")
        self._join_seams(as_weld(weld, self.points))
        if not (self.site_key >= 0).any() and not (self.triangle_cap >= 0).any():
            self._part_sheets()

    @property
    def _corners(self) -> np.ndarray:
        """Sites of the triangles' corners, shape (triangle_count, 3)."""
        return self.triangles if self.point_site is None else self.point_site[self.triangles]

    @property
    def _mesh(self) -> PolygonMesh:
        return PolygonMesh.of_triangles(self.site_points, self._corners)

    def _join_seams(self, tolerance: float) -> None:
        """Find the sites of points; without seams each point is one."""
        if tolerance < 0.0:
            return
        first = weld_seams(self._mesh, tolerance, apart=self.site_key >= 0)
        kept, site = np.unique(first, return_inverse=True)
        if len(kept) == len(self.points):
            return
        corners = first[self.triangles]
        if (corners == corners[:, :1]).all():
            raise ValueError("all points of the surface's triangles coincide; there is no surface")
        self._keep_triangles((corners != np.roll(corners, 1, axis=1)).all(axis=1))
        self.points = self.points[first]
        self.site_points, self.site_key = self.points[kept], self.site_key[kept]
        self.point_site = site.reshape(-1)

    def _leave_out(self, which: np.ndarray, one: str, several: str) -> None:
        """Leave out triangles, a mask, and note why."""
        if which.any():
            self.repairs.add(self._number[which], "triangle", one, several)
            self._keep_triangles(~which)

    def _part_sheets(self) -> None:
        """Make triangles sheets, each with points of its own."""
        again = repeated(self._corners)
        self._leave_out(again, "is there twice and is left out", "are there twice and are left out")
        sheets = find_sheets(self._mesh)
        turned = np.flatnonzero(sheets.turned)
        self.repairs.add(
            self._number[turned],
            "triangle",
            "ran the other way than those around it and is turned",
            "ran the other way than those around them and are turned",
        )
        self.repairs.add(
            sheets.branches,
            "edge",
            "has three triangles or more, which are parted into sheets",
            "have three triangles or more, which are parted into sheets",
        )
        order = np.tile(np.arange(3), (len(self.triangles), 1))
        order[turned] = [0, 2, 1]
        self._reorder_corners(order)
        self._part_points(np.take_along_axis(sheets.fan, order, axis=1))

    def _reorder_corners(self, order: np.ndarray) -> None:
        """Walk the corners of triangles in another order, shape (triangle_count, 3)."""
        if (order == np.arange(3)).all():
            return
        rows = np.arange(len(self.triangles))[:, None]
        self.triangles = self.triangles[rows, order]
        if self.own_corner_uvs is not None:
            self.own_corner_uvs = self.own_corner_uvs[rows, order]
        self.attributes = self.attributes.mapped(
            point=lambda values: values, corner=lambda values: values[rows, order], triangle=lambda values: values
        )

    def _part_points(self, fan: np.ndarray) -> None:
        """Give each fan of corners a site, and each sheet points, of its own."""
        if fan.max(initial=-1) + 1 == np.count_nonzero(np.bincount(self._corners.reshape(-1))):
            return
        point_site = np.arange(len(self.points)) if self.point_site is None else self.point_site
        parting = Parting.of(self.triangles, point_site, len(self.site_points), fan)
        self.triangles = parting.triangles
        self.is_parted = len(parting.site) > len(self.site_points)
        if not self.is_parted:
            return
        self.site_points, self.site_key = self.site_points[parting.site], self.site_key[parting.site]
        for name in ("points", "uvs", "normals"):
            values = getattr(self, name)
            setattr(self, name, None if values is None else values[parting.point])
        if self.point_site is None:
            self.points = self.site_points
        else:
            self.point_site = parting.point_site
        self.attributes = self.attributes.mapped(
            point=lambda values: values[parting.point], corner=lambda values: values, triangle=lambda values: values
        )

    def _keep_triangles(self, kept: np.ndarray) -> None:
        """Leave out all triangles but some, a mask."""
        if kept.all():
            return
        for name in ("triangles", "own_corner_uvs", "triangle_cap", "cap_side", "_number"):
            values = getattr(self, name)
            setattr(self, name, None if values is None else values[kept])
        self.attributes = self.attributes.mapped(
            point=lambda values: values, corner=lambda values: values[kept], triangle=lambda values: values[kept]
        )
