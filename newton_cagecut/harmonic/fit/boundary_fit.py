# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The harmonic coordinates of a cage, cut or not, by a fit: no walks, and an error that falls with the panels' size."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...cage import Cage
from ..walls.frame import UnitFrame
from .exactness import affine_frames, make_exact, make_slopes_exact
from .face_sheets import face_sheets
from .face_values import FaceFunctions
from .fit_memory import INWARD, FaceSheet, FitMemory
from .layers.density_fit import DensityFit
from .layers.sheets import SheetBatch
from .layers.spans import SPAN
from .panels.face_panels import FacePanels, FacePlanes, affordable_panels
from .plane_fit import PlaneFit
from .point_rows import PointRows
from .residual_sums import NODES

_PANEL_SIZE = 0.6
_SLOPES_INWARD = 1e-6
"""How far inside of a face its gradients are evaluated, in the unit frame."""


class BoundaryFit:
    """Harmonic coordinates of a cage.

    Args:
        cage: The cage.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        device: Where to compute.
        panel_size: Greatest length of panels in space, relative to half of the longest side of the cage's bounding box.
        memory: What earlier fits have kept; this one leaves there what it has.
    """

    def __init__(
        self,
        cage: Cage,
        *,
        quads: str,
        device: wp.context.Device,
        panel_size: float = _PANEL_SIZE,
        memory: FitMemory | None = None,
    ) -> None:
        self.cage = cage
        self.frame = UnitFrame.of(cage.vertices)
        self._quads, self._device = quads, device
        self._columns = [np.flatnonzero(cage.vertex_piece == piece) for piece in range(cage.piece_count)]
        self._affine = affine_frames(cage, self.frame, device)
        if cage.dimension == 2:
            self._fits = [self._plane_fit_of(piece) for piece in range(cage.piece_count)]
            return
        self.memory = FitMemory(3, device) if memory is None else memory
        self._planes = FacePlanes(cage, self.frame)
        panels = affordable_panels(cage, self.frame, self._planes, panel_size, self.memory.panels)
        functions = self._face_functions()
        self._faces = self._face_sheets(panels, functions)
        self._order = [self._ordered(piece, panels) for piece in range(cage.piece_count)]
        self.batch = SheetBatch([self._faces[face].sheet for order in self._order for face in order], device)
        self.sheet_piece = np.repeat(np.arange(cage.piece_count), [len(order) for order in self._order])
        self.memory.galerkin.bring(self.batch, self.sheet_piece)
        earlier = self.memory.fits
        self._fits = [self._fit_of(piece, earlier) for piece in range(cage.piece_count)]
        self.memory.fits = self._fits

    def _face_functions(self) -> list[FaceFunctions]:
        """Boundary functions of all faces, those that are known already and others."""
        polygons = [self._planes.polygon(face) for face in range(self.cage.face_count)]
        self._polygon_keys = [self._quads.encode() + polygon.tobytes() for polygon in polygons]
        known, found = self.memory.functions, {}
        for key, polygon in zip(self._polygon_keys, polygons):
            if key not in found:
                found[key] = known.get(key) or FaceFunctions(polygon, quads=self._quads)
        functions = [found[key] for key in self._polygon_keys]
        FaceFunctions.make_fits(functions, self._device)
        return functions

    def _face_sheets(self, panels: FacePanels, functions: list[FaceFunctions]) -> list[FaceSheet]:
        """The sheets of all faces, those that are known already and others."""
        ends = np.searchsorted(panels.face, np.arange(self.cage.face_count + 1))
        groups = [np.arange(first, last) for first, last in zip(ends[:-1], ends[1:])]
        keys = []
        for face, (first, last) in enumerate(zip(ends[:-1], ends[1:])):
            own = slice(first, last)
            parts = (panels.corners[own], panels.nodes[own], panels.charged[own], panels.valued[own])
            parts = (*parts, self._planes.origin[face], self._planes.axes[face])
            keys.append(self._polygon_keys[face] + b"".join(part.tobytes() for part in parts))
        known = self.memory.faces
        new = [face for face, key in enumerate(keys) if key not in known]
        made = face_sheets(self._planes, new, [functions[face] for face in new], panels, groups)
        found = {keys[face]: own for face, own in zip(new, made)}
        faces = {key: known.get(key) or found[key] for key in keys}
        self.memory.functions, self.memory.faces = dict(zip(self._polygon_keys, functions)), faces
        self._functions = functions
        return [faces[key] for key in keys]

    def _ordered(self, piece: int, panels: FacePanels) -> list[int]:
        """Faces of a piece; those that a step of a cut is likely to change come last."""
        own = np.flatnonzero(self.cage.face_piece == piece)
        return own[np.lexsort((own, panels.rank[own]))].tolist()

    def _fit_of(self, piece: int, earlier: list[DensityFit]) -> DensityFit:
        order = self._order[piece]
        sheets = [self._faces[face].sheet for face in order]
        columns = [np.searchsorted(self._columns[piece], self.cage.faces[face]) for face in order]
        # The earlier fit that starts with the same sheet has most in common.
        like = next((fit for fit in earlier if fit.sheets[0] is sheets[0]), None)
        return DensityFit(sheets, columns, len(self._columns[piece]), self.memory.galerkin, earlier=like)

    def _plane_fit_of(self, piece: int) -> PlaneFit:
        segments = np.array(self.cage.faces)[self.cage.face_piece == piece]
        local = np.searchsorted(self._columns[piece], segments)
        edges = self.frame.to_unit(self.cage.vertices)[segments]
        return PlaneFit(edges, local, len(self._columns[piece]), self._device)

    def weights(
        self, points: np.ndarray, piece: np.ndarray, face: np.ndarray | None = None, *, rows: PointRows | None = None
    ) -> np.ndarray:
        """Weights that add up to 1 and reproduce the points, to rounding.

        Args:
            points: Rest positions inside or on faces [m], shape (point_count, dimension).
            piece: Piece of the cage that each lies in, shape (point_count,).
            face: Face that a point lies on, -1 for those inside; by default all are. Shape (point_count,).
            rows: Layers at the points that are kept, if any.

        Returns:
            Weights, shape (point_count, cage.vertex_count); those of vertices of other pieces are 0.
        """
        face = np.full(len(points), -1) if face is None else face
        inside = np.where(face < 0, piece, -1)
        out = self.values(points, inside, rows) + self.boundary(points, face)
        return make_exact(self._affine, self.frame.to_unit(points), inside, out)

    def exact(self, points: np.ndarray, piece: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Weights of points inside made exact: see ``weights``. Those of piece -1 stay as they are."""
        return make_exact(self._affine, self.frame.to_unit(points), piece, weights)

    def boundary(self, points: np.ndarray, face: np.ndarray) -> np.ndarray:
        """Boundary functions at points of faces, 0 for those on face -1, shape (point_count, cage.vertex_count)."""
        out = np.zeros((len(points), self.cage.vertex_count))
        unit = self.frame.to_unit(points)
        numbers = np.unique(face[face >= 0]).tolist()
        own = [np.flatnonzero(face == number) for number in numbers]
        for number, rows, found in zip(numbers, own, self._on_faces(numbers, [unit[rows] for rows in own])):
            for k, column in enumerate(self.cage.faces[number]):
                out[rows, column] += found[:, k]
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
            corners, face = zip(*(fit.outline.panels() for fit in self._fits))
            face = [np.flatnonzero(self.cage.face_piece == piece)[own] for piece, own in enumerate(face)]
            corners, face = np.concatenate(corners), np.concatenate(face)
            order = np.argsort(face, kind="stable")
            corners, face = corners[order], face[order]
        else:
            cells = [own.cells for own in self._faces]
            corners, face = np.concatenate(cells), np.repeat(np.arange(len(cells)), list(map(len, cells)))
        return corners * self.frame.half_side + self.frame.center, face

    def residuals(self, hats: np.ndarray) -> np.ndarray:
        """What the fit leaves over of the boundary functions at points of its panels, a little inside.

        Args:
            hats: Hat functions at the points of a panel, shape (n, dimension).

        Returns:
            Residuals, shape (panel_count, n, cage.vertex_count).
        """
        corners, face = self.panels()
        if self.cage.dimension == 3:
            return self._kept_residuals(len(corners))
        places = sum(hats[:, k, None] * corners[:, None, k] for k in range(2)).reshape(-1, 2)
        return self.residuals_at(places, np.repeat(face, len(hats))).reshape(len(face), len(hats), -1)

    def residuals_at(self, points: np.ndarray, face: np.ndarray) -> np.ndarray:
        """What the fit leaves over at points of faces, put onto these, shape (point_count, cage.vertex_count).

        Args:
            points: Points on faces, but for rounding [m], shape (point_count, dimension).
            face: The face of each, shape (point_count,).
        """
        unit, outward = self.frame.to_unit(points), self.outward(face)
        if self.cage.dimension == 2:
            start = self.frame.to_unit(self.cage.vertices)[np.asarray(self.cage.faces)[face, 0]]
            unit -= ((unit - start) * outward).sum(axis=1, keepdims=True) * outward
        else:
            for number in np.unique(face).tolist():
                own = face == number
                unit[own] = self._planes.to_space(number, self._planes.to_plane(number, unit[own]))
                outward[own] = self._planes.outward[number]
        inside = (unit - INWARD * outward) * self.frame.half_side + self.frame.center
        return self.boundary(points, face) - self.values(inside, self.cage.face_piece[face])

    def _kept_residuals(self, cell_count: int) -> np.ndarray:
        """Residuals in space, from layers that the memory keeps."""
        memory, site_count = self.memory, len(NODES[3])
        order = [face for faces in self._order for face in faces]
        memory.sites.bring(self.batch, self.sheet_piece, [self._faces[face].sites for face in order])
        known = memory.on_faces(self._faces)
        out = np.zeros((cell_count, site_count, self.cage.vertex_count))
        first = np.cumsum([0, *(len(own.cells) for own in self._faces)])
        for number, (fit, columns) in enumerate(zip(self._fits, self._columns)):
            faces = [self._faces[face] for face in self._order[number]]
            count = [len(own.sites) // SPAN for own in faces]
            spans = [memory.sites.first_span(own.sheet) + np.arange(n) for own, n in zip(faces, count)]
            found = fit.evaluated(memory.sites.rows, np.concatenate(spans))
            for face, part in zip(self._order[number], np.split(found, np.cumsum(count)[:-1])):
                own = slice(first[face], first[face + 1])
                count = (first[face + 1] - first[face]) * site_count
                values = part.reshape(-1, part.shape[-1])[:count].reshape(-1, site_count, part.shape[-1])
                out[own, :, columns] = -values
        for face, values in enumerate(known):
            for k, column in enumerate(self.cage.faces[face]):
                out[first[face] : first[face + 1], :, column] += values[:, :, k]
        return out

    def slopes(
        self, points: np.ndarray, piece: np.ndarray, face: np.ndarray | None = None, *, rows: PointRows | None = None
    ) -> np.ndarray:
        """Gradients of the weights [1/m] that keep rigid motions free, shape (point_count, vertex_count, dimension).

        Args:
            points: Rest positions [m], shape (point_count, dimension).
            piece: See ``weights``.
            face: See ``weights``; there the gradient is that a little inside.
            rows: Gradients of layers at the points that are kept, if any.
        """
        if face is not None:
            inward = np.where(face >= 0, -_SLOPES_INWARD * self.frame.half_side, 0.0)
            points = points + inward[:, None] * self.outward(face)
        return self.exact_slopes(piece, self.gradients(points, piece, rows))

    def exact_slopes(self, piece: np.ndarray, slopes: np.ndarray) -> np.ndarray:
        """Gradients [1/m] made exact: see ``slopes``. Those of points of piece -1 stay as they are."""
        side = self.frame.half_side
        return make_slopes_exact(self._affine, piece, slopes * side) / side

    def _on_faces(self, faces: list[int], unit: list[np.ndarray]) -> list[np.ndarray]:
        """Boundary functions of faces at points of theirs, shape (point_count, corner_count) each."""
        if self.cage.dimension == 3:
            places = [self._planes.to_plane(face, points) for face, points in zip(faces, unit)]
            return FaceFunctions.values([self._functions[face] for face in faces], places)
        found = []
        for face, points in zip(faces, unit):
            start, end = self.frame.to_unit(self.cage.vertices[list(self.cage.faces[face])])
            share = ((points - start) * (end - start)).sum(axis=1) / ((end - start) ** 2).sum()
            found.append(np.stack([1.0 - share, share], axis=1))
        return found

    def values(self, points: np.ndarray, piece: np.ndarray, rows: PointRows | None = None) -> np.ndarray:
        """The weights of points inside as the layers give them; see ``weights``. Those of piece -1 are 0."""
        out = np.zeros((len(points), self.cage.vertex_count))
        self._evaluate(points, piece, rows, out)
        return out

    def gradients(self, points: np.ndarray, piece: np.ndarray, rows: PointRows | None = None) -> np.ndarray:
        """The gradients [1/m] of points inside as the layers give them; see ``slopes``."""
        out = np.zeros((len(points), self.cage.vertex_count, self.cage.dimension))
        self._evaluate(points, piece, rows, out, slopes=True)
        return out / self.frame.half_side

    def _evaluate(
        self, points: np.ndarray, piece: np.ndarray, rows: PointRows | None, out: np.ndarray, *, slopes: bool = False
    ) -> None:
        unit = self.frame.to_unit(points)
        if rows is not None:
            rows.bring(self.batch, self.sheet_piece, unit, piece)
        for number, (fit, columns) in enumerate(zip(self._fits, self._columns)):
            own = np.flatnonzero(piece == number)
            if not len(own):
                continue
            if rows is not None:
                out[np.ix_(own, columns)] = rows.evaluated(fit, own)
            elif self.cage.dimension == 2:
                out[np.ix_(own, columns)] = fit.gradients(unit[own]) if slopes else fit.inside(unit[own])
            else:
                out[np.ix_(own, columns)] = fit.at(unit[own], self.batch, slopes=slopes)
