# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Strips of a surface's cut, each in a plane of the cage's.

Section 6.3 of the paper. A flat mesh is cut as the open mesh in space that it is, by the plane that stands on the
blade's line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..section import BladePlane, Hinge, Strip
from .surface import Surface

_ON_FRONT = 1e-10
_ROUNDING = 1e-13


@dataclass(frozen=True, eq=False)
class SurfaceStrip:
    """One plane's part of a surface's cut."""

    base: Surface
    """The surface before the strip."""
    strip: Strip
    """The strip of its triangles."""
    wall: int
    """Number of the wall on which new points lie."""
    offset: np.ndarray
    """From the cage's front to the surface's, which keeps off points and edges, where the strip begins [m]."""
    offset_ahead: float
    """The same as a coordinate s in the plane [m]."""

    @classmethod
    def of(
        cls,
        surface: Surface,
        plane: BladePlane,
        wall: int,
        *,
        hinge: Hinge | None = None,
        window: tuple[float, float, float] | None = None,
        offset: np.ndarray | None = None,
    ) -> SurfaceStrip:
        """Section a surface.

        Args:
            surface: The surface.
            plane: Plane of the cage's cut.
            wall: Number of the cage's wall.
            hinge: Front of the strip before, at ``s = 0``.
            window: Heel, tip and start of the cage's cut [m].
            offset: From the cage's front to the surface's; nothing by default [m].

        Raises:
            ValueError: If the section does not close at the hinge.
        """
        plane = plane.in_space()
        offset = np.zeros(3) if offset is None else offset
        ahead = float(plane.coordinates((plane.origin + offset)[None])[0, 1])
        size = np.ptp(surface.site_points, axis=0).max()
        strip = Strip.of_polygons(
            surface.mesh,
            replace(plane, origin=plane.origin + offset),
            hinge=hinge,
            window=window,
            tolerance=_ON_FRONT * size,
            rounding=_ROUNDING * size,
            face_group=surface.triangle_solid,
        )
        return cls(surface, strip, int(wall), offset, ahead)

    @property
    def plane(self) -> BladePlane:
        """Plane of the strip, in space."""
        return self.strip.plane

    def reach_at(self, front: float) -> float:
        """Coordinate s up to which the surface opens at a front of the cage's cut.

        Tips keep off points and edges of the mesh, so that it is plain in which triangle each of them lies.

        Args:
            front: Coordinate s of the cage's front [m].
        """
        return self.strip.clear_front(front - self.offset_ahead)
