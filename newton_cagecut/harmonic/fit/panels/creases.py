# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Creases: where the densities on a cage are singular, and how small panels have to be there.

Along an edge of the interior angle a the density is like the distance to the power pi / a - 1, so panels shrink towards
edges of more than half a turn, most of all towards the front of a cut; and towards concave corners of faces, where the
boundary functions themselves are not smooth. Lengths follow those of the faces around, not of the whole cage.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....cage import Cage
from ...walls.frame import UnitFrame

_LEAST_ANGLE = 1.02 * np.pi
_CHUNK = 1024
_MARGIN = 1e-6


@dataclass(frozen=True)
class Grading:
    """How panels shrink towards creases.

    Args:
        shrink: Panels at an edge of three quarters of a turn, relative to others; the exponent grows with the angle.
        growth: Panels a distance away from a crease, relative to the distance.
    """

    shrink: float
    growth: float


@dataclass(frozen=True)
class Creases:
    """Edges, those of no length being corners, and the size of panels there.

    Args:
        start: Where they start, shape (n, 3).
        step: From there to their ends, shape (n, 3).
        least: Greatest length of panels on them, shape (n,).
        growth: Length of panels a distance away, relative to the distance.
        at_front: Whether a vertex of the cage lies on the front of a cut, shape (vertex_count,).
        fronts: Half-edges of each face along the front of a cut, as pairs of face and half-edge, shape (m, 2).
    """

    start: np.ndarray
    step: np.ndarray
    least: np.ndarray
    growth: float
    at_front: np.ndarray
    fronts: np.ndarray

    def wanted(self, points: np.ndarray, most: float) -> np.ndarray:
        """Greatest length of panels at points, shape (n,).

        Args:
            points: Where, shape (n, 3).
            most: Greatest length of any panel.
        """
        wanted = np.full(len(points), most)
        for first in range(0, len(points), _CHUNK):
            some = slice(first, first + _CHUNK)
            length = np.maximum(self.least, self.growth * self._distances(points[some]))
            np.minimum(wanted[some], length.min(axis=1, initial=most), out=wanted[some])
        return wanted

    def near(self, centers: np.ndarray, radii: np.ndarray, most: float) -> np.ndarray:
        """Which creases may shrink panels in balls.

        Args:
            centers: Centres of the balls, shape (n, 3).
            radii: Their radii, shape (n,).
            most: Greatest length of any panel.

        Returns:
            Mask, shape (n, crease_count).
        """
        reach = most / self.growth * (1.0 + _MARGIN) + _MARGIN
        return (self.least < most) & (self._distances(centers) - radii[:, None] < reach)

    def _distances(self, points: np.ndarray) -> np.ndarray:
        """Distances of points from the creases, shape (n, crease_count)."""
        squared = np.maximum((self.step**2).sum(axis=1), 1e-300)
        offset = points[:, None] - self.start
        share = np.clip((offset * self.step).sum(axis=2) / squared, 0.0, 1.0)
        return np.sqrt(((offset - share[:, :, None] * self.step) ** 2).sum(axis=2))


def find_creases(cage: Cage, frame: UnitFrame, most: float, grading: Grading) -> Creases:
    """Find the creases of a cage.

    Args:
        cage: The cage.
        frame: The frame of the fit.
        most: Greatest length of any panel, in the frame.
        grading: How panels shrink towards the creases.
    """
    mesh = cage.mesh
    vertices = frame.to_unit(cage.vertices)
    half = np.flatnonzero(mesh.twin >= 0)
    one, other = mesh.face[half], mesh.face[mesh.twin[half]]
    step = vertices[mesh.destination[half]] - vertices[mesh.face_vertex[half]]
    length = np.sqrt((step**2).sum(axis=1))
    angle = _interior_angles(mesh.face_area_vector, one, other, step)
    wall, side = np.asarray(cage.face_wall), np.asarray(cage.face_side)
    front = (wall[one] == wall[other]) & (side[one] != side[other])
    angle[front] = 2.0 * np.pi
    area = np.sqrt((mesh.face_area_vector**2).sum(axis=1)) / frame.half_side**2
    width = np.minimum(area[one], area[other]) / length
    local = np.minimum(most, np.minimum(width, length))
    bent = (angle > _LEAST_ANGLE) & (half < mesh.twin[half])
    corner, corner_local = _concave_corners(cage, frame, most)
    fronts = np.stack([one[front], half[front]], axis=1)
    at_front = np.zeros(cage.vertex_count, dtype=bool)
    at_front[mesh.face_vertex[half[front]]] = True
    ends = mesh.face_vertex[half[bent]], mesh.destination[half[bent]]
    return Creases(
        np.concatenate([vertices[ends[0]], vertices[corner]]),
        np.concatenate([step[bent], np.zeros((len(corner), 3))]),
        np.concatenate(
            [local[bent] * grading.shrink ** (2.0 * angle[bent] / np.pi - 2.0), corner_local * grading.shrink]
        ),
        grading.growth,
        at_front,
        fronts,
    )


def _interior_angles(normal: np.ndarray, one: np.ndarray, other: np.ndarray, step: np.ndarray) -> np.ndarray:
    unit = normal / np.sqrt((normal**2).sum(axis=1, keepdims=True))
    along = step / np.sqrt((step**2).sum(axis=1, keepdims=True))
    turn = (np.cross(unit[one], unit[other]) * along).sum(axis=1)
    return np.pi - np.arctan2(turn, (unit[one] * unit[other]).sum(axis=1))


def _concave_corners(cage: Cage, frame: UnitFrame, most: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices at which a face of a one-sided wall is concave or slit, and the length of the shorter edge there."""
    mesh = cage.mesh
    place = cage.corner_coordinates
    before = np.empty_like(mesh.next)
    before[mesh.next] = np.arange(len(mesh.next))
    arrive, leave = place - place[before], place[mesh.next] - place
    cross = arrive[:, 0] * leave[:, 1] - arrive[:, 1] * leave[:, 0]
    turn = np.arctan2(cross, (arrive * leave).sum(axis=1))
    concave = (turn < -0.05) | (np.abs(np.abs(turn) - np.pi) < 1e-6)
    corner = np.flatnonzero(concave)
    shorter = np.minimum(np.hypot(*arrive[corner].T), np.hypot(*leave[corner].T)) / frame.half_side
    shorter = np.minimum(most, shorter)
    return mesh.face_vertex[corner], shorter
