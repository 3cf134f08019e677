# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The harmonic coordinates of a cage, cut or not, by a fit: no walks, and an error that falls with the panels' size."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...cage import Cage
from ..walls.frame import UnitFrame
from .density_fit import ChargePanels, DensityFit, DipolePanels
from .face_dipoles import projected
from .face_values import FaceValues, face_values
from .panels import FacePanels, FacePlanes, face_panels
from .plane_fit import PlaneFit

_TOLERANCE = 3e-2
"""Error of boundary functions that are not linear, at which their panels are divided no more."""


class BoundaryFit:
    """Harmonic coordinates of a cage.

    Args:
        cage: The cage.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        panel_size: Greatest length of panels in space, relative to half of the longest side of the cage's bounding box.
        device: Where to compute.
        known: Boundary functions of faces, by their corners; those that were missing are added.
    """

    def __init__(
        self,
        cage: Cage,
        *,
        quads: str,
        panel_size: float,
        device: wp.context.Device,
        known: dict[bytes, FaceValues] | None = None,
    ) -> None:
        self.cage = cage
        self.frame = UnitFrame.of(cage.vertices)
        self._known = {} if known is None else known
        self._quads, self._device = quads, device
        self._columns = [np.flatnonzero(cage.vertex_piece == piece) for piece in range(cage.piece_count)]
        if cage.dimension == 2:
            self._fits = [self._plane_fit_of(piece) for piece in range(cage.piece_count)]
            return
        planes = FacePlanes(cage, self.frame)
        panels = face_panels(cage, self.frame, planes, panel_size)
        values = [self._values_of(planes.polygon(face)) for face in range(cage.face_count)]
        self._fits = [self._fit_of(piece, planes, panels, values) for piece in range(cage.piece_count)]

    def _plane_fit_of(self, piece: int) -> PlaneFit:
        segments = np.array(self.cage.faces)[self.cage.face_piece == piece]
        local = np.searchsorted(self._columns[piece], segments)
        edges = self.frame.to_unit(self.cage.vertices)[segments]
        return PlaneFit(edges, local, len(self._columns[piece]), self._device)

    def _values_of(self, polygon: np.ndarray) -> FaceValues:
        key = self._quads.encode() + polygon.tobytes()
        if key not in self._known:
            self._known[key] = face_values(polygon, quads=self._quads, device=self._device)
        return self._known[key]

    def _fit_of(self, piece: int, planes: FacePlanes, panels: FacePanels, values: list[FaceValues]) -> DensityFit:
        own = self.cage.face_piece[panels.face] == piece
        used = np.flatnonzero(own & panels.charged)
        _, nodes = np.unique(panels.nodes[used], return_inverse=True)
        charges = ChargePanels(panels.corners[used], nodes.reshape(-1, 3))
        points = charges.test_points
        known = np.zeros((*points.shape[:2], len(self._columns[piece])))
        parts = []
        for face in np.flatnonzero(self.cage.face_piece == piece).tolist():
            loop = np.searchsorted(self._columns[piece], self.cage.faces[face])
            at = np.flatnonzero(panels.face[used] == face)
            if len(at):
                place = planes.to_plane(face, points[at]).reshape(-1, 2)
                found = values[face](place).reshape(len(at), points.shape[1], -1)
                for k, column in enumerate(loop.tolist()):
                    known[at, :, column] += found[:, :, k]
            parts.append(self._dipoles_of(face, planes, panels, values[face], loop))
        corners, counts, columns, densities = (np.concatenate(part) for part in zip(*parts))
        start = np.concatenate([[0], np.cumsum(counts)])
        return DensityFit(charges, DipolePanels(corners, start, columns, densities), known, self._device)

    def _dipoles_of(
        self, face: int, planes: FacePlanes, panels: FacePanels, values: FaceValues, loop: np.ndarray
    ) -> tuple[np.ndarray, ...]:
        """Corners of a face's panels with known densities, items of each, and their columns and densities."""
        if len(loop) == 3:
            corners, density = planes.polygon(face)[None], np.eye(3)[None]
        else:
            own = panels.corners[(panels.face == face) & panels.valued]
            corners, density = projected(values, planes.to_plane(face, own), _TOLERANCE)
        items = np.swapaxes(density, 1, 2).reshape(-1, 3)
        counts = np.full(len(corners), len(loop))
        return planes.to_space(face, corners), counts, np.tile(loop, len(corners)), items

    def values(self, points: np.ndarray, piece: np.ndarray) -> np.ndarray:
        """Weights of points inside.

        Args:
            points: Rest positions [m], shape (point_count, dimension).
            piece: Piece of the cage that each lies in, shape (point_count,).

        Returns:
            Weights, shape (point_count, cage.vertex_count); those of vertices of other pieces are 0.
        """
        out = np.zeros((len(points), self.cage.vertex_count))
        unit = self.frame.to_unit(points)
        for own, fit, columns in self._by_piece(piece):
            out[np.ix_(own, columns)] = fit.values(unit[own])
        return out

    def gradients(self, points: np.ndarray, piece: np.ndarray) -> np.ndarray:
        """Gradients of the weights [1/m], shape (point_count, cage.vertex_count, dimension); see ``values``."""
        out = np.zeros((len(points), self.cage.vertex_count, self.cage.dimension))
        unit = self.frame.to_unit(points)
        for own, fit, columns in self._by_piece(piece):
            out[np.ix_(own, columns)] = fit.gradients(unit[own]) / self.frame.half_side
        return out

    def _by_piece(self, piece: np.ndarray) -> list[tuple[np.ndarray, DensityFit | PlaneFit, np.ndarray]]:
        """Points, fit and columns of each piece that has points."""
        groups = [np.flatnonzero(piece == number) for number in range(len(self._fits))]
        return [(own, fit, columns) for own, fit, columns in zip(groups, self._fits, self._columns) if len(own)]
