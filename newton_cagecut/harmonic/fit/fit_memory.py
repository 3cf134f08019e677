# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What fits of a cage keep for those of its edits: all of it follows from what it is kept by, and speeds up alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import warp as wp

from .face_values import FaceFunctions
from .layers.density_fit import DensityFit
from .layers.galerkin import Galerkin
from .layers.sheets import Sheet
from .layers.sites import SheetSites
from .layers.spans import in_spans
from .panels.face_panels import PanelParts
from .residual_sums import NODES

INWARD = 1e-9
"""How far inside of a face its residual is evaluated, in the unit frame: there the fit is finite and of its side.

Farther off, residuals at the end of a slit would not be those on it, and what walks make of them would be biased.
"""


@dataclass(frozen=True, eq=False)
class FaceSheet:
    """The sheet of a face and what else its panels tell.

    Args:
        sheet: The sheet.
        cells: Panels on which its densities are linear, in the unit frame, shape (cell_count, 3, 3).
        functions: Boundary functions of the face.
        outward: Its normal.
        to_plane: From points of the frame, shape (n, 3), to its plane, shape (n, 2).
    """

    sheet: Sheet
    cells: np.ndarray
    functions: FaceFunctions
    outward: np.ndarray
    to_plane: Callable[[np.ndarray], np.ndarray]

    @property
    def site_points(self) -> np.ndarray:
        """Points of the cells at which what the fit leaves over is evaluated, shape (cell_count, site_count, 3)."""
        hats = NODES[3]
        return sum(hats[:, k, None] * self.cells[:, None, k] for k in range(3))

    @cached_property
    def sites(self) -> np.ndarray:
        """These points a little inside, in whole spans, shape (n, 3)."""
        return in_spans((self.site_points - INWARD * self.outward).reshape(-1, 3))


class FitMemory:
    """Functions, sheets and integrals of the last fit.

    Args:
        dimension: Dimension of the space.
        device: Where the fits are.
    """

    def __init__(self, dimension: int, device: wp.context.Device) -> None:
        self.functions: dict[bytes, FaceFunctions] = {}
        self.faces: dict[bytes, FaceSheet] = {}
        self.galerkin = Galerkin(dimension, device)
        self.sites = SheetSites(dimension, device)
        self.fits: list[DensityFit] = []
        self.panels: PanelParts = {}
        self._on_face: dict[FaceSheet, np.ndarray] = {}

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return self.galerkin.byte_count + self.sites.rows.byte_count

    def on_faces(self, faces: list[FaceSheet]) -> list[np.ndarray]:
        """Boundary functions of faces at their sites, shape (cell_count, site_count, corner_count) each."""
        new = [face for face in faces if face not in self._on_face]
        points = [face.to_plane(face.site_points).reshape(-1, 2) for face in new]
        values = FaceFunctions.values([face.functions for face in new], points)
        found = dict(zip(new, values))
        self._on_face = {face: self._on_face.get(face, found.get(face)) for face in faces}
        return [
            self._on_face[face].reshape(len(face.cells), len(NODES[3]), face.functions.corner_count) for face in faces
        ]
