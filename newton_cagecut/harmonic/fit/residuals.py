# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a fit leaves over of the boundary functions, as tables on the faces that landings of walks are looked up in.

The mean of the residual over the landings of a point's walks is the error of the fit at the point, whatever the fit is:
walks make it unbiased and say how far off it is, and few are enough, since the residual is small. Evaluating the fit at
every landing would cost more than the walk; on each panel the residual is taken as the quadratic function through its
values at a few inner points.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from ..walls.frame import UnitFrame
from .boundary_fit import BoundaryFit
from .layers.products import LANE, WIDTH, lane_count
from .residual_sums import NODES, TERMS, ResidualCell, ResidualTable


def _terms(hats: np.ndarray) -> np.ndarray:
    """Squares, then products of hat functions and the next ones, shape (n, term_count)."""
    products = hats * np.roll(hats, -1, axis=1)
    return np.concatenate([hats**2, products[:, : TERMS[hats.shape[1]] - hats.shape[1]]], axis=1)


def build_residuals(fit: BoundaryFit, frame: UnitFrame, device: wp.context.Device) -> ResidualTable:
    """Evaluate what a fit leaves over.

    Args:
        fit: The fit.
        frame: The unit frame of the walks, that of the cage before any edit.
        device: Where to put the table.
    """
    cage = fit.cage
    corners, face = fit.panels()
    hats = NODES[cage.dimension]
    residual = fit.residuals(hats)
    inverse = np.linalg.inv(_terms(hats))
    terms = np.zeros((len(face), len(hats), lane_count(cage.vertex_count) * WIDTH))
    terms[:, :, : cage.vertex_count] = np.einsum("kn,cnv->ckv", inverse, residual)
    table = ResidualTable()
    start = np.searchsorted(face, np.arange(cage.face_count + 1))
    table.start = wp.array(start.astype(np.int32), dtype=wp.int32, device=device)
    table.cells = wp.array(_cells(fit, frame, corners, face), dtype=ResidualCell, device=device)
    table.terms = wp.array(terms.reshape(-1, terms.shape[2] // WIDTH, WIDTH), dtype=LANE, device=device)
    return table


def _cells(fit: BoundaryFit, frame: UnitFrame, corners: np.ndarray, face: np.ndarray) -> np.ndarray:
    """Panels as affine functions of the coordinates in their walls' planes."""
    cage = fit.cage
    walls = [cage.walls[wall] for wall in cage.face_wall]
    origin = np.array([frame.to_unit(wall.origin) for wall in walls])[face]
    axes = np.array([wall.axes for wall in walls])[face]
    offset = frame.to_unit(corners) - origin[:, None]
    place = np.stack([(offset * axes[:, None, k]).sum(axis=2) for k in range(axes.shape[1])], axis=2)
    rows = np.zeros(len(face), dtype=ResidualCell.numpy_dtype())
    if cage.dimension == 2:
        step = 1.0 / (place[:, 1, 0] - place[:, 0, 0])
        slope = np.stack([-step, step], axis=1)
        rows["slope"][:, :2, 0] = slope
        rows["base"][:, :2] = [1.0, 0.0] - slope * place[:, :1, 0]
        return rows
    first, second = place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    slope = np.zeros((len(face), 3, 2))
    slope[:, 1] = np.stack([second[:, 1], -second[:, 0]], axis=1) / area[:, None]
    slope[:, 2] = np.stack([-first[:, 1], first[:, 0]], axis=1) / area[:, None]
    slope[:, 0] = -slope[:, 1] - slope[:, 2]
    rows["slope"] = slope
    rows["base"] = [1.0, 0.0, 0.0] - (slope * place[:, :1]).sum(axis=2)
    return rows
