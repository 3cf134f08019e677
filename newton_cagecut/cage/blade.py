# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Blades, and the planes that they sweep.

Section 5.2 of the paper defines a cut in 3D by a line and a cutting direction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .wall import Wall

_LEAST_SINE = 1e-3


class Blade:
    """A straight edge that moves in one direction, in the rest frame."""

    def __init__(
        self,
        origin: np.ndarray,
        edge: np.ndarray,
        direction: np.ndarray,
        *,
        width: float | tuple[float, float] | None = None,
        start: float | None = None,
    ):
        """Define a blade.

        Args:
            origin: A point of the plane that the blade sweeps, shape (3,) [m].
            edge: Direction of the blade's line, of any length, shape (3,).
            direction: Direction in which the blade moves, of any length, not along the edge, shape (3,).
            width: Where the knife ends along its edge, from the origin: (heel, tip), or one length for both ways
                together with the origin in the middle; None for a knife without ends [m].
            start: Where the knife starts along its direction, from the origin; what lies behind is not cut. None for
                outside of the body [m].

        Raises:
            TypeError: If something is not three numbers.
            ValueError: If something is not finite, a direction is zero or both are parallel.
        """
        self.origin = _as_vector(origin, "origin")
        self.edge = _as_unit(edge, "edge")
        self.direction = _as_unit(direction, "direction")
        normal = np.cross(self.edge, self.direction)
        sine = float(np.linalg.norm(normal))
        if sine < _LEAST_SINE:
            raise ValueError(
                f"the blade's edge and direction are parallel (sine of their angle {sine:.3g}): they span no plane"
            )
        self.normal = normal / sine
        self.heel, self.tip = _as_width(width)
        self.start = -np.inf if start is None else float(start)
        if np.isnan(self.start) or self.start == np.inf:
            raise ValueError(f"the blade's start must be a length, got {start!r}")
        for vector in (self.origin, self.edge, self.direction, self.normal):
            vector.setflags(write=False)

    @property
    def window(self) -> tuple[float, float, float] | None:
        """Heel, tip and start, None where the blade has none of them [m]."""
        window = (self.heel, self.tip, self.start)
        return window if np.isfinite(window).any() else None

    def __repr__(self) -> str:
        return f"Blade(origin={self.origin.tolist()}, edge={self.edge.tolist()}, direction={self.direction.tolist()})"


