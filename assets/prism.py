# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Prisms over a plane figure that may have holes, as cages whose side faces are planar whatever their heights."""

from __future__ import annotations

from collections.abc import Sequence

Loop = tuple[int, ...]


def prism_faces(pieces: Sequence[Sequence[int]], corner_count: int, bottom: Sequence[Sequence[int]] = ()) -> list[Loop]:
    """Return the faces of a prism whose corners come twice: first those above, then those below, in the same order.

    Args:
        pieces: Polygons that the figure consists of, counterclockwise seen from above.
        corner_count: Corners of the figure.
        bottom: Those below, where they differ, also counterclockwise seen from above.

    Returns:
        The pieces above, those below, and a quad for each edge of a piece that no other piece shares.
    """
    edges = [(a, b) for piece in pieces for a, b in zip(piece, (*piece[1:], piece[0]))]
    shared = {(b, a) for a, b in edges}
    below = [tuple(corner_count + v for v in reversed(piece)) for piece in bottom or pieces]
    sides = [(b, a, corner_count + a, corner_count + b) for a, b in edges if (a, b) not in shared]
    return [tuple(piece) for piece in pieces] + below + sides


def split_quads(faces: Sequence[Loop]) -> list[Loop]:
    """Return faces with each quad cut into two triangles."""
    halves = [[face] if len(face) != 4 else [face[:3], (face[0], *face[2:])] for face in faces]
    return [half for pair in halves for half in pair]
