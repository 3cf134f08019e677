# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Plane cages for the tests, and what must hold of every plane cage that was cut."""

from __future__ import annotations

import numpy as np

from newton_cagecut.cage import Cage


def outline(*loops) -> Cage:
    """A plane cage of loops of points: outer ones counterclockwise, those around holes clockwise."""
    sizes = [len(loop) for loop in loops]
    first = np.concatenate([[0], np.cumsum(sizes)])
    faces = [(int(k + i), int(k + (i + 1) % n)) for k, n in zip(first, sizes, strict=False) for i in range(n)]
    return Cage(np.concatenate([np.asarray(loop, dtype=np.float64) for loop in loops]), faces)


def ring(count: int, radius: float = 1.0, inner: float | None = None) -> np.ndarray:
    """A regular polygon, or a star with ``count`` spikes if an inner radius is given, shape (n, 2)."""
    n = count if inner is None else 2 * count
    angle = np.arange(n) * 2.0 * np.pi / n + 0.1
    r = np.where(np.arange(n) % 2 == 0, radius, radius if inner is None else inner)
    return np.c_[r * np.cos(angle), r * np.sin(angle)]


def rectangle(low, high) -> np.ndarray:
    """The corners of a rectangle, counterclockwise."""
    (a, b), (c, d) = low, high
    return np.array([[a, b], [c, b], [c, d], [a, d]], dtype=np.float64)


def square() -> Cage:
    """The unit square."""
    return outline(rectangle((0, 0), (1, 1)))


def comb() -> Cage:
    """A comb of four teeth."""
    teeth = [[x + dx, y] for x in (6, 4, 2, 0) for dx, y in ((1, 1), (1, 3), (0, 3), (0, 1))]
    return outline([[0, 0], [7, 0], *teeth[1:-1]])


def island() -> Cage:
    """A square with a square hole in which another body lies."""
    return outline(rectangle((0, 0), (5, 5)), rectangle((1, 1), (4, 4))[::-1], rectangle((2, 2), (3, 2.5)))


PLANES = {
    "square": square,
    "l_shape": lambda: outline([[0, 0], [2, 0], [2, 1], [1, 1], [1, 3], [0, 3]]),
    "star": lambda: outline(ring(5, inner=0.45)),
    "holed_square": lambda: outline(rectangle((0, 0), (3, 3)), rectangle((1, 1), (2, 2))[::-1]),
    "annulus": lambda: outline(ring(12), ring(9, 0.6)[::-1]),
    "comb": comb,
    "island": island,
    "collinear": lambda: outline([[0, 0], [1, 0], [2, 0], [2, 0.5], [2, 1.2], [1.1, 0.9], [0.4, 1.7], [0, 1]]),
}
"""Plane cages: convex, concave, with holes, in two bodies, with collinear segments."""


def loops_of(cage: Cage) -> list[list[int]]:
    """The loops of a plane cage, found by walking; every vertex lies on just one."""
    after = dict(cage.faces)
    assert len(after) == len(set(after.values())) == cage.face_count == cage.vertex_count
    loops = []
    while after:
        first = min(after)
        loop, vertex = [first], after.pop(first)
        while vertex != first:
            loop.append(vertex)
            vertex = after.pop(vertex)
        loops.append(loop)
    return loops


def check_outline(cage: Cage, area: float, rtol: float = 1e-9) -> None:
    """Assert what every edit of a plane cage must preserve."""
    cage.validate()
    loops = loops_of(cage)
    assert len(loops) == cage.component_count
    assert cage.euler_characteristic == 0
    areas = [_shoelace(cage.vertices[loop]) for loop in loops]
    found = cage.component_volumes[[cage.vertex_component[loop[0]] for loop in loops]]
    np.testing.assert_allclose(areas, found, rtol=rtol, atol=1e-15 * cage.diameter**2)
    np.testing.assert_allclose([sum(areas), cage.volume], area, rtol=rtol)
    assert (cage.piece_volumes > 0.0).all()
    assert cage.piece_count == np.count_nonzero(cage.component_volumes > 0.0)
    start, end = np.moveaxis(cage.vertices[np.array(cage.faces)], 1, 0)
    walls = [cage.walls[w] for w in cage.face_wall]
    sign = 1 - 2 * cage.face_side
    normal = np.array([wall.normal for wall in walls]) * sign[:, None]
    along = end - start
    assert (normal[:, 0] * along[:, 1] - normal[:, 1] * along[:, 0] > 0.0).all()
    origin = np.array([wall.origin for wall in walls])
    for point in (start, end):
        np.testing.assert_allclose(np.einsum("ij,ij->i", point - origin, normal), 0.0, atol=1e-9 * cage.diameter)


def _shoelace(points: np.ndarray) -> float:
    x, y = (points - points[0]).T
    return 0.5 * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def segment_crossings(cage: Cage) -> int:
    """Number of pairs of segments that cross at a point inside of both; sides of cuts only coincide."""
    start, end = np.moveaxis(cage.vertices[cage.simplices] / cage.diameter, 1, 0)
    along = end - start
    length = np.hypot(*along.T)[:, None]
    left = np.stack([-along[:, 1], along[:, 0]], axis=1) / length
    height = [(point[None] - start[:, None]) @ left[:, :, None] for point in (start, end)]
    one, two = height[0][..., 0], height[1][..., 0]
    apart = (one * two < 0.0) & (np.minimum(np.abs(one), np.abs(two)) > 1e-9)
    return int(np.count_nonzero(apart & apart.T)) // 2
