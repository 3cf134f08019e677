# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangulation of weakly simple polygons by ear clipping.

The faces that cutting leaves (section 5.1 of the paper) have slits, bridges to holes and collinear corners.
Orientation tests break ties as if every corner stood an infinitesimal step inside the polygon (simulation of
simplicity, Edelsbrunner and Muecke 1990): so the two sides of a slit are apart and the polygon is simple. Whatever ears
are clipped, the signed triangles sum to the polygon, so that no point of it is left uncovered.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

_FLAT = 1e-13
_FLAT_STEP = 1e-9
_UTURN = 1e-7
_POOR = 1e-3
_MANY = 512
"""Pairs of an ear and a corner that may lie in it, from which they are looked at as arrays first."""


def triangulate(points: np.ndarray, *, apart: np.ndarray | None = None) -> np.ndarray:
    """Triangulate a polygon given by its corners in counterclockwise order.

    The polygon may touch itself as slits and bridges do: edges that coincide, corners that coincide, collinear corners.

    Args:
        points: Corners, shape (corner_count, 2).
        apart: Corners of which no diagonal may join two, as a mask, shape (corner_count,). That can be had if they lie
            on the border of a convex region around the polygon, edges between them on that border too, and some other
            corner is there.

    Returns:
        Triangles of corner indices, shape (corner_count - 2, 3), counterclockwise.

    Raises:
        ValueError: If there are fewer than three corners.
    """
    points = np.asarray(points, dtype=np.float64)
    count = len(points)
    if count < 3:
        raise ValueError(f"a polygon needs at least 3 corners, got {count}")
    if count == 3:
        return np.array([[0, 1, 2]])
    clipper = _EarClipper(_scaled(points.tolist()), [False] * count if apart is None else np.asarray(apart).tolist())
    return np.array(clipper.clip(), dtype=np.int64)


