# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Moves the vertices of a coarse shell until it holds a mesh closely.

Each step is a linear program (sequential linear programming): the moves that add the least volume, or take away the
most, while every point of the wrap comes inside, the faces keep their distance from the mesh, and the shell neither
meets itself nor grows needles. So a decimated shell, which cuts into the mesh, grows where it must and shrinks where it
can. Lengths are in units of the mesh's size.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.spatial import cKDTree

from .inequalities import Inequalities
from .shell import Shell, keep_apart, keep_around, keep_flat, keep_off, keep_shape

_FIRST_STEP = 0.23  # longest move along an axis, of the root of one over the number of triangles
_DECAY = 0.85  # of the step, each time
_STEPS = 24
_PATIENCE = 8  # steps after which a shortfall beyond the next step is hopeless
_GAP = 0.01  # between parts of the shell that are no neighbours
_HEIGHT = 0.25  # least height of a triangle, of the root of one over their number
_SETTLED = 1e-3  # change of the volume that ends it


def tighten(
    shell: Shell,
    points: np.ndarray,
    skin: cKDTree,
    *,
    margin: float,
    spacing: float,
    panels: Sequence[np.ndarray] = (),
    tick: Callable[[], None] = lambda: None,
) -> Shell:
    """Return the shell around a mesh that comes out of the moves.

    Args:
        shell: The coarse shell to start from.
        points: Points that the shell must hold, shape (point_count, 3).
        skin: Points spread over the mesh.
        margin: Distance that the faces must keep from the skin.
        spacing: Distance between the points of the faces that are compared with the skin.
        panels: Triangle ids of each panel that is to become flat.
        tick: Called before each step.

    Returns:
        The shell. It may leave points out, or meet itself, where small steps lead to none that does not.
    """
    size = 1.0 / np.sqrt(len(shell.triangles))
    step, height, volume = _FIRST_STEP * size, _HEIGHT * size, np.inf
    for count in range(_STEPS):
        tick()
        rows, reach = Inequalities(len(shell.vertices)), np.sqrt(3.0) * step
        keep_around(rows, shell, points, reach)
        keep_off(rows, shell, skin, margin, spacing, reach)
        keep_apart(rows, shell, _GAP, reach)
        keep_shape(rows, shell, height)
        keep_flat(rows, shell, panels)
        moves, shortfall = rows.least(shell.volume_growth, step)
        shell = shell.moved(moves)
        settled = shortfall == 0.0 and abs(shell.volume - volume) < _SETTLED * shell.volume
        if count >= _PATIENCE and (settled or shortfall > step):
            break
        step, volume = _DECAY * step, shell.volume
    return shell
