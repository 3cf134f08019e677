# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""USD: cages and surfaces in, animations with changing topology out."""

from .animation import AnimationWriter
from .body_frame import BodyFrame
from .layers import checked_path
from .mesh_data import MeshData, check_mesh, turn_up
from .outline import border_of
from .read import open_stage, read_cage, read_mesh, read_meshes, read_surface
from .scene_frame import SceneFrame, SceneShape
from .validate import validate_animation
from .write import write_cage, write_mesh

__all__ = [
    "AnimationWriter",
    "BodyFrame",
    "MeshData",
    "SceneFrame",
    "SceneShape",
    "border_of",
    "check_mesh",
    "checked_path",
    "open_stage",
    "read_cage",
    "read_mesh",
    "read_meshes",
    "read_surface",
    "turn_up",
    "validate_animation",
    "write_cage",
    "write_mesh",
]
