# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A polygon mesh as plain arrays, on its way between USD and the cage and surface rooms."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from ..geometry import polygon_triangles

_Y_TO_Z = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True, eq=False)
class MeshData:
    """A polygon mesh in metres.

    Attributes:
        points: Vertices [m], shape ``(n, 3)``, float64, in world space.
        faces: Vertex indices of each polygon, counter-clockwise seen from outside.
        uvs: Texture coordinates of the vertices, shape ``(n, 2)``, or ``None``.
        name: Name of the mesh.
        up_axis: ``"Y"`` or ``"Z"``, the axis of ``points`` that points up.
        corner_uvs: Texture coordinates of the faces' corners, face after face, shape ``(corner_count, 2)``, where they
            have seams and so ``uvs`` is ``None``.
        corner_normals: Normals of the faces' corners, of any length, shape ``(corner_count, 3)``, or ``None``.
    """

    points: np.ndarray
    faces: tuple[tuple[int, ...], ...]
    uvs: np.ndarray | None = None
    name: str = "mesh"
    up_axis: str = "Z"
    corner_uvs: np.ndarray | None = None
    corner_normals: np.ndarray | None = None

    @property
    def triangle_corners(self) -> np.ndarray:
        """The corner, of all corners face after face, at each corner of the triangles, shape ``(m, 3)``, int32."""
        counts = np.fromiter(map(len, self.faces), dtype=np.int64, count=len(self.faces))
        corners = np.fromiter(chain.from_iterable(self.faces), dtype=np.int64)
        return polygon_triangles(self.points[corners], counts, np.arange(len(corners)))

    @property
    def triangles(self) -> np.ndarray:
        """The faces cut into triangles, shape ``(m, 3)``, int32."""
        counts = np.fromiter(map(len, self.faces), dtype=np.int64, count=len(self.faces))
        return polygon_triangles(self.points, counts, np.fromiter(chain.from_iterable(self.faces), dtype=np.int64))

    def turned(self, up_axis: str) -> MeshData:
        """The mesh rotated about x so that this axis, ``"Y"`` or ``"Z"``, points up."""
        normals = self.corner_normals
        return replace(
            self,
            points=turn_up(self.points, self.up_axis, up_axis),
            up_axis=up_axis,
            corner_normals=None if normals is None else turn_up(normals, self.up_axis, up_axis),
        )


def turn_up(points: np.ndarray, up_axis: str, wanted: str) -> np.ndarray:
    """Return points rotated about x from one up axis, ``"Y"`` or ``"Z"``, to another one.

    Args:
        points: The points, shape ``(n, 3)``.
        up_axis: The axis of them that points up.
        wanted: The axis that is to point up.
    """
    if wanted == up_axis:
        return points
    return points @ (_Y_TO_Z.T if wanted == "Z" else _Y_TO_Z)


def check_mesh(label: str, points: np.ndarray, counts: np.ndarray, indices: np.ndarray) -> None:
    """Raise when the arrays are no polygon mesh.

    Args:
        label: What the errors call the mesh.
        points: Vertices, shape ``(n, 3)``.
        counts: Vertices of each face, shape ``(F,)``.
        indices: Vertex indices of all faces, shape ``(sum(counts),)``.

    Raises:
        ValueError: The mesh is empty, not finite, or a face is too short or points outside the vertices.
    """
    if len(points) == 0 or len(counts) == 0:
        raise ValueError(f"{label} is empty: it has {len(points)} points and {len(counts)} faces")
    infinite = ~np.isfinite(points).all(axis=1)
    if infinite.any():
        raise ValueError(f"{label}: vertex {infinite.argmax()} is not finite: {points[infinite.argmax()]}")
    if counts.sum() != len(indices):
        raise ValueError(f"{label}: faceVertexCounts add up to {counts.sum()}, but there are {len(indices)} indices")
    if (counts < 3).any():
        face = int((counts < 3).argmax())
        raise ValueError(f"{label}: face {face} has {counts[face]} vertices; a face needs at least 3")
    outside = (indices < 0) | (indices >= len(points))
    if outside.any():
        corner = int(outside.argmax())
        face = int(np.searchsorted(np.cumsum(counts), corner, side="right"))
        raise ValueError(f"{label}: face {face} refers to vertex {indices[corner]}, but there are {len(points)}")
