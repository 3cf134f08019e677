# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Weights and gradients of points from the fit of a cage."""

from __future__ import annotations

import numpy as np
import warp as wp

from ..fit.boundary_fit import BoundaryFit
from ..fit.face_lookup import nearest_faces
from ..launch import launch
from ..walks.query_points import QueryPoints
from ..walls.grid import CandidateGrid
from ..walls.nearest_wall import measure_distance
from .fitted_rows import FittedRows
from .point_weights import PointWeights
from .walked_residuals import WalkedResiduals

_NEAR = 1e-5
"""Distance from the walls in the unit frame below which it is measured again, in float64."""
_ON_FACE = 3e-7
"""Distance below which a point lies on a face: more than positions in float32 are rounded off."""
_BATCH = 1 << 13

wp.set_module_options({"enable_backward": False})


@wp.kernel(enable_backward=False)
def _write_weights(
    offset: int,
    rows: wp.array[wp.int32],
    values: wp.array2d[wp.float64],
    weights: wp.array2d[float],
    degrees: wp.array[wp.int32],
    lowest: wp.array[float],
):
    i = offset + wp.tid()
    point = rows[i]
    least = float(0.0)
    for j in range(values.shape[1]):
        weight = float(values[i, j])
        weights[point, j] = weight
        least = wp.min(least, weight)
    lowest[point] = least
    degrees[point] = 0


@wp.kernel(enable_backward=False)
def _write_errors(offset: int, rows: wp.array[wp.int32], values: wp.array2d[wp.float64], errors: wp.array2d[float]):
    i = offset + wp.tid()
    for j in range(values.shape[1]):
        errors[rows[i], j] = float(values[i, j])


@wp.kernel(enable_backward=False)
def _write_gradients(
    offset: int, rows: wp.array[wp.int32], slopes: wp.array2d[wp.vec3], gradients: wp.array2d[wp.vec3]
):
    i = offset + wp.tid()
    for j in range(slopes.shape[1]):
        gradients[rows[i], j] = slopes[i, j]


def resolve_fitted(
    indices: np.ndarray,
    weights: PointWeights,
    points: QueryPoints,
    fit: BoundaryFit,
    grid: CandidateGrid,
    landed: WalkedResiduals | None,
    rows: FittedRows,
) -> None:
    """Read the weights of points, and the gradients of those that have them, from a fit.

    Walks correct the weights by the mean of what the fit leaves over where they have landed, and the gradients inside
    as far as what they say of these stands out of its noise.

    Args:
        indices: The points, shape (n,).
        weights: Where their rows are written.
        points: Where they are.
        fit: The fit of their cage.
        grid: The walls.
        landed: What walks say of the fit; None without walks.
        rows: Layers that are kept.
    """
    device = weights.weights.device
    position, key, piece, gradient_row = (
        array.numpy()[indices] for array in (points.position, points.key, points.piece, points.gradient_row)
    )
    face, piece = _faces(position, key, piece, fit, grid)
    frame = grid.walls.frame
    rest = position[:, : fit.cage.dimension].astype(np.float64) * frame.half_side + frame.center
    for first in range(0, len(indices), _BATCH):
        some = slice(first, first + _BATCH)
        at = wp.array(indices[some].astype(np.int32), dtype=wp.int32, device=device)
        kept = rows.values and rows.values.choose(indices[some])
        found = fit.weights(rest[some], piece[some], face[some], rows=kept)
        if landed is not None:
            inside = np.where(face[some] < 0, piece[some], -1)
            found, errors = _corrected(indices[some], rest[some], inside, found, fit, landed)
            errors = wp.array(errors, dtype=wp.float64, device=device)
            launch(_write_errors, at.size, [at, errors, weights.errors], device=device)
        values = wp.array(found, dtype=wp.float64, device=device)
        inputs = [at, values, weights.weights, weights.degrees, weights.lowest]
        launch(_write_weights, at.size, inputs, device=device)
    sloped = np.flatnonzero(gradient_row >= 0)
    for first in range(0, len(sloped), _BATCH):
        some = sloped[first : first + _BATCH]
        slopes = np.zeros((len(some), fit.cage.vertex_count, 3), dtype=np.float32)
        kept = rows.slopes and rows.slopes.choose(gradient_row[some])
        found = fit.slopes(rest[some], piece[some], face[some], rows=kept)
        if landed is not None:
            inside = np.where(face[some] < 0, piece[some], -1)
            found = fit.exact_slopes(inside, landed.corrected_slopes(indices[some], inside, found, points, frame))
        slopes[..., : fit.cage.dimension] = found
        at = wp.array(gradient_row[some].astype(np.int32), dtype=wp.int32, device=device)
        inputs = [at, wp.array(slopes, dtype=wp.vec3, device=device), weights.gradients]
        launch(_write_gradients, len(some), inputs, device=device)


def _corrected(
    indices: np.ndarray,
    rest: np.ndarray,
    inside: np.ndarray,
    weights: np.ndarray,
    fit: BoundaryFit,
    landed: WalkedResiduals,
) -> tuple[np.ndarray, np.ndarray]:
    """Weights corrected by walks where points lie inside, and their standard errors, which are 0 on faces."""
    sums, squares = landed.sums(indices, weights.shape[1])
    mean = sums / landed.walks
    spread = np.maximum(squares / landed.walks - mean**2, 0.0)
    errors = np.sqrt(spread / max(landed.walks - 1, 1))
    on_face = inside < 0
    mean[on_face] = errors[on_face] = 0.0
    return fit.exact(rest, inside, weights + mean), errors


def _faces(
    position: np.ndarray, key: np.ndarray, piece: np.ndarray, fit: BoundaryFit, grid: CandidateGrid
) -> tuple[np.ndarray, np.ndarray]:
    """The faces on which points lie, -1 for those inside, and the piece of each point."""
    device = grid.walls.device
    distance = wp.empty(len(position), dtype=float, device=device)
    at = wp.array(position, dtype=wp.vec3, device=device)
    launch(measure_distance, len(position), [grid.walls.data, grid.cells, at, distance], device=device)
    face = np.full(len(position), -1, dtype=np.int64)
    near = np.flatnonzero((key >= 0) | (piece < 0) | (distance.numpy() < _NEAR))
    frame, cage = grid.walls.frame, fit.cage
    rest = position[near, : cage.dimension].astype(np.float64) * frame.half_side + frame.center
    found, off = nearest_faces(cage, rest, key[near])
    on = (key[near] >= 0) | (piece[near] < 0) | (off < _ON_FACE * frame.half_side)
    face[near[on]] = found[on]
    return face, np.where(face >= 0, cage.face_piece[face], piece)
