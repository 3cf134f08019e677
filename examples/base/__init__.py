# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What the scenes have in common: bodies, cuts on a schedule, recording, pictures, timings."""

from .assets import ASSETS, asset
from .cut_scene import CutScene
from .cutting import CutSchedule, PlannedCut, along, frames_of
from .knife import knife_at
from .picture import Camera
from .scene import Scene, require
from .shapes import box_cage, box_mesh

__all__ = [
    "ASSETS",
    "Camera",
    "CutSchedule",
    "CutScene",
    "PlannedCut",
    "Scene",
    "along",
    "asset",
    "box_cage",
    "box_mesh",
    "frames_of",
    "knife_at",
    "require",
]
