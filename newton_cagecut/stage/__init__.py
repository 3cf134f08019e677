# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Stages in: prims of a USD stage become cage bodies of a builder, and blades with their tracks."""

from .add_usd import add_usd
from .stage_scene import StageBlade, StageScene

__all__ = ["StageBlade", "StageScene", "add_usd"]
