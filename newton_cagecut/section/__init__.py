# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a moving plane, or a line in 2D, does to any polygon mesh (paper, sections 4 and 5.2)."""

from .blade import Blade, BladePlane, clear_plane, clear_turn
from .clipping import ClippedSection
from .hinge import Hinge
from .line_opening import LineOpening
from .numbering import Numbering
from .opening import Opening
from .section import Section, clear_front
from .segments import LineSection
from .swept_region import Region

__all__ = [
    "Blade",
    "BladePlane",
    "ClippedSection",
    "Hinge",
    "LineOpening",
    "LineSection",
    "Numbering",
    "Opening",
    "Region",
    "Section",
    "clear_front",
    "clear_plane",
    "clear_turn",
]
