# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The pieces that a body is in: what of its cage and surface, and how much mass, belongs to each.

The weights of a point are zero on every vertex of another piece (paper, section 5.2), so they tell where it belongs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...cage import pieces_of
from .simulated_body import SimulatedBody


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyPiece:
    """One piece of a body.

    Args:
        vertices: Ids of its cage vertices, ascending, shape (vertex_count,).
        faces: Faces of the cage that bound it, ascending, shape (face_count,).
        surface_points: Its surface points, ascending, shape (point_count,).
        surface_triangles: Its surface triangles, ascending, shape (triangle_count,).
        volume: Volume of its part of the cage, of a plane body area times thickness [m^3].
        mass: Its mass, 0 for a body without elasticity [kg].
    """

    vertices: np.ndarray
    faces: np.ndarray
    surface_points: np.ndarray
    surface_triangles: np.ndarray
    volume: float
    mass: float


def body_pieces(body: SimulatedBody) -> tuple[BodyPiece, ...]:
    """The pieces of a body as it is now, in the order of their lowest cage vertices.

    Args:
        body: The body.
    """
    pieces = pieces_of(body.cage)
    piece_of_vertex = np.empty(body.cage.vertex_count, dtype=np.int64)
    for number, piece in enumerate(pieces):
        piece_of_vertex[piece.vertices] = number
    surface, first = body.surface, body.surface_row
    rows = body.coordinates.weights[first : first + surface.site_count]
    of_point = piece_of_vertex[np.abs(rows).argmax(axis=1)]
    if surface.point_site is not None:
        of_point = of_point[surface.point_site]
    density = body.definition.material.density if body.system is not None else 0.0
    thickness = body.definition.thickness if body.is_plane else 1.0
    return tuple(
        BodyPiece(
            vertices=piece.vertices,
            faces=piece.faces,
            surface_points=np.flatnonzero(of_point == number),
            surface_triangles=np.flatnonzero(of_point[surface.triangles[:, 0]] == number),
            volume=thickness * piece.volume,
            mass=density * thickness * piece.volume,
        )
        for number, piece in enumerate(pieces)
    )
