# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What walks say of a fit: the mean of what it leaves over where they landed, for weights and for gradients.

The mean for a weight is taken whole: it is unbiased, and its noise is known. That for a gradient is d / r times as
noisy as the residual, r being the distance to the walls, while the fit's gradient inside is smoother than its values on
the boundary: there few walks would add more noise than they take away error. So a point's correction c is shrunk
towards 0 by the factor 1 - 2 s / c.c, where s is the sum of its squared standard errors, and left out where that is
below 0 (James and Stein 1961): what does not stand out of the noise is held back, and with more walks the factor goes
to 1. It depends on the point's own walks alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ..faces.face_tables import FaceTables
from ..fit.layers.products import WIDTH
from ..fit.residual_sums import ResidualSums, ResidualTable, empty_sums, make_residual_kernel
from ..launch import launch
from ..options import WalkOptions
from ..walks.query_points import QueryPoints
from ..walks.records import WalkRecords
from ..walls.frame import UnitFrame

_HELD_BACK = wp.constant(wp.float64(2.0))
"""Times the squared noise that a squared correction has to stand out by."""
_SHORTEST_RADIUS = wp.constant(4.0)
"""Least first radius that the gradient's estimator divides by, times the number of walks, in the unit frame."""

wp.set_module_options({"enable_backward": False})


@wp.func
def _excess(out: ResidualSums, i: int, j: int, walks: wp.float64) -> wp.vec3d:
    """Mean over the walks of a vertex's residual, less its own mean, times the direction."""
    lane = j // WIDTH
    k = j % WIDTH
    flux = wp.vec3d(out.flux_x[i, lane][k], out.flux_y[i, lane][k], out.flux_z[i, lane][k])
    return (flux - out.sums[i, lane][k] / walks * out.directions[i]) / (walks - wp.float64(1.0))


@wp.kernel(enable_backward=False)
def _correct_slopes(
    offset: int,
    rows: wp.array[wp.int32],
    piece: wp.array[wp.int32],
    points: QueryPoints,
    walk_count: int,
    dimension: int,
    half_side: float,
    out: ResidualSums,
    slopes: wp.array3d[wp.float64],
):
    i = offset + wp.tid()
    if piece[i] < 0:
        return
    walks = wp.float64(walk_count)
    radius = wp.max(points.first_radius[rows[i]], _SHORTEST_RADIUS / float(walk_count))
    noise = wp.float64(0.0)
    squared = wp.float64(0.0)
    for j in range(slopes.shape[1]):
        mean = out.sums[i, j // WIDTH][j % WIDTH] / walks
        spread = out.squares[i, j // WIDTH][j % WIDTH] / walks - mean * mean
        noise += wp.max(spread, wp.float64(0.0)) / (walks - wp.float64(1.0))
        squared += wp.length_sq(_excess(out, i, j, walks))
    if squared <= _HELD_BACK * noise:
        return
    scale = (wp.float64(1.0) - _HELD_BACK * noise / squared) * wp.float64(float(dimension) / (radius * half_side))
    for j in range(slopes.shape[1]):
        correction = scale * _excess(out, i, j, walks)
        for axis in range(dimension):
            slopes[i, j, axis] = slopes[i, j, axis] + correction[axis]


@dataclass(frozen=True, eq=False)
class WalkedResiduals:
    """What corrects a fit: its residuals, and where walks have landed.

    Args:
        table: Residuals on the faces.
        faces: The faces.
        records: Landings of the walks, of which the faces are known.
        options: Options of the walks, of which there is one at least.
        first_point: The point whose walks are the first of the records.
    """

    table: ResidualTable
    faces: FaceTables
    records: WalkRecords
    options: WalkOptions
    first_point: int

    @property
    def walks(self) -> int:
        """Walks a point."""
        return self.options.walks

    def sums(self, indices: np.ndarray, vertex_count: int) -> tuple[np.ndarray, np.ndarray]:
        """Sums of the residuals at the landings of points, and of their squares, shape (n, vertex_count) each."""
        rows = wp.array(indices.astype(np.int32), dtype=wp.int32, device=self.records.device)
        found = self._summed(rows, slopes=False)
        return tuple(each.numpy().reshape(len(indices), -1)[:, :vertex_count] for each in (found.sums, found.squares))

    def corrected_slopes(
        self, indices: np.ndarray, piece: np.ndarray, slopes: np.ndarray, points: QueryPoints, frame: UnitFrame
    ) -> np.ndarray:
        """Gradients of a fit with what walks say of them, as far as it stands out of its noise.

        Args:
            indices: The points, shape (n,).
            piece: Piece that each lies in, -1 where the gradients are to stay as they are, shape (n,).
            slopes: The fit's gradients [1/m], shape (n, vertex_count, dimension).
            points: All points; their first walks have measured how far they are from the walls.
            frame: The unit frame of the walks.
        """
        if self.walks < 2:
            return slopes
        device = self.records.device
        rows, pieces = (wp.array(each.astype(np.int32), dtype=wp.int32, device=device) for each in (indices, piece))
        found = self._summed(rows, slopes=True)
        corrected = wp.array(slopes, dtype=wp.float64, device=device)
        inputs = [rows, pieces, points, self.walks, self.records.dimension, frame.half_side, found, corrected]
        launch(_correct_slopes, len(indices), inputs, device=device, smallest_chunk=16)
        return corrected.numpy()

    def _summed(self, rows: wp.array, *, slopes: bool) -> ResidualSums:
        """Sums of the residuals of points."""
        device = self.records.device
        out = empty_sums(rows.size, self.table.terms.shape[1], device, slopes=slopes)
        inputs = [rows, self.walks, self.first_point, wp.uint32(self.options.seed), self.faces]
        inputs += [self.records.landings, self.table, out]
        kernel = make_residual_kernel(self.records.dimension, slopes=slopes)
        launch(kernel, rows.size, inputs, device=device, smallest_chunk=16)
        return out