def convex_quad_triangles(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangulate those of many quads that are strictly convex, as :func:`triangulate` does.

    Args:
        points: Corners in counterclockwise order, shape (quad_count, 4, 2).

    Returns:
        Triangles of corner indices of the convex quads, shape (convex_count, 2, 3), and which quads are convex, shape
        (quad_count,).
    """
    low, high = points.min(axis=1), points.max(axis=1)
    scale = (high - low).max(axis=1)
    q = (points - low[:, None]) / np.where(scale > 0.0, scale, 1.0)[:, None, None]
    p, r = np.roll(q, 1, axis=1), np.roll(q, -1, axis=1)
    (ux, uy), (vx, vy), (wx, wy) = (np.moveaxis(edge, -1, 0) for edge in (q - p, r - p, r - q))
    turn = ux * vy - uy * vx
    convex = (turn > _FLAT * ((abs(ux) + abs(uy)) + (abs(vx) + abs(vy)))).all(axis=1)
    squares = (ux * ux + wx * wx + vx * vx) + (uy * uy + wy * wy + vy * vy)
    quality = (turn / np.where(squares > 0.0, squares, 1.0))[convex]
    rank = np.argsort(-quality, axis=1, kind="stable")
    best, opposite = rank[:, 0], (rank[:, 0] + 2) % 4
    worth = np.take_along_axis(quality, np.stack([best, opposite], axis=1), axis=1)
    second = rank[:, 1] == opposite
    together = (worth[:, 1] >= 0.25 * worth[:, 0]) | (second & (worth[:, 1] >= _POOR * worth[:, 0]))
    around = np.array([-1, 0, 1])
    ears = (np.stack([best, opposite], axis=1)[:, :, None] + around) % 4
    ears[~together, 1] = np.sort(ears[~together, 1], axis=1)  # what one ear leaves is no ear
    return ears, convex


def _scaled(points: list[list[float]]) -> list[list[float]]:
    """Corners in a unit square, each with its inward step behind."""
    xs, ys = [x for x, _ in points], [y for _, y in points]
    low_x, low_y = min(xs), min(ys)
    scale = max(max(xs) - low_x, max(ys) - low_y)
    if scale <= 0.0:
        scale = 1.0
    scaled = [((x - low_x) / scale, (y - low_y) / scale) for x, y in points]
    return [[*spot, *step] for spot, step in zip(scaled, _inward_directions(scaled))]


def _inward_directions(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Unit directions from the corners into the polygon, ahead at a slit's tip."""
    out = _unit_edges(points)
    steps = []
    for (into_x, into_y), (out_x, out_y) in zip([out[-1], *out[:-1]], out):
        x, y = -(into_y + out_y), into_x + out_x
        length = _length(x, y)
        steps.append((into_x, into_y) if length < _UTURN else (x / length, y / length))
    return steps


def _unit_edges(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Unit vectors of the edges that leave the corners; an edge without length takes over from the one before it."""
    edges = [(qx - px, qy - py) for (px, py), (qx, qy) in zip(points, [*points[1:], points[0]])]
    lengths = [_length(x, y) for x, y in edges]
    units = [(x / length, y / length) if length > 0.0 else None for (x, y), length in zip(edges, lengths)]
    before = next((unit for unit in reversed(units) if unit is not None), (1.0, 0.0))
    for i, unit in enumerate(units):
        units[i] = before = unit or before
    return units


def _length(x: float, y: float) -> float:
    return abs(complex(x, y))  # of the C library, as NumPy's; that of ``math`` rounds in another way


def _orientation(p: list[float], q: list[float], r: list[float]) -> float:
    """Sign of the turn p, q, r with ties broken by the corners' inward steps, the last two numbers of each."""
    px, py, pa, pb = p
    qx, qy, qa, qb = q
    rx, ry, ra, rb = r
    ux, uy, vx, vy = qx - px, qy - py, rx - px, ry - py
    value = ux * vy - uy * vx
    reach = (abs(ux) + abs(uy)) + (abs(vx) + abs(vy))
    if abs(value) > _FLAT * reach:
        return _sign(value)
    ua, ub, va, vb = qa - pa, qb - pb, ra - pa, rb - pb
    first = (ua * vy - ub * vx) + (ux * vb - uy * va)
    if abs(first) > _FLAT_STEP * reach:
        return _sign(first)
    second = ua * vb - ub * va
    return _sign(second) if abs(second) > _FLAT_STEP else 0.0


def _sign(value: float) -> float:
    return (value > 0.0) - (value < 0.0)


def _shape_quality(p: list[float], q: list[float], r: list[float]) -> float:
    """Area over squared edge lengths: greatest for equilateral triangles, zero for flat ones, negative for inverted."""
    ux, uy, vx, vy, wx, wy = q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1], r[0] - q[0], r[1] - q[1]
    squares = (ux * ux + wx * wx + vx * vx) + (uy * uy + wy * wy + vy * vy)
    return (ux * vy - uy * vx) / (squares if squares > 0.0 else 1.0)


class _EarClipper:
    """A polygon from which ears are cut in rounds, many at a time.

    Its corners are few as a rule, so that loops over numbers are several times faster than arrays.

    Args:
        corner: Position and inward step of each corner, four numbers.
        apart: Whether each corner is one of those of which no diagonal may join two.
    """

    def __init__(self, corner: list[list[float]], apart: list[bool]) -> None:
        self._corner = corner
        self._apart = apart
        self._remaining = list(range(len(corner)))
        self._turn = [0.0] * len(corner)
        self._quality = [0.0] * len(corner)
        self._changed = [True] * len(corner)
        """Corners one of whose neighbours is another than when their turn and quality were found."""

    def clip(self) -> list[tuple[int, int, int]]:
        """Triangles of corner indices, counterclockwise."""
        triangles = []
        while (size := len(self._remaining)) > 3:
            clipped = self._choose_ears()
            here = self._remaining
            triangles += [(here[i - 1], here[i], here[(i + 1) % size]) for i in clipped]
            for i in clipped:
                self._changed[here[i - 1]] = self._changed[here[(i + 1) % size]] = True
            gone = set(clipped)
            self._remaining = [number for i, number in enumerate(here) if i not in gone]
        if size == 3:
            triangles.append(tuple(self._remaining))
        return triangles

    def _choose_ears(self) -> list[int]:
        """Positions in ``remaining`` of ears that can be clipped together, at least one."""
        here, turn, apart = self._remaining, self._turn, self._apart
        after = [*here[1:], here[0]]
        ring = list(zip([here[-1], *here[:-1]], here, after))
        for a, b, c in ring:
            if self._changed[b]:
                self._measure(a, b, c)
        allowed = [not (apart[a] and apart[c]) for a, b, c in ring]
        quality = [self._quality[number] for number in here]
        candidates = [i for i, number in enumerate(here) if turn[number] > 0.0 and allowed[i]]
        if not candidates:
            choice = [i for i, is_allowed in enumerate(allowed) if is_allowed] or range(len(here))
            return [max(choice, key=quality.__getitem__)]
        blocking = [number for number in here if turn[number] <= 0.0]
        blocked = self._blocked([ring[i] for i in candidates], blocking)
        free = [i for i, is_blocked in zip(candidates, blocked) if not is_blocked]
        if not free:
            return [max(candidates, key=quality.__getitem__)]
        free.sort(key=lambda i: -quality[i])
        best = quality[free[0]]
        least, poor = min(0.25 * best, best), _POOR * best
        half = len(free) // 2
        good = [i for rank, i in enumerate(free) if quality[i] >= least or (rank < half and quality[i] >= poor)]
        return _not_neighbours(good, len(here))

    @cached_property
    def _positions(self) -> np.ndarray:
        return np.array(self._corner)[:, :2]

    def _measure(self, a: int, b: int, c: int) -> None:
        p, q, r = self._corner[a], self._corner[b], self._corner[c]
        self._turn[b] = _orientation(p, q, r)
        self._quality[b] = _shape_quality(p, q, r)
        self._changed[b] = False

    def _blocked(self, ears: list[tuple[int, int, int]], others: list[int]) -> list[bool]:
        """Whether some other corner lies in the closed triangle of each ear."""
        if len(ears) * len(others) < _MANY:
            return [self._holds_any(ear, others) for ear in ears]
        near = self._near(np.array(ears), np.array(others))
        return [bool(spots) and self._holds_any(ear, spots) for ear, spots in zip(ears, near)]

    def _near(self, ears: np.ndarray, others: np.ndarray) -> list[list[int]]:
        """The other corners in the box of each ear."""
        triangle = self._positions[ears]
        low, high = triangle.min(axis=1)[:, None] - _FLAT, triangle.max(axis=1)[:, None] + _FLAT
        spot = self._positions[others]
        inside = ((spot >= low) & (spot <= high)).all(axis=2)
        return [others[row].tolist() for row in inside]

    def _holds_any(self, ear: tuple[int, int, int], others: list[int]) -> bool:
        a, b, c = ear
        p, q, r = self._corner[a], self._corner[b], self._corner[c]
        low_x, high_x = min(p[0], q[0], r[0]) - _FLAT, max(p[0], q[0], r[0]) + _FLAT
        low_y, high_y = min(p[1], q[1], r[1]) - _FLAT, max(p[1], q[1], r[1]) + _FLAT
        for number in others:
            spot = self._corner[number]
            if (
                low_x <= spot[0] <= high_x
                and low_y <= spot[1] <= high_y
                and number != a
                and number != c
                and _orientation(r, p, spot) >= 0.0
                and _orientation(p, q, spot) >= 0.0
                and _orientation(q, r, spot) >= 0.0
            ):
                return True
        return False


def _not_neighbours(positions: list[int], size: int) -> list[int]:
    """The leading positions of which no two are neighbours on a ring of ``size``."""
    taken = bytearray(size)
    chosen = []
    for p in positions:
        if not taken[p]:
            chosen.append(p)
            taken[p - 1] = taken[p] = taken[(p + 1) % size] = 1
    return chosen
