# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The harmonic coordinates of a cage, cut or not, by a fit: no walks, and an error that falls with the panels' size."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...cage import Cage
from ..walls.frame import UnitFrame
from .exactness import affine_frames, make_exact, make_slopes_exact
from .face_dipoles import FaceFunctions
from .layers.density_fit import ChargePanels, DensityFit, DipolePanels
from .panels.face_panels import FacePanels, FacePlanes, affordable_panels
from .plane_fit import PlaneFit

_TOLERANCE = 3e-2
"""Error of boundary functions that are not linear, at which their panels are divided no more."""
_PANEL_SIZE = 0.6
_INWARD = 1e-6
"""How far inside of a face gradients on it are taken, in the unit frame: there they are finite and of its side."""


class BoundaryFit:
    """Harmonic coordinates of a cage.

    Args:
        cage: The cage.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        device: Where to compute.
        panel_size: Greatest length of panels in space, relative to half of the longest side of the cage's bounding box.
        known: Boundary functions of faces, by their corners, of an earlier fit; replaced by those of this one.
    """

    def __init__(
        self,
        cage: Cage,
        *,
        quads: str,
        device: wp.context.Device,
        panel_size: float = _PANEL_SIZE,
        known: dict[bytes, FaceFunctions] | None = None,
    ) -> None:
        self.cage = cage
        self.frame = UnitFrame.of(cage.vertices)
        self._quads, self._device = quads, device
        self._columns = [np.flatnonzero(cage.vertex_piece == piece) for piece in range(cage.piece_count)]
        self._affine = affine_frames(cage, self.frame, device)
        if cage.dimension == 2:
            self._fits = [self._plane_fit_of(piece) for piece in range(cage.piece_count)]
            return
        self._planes = FacePlanes(cage, self.frame)
        self._functions = self._face_functions({} if known is None else known)
        panels = affordable_panels(cage, self.frame, self._planes, panel_size)
        self._cells: dict[int, np.ndarray] = {}
        self._fits = [self._fit_of(piece, panels) for piece in range(cage.piece_count)]

    def _face_functions(self, known: dict[bytes, FaceFunctions]) -> list[FaceFunctions]:
        """Boundary functions of all faces, those that are known already and others."""
        polygons = [self._planes.polygon(face) for face in range(self.cage.face_count)]
        keys = [self._quads.encode() + polygon.tobytes() for polygon in polygons]
        found = {}
        for key, polygon in zip(keys, polygons):
            if key not in found:
                found[key] = known.get(key) or FaceFunctions(polygon, quads=self._quads, device=self._device)
        known.clear()
        known.update(found)
        return [found[key] for key in keys]

    def _plane_fit_of(self, piece: int) -> PlaneFit:
        segments = np.array(self.cage.faces)[self.cage.face_piece == piece]
        local = np.searchsorted(self._columns[piece], segments)
        edges = self.frame.to_unit(self.cage.vertices)[segments]
        return PlaneFit(edges, local, len(self._columns[piece]), self._device)

    def _fit_of(self, piece: int, panels: FacePanels) -> DensityFit:
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
                place = self._planes.to_plane(face, points[at]).reshape(-1, 2)
                found = self._functions[face].at(place).reshape(len(at), points.shape[1], -1)
                for k, column in enumerate(loop.tolist()):
                    known[at, :, column] += found[:, :, k]
            parts.append(self._dipoles_of(face, panels, loop))
        corners, counts, columns, densities = (np.concatenate(part) for part in zip(*parts))
        start = np.concatenate([[0], np.cumsum(counts)])
        return DensityFit(charges, DipolePanels(corners, start, columns, densities), known, self._device)

    def _dipoles_of(self, face: int, panels: FacePanels, loop: np.ndarray) -> tuple[np.ndarray, ...]:
        """Corners of a face's panels with known densities, items of each, and their columns and densities."""
        own = panels.corners[(panels.face == face) & panels.valued]
        if len(loop) == 3:
            corners, density = self._planes.polygon(face)[None], np.eye(3)[None]
            self._cells[face] = own
        else:
            corners, density = self._functions[face].projected(self._planes.to_plane(face, own), _TOLERANCE)
            self._cells[face] = self._planes.to_space(face, corners)
        items = np.swapaxes(density, 1, 2).reshape(-1, 3)
        counts = np.full(len(corners), len(loop))
        return self._planes.to_space(face, corners), counts, np.tile(loop, len(corners)), items

    def weights(self, points: np.ndarray, piece: np.ndarray, face: np.ndarray | None = None) -> np.ndarray:
        """Weights that add up to 1 and reproduce the points, to rounding.

        Args:
            points: Rest positions inside or on faces [m], shape (point_count, dimension).
            piece: Piece of the cage that each lies in, shape (point_count,).
            face: Face that a point lies on, -1 for those inside; by default all are. Shape (point_count,).

        Returns:
            Weights, shape (point_count, cage.vertex_count); those of vertices of other pieces are 0.
        """
        face = np.full(len(points), -1) if face is None else face
        inside = np.where(face < 0, piece, -1)
        out = self.values(points, inside) + self.boundary(points, face)
        return make_exact(self._affine, self.frame.to_unit(points), inside, out)

    def exact(self, points: np.ndarray, piece: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Weights of points inside made exact: see ``weights``. Those of piece -1 stay as they are."""
        return make_exact(self._affine, self.frame.to_unit(points), piece, weights)

    def boundary(self, points: np.ndarray, face: np.ndarray) -> np.ndarray:
        """Boundary functions at points of faces, 0 for those on face -1, shape (point_count, cage.vertex_count)."""
        out = np.zeros((len(points), self.cage.vertex_count))
        unit = self.frame.to_unit(points)
        for number in np.unique(face[face >= 0]).tolist():
            own = np.flatnonzero(face == number)
            found = self._on_face(number, unit[own])
            for k, column in enumerate(self.cage.faces[number]):
                out[own, column] += found[:, k]
        return out

    def outward(self, face: np.ndarray) -> np.ndarray:
        """Unit normals of faces, out of the body, shape (n, dimension)."""
        vector = self.cage.mesh.face_area_vector
        return (vector / np.sqrt((vector**2).sum(axis=1, keepdims=True)))[face]

    def panels(self) -> tuple[np.ndarray, np.ndarray]:
        """Panels of the faces on which the fit's densities are linear, for tables on them.

        Returns:
            Corners [m], shape (panel_count, dimension, dimension), and the face of each panel, ascending.
        """
        if self.cage.dimension == 2:
            corners, face = zip(*(fit.panels() for fit in self._fits))
            face = [np.flatnonzero(self.cage.face_piece == piece)[own] for piece, own in enumerate(face)]
        else:
            corners = [self._cells[face] for face in range(self.cage.face_count)]
            face = [np.full(len(own), number) for number, own in enumerate(corners)]
        corners, face = np.concatenate(corners), np.concatenate(face)
        order = np.argsort(face, kind="stable")
        return corners[order] * self.frame.half_side + self.frame.center, face[order]

    def slopes(self, points: np.ndarray, piece: np.ndarray, face: np.ndarray | None = None) -> np.ndarray:
        """Gradients of the weights [1/m] that keep rigid motions free, shape (point_count, vertex_count, dimension).

        Args:
            points: Rest positions [m], shape (point_count, dimension).
            piece: See ``weights``.
            face: See ``weights``; there the gradient is that a little inside.
        """
        if face is not None:
            inward = np.where(face >= 0, -_INWARD * self.frame.half_side, 0.0)
            points = points + inward[:, None] * self.outward(face)
        slopes = self.gradients(points, piece) * self.frame.half_side
        return make_slopes_exact(self._affine, piece, slopes) / self.frame.half_side

    def _on_face(self, face: int, unit: np.ndarray) -> np.ndarray:
        """Boundary functions at points of a face, shape (point_count, corner_count)."""
        if self.cage.dimension == 3:
            return self._functions[face].values(self._planes.to_plane(face, unit))
        start, end = self.frame.to_unit(self.cage.vertices[list(self.cage.faces[face])])
        share = ((unit - start) * (end - start)).sum(axis=1) / ((end - start) ** 2).sum()
        return np.stack([1.0 - share, share], axis=1)

    def values(self, points: np.ndarray, piece: np.ndarray) -> np.ndarray:
        """The weights of points inside as the layers give them; see ``weights``. Those of piece -1 are 0."""
        out = np.zeros((len(points), self.cage.vertex_count))
        unit = self.frame.to_unit(points)
        for own, fit, columns in self._by_piece(piece):
            out[np.ix_(own, columns)] = fit.values(unit[own])
        return out

    def gradients(self, points: np.ndarray, piece: np.ndarray) -> np.ndarray:
        """The gradients [1/m] of points inside as the layers give them; see ``slopes``."""
        out = np.zeros((len(points), self.cage.vertex_count, self.cage.dimension))
        unit = self.frame.to_unit(points)
        for own, fit, columns in self._by_piece(piece):
            out[np.ix_(own, columns)] = fit.gradients(unit[own]) / self.frame.half_side
        return out

    def _by_piece(self, piece: np.ndarray) -> list[tuple[np.ndarray, DensityFit | PlaneFit, np.ndarray]]:
        """Points, fit and columns of each piece that has points."""
        groups = [np.flatnonzero(piece == number) for number in range(len(self._fits))]
        return [(own, fit, columns) for own, fit, columns in zip(groups, self._fits, self._columns) if len(own)]
