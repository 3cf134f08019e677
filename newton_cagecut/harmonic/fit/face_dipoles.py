# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The boundary functions of faces as densities of double layers: linear on panels that are as small as that asks for.

On triangles they are linear anyway. Elsewhere each panel has the linear functions of least square error, which keeps
linear functions exactly, and panels are divided until the error is small.
"""

from __future__ import annotations

import numpy as np

from .face_values import FaceFunctions

_DIVISIONS = 4
_NEAR, _FAR = 0.816847572980459, 0.108103018168070
_NEAR_WEIGHT, _FAR_WEIGHT = 0.109951743655322, 0.223381589678011


def divided(corners: np.ndarray) -> np.ndarray:
    """Quarters of triangles of any dimension, shape (4 * triangle_count, 3, dimension)."""
    middle = (corners + np.roll(corners, -1, axis=1)) / 2.0
    at_corners = [np.stack([corners[:, k], middle[:, k], middle[:, k - 1]], axis=1) for k in range(3)]
    return np.concatenate([*at_corners, middle])


def _rule() -> tuple[np.ndarray, np.ndarray]:
    """Hat functions at points inside a triangle, and the weights of the points: a rule on each of its quarters."""
    near = np.full((3, 3), (1.0 - _NEAR) / 2.0) + (1.5 * _NEAR - 0.5) * np.eye(3)
    far = np.full((3, 3), (1.0 - _FAR) / 2.0) + (1.5 * _FAR - 0.5) * np.eye(3)
    hats = np.concatenate([near, far])
    weights = np.repeat([_NEAR_WEIGHT, _FAR_WEIGHT], 3)
    return np.concatenate([hats @ quarter for quarter in divided(np.eye(3)[None])]), np.tile(weights, 4) / 4.0


_HATS, _WEIGHTS = _rule()
_PROJECTION = np.linalg.inv((np.ones((3, 3)) + np.eye(3)) / 12.0) @ (_HATS * _WEIGHTS[:, None]).T
"""From values at the rule's points to those at the corners of the linear function of least square error."""


def projected(
    functions: list[FaceFunctions], corners: list[np.ndarray], tolerance: float
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Boundary functions of faces as linear functions on triangles.

    Args:
        functions: The functions of each face.
        corners: Panels of each face in its plane, shape (panel_count, 3, 2) each.
        tolerance: Error at which triangles are divided no more.

    Returns:
        For each face corners of the triangles in the plane, shape (n, 3, 2), and values there, shape
        (n, 3, corner_count).
    """
    parts = [([], []) for _ in functions]
    faces = list(range(len(functions)))
    for division in range(_DIVISIONS + 1):
        points = [sum(_HATS[:, k, None] * own[:, None, k] for k in range(3)).reshape(-1, 2) for own in corners]
        left = []
        for face, own, found in zip(faces, corners, FaceFunctions.values([functions[f] for f in faces], points)):
            found = found.reshape(len(own), len(_HATS), -1)
            density = np.einsum("kq,tqc->tkc", _PROJECTION, found)
            error = np.abs(np.einsum("qk,tkc->tqc", _HATS, density) - found).max(axis=(1, 2))
            large = (error > tolerance) & (division < _DIVISIONS)
            parts[face][0].append(own[~large])
            parts[face][1].append(density[~large])
            if large.any():
                left.append((face, divided(own[large])))
        if not left:
            break
        faces, corners = (list(column) for column in zip(*left))
    return [(np.concatenate(triangles), np.concatenate(densities)) for triangles, densities in parts]
