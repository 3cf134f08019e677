# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages, plane sections, blades and cuts, in NumPy and float64."""

from .cage import Cage
from .checks.clearance import mesh_clearance
from .checks.inside import boundary_distances, check_inside
from .edits.cut import Cut, CutSnapshot
from .edits.edit import CageEdit
from .pieces import CagePiece, pieces_of
from .wall import Wall

__all__ = [
    "Cage",
    "CageEdit",
    "CagePiece",
    "Cut",
    "CutSnapshot",
    "Wall",
    "boundary_distances",
    "check_inside",
    "mesh_clearance",
    "pieces_of",
]
