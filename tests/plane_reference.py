# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Harmonic coordinates of polygons to many digits, by a method that shares nothing with the walks.

The Laplace equation is solved by rational functions with poles that cluster exponentially towards the corners (Gopal
and Trefethen 2019, "Solving Laplace problems with corner singularities via rational functions"). By the maximum
principle no error inside exceeds the greatest one on the boundary, so the solution measures its own error.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lstsq

from newton_cagecut.cage import Cage
from plane_shapes import loops_of

_POLES = 24
"""Poles a corner."""
_DEGREE = 20
"""Degree of the polynomial beside them."""


class PlaneReference:
    """Harmonic coordinates of a polygon that may have one slit.

    A slit's tip would be a corner of 360 degrees; the square root about the tip opens it to a straight line.

    Args:
        corners: The polygon, counterclockwise, shape (n, 2); a slit runs to its tip and back.
    """

    def __init__(self, corners: np.ndarray) -> None:
        self._corner = corners @ [1.0, 1.0j]
        count = len(corners)
        tips = np.flatnonzero(np.abs(np.roll(self._corner, 1) - np.roll(self._corner, -1)) < 1e-12)
        self._tip = int(tips[0]) if len(tips) else None
        near = np.geomspace(1e-10, 0.5, 2 * _POLES)
        share = np.unique(np.concatenate([near, 1.0 - near, np.linspace(0.0, 1.0, 4 * _DEGREE)[1:-1]]))
        place, value = self._boundary(share)
        self._center = place.mean()
        self._size = float(np.abs(place - self._center).max())
        self._distance = self._size * np.exp(-4.0 * (np.sqrt(_POLES) - np.sqrt(np.arange(1, _POLES + 1))))
        self._pole = np.concatenate([self._poles_of(corner) for corner in range(count)])
        basis = _real_and_imaginary(self._functions(place))
        length = np.linalg.norm(basis, axis=0)
        solution = lstsq(basis / length, value, cond=1e-14, lapack_driver="gelsy")[0] / length[:, None]
        real, imaginary = np.split(solution, [self._function_count])
        self._coefficient = real - 1j * np.concatenate([np.zeros((1, count)), imaginary])
        place, value = self._boundary(np.random.default_rng(0).beta(0.3, 0.3, 200))
        self.error = float(np.abs((self._functions(place) @ self._coefficient).real - value).max())

    def weights(self, points: np.ndarray) -> np.ndarray:
        """Coordinates of points, not on a slit, with respect to each corner, shape (point_count, corner_count)."""
        return (self._functions(self._opened(points @ [1.0, 1.0j])) @ self._coefficient).real

    def gradients(self, points: np.ndarray) -> np.ndarray:
        """Gradients of the coordinates, shape (point_count, corner_count, 2)."""
        z = points @ [1.0, 1.0j]
        place = self._opened(z)
        offset = (place - self._center)[:, None] / self._size
        power = np.arange(1, _DEGREE + 1)
        slope = np.concatenate(
            [
                np.zeros((len(z), 1)),
                power * offset ** (power - 1) / self._size,
                -np.tile(self._distance, len(self._corner)) / (place[:, None] - self._pole) ** 2,
            ],
            axis=1,
        )
        slope = slope @ self._coefficient
        if self._tip is not None:
            slope *= (-0.5 / self._mouth / place)[:, None]
        return np.stack([slope.real, -slope.imag], axis=2)

    @property
    def _function_count(self) -> int:
        return 1 + _DEGREE + len(self._pole)

    @property
    def _mouth(self) -> complex:
        """From the tip of the slit to its mouth."""
        return self._corner[self._tip - 1] - self._corner[self._tip]

    def _opened(self, z: np.ndarray) -> np.ndarray:
        """Where the square root takes points that are not on the slit."""
        return z if self._tip is None else np.sqrt(-(z - self._corner[self._tip]) / self._mouth)

    def _edge_point(self, edge: int, share: np.ndarray) -> np.ndarray:
        """Points of an edge by their share of it, opened; on the slit by the share of the root of the distance."""
        start, end = self._corner[edge], self._corner[(edge + 1) % len(self._corner)]
        if edge == self._tip:
            return -1j * share
        if (edge + 1) % len(self._corner) == self._tip:
            return 1j * (1.0 - share)
        return self._opened(start + share * (end - start))

    def _boundary(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Opened points at the same shares of every edge, and the hat functions there."""
        count = len(self._corner)
        value = np.zeros((count, len(share), count))
        for edge in range(count):
            end = (edge + 1) % count
            along = share**2 if edge == self._tip else 1.0 - (1.0 - share) ** 2 if end == self._tip else share
            value[edge, :, edge], value[edge, :, end] = 1.0 - along, along
        place = np.concatenate([self._edge_point(edge, share) for edge in range(count)])
        return place, value.reshape(-1, count)

    def _poles_of(self, corner: int) -> np.ndarray:
        """Poles on the bisector outside of a corner, as the opened polygon has it."""
        step = np.array([0.0, 1e-6])
        before = (corner or len(self._corner)) - 1
        here, ahead = self._edge_point(corner, step)
        end, back = self._edge_point(before, 1.0 - step)
        here = end if before == self._tip else here  # the root of the mouth itself is ambiguous
        inner = np.angle((back - here) / (ahead - here)) % (2.0 * np.pi)
        return here - self._distance * np.exp(0.5j * inner) * (ahead - here) / abs(ahead - here)

    def _functions(self, place: np.ndarray) -> np.ndarray:
        """Powers and poles at opened points, shape (n, function_count)."""
        offset = (place - self._center) / self._size
        powers = offset[:, None] ** np.arange(_DEGREE + 1)
        poles = np.tile(self._distance, len(self._corner)) / (place[:, None] - self._pole)
        return np.concatenate([powers, poles], axis=1)


def _real_and_imaginary(functions: np.ndarray) -> np.ndarray:
    """Real functions whose combinations are the real parts of those of complex ones; the first is constant."""
    return np.concatenate([functions.real, functions.imag[:, 1:]], axis=1)


def plane_reference(cage: Cage, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Harmonic coordinates of a plane cage of one loop, and their gradients, shapes (n, v) and (n, v, 2)."""
    (loop,) = loops_of(cage)
    reference = PlaneReference(cage.vertices[loop])
    order = np.argsort(loop)
    return reference.weights(points)[:, order], reference.gradients(points)[:, order]