@dataclass(frozen=True, eq=False)
class BladePlane:
    """The plane that a blade sweeps, with a coordinate along its edge and one along its direction."""

    origin: np.ndarray
    """A point of the plane, shape (3,) [m]."""
    edge: np.ndarray
    """Unit direction of the blade's line, shape (3,)."""
    direction: np.ndarray
    """Unit direction of the sweep, shape (3,)."""
    normal: np.ndarray
    """Unit normal, along ``edge x direction``, shape (3,)."""

    @classmethod
    def of(cls, blade: Blade) -> BladePlane:
        """The plane through a blade's origin.

        Args:
            blade: The blade.
        """
        return cls(blade.origin, blade.edge, blade.direction, blade.normal)

    def shifted(self, offset: float) -> BladePlane:
        """The plane moved along its normal.

        Args:
            offset: Distance to move [m].
        """
        return BladePlane(self.origin + offset * self.normal, self.edge, self.direction, self.normal)

    def at(self, front: float) -> BladePlane:
        """The same plane with its origin moved to a front.

        Args:
            front: Coordinate s of the front [m].
        """
        return BladePlane(self.origin + front * self.direction, self.edge, self.direction, self.normal)

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Signed distance, the same to the last bit for the same point, shape (point_count,) [m].

        Args:
            points: Points, shape (point_count, 3) [m].
        """
        return _dot(points - self.origin, self.normal)

    def coordinates(self, points: np.ndarray) -> np.ndarray:
        """Coordinates (a, s) along the edge and the direction, shape (point_count, 2) [m].

        Args:
            points: Points of the plane, shape (point_count, 3) [m].
        """
        offset = points - self.origin
        along_edge, along_direction = _dot(offset, self.edge), _dot(offset, self.direction)
        cosine = float(self.edge @ self.direction)
        square = 1.0 - cosine * cosine
        a = (along_edge - cosine * along_direction) / square
        s = (along_direction - cosine * along_edge) / square
        return np.stack([a, s], axis=1)

    def wall(self) -> Wall:
        """The wall that a cut along this plane leaves."""
        return Wall(self.origin, np.stack([self.edge, np.cross(self.normal, self.edge)]), self.normal, two_sided=True)


def clear_plane(plane: BladePlane, points: np.ndarray, tolerance: float) -> BladePlane:
    """The plane moved, by as little as can be, so that no point is within the tolerance of it.

    Args:
        plane: The plane.
        points: Points to keep off, shape (point_count, 3) [m].
        tolerance: Distance to keep [m].
    """
    distance = plane.distance(points)
    if len(distance) == 0 or np.abs(distance).min() > tolerance:
        return plane
    return plane.shifted(_nearest_gap(distance, np.full(len(distance), 1.5 * tolerance)))


def clear_turn(plane: BladePlane, points: np.ndarray, tolerance: float) -> BladePlane:
    """The plane turned about its line ``s = 0``, by as little as can be, so that no point is within the tolerance.

    Points beside or behind that line do not count.

    Args:
        plane: The plane.
        points: Points to keep off, shape (point_count, 3) [m].
        tolerance: Distance to keep [m].
    """
    across = np.cross(plane.normal, plane.edge)
    height, ahead = plane.distance(points), _dot(points - plane.origin, across)
    close = (ahead > 8.0 * tolerance) & (np.abs(height) < 0.25 * ahead)
    height, ahead = height[close], ahead[close]
    if len(height) == 0 or np.abs(height).min() > tolerance:
        return plane
    angle = _nearest_gap(np.arctan2(height, ahead), 1.5 * tolerance / ahead)
    cosine, sine = np.cos(angle), np.sin(angle)
    along = plane.direction @ plane.edge
    turned = cosine * across + sine * plane.normal
    direction = along * plane.edge + np.sqrt(1.0 - along * along) * turned
    return BladePlane(plane.origin, plane.edge, direction, cosine * plane.normal - sine * across)


def _nearest_gap(position: np.ndarray, margin: np.ndarray) -> float:
    """The value nearest to zero that keeps every position at its margin."""
    order = np.argsort(position - margin, kind="stable")
    low, high = (position - margin)[order], np.maximum.accumulate((position + margin)[order])
    lowest, highest = np.concatenate([[-np.inf], high]), np.concatenate([low, [np.inf]])
    nearest = np.clip(0.0, lowest, highest)[lowest <= highest]
    return float(nearest[np.argmin(np.abs(nearest))])


def _dot(vectors: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Dot products by element-wise arithmetic, which does not depend on a vector's place in the array."""
    return vectors[:, 0] * axis[0] + vectors[:, 1] * axis[1] + vectors[:, 2] * axis[2]


def _as_width(width: float | tuple[float, float] | None) -> tuple[float, float]:
    if width is None:
        return -np.inf, np.inf
    try:
        heel, tip = (float(end) for end in (width if np.ndim(width) else (-0.5 * width, 0.5 * width)))
    except (TypeError, ValueError):
        raise TypeError(f"the blade's width must be a length or (heel, tip), got {width!r}") from None
    if not heel < tip:
        raise ValueError(f"the blade's heel must lie before its tip, got ({heel:g}, {tip:g})")
    return heel, tip


def _as_vector(value: np.ndarray, name: str) -> np.ndarray:
    try:
        vector = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"the blade's {name} must be three numbers, got {value!r}") from None
    if vector.shape != (3,):
        raise ValueError(f"the blade's {name} must have shape (3,), got {vector.shape}")
    if not np.isfinite(vector).all():
        raise ValueError(f"the blade's {name} is not finite: {vector.tolist()}")
    return vector


def _as_unit(value: np.ndarray, name: str) -> np.ndarray:
    vector = _as_vector(value, name)
    largest = float(np.abs(vector).max())
    if largest == 0.0:
        raise ValueError(f"the blade's {name} is zero; give it a direction")
    vector = vector / largest
    return vector / np.linalg.norm(vector)
