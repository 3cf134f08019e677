# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes and cages from files: USD, OBJ, OFF, PLY, STL and glTF."""

from .read_file import read_cage, read_mesh

__all__ = ["read_cage", "read_mesh"]
