# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What one body looks like in one frame of an animation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry import as_floats, as_integers, as_loops, as_points
from .layers import checked_color, checked_name, flat_faces
from .mesh_data import check_mesh
from .outline import outline_loops


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyFrame:
    """What one body looks like in one frame, in metres.

    Attributes:
        name: Name of the body, the same in all frames.
        points: Vertices of the surface [m], shape ``(n, 3)``, also of a plane body.
        triangles: Triangles of the surface, shape ``(m, 3)``.
        triangle_cap: The wall of the cut whose cap a triangle belongs to, or -1 on the skin, shape ``(m,)``.
            ``None``: all skin.
        rest_points: Vertices of the surface at rest [m], shape ``(n, 3)``, which tell the two sides of a cut apart
            however far they have come. ``None``: ``points`` tell them. Read when the triangles change.
        velocities: Velocities of the points [m/s], shape ``(n, 3)``, for motion blur, or ``None``.
        uvs: Texture coordinates of the triangles' corners, shape ``(m, 3, 2)``, or ``None``. Read when the triangles
            change.
        has_skin_uvs: Whether those of the skin mean anything; only those of the caps are written otherwise.
        cage_points: Vertices of the cage [m], shape ``(k, 3)``, or ``None`` for no cage.
        cage_faces: Polygons of the cage, or the segments of a plane one.
        skin_color: Linear RGB of the skin. Read at the first frame of the body.
        cap_color: Linear RGB of the caps. Read at the first frame of the body.
        skin_texture: A picture file that the skin's texture coordinates lay over it. Read at the first frame.
        cap_texture: The same for the caps.
    """

    name: str
    points: np.ndarray
    triangles: np.ndarray
    triangle_cap: np.ndarray | None = None
    rest_points: np.ndarray | None = None
    velocities: np.ndarray | None = None
    uvs: np.ndarray | None = None
    has_skin_uvs: bool = True
    cage_points: np.ndarray | None = None
    cage_faces: Sequence[Sequence[int]] = ()
    skin_color: tuple[float, float, float] = (0.83, 0.30, 0.10)
    cap_color: tuple[float, float, float] = (0.95, 0.72, 0.52)
    skin_texture: str | None = None
    cap_texture: str | None = None

    @property
    def has_plane_cage(self) -> bool:
        """Whether the cage is made of segments."""
        return len(self.cage_faces) > 0 and len(self.cage_faces[0]) == 2

    def checked(self) -> BodyFrame:
        """Return the frame as NumPy arrays of the right types.

        Raises:
            TypeError: Something is of a wrong type.
            ValueError: The arrays are empty, not finite or do not fit together.
        """
        points = self._rows("points")
        checked_name(self.name)
        triangles = as_integers(self.triangles, f"body {self.name}: triangles", shape=("m", 3)).astype(np.int32)
        check_mesh(f"the surface of body {self.name}", points, *flat_faces(triangles))
        cap = np.full(len(triangles), -1)
        if self.triangle_cap is not None:
            cap = as_integers(self.triangle_cap, f"body {self.name}: triangle_cap", shape=(len(triangles),))
        for name in ("skin_color", "cap_color"):
            checked_color(getattr(self, name), f"body {self.name}: {name}")
        rest_points = points if self.rest_points is None else self._like_points("rest_points", points)
        velocities = None if self.velocities is None else self._like_points("velocities", points)
        uvs = None if self.uvs is None else as_floats(self.uvs, f"body {self.name}: uvs must be numbers")
        if uvs is not None and uvs.shape != (len(triangles), 3, 2):
            raise ValueError(f"body {self.name}: uvs must have shape ({len(triangles)}, 3, 2), got {uvs.shape}")
        cage_points = self.cage_points
        if cage_points is not None:
            cage_points = self._rows("cage_points")
            as_loops(self.cage_faces, f"the cage of body {self.name}")
            if self.has_plane_cage:
                outline_loops(f"the cage of body {self.name}", self.cage_faces, len(cage_points))
            else:
                check_mesh(f"the cage of body {self.name}", cage_points, *flat_faces(self.cage_faces))
        surface = {"points": points, "triangles": triangles, "triangle_cap": cap, "rest_points": rest_points}
        return replace(self, **surface, velocities=velocities, uvs=uvs, cage_points=cage_points)

    def _like_points(self, name: str, points: np.ndarray) -> np.ndarray:
        """Return an array that has a row for each point."""
        rows = self._rows(name)
        if len(rows) != len(points):
            raise ValueError(f"body {self.name}: {name} must have shape {points.shape}, got {rows.shape}")
        return rows

    def _rows(self, name: str) -> np.ndarray:
        """Return one of the arrays of points as float64, shape ``(n, 3)``."""
        return as_points(getattr(self, name), f"body {self.name}: {name}", rows="n", widths=(3,))
