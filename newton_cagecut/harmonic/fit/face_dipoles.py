# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The boundary functions of faces as densities of double layers: linear on panels that are as small as that asks for.

On triangles they are linear anyway. Elsewhere each panel has the linear functions of least square error, which keeps
linear functions exactly, and panels are divided until the error is small.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from .face_values import FaceValues, face_values

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


def projected(values: FaceValues, corners: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Boundary functions of a face as linear functions on triangles.

    Args:
        values: The functions.
        corners: Panels of the face in its plane, shape (panel_count, 3, 2).
        tolerance: Error at which triangles are divided no more.

    Returns:
        Corners of the triangles in the plane, shape (n, 3, 2), and values there, shape (n, 3, corner_count).
    """
    triangles, densities = [], []
    for division in range(_DIVISIONS + 1):
        points = sum(_HATS[:, k, None] * corners[:, None, k] for k in range(3))
        found = values(points.reshape(-1, 2)).reshape(len(corners), len(_HATS), -1)
        density = np.einsum("kq,tqc->tkc", _PROJECTION, found)
        error = np.abs(np.einsum("qk,tkc->tqc", _HATS, density) - found).max(axis=(1, 2))
        large = (error > tolerance) & (division < _DIVISIONS)
        triangles.append(corners[~large])
        densities.append(density[~large])
        if not large.any():
            break
        corners = divided(corners[large])
    return np.concatenate(triangles), np.concatenate(densities)


class FaceFunctions:
    """The boundary functions of a face, and what was last asked of them: an edit leaves the panels of most faces alone.

    Args:
        corners: Corners in the face's plane, counterclockwise, shape (corner_count, 2).
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        device: Where to compute.
    """

    def __init__(self, corners: np.ndarray, *, quads: str, device: wp.context.Device) -> None:
        self.values = face_values(corners, quads=quads, device=device)
        self._places, self._found = b"", np.zeros(0)
        self._panels, self._projected = b"", (np.zeros(0), np.zeros(0))

    def at(self, points: np.ndarray) -> np.ndarray:
        """The functions at points of the face's plane, shape (n, corner_count)."""
        places = points.tobytes()
        if places != self._places:
            self._places, self._found = places, self.values(points)
        return self._found

    def projected(self, corners: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """The functions as linear ones on triangles; see ``projected``."""
        panels = corners.tobytes()
        if panels != self._panels:
            self._panels, self._projected = panels, projected(self.values, corners, tolerance)
        return self._projected
