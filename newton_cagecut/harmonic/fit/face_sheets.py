# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The sheets of faces: charges on their panels, and their boundary functions as dipoles."""

from __future__ import annotations

from functools import partial

import numpy as np

from .face_dipoles import projected
from .face_values import FaceFunctions
from .fit_memory import FaceSheet
from .layers.sheets import Sheet, test_points_of
from .panels.face_panels import FacePanels, FacePlanes

_TOLERANCE = 3e-2
"""Error of boundary functions that are not linear, at which their panels are divided no more."""


def face_sheets(
    planes: FacePlanes,
    faces: list[int],
    functions: list[FaceFunctions],
    panels: FacePanels,
    groups: list[np.ndarray],
) -> list[FaceSheet]:
    """Make the sheets of faces.

    Args:
        planes: The planes of the cage's faces.
        faces: The faces.
        functions: Boundary functions of each of these.
        panels: Panels of all faces.
        groups: Which panels each face of the cage has.
    """
    own = [groups[face] for face in faces]
    charges = [at[panels.charged[at]] for at in own]
    tests = [test_points_of(panels.corners[at]) for at in charges]
    values = FaceFunctions.values(
        functions, [planes.to_plane(face, points).reshape(-1, 2) for face, points in zip(faces, tests)]
    )
    cells = [panels.corners[at[panels.valued[at]]] for at in own]
    dipoles = _dipoles(planes, faces, functions, cells)
    made = []
    for k, (face, at, points, (corners, density)) in enumerate(zip(faces, charges, tests, dipoles)):
        found = values[k].reshape(*points.shape[:2], functions[k].corner_count)
        nodes = np.unique(panels.nodes[at], return_inverse=True)[1].reshape(-1, 3)
        sheet = Sheet(panels.corners[at], nodes, corners, density, found)
        own_cells = cells[k] if functions[k].corner_count == 3 else corners
        to_plane = partial(planes.to_plane, face)
        made.append(FaceSheet(sheet, own_cells, functions[k], planes.outward[face], to_plane))
    return made


def _dipoles(
    planes: FacePlanes, faces: list[int], functions: list[FaceFunctions], cells: list[np.ndarray]
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Corners of each face's panels with dipoles, and their densities."""
    found: list[tuple[np.ndarray, np.ndarray]] = []
    curved = [k for k, own in enumerate(functions) if own.corner_count > 3]
    flat = [planes.to_plane(faces[k], cells[k]) for k in curved]
    by_number = dict(zip(curved, projected([functions[k] for k in curved], flat, _TOLERANCE)))
    for k, face in enumerate(faces):
        corners, density = by_number.get(k, (planes.polygon(face)[None], np.eye(3)[None]))
        found.append((planes.to_space(face, corners), density))
    return found
