# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The least change after which weights add up to 1 and reproduce positions, and gradients keep rigid motions free."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...cage import Cage
from ...geometry import lifted
from ..launch import launch
from ..walls.frame import UnitFrame

wp.set_module_options({"enable_backward": False})

_ROUNDS = wp.constant(2)
"""Corrections, the second for what the first has rounded off."""


@wp.struct
class AffineFrames:
    """For each piece of a cage the affine functions on its vertices, a row a vertex or a piece.

    ``affine`` holds 1 and a vertex's offset from the middle of its piece, ``inverse`` the inverse of their products'
    sum over the piece, ``center`` the middles.
    """

    affine: wp.array[wp.vec4d]
    piece: wp.array[wp.int32]
    inverse: wp.array[wp.mat44d]
    center: wp.array[wp.vec3d]


def affine_frames(cage: Cage, frame: UnitFrame, device: wp.context.Device) -> AffineFrames:
    """Put the affine functions of a cage's pieces on a device.

    Args:
        cage: The cage.
        frame: The frame of positions.
        device: Where to put them.
    """
    vertices = lifted(frame.to_unit(cage.vertices))
    center, inverse = np.zeros((cage.piece_count, 3)), np.zeros((cage.piece_count, 4, 4))
    affine = np.ones((len(vertices), 4))
    for piece in range(cage.piece_count):
        own = cage.vertex_piece == piece
        center[piece] = vertices[own].mean(axis=0)
        affine[own, 1:] = vertices[own] - center[piece]
        products = sum(np.multiply.outer(row, row) for row in affine[own])
        if cage.dimension == 2:
            products[3, 3] = 1.0  # nothing else is there along the third axis
        inverse[piece] = np.linalg.inv(products)
    frames = AffineFrames()
    frames.affine = wp.array(affine, dtype=wp.vec4d, device=device)
    frames.piece = wp.array(np.asarray(cage.vertex_piece, dtype=np.int32), dtype=wp.int32, device=device)
    frames.inverse = wp.array(inverse, dtype=wp.mat44d, device=device)
    frames.center = wp.array(center, dtype=wp.vec3d, device=device)
    return frames


@wp.func
def _corrected(frames: AffineFrames, row: int, piece: int, target: wp.vec4d, values: wp.array2d[wp.float64]):
    for _round in range(_ROUNDS):
        missing = target
        for j in range(frames.affine.shape[0]):
            if frames.piece[j] == piece:
                missing -= frames.affine[j] * values[row, j]
        missing = frames.inverse[piece] * missing
        for j in range(frames.affine.shape[0]):
            if frames.piece[j] == piece:
                value = values[row, j]
                values[row, j] = value + wp.dot(frames.affine[j], missing)


@wp.kernel(enable_backward=False)
def _correct_values(
    offset: int,
    frames: AffineFrames,
    positions: wp.array[wp.vec3d],
    piece: wp.array[wp.int32],
    values: wp.array2d[wp.float64],
):
    i = offset + wp.tid()
    own = piece[i]
    if own >= 0:
        place = positions[i] - frames.center[own]
        one = wp.float64(1.0)
        _corrected(frames, i, own, wp.vec4d(one, place[0], place[1], place[2]), values)


@wp.kernel(enable_backward=False)
def _correct_slopes(
    offset: int, frames: AffineFrames, dimension: int, piece: wp.array[wp.int32], slopes: wp.array2d[wp.float64]
):
    row = offset + wp.tid()
    own = piece[row // dimension]
    if own >= 0:
        target = wp.vec4d()
        target[1 + row % dimension] = wp.float64(1.0)
        _corrected(frames, row, own, target, slopes)


def make_exact(frames: AffineFrames, positions: np.ndarray, piece: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Weights that add up to 1 and reproduce positions (paper, equation 5).

    Args:
        frames: The affine functions.
        positions: Positions in their frame, shape (point_count, dimension).
        piece: Piece whose vertices are corrected, -1 to leave a point as it is, shape (point_count,).
        values: Weights, shape (point_count, vertex_count).
    """
    device = frames.affine.device
    inputs = [frames, wp.array(lifted(positions), dtype=wp.vec3d, device=device)]
    inputs += [wp.array(piece.astype(np.int32), dtype=wp.int32, device=device)]
    rows = wp.array(values, dtype=wp.float64, device=device)
    launch(_correct_values, len(values), [*inputs, rows], device=device, smallest_chunk=64)
    return rows.numpy()


def make_slopes_exact(frames: AffineFrames, piece: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Gradients that add up to 0 and to the identity with positions.

    Args:
        frames: The affine functions.
        piece: Piece whose vertices are corrected, -1 to leave a point as it is, shape (point_count,).
        slopes: Gradients in the frame, shape (point_count, vertex_count, dimension).
    """
    device, (count, vertices, dimension) = frames.affine.device, slopes.shape
    rows = np.swapaxes(slopes, 1, 2).reshape(count * dimension, vertices)
    rows = wp.array(np.ascontiguousarray(rows), dtype=wp.float64, device=device)
    inputs = [frames, dimension, wp.array(piece.astype(np.int32), dtype=wp.int32, device=device), rows]
    launch(_correct_slopes, count * dimension, inputs, device=device, smallest_chunk=64)
    return np.swapaxes(rows.numpy().reshape(count, dimension, vertices), 1, 2)
