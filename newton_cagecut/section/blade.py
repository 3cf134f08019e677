# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Blades, and the planes that they sweep.

Section 5.2 of the paper defines a cut in 3D by a line and a cutting direction; in the plane (section 4) the blade is a
point. There the line is what the point sweeps, its edge sticks out of the plane, and every vector has two numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import as_number, as_vector, dots, is_number, lifted, shown

_LEAST_SINE = 1e-3
_STARTS = (-np.inf, np.finfo(float).max)


class Blade:
    """A straight edge, or in the plane a point, that moves in one direction, in the rest frame."""

    def __init__(
        self,
        origin: np.ndarray,
        edge: np.ndarray | None = None,
        direction: np.ndarray | None = None,
        *,
        width: float | tuple[float, float] | None = None,
        start: float | None = None,
    ):
        """Define a blade: ``Blade(origin, edge, direction)``, or ``Blade(origin, direction)`` in the plane.

        Args:
            origin: A point of the plane, or of the line, that the blade sweeps, shape (3,) or (2,) [m].
            edge: Direction of the blade's line, of any length, shape (3,); in the plane there is none.
            direction: Direction in which the blade moves, of any length, not along the edge, shape (3,) or (2,).
            width: Where the knife ends along its edge, from the origin: (heel, tip), or one length for both ways
                together with the origin in the middle; None for a knife without ends, as always in the plane [m].
            start: Where the knife starts along its direction, from the origin; what lies behind is not cut. None for
                outside of the body; in the plane it must lie outside, between parts of the body [m].

        Raises:
            TypeError: If something is not as many numbers as the space has dimensions, or missing.
            ValueError: If something is not finite, a direction is zero or both are parallel, or the blade has an edge
                or a width in the plane.
        """
        self.origin = as_vector(origin, "the blade's origin")
        if self.dimension == 2:
            direction = _only_direction(edge, direction, width)
            self.edge = np.zeros(2)
        else:
            if edge is None or direction is None:
                raise TypeError("a blade in space needs an edge and a direction: Blade(origin, edge, direction)")
            self.edge = _as_unit(edge, "edge", 3)
        self.direction = _as_unit(direction, "direction", self.dimension)
        self.normal = _normal(self.edge, self.direction)
        self.heel, self.tip = _as_width(width)
        self.start = -np.inf if start is None else as_number(start, "the blade's start", limits=_STARTS)
        for vector in (self.origin, self.edge, self.direction, self.normal):
            vector.setflags(write=False)

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return len(self.origin)

    @property
    def window(self) -> tuple[float, float, float] | None:
        """Heel, tip and start, None where the blade has none of them [m]."""
        window = (self.heel, self.tip, self.start)
        return window if np.isfinite(window).any() else None

    def __repr__(self) -> str:
        edge = f"edge={self.edge.tolist()}, " if self.dimension == 3 else ""
        return f"Blade(origin={self.origin.tolist()}, {edge}direction={self.direction.tolist()})"


