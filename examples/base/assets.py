# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The shapes of the scenes: cages and meshes from the folder ``assets`` beside the examples."""

from __future__ import annotations

from pathlib import Path

from newton_cagecut import Cage, Surface
from newton_cagecut.usd import read_cage, read_surface

ASSETS = Path(__file__).parents[2] / "assets"


def asset(name: str) -> tuple[Cage, Surface]:
    """Return the cage and the embedded surface of a shape, in metres.

    Args:
        name: Name of its files.
    """
    cage = read_cage(ASSETS / f"{name}_cage.usda")
    return cage, read_surface(ASSETS / f"{name}.usdc", flat=cage.dimension == 2)
