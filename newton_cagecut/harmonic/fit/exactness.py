# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The least change after which weights add up to 1 and reproduce positions, and gradients keep rigid motions free."""

from __future__ import annotations

import numpy as np

from ...cage import Cage
from ..walls.frame import UnitFrame


def make_exact(
    cage: Cage, points: np.ndarray, piece: np.ndarray, weights: np.ndarray, gradients: np.ndarray | None = None
) -> None:
    """Correct weights and gradients in place, each by vertices of the point's own piece (paper, equation 5).

    Args:
        cage: The cage.
        points: Rest positions [m], shape (point_count, dimension).
        piece: Piece that each lies in, shape (point_count,).
        weights: Weights, shape (point_count, cage.vertex_count).
        gradients: Their gradients [1/m], shape (point_count, cage.vertex_count, dimension).
    """
    frame = UnitFrame.of(cage.vertices)
    for number in range(cage.piece_count):
        own = np.flatnonzero(piece == number)
        columns = np.flatnonzero(cage.vertex_piece == number)
        vertices = frame.to_unit(cage.vertices[columns])
        center = vertices.mean(axis=0)
        affine = np.concatenate([np.ones((1, len(columns))), (vertices - center).T])
        spread = np.linalg.inv(np.einsum("av,bv->ab", affine, affine))
        spread = np.einsum("ab,bv->av", spread, affine)
        target = np.concatenate([np.ones((len(own), 1)), frame.to_unit(points[own]) - center], axis=1)
        for _ in range(2):  # the second time for what the first one has rounded off
            missing = target - np.einsum("pv,av->pa", weights[np.ix_(own, columns)], affine)
            weights[np.ix_(own, columns)] += np.einsum("pa,av->pv", missing, spread)
            if gradients is not None:
                slopes = np.eye(cage.dimension + 1)[1:] / frame.half_side
                for axis, slope in enumerate(slopes):
                    place = np.ix_(own, columns, [axis])
                    missing = slope - np.einsum("pv,av->pa", gradients[place][..., 0], affine)
                    gradients[place] += np.einsum("pa,av->pv", missing, spread)[..., None]
