# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages, plane sections, blades and cuts, in NumPy and float64."""

from .blade import Blade, BladePlane
from .cage import Cage
from .clearance import mesh_clearance
from .cut import Cut, CutSnapshot
from .edit import CageEdit
from .inside import boundary_distances, check_inside
from .pieces import CagePiece
from .polygon_mesh import PolygonMesh
from .space import lifted
from .triangulate import triangulate
from .wall import Wall

__all__ = [
    "Blade",
    "BladePlane",
    "Cage",
    "CageEdit",
    "CagePiece",
    "Cut",
    "CutSnapshot",
    "PolygonMesh",
    "Wall",
    "boundary_distances",
    "check_inside",
    "lifted",
    "mesh_clearance",
    "triangulate",
]
