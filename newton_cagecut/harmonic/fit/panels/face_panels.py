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
from .creases import Creases, Grading, find_creases
from .strips import fan_panels, strip_panels

GRADINGS = (Grading(0.35, 1.75), Grading(0.6, 2.5), Grading(1.0, 4.0), Grading(1.0, np.inf))
"""From fine to coarse; with the last one only long panels are divided."""
_ENOUGH_UNKNOWNS, _MOST_UNKNOWNS = 1600, 8000
_MANY_CORNERS = 800
"""Corners of faces from which on a coarse grading is likely to be the one."""
_FLAT = 1e-9
"""Height of triangles without area, relative to their longest edges."""


class FacePlanes:
    """Planes of a cage's faces, in its unit frame: coordinates in which every face is counterclockwise."""

    def __init__(self, cage: Cage, frame: UnitFrame) -> None:
        walls = [cage.walls[wall] for wall in cage.face_wall]
        self.origin = frame.to_unit(np.array([wall.origin for wall in walls]))
        self.axes = np.array([wall.axes for wall in walls])
        self.axes[:, 1] *= (1.0 - 2.0 * np.asarray(cage.face_side))[:, None]
        self.outward = np.cross(self.axes[:, 0], self.axes[:, 1])
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
        nodes: Numbers of the corners within their face, shape (panel_count, 3).
        face: Face of each panel, ascending, shape (panel_count,).
        charged: Whether a panel carries charges. Where both sides of a cut belong to one piece, one side does.
        valued: Whether a panel is one of those that its face is divided into. The others lie on parts of faces that
            only carry charges.
        rank: Faces that come later in the order of their ranks are more likely to change in the next step of a cut,
            shape (face_count,).
    """

    corners: np.ndarray
    nodes: np.ndarray
    face: np.ndarray
    charged: np.ndarray
    valued: np.ndarray
    rank: np.ndarray

    @property
    def unknown_count(self) -> int:
        """Number of nodes with charges."""
        most = int(self.nodes.max()) + 1
        return len(np.unique((self.face[:, None] * most + self.nodes)[self.charged]))


PanelParts = dict[bytes, tuple[np.ndarray, np.ndarray]]
"""Corners of panels and their nodes, by what they are a function of."""


def face_panels(
    cage: Cage,
    frame: UnitFrame,
    planes: FacePlanes,
    most: float,
    grading: Grading = GRADINGS[0],
    known: PanelParts | None = None,
) -> FacePanels:
    """Divide the faces of a cage into panels.

    Args:
        cage: The cage.
        frame: Its unit frame.
        planes: The planes of its faces in the frame.
        most: Greatest length of panels, in the frame.
        grading: How panels shrink towards creases.
        known: Panels of faces of an earlier cage; replaced by those of this one.
    """
    known = {} if known is None else known
    creases = find_creases(cage, frame, most, grading)
    uncovered = uncovered_parts(cage)
    vertices = frame.to_unit(cage.vertices)
    fronted = {
        face: creases.fronts[creases.fronts[:, 0] == face, 1] for face in np.unique(creases.fronts[:, 0]).tolist()
    }
    whole, rank = _whole_faces(cage, planes, vertices, creases, most, set(fronted), known)
    for face, half_edges in fronted.items():
        whole[face] = _strips(cage, planes, face, half_edges, most, known)
    parts = []
    for face, (_, corners, nodes) in enumerate(whole):
        charged = face not in uncovered
        parts.append((corners, nodes, face, charged, True))
        if not charged and uncovered[face]:
            place, rest = fan_panels([polygon / frame.half_side for polygon in uncovered[face]])
            parts.append((planes.to_space(face, place)[rest], rest + int(nodes.max()) + 1, face, True, False))
    known.clear()
    known.update({key: (corners, nodes) for key, corners, nodes in whole})
    count = [len(part[1]) for part in parts]
    face, charged, valued = (np.repeat([part[k] for part in parts], count) for k in (2, 3, 4))
    return FacePanels(
        np.concatenate([part[0] for part in parts]),
        np.concatenate([part[1] for part in parts]),
        face,
        charged,
        valued,
        rank,
    )


def _whole_faces(
    cage: Cage,
    planes: FacePlanes,
    vertices: np.ndarray,
    creases: Creases,
    most: float,
    skipped: set[int],
    known: PanelParts,
) -> tuple[list[tuple[bytes, np.ndarray, np.ndarray]], np.ndarray]:
    """Faces bisected towards creases: what they follow from, corners and nodes; and the rank of each face."""
    mesh, count = cage.mesh, cage.face_count
    low, high = (ufunc.reduceat(vertices[mesh.face_vertex], mesh.face_start[:-1]) for ufunc in (np.minimum, np.maximum))
    near = creases.near((low + high) / 2.0, np.sqrt(((high - low) ** 2).sum(axis=1)) / 2.0, most)
    rank = 2 * _latest_cut(cage, vertices, most / creases.growth)
    # A cut that advances moves its front, and with it the panels of the faces that meet there.
    rank += np.logical_or.reduceat(creases.at_front[mesh.face_vertex], mesh.face_start[:-1])
    rows = np.concatenate([creases.start, creases.step, creases.least[:, None]], axis=1)
    found: list[tuple[bytes, np.ndarray, np.ndarray]] = [
        (b"", np.zeros((0, 3, 3)), np.zeros((0, 3), dtype=int))
    ] * count
    settings = np.array([most, creases.growth]).tobytes()
    plain = ~_is_flat(vertices[cage.triangles])
    new, triangles, corners = [], [], []
    for face in range(count):
        if face in skipped:
            continue
        own_triangles = cage.triangles[plain & (cage.triangle_face == face)]
        crease = rows[near[face]]
        crease = crease[np.lexsort(crease.T)]
        corner, number = np.unique(own_triangles, return_inverse=True)
        parts = (vertices[corner], number, crease, planes.origin[face], planes.axes[face])
        key = b"".join([settings, *(part.tobytes() for part in parts)])
        found[face] = (key, *known.get(key, found[face][1:]))
        if key not in known:
            triangles.append(number.reshape(-1, 3) + sum(map(len, corners)))
            corners.append(vertices[corner])
            new.append(face)
    if new:
        points, nodes, source = bisect(
            np.concatenate(corners), np.concatenate(triangles), lambda center: creases.wanted(center, most)
        )
        owner = np.repeat(new, [len(own) for own in triangles])[source]
        panels = planes.flattened(owner, points[nodes])
        for face in new:
            own = owner == face
            found[face] = (found[face][0], panels[own], _numbered(nodes[own]))
    return found, rank


def _latest_cut(cage: Cage, vertices: np.ndarray, reach: float) -> np.ndarray:
    """The latest cut whose plane each face comes near to, as its wall, -1 without: one that advances gets on there."""
    mesh, frame = cage.mesh, UnitFrame.of(cage.vertices)
    latest = np.full(cage.face_count, -1)
    for number, wall in enumerate(cage.walls):
        if wall.two_sided:
            height = ((vertices - frame.to_unit(wall.origin)) * wall.normal).sum(axis=1)[mesh.face_vertex]
            low, high = (ufunc.reduceat(height, mesh.face_start[:-1]) for ufunc in (np.minimum, np.maximum))
            latest[np.maximum(low, -high) < reach] = number
    return latest


def _strips(
    cage: Cage, planes: FacePlanes, face: int, half_edges: np.ndarray, most: float, known: PanelParts
) -> tuple[bytes, np.ndarray, np.ndarray]:
    """A face along fronts in strips: what they follow from, corners and nodes."""
    ends = np.stack([planes.corners[half_edges], planes.corners[cage.mesh.next[half_edges]]], axis=1)
    polygons = _convex_parts(cage, planes, face)
    parts = (planes.origin[face], planes.axes[face], ends, *polygons)
    key = b"".join([b"strips", np.float64(most).tobytes(), *(part.tobytes() for part in parts)])
    if key not in known:
        place, nodes = strip_panels(polygons, ends, most)
        return key, planes.to_space(face, place)[nodes], _numbered(nodes)
    return (key, *known[key])


def _numbered(nodes: np.ndarray) -> np.ndarray:
    """Nodes numbered without gaps, in their order."""
    return np.unique(nodes, return_inverse=True)[1].reshape(-1, 3)


def _is_flat(corners: np.ndarray) -> np.ndarray:
    """Whether triangles have no area, as some of a face with corners in a row have, shape (triangle_count,)."""
    edge = np.roll(corners, -1, axis=1) - corners
    area_vector = np.cross(edge[:, 0], edge[:, 1])
    return (area_vector**2).sum(axis=1) < (_FLAT * (edge**2).sum(axis=2).max(axis=1)) ** 2


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


def affordable_panels(
    cage: Cage, frame: UnitFrame, planes: FacePlanes, most: float, known: PanelParts | None = None
) -> FacePanels:
    """Panels of the finest grading that leaves no more unknowns than a solve is quick for.

    Cages of many faces are tried from the coarsest grading on, and few tries are made of others too.

    Args:
        cage: The cage.
        frame: Its unit frame.
        planes: The planes of its faces in the frame.
        most: Greatest length of panels, in the frame.
        known: See ``face_panels``.

    Raises:
        ValueError: There are too many faces for any.
    """
    known = {} if known is None else known
    before = dict(known)
    known.clear()
    many = sum(map(len, cage.faces)) > _MANY_CORNERS
    panels = None
    for grading in reversed(GRADINGS) if many else GRADINGS:
        found = dict(before)
        tried = face_panels(cage, frame, planes, most, grading, found)
        known.update(found)
        enough = tried.unknown_count <= _ENOUGH_UNKNOWNS
        if enough or not many or panels is None:
            panels = tried
        if enough != many:
            break
    count = panels.unknown_count
    if count > _MOST_UNKNOWNS:
        raise ValueError(
            f"a fit of this cage of {cage.face_count} faces has {count} unknowns, {_MOST_UNKNOWNS} at most: "
            "take correction='harmonic'"
        )
    return panels
