# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a moving plane, or a line in 2D, does to any polygon mesh (paper, sections 4 and 5.2).

A blade sweeps a plane; a strip is the section of a mesh with it, which opens up to any front.
"""

from .blade import Blade, BladePlane
from .clearing import clear_plane, clear_turn
from .hinge import Hinge
from .nodes import Nodes
from .opening import Opening
from .section import Section
from .strip import Strip
from .swept_region import SweptRegion

__all__ = [
    "Blade",
    "BladePlane",
    "Hinge",
    "Nodes",
    "Opening",
    "Section",
    "Strip",
    "SweptRegion",
    "clear_plane",
    "clear_turn",
]
