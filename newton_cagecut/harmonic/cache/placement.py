# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Points on their way into a domain: all that is stored of each, worked out before anything is written."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .domain_state import DomainState


@dataclass(frozen=True, eq=False)
class Placement:
    """Points and what is stored of them, a row a point.

    Args:
        indices: Their numbers, shape (n,).
        rest: Rest positions [m], shape (n, dimension).
        positions: Positions in the unit frame, float32, shape (n, 3).
        keys: Keys, shape (n,).
        pieces: Pieces of the cage, -1 on a wall or outside, shape (n,).
    """

    indices: np.ndarray
    rest: np.ndarray
    positions: np.ndarray
    keys: np.ndarray
    pieces: np.ndarray

    @classmethod
    def of(
        cls, state: DomainState, indices: np.ndarray, points: np.ndarray, keys: np.ndarray, *, outside: np.ndarray
    ) -> Placement:
        """Work out what is stored.

        Args:
            state: Walls and faces that the points are among.
            indices: Numbers of the points, shape (n,).
            points: Their rest positions [m], shape (n, dimension).
            keys: Their keys, shape (n,).
            outside: Which of the n lie outside of the cage, within its tolerance.
        """
        pieces = np.full(len(indices), -1, np.int32)
        inner = keys < 0
        pieces[inner] = state.pieces_of(points[inner])
        pieces[outside] = -1
        return cls(indices, points, state.frame.to_space(points), keys, pieces)