@dataclass(frozen=True, eq=False)
class BladePlane:
    """The plane that a blade sweeps, with a coordinate along its edge and one along its direction.

    In 2D it is the line that the blade sweeps; the coordinate along the edge, which sticks out of it, is zero.
    """

    origin: np.ndarray
    """A point of the plane, shape (dimension,) [m]."""
    edge: np.ndarray
    """Unit direction of the blade's line, shape (3,); in 2D what the plane sees of it, zero, shape (2,)."""
    direction: np.ndarray
    """Unit direction of the sweep, shape (dimension,)."""
    normal: np.ndarray
    """Unit normal, along ``edge x direction``, which in 2D is left of the direction, shape (dimension,)."""

    @classmethod
    def of(cls, blade: Blade) -> BladePlane:
        """The plane through a blade's origin.

        Args:
            blade: The blade.
        """
        return cls(blade.origin, blade.edge, blade.direction, blade.normal)

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return len(self.origin)

    @property
    def across(self) -> np.ndarray:
        """Unit direction of the plane across its edge, ahead, shape (dimension,)."""
        return self.direction if self.dimension == 2 else np.cross(self.normal, self.edge)

    def in_space(self) -> BladePlane:
        """The plane itself, or in 2D the one in space that stands on the line, with the blade's edge along z."""
        if self.dimension == 3:
            return self
        return BladePlane(lifted(self.origin), np.array([0.0, 0.0, 1.0]), lifted(self.direction), lifted(self.normal))

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

    def towards(self, direction: np.ndarray) -> BladePlane:
        """The plane in which the blade moves in another direction.

        Args:
            direction: The direction, of any length, not along the edge, shape (dimension,).

        Raises:
            TypeError: If the direction is not as many numbers as the space has dimensions.
            ValueError: If the direction is not finite, zero or along the edge.
        """
        edge = (self.edge,) if self.dimension == 3 else ()
        return BladePlane.of(Blade(self.origin, *edge, direction))

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Signed distance, the same to the last bit for the same point, shape (point_count,) [m].

        Args:
            points: Points, shape (point_count, dimension) [m].
        """
        return dots(points - self.origin, self.normal)

    def coordinates(self, points: np.ndarray) -> np.ndarray:
        """Coordinates (a, s) along the edge and the direction, shape (point_count, 2) [m].

        Args:
            points: Points of the plane, shape (point_count, dimension) [m].
        """
        offset = points - self.origin
        along_edge, along_direction = dots(offset, self.edge), dots(offset, self.direction)
        cosine = float(self.edge @ self.direction)
        square = 1.0 - cosine * cosine
        a = (along_edge - cosine * along_direction) / square
        s = (along_direction - cosine * along_edge) / square
        return np.stack([a, s], axis=1)


def _normal(edge: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Unit normal along ``edge x direction``, the edge of a plane's blade pointing out of it."""
    if len(direction) == 2:
        return np.array([-direction[1], direction[0]])
    normal = np.cross(edge, direction)
    sine = float(np.linalg.norm(normal))
    if sine < _LEAST_SINE:
        raise ValueError(
            f"the blade's edge and direction are parallel (sine of their angle {sine:.3g}): they span no plane"
        )
    return normal / sine


def _only_direction(edge: np.ndarray | None, direction: np.ndarray | None, width: object) -> np.ndarray:
    """The direction of a blade in the plane, which comes in the place of the edge or by its name."""
    if width is not None:
        raise ValueError(f"a blade in the plane is a point, which has no width, got {width!r}")
    if direction is None:
        direction = edge
    elif edge is not None:
        raise ValueError("a blade in the plane has no edge; give Blade(origin, direction)")
    if direction is None:
        raise TypeError("a blade in the plane needs a direction: Blade(origin, direction)")
    return direction


def _as_width(width: float | tuple[float, float] | None) -> tuple[float, float]:
    if width is None:
        return -np.inf, np.inf
    ends = (-0.5 * width, 0.5 * width) if is_number(width) else width
    if not (isinstance(ends, tuple | list | np.ndarray) and len(ends) == 2 and all(is_number(end) for end in ends)):
        raise TypeError(f"the blade's width must be a length or (heel, tip), got {shown(width)}")
    heel, tip = (as_number(end, "the blade's width") for end in ends)
    if not heel < tip:
        raise ValueError(f"the blade's heel must lie before its tip, got ({heel:g}, {tip:g})")
    return heel, tip


def _as_unit(value: np.ndarray, name: str, dimension: int) -> np.ndarray:
    vector = as_vector(value, f"the blade's {name}", dimension=dimension)
    largest = float(np.abs(vector).max())
    if largest == 0.0:
        raise ValueError(f"the blade's {name} is zero; give it a direction")
    vector = vector / largest
    return vector / np.linalg.norm(vector)
