# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a mesh becomes when a section of it is opened up to a front: created vertices, faces, sides.

Sections 4.3 and 5.2 of the paper. How faces are walked, or segments split, stands beside this file.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .created_vertices import CreatedVertices
from .face_walk import walk_faces
from .numbering import Numbering
from .opened_faces import OpenedFaces
from .section import Section
from .segment_split import split_segments
from .swept_region import SweptRegion


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


def open_section(section: Section, numbering: Numbering, front: float) -> Opening:
    """Open a section.

    Args:
        section: The section.
        numbering: Its vertex ids.
        front: Coordinate s up to which it is open [m].
    """
    region = SweptRegion(section, front, middles=np.flatnonzero(numbering.middle_plus >= 0))
    vertices = CreatedVertices(section, numbering, region)
    faces = split_segments(vertices) if section.mesh.dimension == 2 else walk_faces(vertices)
    return Opening(section, region, vertices, faces)
