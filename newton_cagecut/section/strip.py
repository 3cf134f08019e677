# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Planar strips of a cut, straight ones in 2D.

Sections 4 and 5.2 of the paper. A strip is a pure function of the mesh before it, the plane and the front: its section
is computed once, and every step opens it anew. Cages and the surfaces in them are cut by the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import PolygonMesh
from .blade import BladePlane
from .clearing import clear_front
from .clipping import clipped
from .created_vertices import CreatedVertices
from .hinge import Hinge
from .loop_walk import walk_faces
from .numbering import Numbering
from .opening import Opening
from .polygons import section_of_polygons
from .section import Section
from .segment_split import split_segments
from .segments import section_of_segments
from .swept_region import SweptRegion


@dataclass(frozen=True, eq=False)
class Strip:
    """One plane's part of a cut through a mesh."""

    section: Section
    """The section of the mesh before the strip."""
    numbering: Numbering
    """Ids of the vertices that opening it creates."""
    fronts: np.ndarray
    """Coordinate s at which the front reaches each node, ascending, shape (node_count,) [m]."""
    tolerance: float
    """Distance that fronts keep from nodes [m]."""

    @classmethod
    def of_polygons(
        cls,
        mesh: PolygonMesh,
        plane: BladePlane,
        *,
        hinge: Hinge | None = None,
        window: tuple[float, float, float] | None = None,
        tolerance: float,
        window_tolerance: float = 0.0,
        rounding: float = 0.0,
        face_group: np.ndarray | None = None,
    ) -> Strip:
        """Section polygons.

        Args:
            mesh: The polygons, closed or open.
            plane: The plane.
            hinge: Front of the strip before, at ``s = 0``.
            window: Heel, tip and start of a knife, which bound coordinates a, a and s [m].
            tolerance: Distance that fronts keep from nodes [m].
            window_tolerance: Distance that the window's borders keep from nodes [m].
            rounding: Distance up to which vertices count as on the plane [m].
            face_group: Number of the solid that each face bounds, where solids may overlap, shape (face_count,).

        Raises:
            ValueError: If the section does not close at the hinge.
        """
        section = section_of_polygons(mesh, plane, face_group=face_group, hinge=hinge, tolerance=rounding)
        return cls._of(section if window is None else clipped(section, window, window_tolerance), tolerance)

    @classmethod
    def of_segments(
        cls,
        mesh: PolygonMesh,
        plane: BladePlane,
        *,
        vertex_piece: np.ndarray,
        hinge: Hinge | None = None,
        window: tuple[float, float, float] | None = None,
        tolerance: float,
    ) -> Strip:
        """Section the segments around a plane body.

        Args:
            mesh: The segments, in closed loops.
            plane: The line.
            vertex_piece: Solid piece of each vertex, shape (vertex_count,).
            hinge: Tip of the strip before, at ``s = 0``.
            window: Bounds as of a knife, of which the last is where the blade starts [m].
            tolerance: Distance that fronts and the start keep from nodes [m].

        Raises:
            ValueError: If the section does not close at the hinge, or the blade starts inside the body.
        """
        start = {} if window is None else {"start": window[2], "tolerance": tolerance}
        return cls._of(section_of_segments(mesh, plane, vertex_piece=vertex_piece, hinge=hinge, **start), tolerance)

    @classmethod
    def _of(cls, section: Section, tolerance: float) -> Strip:
        return cls(section, Numbering(section), np.sort(section.nodes.coordinates[:, 1]), tolerance)

    @property
    def plane(self) -> BladePlane:
        """The plane."""
        return self.section.plane

    @property
    def touches(self) -> bool:
        """Whether the plane meets the mesh."""
        return len(self.fronts) > 0

    def clear_front(self, front: float) -> float:
        """A front moved on where it would pass too close to a node.

        Args:
            front: Coordinate s of the front [m].
        """
        return clear_front(self.fronts, front, self.tolerance)

    def is_complete(self, front: float) -> bool:
        """Whether nothing is left to cut beyond a front.

        Args:
            front: Coordinate s of the front [m].
        """
        return not self.touches or front > float(self.fronts[-1])

    def opened(self, front: float) -> Opening:
        """The mesh opened up to a front.

        Args:
            front: Coordinate s of the front [m].
        """
        middles = np.flatnonzero(self.numbering.middle_plus >= 0)
        region = SweptRegion(self.section, front, middles=middles)
        vertices = CreatedVertices(self.section, self.numbering, region)
        faces = split_segments(vertices) if self.section.mesh.dimension == 2 else walk_faces(vertices)
        return Opening(self.section, region, vertices, faces)

    def swept(self, opening: Opening, since: float) -> SweptRegion:
        """What of an opening lies ahead of an earlier front.

        Args:
            opening: The strip opened.
            since: Coordinate s of the earlier front [m].
        """
        region = opening.region
        if self.touches and since < self.fronts[0] and not len(region.middles):
            return region
        return SweptRegion(self.section, region.upper, since)
