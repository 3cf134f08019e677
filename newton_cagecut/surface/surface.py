# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces: the detailed meshes that a cage carries.

Section 6.3 of the paper calls this the embedded mesh. Positions are in the rest frame. What a plane cage carries is a
flat mesh, whose triangles fill the body; as a mesh in space it lies in the plane z = 0 and is open.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from ..cage import Wall
from ..geometry import (
    PolygonMesh,
    as_finite,
    as_indices,
    as_sequence,
    triangle_normals,
    units,
    winding_numbers,
)
from .attributes import Attributes
from .preparing.draft import Draft
from .preparing.open_edges import open_notes
from .preparing.repairs import Repairs
from .surface_arguments import as_rows

_CANCELLED = 1e-9
_NO_LENGTH = 1e-30


class Surface:
    """A triangle mesh at rest, closed, open or flat, with what earlier cuts left on it; immutable.

    Points that were split along seams, for texture coordinates or normals, share a *site*: topology, walks and weights
    are those of sites, attributes those of points or corners. Points keep their numbers under cuts.
    """

    def __init__(
        self,
        points: np.ndarray,
        triangles: np.ndarray,
        *,
        uvs: np.ndarray | None = None,
        normals: np.ndarray | None = None,
        triangle_cap: np.ndarray | None = None,
        point_key: np.ndarray | None = None,
        weld: float | None = None,
        data: Mapping[str, object] | None = None,
    ):
        """Validate and build a surface.

        Open edges that lie on each other, end on end and in opposite directions, are a seam: their points move as one.
        Edges that are closed as they are given are left alone, and so are points on walls.

        Triangles that use a point twice, as given or along a seam, or that are there twice, are left out. The others
        become sheets of one orientation: those that run the other way than most around them are turned, and where an
        edge has three or more, or points only touch, each sheet gets a point of its own behind the others.
        :attr:`notes` tells of all this.

        Args:
            points: Rest positions, shape (point_count, 3), or (point_count, 2) in the plane [m].
            triangles: Point ids, counterclockwise seen from outside, in the plane seen from +z, shape
                (triangle_count, 3).
            uvs: Texture coordinates of the points, shape (point_count, 2), or of the triangles' corners, shape
                (triangle_count, 3, 2).
            normals: Unit normals of the points, shape (point_count, 3); none in the plane.
            triangle_cap: Wall of the cut that each triangle caps, -1 for the original surface, shape (triangle_count,).
            point_key: ``2 * wall + side`` of the wall on which each point lies, -1 inside, shape (point_count,).
            weld: Distance up to which ends of open edges lie on each other, 0 for points at exactly one place [m]; by
                default 1e-6 of the longest side of the box around the points. Negative: nothing is joined.
            data: Further arrays by name, which cuts carry along: of points, shape (point_count, ...), of corners,
                shape (triangle_count, 3, ...), or of triangles, shape (triangle_count, ...). Where a shape could be of
                two of them, a pair says which: ``("triangle", array)``; (triangle_count, 3, k) is taken to be of
                corners.

        Raises:
            TypeError: If something is not numbers, or the triangles not integers.
            ValueError: If a shape, a value or an index is wrong; the text names the culprit.
        """
        draft = Draft(
            points=as_rows(points, "points", (3, 2)),
            triangles=triangles,
            uvs=uvs,
            normals=normals,
            triangle_cap=triangle_cap,
            point_key=point_key,
            data=data,
        )
        draft.prepare(weld)
        vars(self).update(draft.arrays)
        self._repairs = draft.repairs
        self._freeze()

    @classmethod
    def _assembled(
        cls,
        *,
        points: np.ndarray,
        triangles: np.ndarray,
        point_site: np.ndarray | None,
        sites: np.ndarray,
        site_key: np.ndarray,
        uvs: np.ndarray | None,
        own_corner_uvs: np.ndarray | None,
        normals: np.ndarray | None,
        triangle_cap: np.ndarray,
        cap_side: np.ndarray,
        attributes: Attributes,
        is_parted: bool,
    ) -> Surface:
        """A surface that a cut made, taken as it is."""
        surface = cls.__new__(cls)
        surface.points, surface.triangles, surface.point_site = points, triangles, point_site
        surface.site_points, surface.site_key = points if point_site is None else sites, site_key
        surface.uvs, surface.own_corner_uvs, surface.normals = uvs, own_corner_uvs, normals
        surface.triangle_cap, surface.cap_side, surface.attributes = triangle_cap, cap_side, attributes
        surface.is_parted, surface._repairs = is_parted, Repairs()
        surface._freeze()
        return surface

    def _freeze(self) -> None:
        arrays = (self.points, self.triangles, self.uvs, self.own_corner_uvs, self.normals, self.point_site)
        for array in (*arrays, self.site_points, self.triangle_cap, self.cap_side, self.site_key):
            if array is not None:
                array.setflags(write=False)

    def __repr__(self) -> str:
        return f"Surface(point_count={self.point_count}, triangle_count={self.triangle_count})"

    @property
    def dimension(self) -> int:
        """Dimension of the space, 2 for a flat mesh or 3."""
        return self.points.shape[1]

    @property
    def point_count(self) -> int:
        """Number of points."""
        return len(self.points)

    @property
    def site_count(self) -> int:
        """Number of sites: points, those along a seam counting as one."""
        return len(self.site_points)

    @property
    def triangle_count(self) -> int:
        """Number of triangles."""
        return len(self.triangles)

    def with_data(self, data: Mapping[str, object] | None) -> Surface:
        """The surface with other arrays of the user.

        Args:
            data: Arrays by name, as at construction; those of triangles and corners are of the triangles as they are.

        Raises:
            TypeError: If an array is not of numbers.
            ValueError: If an array does not fit.
        """
        other = copy.copy(self)
        other.attributes = Attributes.of(data, self.point_count, self.triangle_count)
        return other

    @property
    def data(self) -> Mapping[str, np.ndarray]:
        """The user's arrays as they are now, by name, read-only.

        Arrays of floating point are interpolated along split edges; of whole numbers and flags a new point has that of
        the nearest old one. Triangles pass theirs on to their parts. On caps, arrays of corners and triangles are zero.
        """
        return self.attributes.merged()

    @cached_property
    def site_triangles(self) -> np.ndarray:
        """Sites of the triangles' corners, shape (triangle_count, 3)."""
        return self.triangles if self.point_site is None else self.point_site[self.triangles]

    @cached_property
    def site_point(self) -> np.ndarray:
        """The first point of each site, shape (site_count,)."""
        if self.point_site is None:
            return np.arange(self.point_count)
        return np.unique(self.point_site, return_index=True)[1]

    @cached_property
    def point_place(self) -> np.ndarray | None:
        """Site with which each point moves, shape (point_count,); None if it is the one of the same number.

        Sheets that touch have sites of their own at one place, with walks of their own; the points there move with the
        first of them, until a cut takes them apart, so that no gap opens.
        """
        if not self.is_parted:
            return self.point_site
        key = np.column_stack([self.site_points, self.site_key])
        own = np.flatnonzero(self.on_several_cuts(np.arange(self.site_count)))
        apart = np.zeros(self.site_count)
        apart[own] = 1.0 + own
        _, first, place = np.unique(np.column_stack([key, apart]), axis=0, return_index=True, return_inverse=True)
        place = first[place.reshape(-1)]
        return place if self.point_site is None else place[self.point_site]

    @property
    def point_key(self) -> np.ndarray:
        """``2 * wall + side`` of the wall on which each point lies, -1 inside, shape (point_count,)."""
        return self.site_key if self.point_site is None else self.site_key[self.point_site]

    @cached_property
    def mesh(self) -> PolygonMesh:
        """The triangles of the sites with their half-edges, in space; a flat mesh lies in the plane z = 0."""
        return PolygonMesh.of_triangles(self.site_points, self.site_triangles)

    @property
    def triangle_key(self) -> np.ndarray:
        """``2 * wall + side`` of the side of a cut that each triangle caps, -1 for the others, shape (m,)."""
        return np.where(self.triangle_cap >= 0, 2 * self.triangle_cap + self.cap_side, -1)

    @cached_property
    def closed(self) -> bool:
        """Whether every edge has exactly two triangles that run along it in opposite directions; never in the plane."""
        return bool((self.mesh.twin >= 0).all())

    def corner_uvs(self, walls: Sequence[Wall], *, scale: float = 1.0) -> np.ndarray:
        """Texture coordinates of the triangles' corners, shape (triangle_count, 3, 2).

        Caps have their own: lengths along the axes of the wall that they cap, so that a texture is not stretched on
        them; the others have those that were given of corners or of points, or zeros without any.

        Args:
            walls: The cage's walls.
            scale: Texture coordinates a metre on caps [1/m].

        Raises:
            TypeError: If the walls are none, or the scale is not a number.
            ValueError: If the scale is not positive, or a cap's wall is missing.
        """
        scale = as_finite(scale, "scale, texture coordinates a metre,")
        walls = self._walls(walls)
        corners = self.own_corner_uvs
        if corners is None:
            corners = (np.zeros((self.point_count, 2)) if self.uvs is None else self.uvs)[self.triangles]
        corners = corners.copy()
        for number in np.unique(self.triangle_cap[self.triangle_cap >= 0]).tolist():
            cap, wall = self.triangle_cap == number, walls[number]
            corners[cap] = scale * ((self.points[self.triangles[cap]] - wall.origin) @ wall.axes.T)
        return corners

    def corner_normals(self, walls: Sequence[Wall]) -> np.ndarray:
        """Unit normals of the triangles' corners, shape (triangle_count, 3, 3).

        Caps have that of their side of the cut; the others have those of their points, or their own plane's.

        Args:
            walls: The cage's walls.

        Raises:
            TypeError: If the walls are none.
            ValueError: If a cap's wall is missing.
        """
        walls = self._walls(walls)
        if self.normals is None:
            corners = np.repeat(units(self.mesh.face_area_vector)[:, None], 3, axis=1)
        else:
            corners = self.normals[self.triangles]
        for number in np.unique(self.triangle_cap[self.triangle_cap >= 0]).tolist():
            cap = self.triangle_cap == number
            corners[cap] = (1 - 2 * self.cap_side[cap].astype(float))[:, None, None] * walls[number].normal
        return corners

    def _walls(self, walls: Sequence[Wall]) -> tuple[Wall, ...]:
        """The walls, those of all caps among them."""
        walls, last = as_sequence(walls, Wall, "walls"), int(self.triangle_cap.max(initial=-1))
        if last >= len(walls):
            raise ValueError(f"walls: a cap is on wall {last}, and there are {len(walls)}; pass cage.walls of this cut")
        return walls

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """What was done to the mesh so that it can be cut, and what cuts will leave open, a sentence each."""
        if self.dimension == 2 or self.closed:
            return tuple(self._repairs.notes)
        return (*self._repairs.notes, *open_notes(self.mesh))

    def refuse_branches(self) -> None:
        """Raise if an edge has more than two triangles, or two that run along it in the same direction.

        Sheets have none, but for one that touches itself along an edge and hangs together around both of its ends.

        Raises:
            ValueError: If so; a cut could not tell which triangles stay together.
        """
        mesh = self.mesh
        order = np.argsort(mesh.edge_key, kind="stable")
        key, first = np.unique(mesh.edge_key[order], return_index=True)
        count = np.diff(np.append(first, len(order)))
        bad = np.flatnonzero((count > 2) | ((count == 2) & (mesh.twin[order[first]] < 0)))
        if len(bad):
            a, b = divmod(int(key[bad[0]]), mesh.vertex_count)
            triangles = mesh.face[order[first[bad[0]] : first[bad[0]] + count[bad[0]]]].tolist()
            raise ValueError(
                f"the surface cannot be cut: edge ({a}, {b}) joins triangles {triangles}, which touch along it and "
                f"hang together around both of its ends ({len(bad)} such edges); divide the edge in two of them"
            )

    @property
    def volume(self) -> float:
        """Enclosed volume, meaningful if closed, in 2D the area of the triangles [m^d]."""
        return float((self.mesh.face_volume if self.dimension == 3 else self.mesh.face_area_vector[:, 2]).sum())

    def directions_inward(self, sites: np.ndarray) -> np.ndarray:
        """Unit vectors from sites into the solid around them, away from the skin and from every cap.

        Shape (n, dimension).

        A site that lies on several cuts belongs to the piece into which this points. It is minus the sum of the
        normals at the site, one for the skin and one for each wall, so that slivers do not matter. Where both sides of
        a cut meet, at its front and at the borders of a knife's, theirs cancel.

        Args:
            sites: Site ids, shape (n,).

        Raises:
            TypeError: If they are not integers.
            ValueError: If one is of no site.
        """
        sites = as_indices(sites, "sites", of="site", limit=self.site_count)
        if self.dimension == 2:
            return self._directions_from_border(sites)
        row = np.full(self.site_count, -1)
        row[sites] = np.arange(len(sites))
        around, corner = np.nonzero(row[self.site_triangles] >= 0)
        corners = self.site_points[self.site_triangles[around]]
        normal = triangle_normals(corners)
        labels, label = np.unique(self.triangle_cap[around], return_inverse=True)
        sums, sizes = np.zeros((len(sites), len(labels), 3)), np.zeros((len(sites), len(labels)))
        where = row[self.site_triangles[around, corner]], label
        np.add.at(sums, where, normal)
        np.add.at(sizes, where, np.linalg.norm(normal, axis=1))
        sums[np.linalg.norm(sums, axis=2) <= _CANCELLED * sizes] = 0.0
        return units(-units(sums, least=_NO_LENGTH).sum(axis=1), least=_NO_LENGTH)

    def on_several_cuts(self, sites: np.ndarray) -> np.ndarray:
        """Whether sites are corners of caps of more than one wall, shape (n,); in the plane of any wall.

        Args:
            sites: Site ids, shape (n,).

        Raises:
            TypeError: If they are not integers.
            ValueError: If one is of no site.
        """
        sites = as_indices(sites, "sites", of="site", limit=self.site_count)
        if self.dimension == 2:
            return self.site_key[sites] >= 0
        low, high = np.full(self.site_count, np.iinfo(np.int32).max), np.full(self.site_count, -1)
        cap = self.triangle_cap >= 0
        corners, wall = self.site_triangles[cap].reshape(-1), np.repeat(self.triangle_cap[cap], 3)
        np.minimum.at(low, corners, wall)
        np.maximum.at(high, corners, wall)
        return low[sites] < high[sites]

    def _directions_from_border(self, sites: np.ndarray) -> np.ndarray:
        """The same for a flat mesh: minus the sum of the normals of the border's two edges at each site.

        At the tip of a cut, where both edges are the two sides of it, they cancel.
        """
        mesh = self.mesh
        border = mesh.twin < 0
        start, end = mesh.face_vertex[border], mesh.destination[border]
        along = units(self.site_points[end] - self.site_points[start], least=_NO_LENGTH)
        outward = along[:, ::-1] * [1.0, -1.0]
        sums = np.zeros((self.site_count, 2))
        for ends in (start, end):
            np.add.at(sums, ends, outward)
        sums[np.linalg.norm(sums, axis=1) <= _CANCELLED] = 0.0
        return units(-sums[sites], least=_NO_LENGTH)

    @cached_property
    def triangle_solid(self) -> np.ndarray:
        """Number of the solid that each triangle bounds, shape (triangle_count,).

        A solid is a component, or one with those in it that are its cavities or cuts wholly inside. Solids may overlap.
        """
        mesh = self.mesh
        if mesh.component_count < 2:
            return np.zeros(self.triangle_count, dtype=np.int64)
        volumes, outward = mesh.component_volumes, mesh.component_outward
        solid = np.arange(mesh.component_count)
        inner = np.flatnonzero(~outward)
        if len(inner):
            first = np.unique(mesh.vertex_component, return_index=True)[1][inner]
            triangles = self.site_triangles.astype(np.int64)
            number = winding_numbers(mesh.vertices[first], mesh.vertices, triangles, mesh.face_component, len(volumes))
            around = np.where((number > 0.5) & outward, volumes, np.inf)
            found = np.isfinite(around).any(axis=1)
            solid[inner[found]] = around[found].argmin(axis=1)
        return solid[mesh.face_component]
