# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The pieces that a cage is in.

Section 5.2 of the paper ends a cut when a piece comes off; here is what belongs to which piece.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .cage import Cage


@dataclass(frozen=True, eq=False)
class CagePiece:
    """One solid piece of a cage: a connected component, with those around cavities and of cuts wholly inside it."""

    vertices: np.ndarray
    """Ids of its vertices, ascending, shape (vertex_count,)."""
    faces: np.ndarray
    """Its faces, ascending, shape (face_count,)."""
    volume: float
    """Its volume, in 2D area, cavities taken off [m^d]."""


def component_piece(cage: Cage) -> np.ndarray:
    """Number of the piece to which each connected component belongs, shape (component_count,).

    Args:
        cage: The cage, which may have been cut.
    """
    volumes = cage.component_volumes
    owner = np.arange(len(volumes))
    outward = cage.mesh.component_outward
    inner = np.flatnonzero(~outward)
    if len(inner):
        first = np.unique(cage.vertex_component, return_index=True)[1][inner]
        number = cage.winding_numbers(cage.vertices[first])
        around = np.where((number > 0.5) & outward, volumes, np.inf)
        owner[inner] = around.argmin(axis=1)
    return np.unique(owner, return_inverse=True)[1].reshape(-1)


def pieces_of(cage: Cage) -> tuple[CagePiece, ...]:
    """The pieces of a cage, in the order of their lowest vertices.

    Args:
        cage: The cage, which may have been cut.
    """
    volume = cage.piece_volumes
    of_vertex, of_face = cage.vertex_piece, cage.face_piece
    return tuple(
        CagePiece(np.flatnonzero(of_vertex == i), np.flatnonzero(of_face == i), float(volume[i]))
        for i in range(len(volume))
    )
