# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""More vertices in the same planes: a body bends more freely and its walls stay what they are.

Every edge gets a vertex in its middle. Triangles become four triangles and convex quads four quads; other polygons are
cut into triangles first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...geometry import PolygonMesh

if TYPE_CHECKING:
    from ..cage import Cage


def refined(cage: Cage) -> tuple[PolygonMesh, np.ndarray]:
    """The mesh of a cage with each face split, and the face that each of its faces is a part of.

    Args:
        cage: A cage without cuts.

    Raises:
        ValueError: If the cage has been cut.
    """
    refuse_cuts(cage, "refine it")
    polygons = _Polygons(cage.vertices)
    if cage.dimension == 2:
        for face, (a, b) in enumerate(cage.faces):
            middle = polygons.middle(a, b)
            polygons.add(face, (a, middle), (middle, b))
    else:
        for face, loop in enumerate(cage.faces):
            if len(loop) == 4 and _is_convex(cage.corner_coordinates[_corners(cage, face)]):
                polygons.add(face, *_four_quads(polygons, loop))
                continue
            for triangle in cage.triangles[cage.triangle_face == face].tolist():
                polygons.add(face, *_four_triangles(polygons, triangle))
    return polygons.mesh(), np.array(polygons.parent)


def refuse_cuts(cage: Cage, deed: str) -> None:
    """Raise if a cage has been cut.

    Args:
        cage: The cage.
        deed: What was to be done, for the text.

    Raises:
        ValueError: If so.
    """
    cuts = [number for number, wall in enumerate(cage.walls) if wall.two_sided]
    if cuts:
        raise ValueError(f"the cage has been cut (wall {cuts[0]}); {deed} before it is cut")


class _Polygons:
    """Polygons that are being made, over vertices of which there is one in the middle of each edge."""

    def __init__(self, vertices: np.ndarray):
        self.vertices, self.loops, self.parent = list(vertices), [], []
        self._middles: dict[tuple[int, int], int] = {}

    def middle(self, a: int, b: int) -> int:
        """The vertex in the middle of an edge."""
        edge = (min(a, b), max(a, b))
        if edge not in self._middles:
            self._middles[edge] = self.vertex(0.5 * (self.vertices[a] + self.vertices[b]))
        return self._middles[edge]

    def vertex(self, position: np.ndarray) -> int:
        """A further vertex."""
        self.vertices.append(position)
        return len(self.vertices) - 1

    def add(self, face: int, *loops: tuple[int, ...]) -> None:
        """Add the parts of a face."""
        self.loops.extend(loops)
        self.parent.extend([face] * len(loops))

    def mesh(self) -> PolygonMesh:
        """All of them."""
        start = np.concatenate([[0], np.cumsum([len(loop) for loop in self.loops])])
        return PolygonMesh(np.array(self.vertices), start, np.concatenate(self.loops).astype(np.int64))


def _corners(cage: Cage, face: int) -> slice:
    return slice(cage.mesh.face_start[face], cage.mesh.face_start[face + 1])


def _is_convex(corners: np.ndarray) -> bool:
    """Whether a counterclockwise polygon turns left at all corners."""
    sides = np.roll(corners, -1, axis=0) - corners
    ahead = np.roll(sides, -1, axis=0)
    return bool((sides[:, 0] * ahead[:, 1] > sides[:, 1] * ahead[:, 0]).all())


def _four_quads(polygons: _Polygons, loop: tuple[int, ...]) -> list[tuple[int, ...]]:
    """A convex quad's corners, each with the middles of its edges and of the quad."""
    sides = [polygons.middle(loop[k - 1], loop[k]) for k in range(4)]
    center = polygons.vertex(0.25 * np.sum([polygons.vertices[corner] for corner in loop], axis=0))
    return [(loop[k], sides[(k + 1) % 4], center, sides[k]) for k in range(4)]


def _four_triangles(polygons: _Polygons, triangle: list[int]) -> list[tuple[int, ...]]:
    """A triangle's corners, each with the middles of its edges, and the triangle of these."""
    sides = [polygons.middle(triangle[k - 1], triangle[k]) for k in range(3)]
    return [*((triangle[k], sides[(k + 1) % 3], sides[k]) for k in range(3)), tuple(sides)]
