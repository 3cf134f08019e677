# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a mesh becomes when a section of it is opened up to a front: created vertices, faces, sides.

Sections 4.3 and 5.2 of the paper. How loops of faces are walked, or segments split, stands beside this file.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .created_vertices import CreatedVertices
from .section import Section
from .swept_region import SweptRegion


@dataclass(frozen=True, eq=False, kw_only=True)
class OpenedFaces:
    """The faces of a mesh after an opening."""

    touched: np.ndarray
    """Faces of the mesh that are slit or split, shape (touched_count,)."""
    first_loops: list[list[int]]
    """What stays in the place of each of them."""
    extra_loops: list[list[int]]
    """Loops split off from touched faces, in the order of their places behind the mesh's faces."""
    extra_face: list[int]
    """Face that each of those was split off from."""
    face_vertex: np.ndarray
    """Vertex at which each half-edge of the mesh starts, after the opening, shape (half_edge_count,)."""
    half_edge_face: np.ndarray
    """Face, after the opening, that walks each half-edge of the mesh, shape (half_edge_count,)."""
    slits: list[tuple[int, list[int]]]
    """Chords along which slits meet no edge of their face, and the vertices of each: at the chord's start, on the
    positive side, at its end, on the negative side."""


@dataclass(frozen=True, eq=False)
class Opening:
    """A section opened up to a front."""

    section: Section
    """The section."""
    region: SweptRegion
    """What of it is open: the sides of the cut are its polygons."""
    vertices: CreatedVertices
    """The vertices that are new."""
    faces: OpenedFaces
    """What became of the mesh's faces."""
