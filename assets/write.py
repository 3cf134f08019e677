# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Writes a mesh and its cage as two files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from newton_cagecut.usd import write_mesh

FOLDER = Path(__file__).parent


def write_asset(
    name: str,
    mesh: tuple[np.ndarray, np.ndarray],
    cage: tuple[np.ndarray, Sequence[Sequence[int]]],
    folder: Path = FOLDER,
) -> None:
    """Write ``<name>.usdc`` and ``<name>_cage.usda``.

    Args:
        name: What it is.
        mesh: Points [m] and triangles of what is in the cage.
        cage: Vertices [m] and faces of the cage.
        folder: Where to.
    """
    write_mesh(folder / f"{name}.usdc", *mesh, name=name)
    write_mesh(folder / f"{name}_cage.usda", *cage, name=f"{name}_cage", purpose="guide")
