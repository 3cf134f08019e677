# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The boundary functions of a face: what each of its corners counts at a point of it.

They are linear on triangles, mean value coordinates on convex quads (paper, equation 4) and elsewhere harmonic in the
face's plane, as in section 5.1 of the paper, but without its nested walks: on rectangles bilinear, else by a fit.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import warp as wp

from .plane_fit import Outline, OutlineFits, nearest_edges, polygon_edges

FaceValues = Callable[[np.ndarray], np.ndarray]
"""Points of a face's plane, shape (n, 2) -> what each corner counts there, shape (n, corner_count)."""
_RIGHT = 1e-9


class FaceFunctions:
    """The boundary functions of a face.

    Args:
        corners: Corners in the face's plane, counterclockwise, shape (corner_count, 2).
        quads: "mean_value" or "harmonic": how convex quads interpolate.
    """

    def __init__(self, corners: np.ndarray, *, quads: str) -> None:
        self.corner_count = len(corners)
        self._direct = _direct_values(corners, quads=quads)
        self._corners = corners
        self._fits: OutlineFits | None = None
        self._number = 0

    @staticmethod
    def make_fits(functions: list[FaceFunctions], device: wp.context.Device) -> None:
        """Make the fits of all functions that need one, together.

        Args:
            functions: The functions.
            device: Where to fit.
        """
        wanted = [own for own in functions if own._direct is None and own._fits is None]
        if wanted:
            fits = OutlineFits([Outline(*polygon_edges(own._corners)) for own in wanted], device)
            for number, own in enumerate(wanted):
                own._fits, own._number = fits, number

    @staticmethod
    def values(functions: list[FaceFunctions], points: list[np.ndarray]) -> list[np.ndarray]:
        """What corners count at points of the planes of faces.

        Args:
            functions: The functions of the faces, whose fits have been made.
            points: Points of each, shape (n, 2) each.

        Returns:
            Values, shape (n, corner_count) each.
        """
        found = [np.zeros((0, own.corner_count)) for own in functions]
        by_fits: dict[int, list[int]] = {}
        for k, (own, places) in enumerate(zip(functions, points)):
            if own._direct is not None:
                found[k] = own._direct(places)
            elif len(places):
                by_fits.setdefault(id(own._fits), []).append(k)
        for chosen in by_fits.values():
            numbers = [functions[k]._number for k in chosen]
            values = functions[chosen[0]]._fits.values(numbers, [points[k] for k in chosen])
            for k, own in zip(chosen, values):
                found[k] = own
        return found


def _direct_values(corners: np.ndarray, *, quads: str) -> FaceValues | None:
    """Boundary functions that have a closed form; None for others."""
    if len(corners) == 3:
        return _barycentric(corners)
    if len(corners) == 4 and quads == "mean_value" and _is_convex(corners):
        return lambda points: _mean_values(corners, points)
    if len(corners) == 4 and _is_rectangle(corners):
        return lambda points: _bilinear(corners, points)
    return None


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _is_convex(corners: np.ndarray) -> bool:
    edge = np.roll(corners, -1, axis=0) - corners
    return bool((_cross(edge, np.roll(edge, -1, axis=0)) > 0.0).all())


def _is_rectangle(corners: np.ndarray) -> bool:
    edge = np.roll(corners, -1, axis=0) - corners
    size = (edge**2).sum(axis=1)
    skew = abs((edge[0] * edge[1]).sum()) / np.sqrt(size[0] * size[1])
    return bool(np.abs(edge[0] + edge[2]).max() < _RIGHT * np.sqrt(size.max()) and skew < _RIGHT)


def _barycentric(corners: np.ndarray) -> FaceValues:
    first, second = corners[1] - corners[0], corners[2] - corners[0]
    area = _cross(first, second)

    def values(points: np.ndarray) -> np.ndarray:
        offset = points - corners[0]
        b, c = _cross(offset, second) / area, _cross(first, offset) / area
        return np.stack([1.0 - b - c, b, c], axis=1)

    return values


def _bilinear(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    first, second = corners[1] - corners[0], corners[3] - corners[0]
    offset = points - corners[0]
    a, b = (offset * first).sum(axis=1) / (first**2).sum(), (offset * second).sum(axis=1) / (second**2).sum()
    return np.stack([(1.0 - a) * (1.0 - b), a * (1.0 - b), a * b, (1.0 - a) * b], axis=1)


def _mean_values(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    arm = corners - points[:, None]
    length = np.sqrt((arm**2).sum(axis=2))
    after = np.roll(arm, -1, axis=1)
    on_edge, edge, share = nearest_edges(polygon_edges(corners)[0], points)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = length * np.roll(length, -1, axis=1) + (arm * after).sum(axis=2)
        half = _cross(arm, after) / cosine  # tangent of half the angle
        weight = (np.roll(half, 1, axis=1) + half) / length
        weight /= weight.sum(axis=1, keepdims=True)
    weight[on_edge] = 0.0
    rows, edge, share = np.flatnonzero(on_edge), edge[on_edge], share[on_edge]
    weight[rows, edge], weight[rows, (edge + 1) % len(corners)] = 1.0 - share, share
    return weight
