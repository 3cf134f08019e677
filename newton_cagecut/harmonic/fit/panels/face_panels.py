# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Panels of a cage's faces: triangles that are small where densities on them vary fast.

Faces of the cage are bisected towards creases, the walls of cuts divided into strips along their fronts. Panels are a
pure function of the cage: how it came to be cut leaves no trace in them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....cage import Cage
from ...walls.frame import UnitFrame
from .bisection import bisect
from .coverage import uncovered_parts
from .creases import Grading, find_creases
from .strips import fan_panels, strip_panels

GRADINGS = (Grading(0.35, 1.75), Grading(0.6, 2.5), Grading(1.0, 4.0), Grading(1.0, np.inf))
"""From fine to coarse; with the last one only long panels are divided."""
_ENOUGH_UNKNOWNS, _MOST_UNKNOWNS = 1600, 8000
_FLAT = 1e-9
"""Height of triangles without area, relative to their longest edges."""


class FacePlanes:
    """Planes of a cage's faces, in its unit frame: coordinates in which every face is counterclockwise."""

    def __init__(self, cage: Cage, frame: UnitFrame) -> None:
        walls = [cage.walls[wall] for wall in cage.face_wall]
        self.origin = frame.to_unit(np.array([wall.origin for wall in walls]))
        self.axes = np.array([wall.axes for wall in walls])
        self.axes[:, 1] *= (1.0 - 2.0 * np.asarray(cage.face_side))[:, None]
        self.corners = cage.corner_coordinates / frame.half_side
        self._start = cage.mesh.face_start

    def polygon(self, face: int) -> np.ndarray:
        """Corners of a face in its plane, shape (corner_count, 2)."""
        return self.corners[self._start[face] : self._start[face + 1]]

    def to_plane(self, face: int, points: np.ndarray) -> np.ndarray:
        """Coordinates of points in a face's plane, shape (..., 2)."""
        offset = points - self.origin[face]
        return np.stack([(offset * axis).sum(axis=-1) for axis in self.axes[face]], axis=-1)

    def flattened(self, faces: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """Corners of panels moved into the planes of their faces: those of a cage are planar within a tolerance only.

        Args:
            faces: Face of each panel, shape (panel_count,).
            corners: Corners of the panels, shape (panel_count, corner_count, 3).
        """
        first, second = self.axes[faces, 0][:, None], self.axes[faces, 1][:, None]
        offset = corners - self.origin[faces][:, None]
        x, y = (offset * first).sum(axis=2, keepdims=True), (offset * second).sum(axis=2, keepdims=True)
        return self.origin[faces][:, None] + x * first + y * second

    def to_space(self, face: int, points: np.ndarray) -> np.ndarray:
        """Points of a face's plane in space, shape (..., 3)."""
        return self.origin[face] + points[..., :1] * self.axes[face, 0] + points[..., 1:] * self.axes[face, 1]


@dataclass(frozen=True)
class FacePanels:
    """Panels of a cage's faces in its unit frame.

    Args:
        corners: Corners, counterclockwise seen from outside, shape (panel_count, 3, 3).
        nodes: Numbers of the corners, of which no two faces share one, shape (panel_count, 3).
        face: Face of each panel, shape (panel_count,).
        charged: Whether a panel carries charges. Where both sides of a cut belong to one piece, one side does.
        valued: Whether a panel is one of those that its face is divided into. The others lie on parts of faces that
            only carry charges.
    """

    corners: np.ndarray
    nodes: np.ndarray
    face: np.ndarray
    charged: np.ndarray
    valued: np.ndarray


def face_panels(
    cage: Cage, frame: UnitFrame, planes: FacePlanes, most: float, grading: Grading = GRADINGS[0]
) -> FacePanels:
    """Divide the faces of a cage into panels.

    Args:
        cage: The cage.
        frame: Its unit frame.
        planes: The planes of its faces in the frame.
        most: Greatest length of panels, in the frame.
        grading: How panels shrink towards creases.
    """
    creases = find_creases(cage, frame, most, grading)
    fronted = np.unique(creases.fronts[:, 0]).tolist()
    uncovered = uncovered_parts(cage)
    vertices = frame.to_unit(cage.vertices)
    plain = ~np.isin(cage.triangle_face, fronted) & ~_is_flat(vertices[cage.triangles])
    corner = cage.triangle_face[plain][:, None] * cage.vertex_count + cage.triangles[plain]
    corner, number = np.unique(corner, return_inverse=True)
    points, nodes, source = bisect(
        vertices[corner % cage.vertex_count], number.reshape(-1, 3), lambda center: creases.wanted(center, most)
    )
    face = cage.triangle_face[plain][source]
    corners = planes.flattened(face, points[nodes])
    parts = [(corners, nodes, face, ~np.isin(face, list(uncovered)), np.ones(len(face), dtype=bool))]
    for f in fronted:
        fronts = creases.fronts[creases.fronts[:, 0] == f, 1]
        ends = np.stack([planes.corners[fronts], planes.corners[cage.mesh.next[fronts]]], axis=1)
        place, nodes = strip_panels(_convex_parts(cage, planes, f), ends, most)
        parts.append(_part(planes, f, place, nodes, f not in uncovered, True))
    for f, polygons in uncovered.items():
        if polygons:
            place, nodes = fan_panels([polygon / frame.half_side for polygon in polygons])
            parts.append(_part(planes, f, place, nodes, True, False))
    offset = np.cumsum([0, *(nodes.max() + 1 for _, nodes, *_ in parts)])
    corners, nodes, face, charged, valued = zip(*parts)
    nodes = [number + first for number, first in zip(nodes, offset)]
    return FacePanels(*(np.concatenate(column) for column in (corners, nodes, face, charged, valued)))


def _is_flat(corners: np.ndarray) -> np.ndarray:
    """Whether triangles have no area, as some of a face with corners in a row have, shape (triangle_count,)."""
    edge = np.roll(corners, -1, axis=1) - corners
    area_vector = np.cross(edge[:, 0], edge[:, 1])
    return (area_vector**2).sum(axis=1) < (_FLAT * (edge**2).sum(axis=2).max(axis=1)) ** 2


def _part(
    planes: FacePlanes, face: int, place: np.ndarray, nodes: np.ndarray, charged: bool, valued: bool
) -> tuple[np.ndarray, ...]:
    count = len(nodes)
    corners = planes.to_space(face, place)[nodes]
    return corners, nodes, np.full(count, face), np.full(count, charged), np.full(count, valued)


def _convex_parts(cage: Cage, planes: FacePlanes, face: int) -> list[np.ndarray]:
    """A face as one convex polygon, or else its triangles, in its plane."""
    polygon = planes.polygon(face)
    edge = np.roll(polygon, -1, axis=0) - polygon
    after = np.roll(edge, -1, axis=0)
    if (edge[:, 0] * after[:, 1] - edge[:, 1] * after[:, 0] > 0.0).all():
        return [polygon]
    loop = np.asarray(cage.faces[face])
    triangles = cage.triangles[cage.triangle_face == face]
    return [polygon[[np.flatnonzero(loop == vertex)[0] for vertex in triangle]] for triangle in triangles]


def affordable_panels(cage: Cage, frame: UnitFrame, planes: FacePlanes, most: float) -> FacePanels:
    """Panels of the finest grading that leaves no more unknowns than a solve is quick for.

    Args:
        cage: The cage.
        frame: Its unit frame.
        planes: The planes of its faces in the frame.
        most: Greatest length of panels, in the frame.

    Raises:
        ValueError: There are too many faces for any.
    """
    for grading in GRADINGS:
        panels = face_panels(cage, frame, planes, most, grading)
        count = len(np.unique(panels.nodes[panels.charged]))
        if count <= _ENOUGH_UNKNOWNS:
            return panels
    if count > _MOST_UNKNOWNS:
        raise ValueError(
            f"a fit of this cage of {cage.face_count} faces has {count} unknowns, {_MOST_UNKNOWNS} at most: "
            "take correction='harmonic'"
        )
    return panels
