# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Shapes that bend, of strips of quads in the plane x, z that are extruded along y."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

Grid = tuple[np.ndarray, list[tuple[int, ...]]]


class Shape(NamedTuple):
    """A body, where it is held, and tractions on where it is loaded."""

    name: str
    points: np.ndarray
    quads: list[tuple[int, ...]]
    depth: tuple[float, float]
    held: Callable
    loaded: Callable
    loads: dict[str, Callable]


def along(*direction: float) -> Callable:
    """A traction that is the same everywhere."""
    return lambda x: np.array([part + 0.0 * x[0] for part in direction])


def twist(x: np.ndarray) -> np.ndarray:
    """A traction that turns about the axis x."""
    return np.array([0.0 * x[0], -x[2], x[1]])


X, Y, Z = along(1.0, 0.0, 0.0), along(0.0, 1.0, 0.0), along(0.0, 0.0, 1.0)


def strip(sections: list) -> Grid:
    """Quads between pairs of points."""
    points = np.array([point for section in sections for point in section], float)
    return points, [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(sections) - 1)]


def grid(xs: np.ndarray, zs: np.ndarray) -> Grid:
    """Quads of a rectangle."""
    m = len(zs)
    quads = [
        (i * m + j, (i + 1) * m + j, (i + 1) * m + j + 1, i * m + j + 1)
        for i in range(len(xs) - 1)
        for j in range(m - 1)
    ]
    return np.array([(x, z) for x in xs for z in zs], float), quads


def merged(*parts: Grid) -> Grid:
    """One grid of several that meet in common points."""
    numbers: dict[tuple, int] = {}
    points, quads = [], []
    for own, cells in parts:
        ids = []
        for point in own:
            key = tuple(np.round(point, 9) + 0.0)
            if key not in numbers:
                numbers[key] = len(points)
                points.append(point)
            ids.append(numbers[key])
        quads += [tuple(ids[i] for i in cell) for cell in cells]
    return np.array(points), quads


def extruded(shape: Shape) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Vertices and faces of a shape, outward."""
    points, count = shape.points, len(shape.points)
    turned = [quad if _area(points[list(quad)]) > 0.0 else quad[::-1] for quad in shape.quads]
    edges = {edge for quad in turned for edge in zip(quad, quad[1:] + quad[:1], strict=True)}
    faces = [tuple(quad) for quad in turned] + [tuple(i + count for i in quad[::-1]) for quad in turned]
    faces += [(b, a, a + count, b + count) for a, b in sorted(edges) if (b, a) not in edges]
    first, second = (np.insert(points, 1, y, axis=1) for y in shape.depth)
    return np.concatenate([first, second]), faces


def _area(corners: np.ndarray) -> float:
    return 0.5 * sum(np.linalg.det([corners[i], corners[(i + 1) % len(corners)]]) for i in range(len(corners)))


def _bar(name: str, segments: int, width: float, height: float) -> Shape:
    own = strip([((x, -height / 2), (x, height / 2)) for x in np.linspace(0.0, 1.0, segments + 1)])
    depth = (-width / 2, width / 2)
    return Shape(name, *own, depth, lambda x: x[0] < 1e-9, lambda x: x[0] > 1 - 1e-9, {"bend": Z, "twist": twist})


def _ell() -> Shape:
    legs = np.linspace(0.2, 0.6, 7)
    own = merged(grid(np.r_[0.0, legs], [0.0, 0.2]), grid([0.0, 0.2], legs))
    return Shape(
        "L-bracket", *own, (0.0, 0.2), lambda x: x[2] > 0.6 - 1e-9, lambda x: x[0] > 0.6 - 1e-9, {"in": Z, "out": Y}
    )


def _tapered() -> Shape:
    own = strip([((x, 0.1 * x - 0.15), (x, 0.15 - 0.1 * x)) for x in np.linspace(0.0, 1.0, 9)])
    return Shape(
        "tapered bar", *own, (-0.1, 0.1), lambda x: x[0] < 1e-9, lambda x: x[0] > 1 - 1e-9, {"in": Z, "out": Y}
    )


def _tee() -> Shape:
    half = np.linspace(0.08, 0.4, 4)
    own = merged(grid(np.r_[-half[::-1], half], [0.0, 0.16]), grid([-0.08, 0.08], np.linspace(-0.5, 0.0, 6)))
    return Shape(
        "T-bracket",
        *own,
        (0.0, 0.2),
        lambda x: abs(x[0]) > 0.4 - 1e-9,
        lambda x: x[2] < -0.5 + 1e-9,
        {"in": X, "out": Y},
    )


def _arc(name: str, segments: int, angle: float, radius: float, thickness: float, depth: float) -> Shape:
    turns = [np.array([np.cos(a), np.sin(a)]) for a in np.linspace(0.0, angle, segments + 1)]
    own = strip([((radius + thickness / 2) * turn, (radius - thickness / 2) * turn) for turn in turns])
    end = np.array([-np.sin(angle), np.cos(angle)])
    return Shape(
        name,
        *own,
        (0.0, depth),
        lambda x: (abs(x[2]) < 1e-9) & (x[0] > 0.0),
        lambda x: abs(end[0] * x[0] + end[1] * x[2]) < 1e-9,
        {"in": X, "out": Y},
    )


def _plate() -> Shape:
    side = np.linspace(0.0, 1.0, 9)
    return Shape(
        "clamped plate",
        *grid(side, side),
        (0.0, 0.1),
        lambda x: np.minimum(np.minimum(x[0], 1 - x[0]), np.minimum(x[2], 1 - x[2])) < 1e-9,
        lambda x: x[1] > 0.1 - 1e-9,
        {"pressure": along(0.0, -1.0, 0.0)},
    )


def _zed() -> Shape:
    low, high, web = np.linspace(0.0, 0.4, 5), np.linspace(0.28, 0.68, 5), np.linspace(0.12, 0.48, 5)
    high[1] = 0.4
    low[-2] = 0.28
    own = merged(grid(low, [0.0, 0.12]), grid([0.28, 0.4], web), grid(high, [0.48, 0.6]))
    return Shape(
        "Z-bracket", *own, (0.0, 0.15), lambda x: x[0] < 1e-9, lambda x: x[0] > 0.68 - 1e-9, {"in": Z, "out": Y}
    )


def _shelf() -> Shape:
    own = grid(np.linspace(0.0, 1.0, 9), np.linspace(0.0, 0.6, 5))
    return Shape("shelf", *own, (0.0, 0.1), lambda x: x[0] < 1e-9, lambda x: x[0] > 1 - 1e-9, {"bend": Y})


def _column() -> Shape:
    own = strip([((-0.05 - 0.1 * t, t), (0.05 + 0.05 * t * t, t)) for t in np.linspace(0.0, 0.9, 9)])
    return Shape(
        "skew column", *own, (0.0, 0.14), lambda x: x[2] > 0.9 - 1e-9, lambda x: x[2] < 1e-9, {"in": X, "out": Y}
    )


SETS: dict[str, tuple[Shape, ...]] = {
    "A": (
        _bar("square bar, 8", 8, 0.2, 0.2),
        _bar("square bar, 16", 16, 0.2, 0.2),
        _bar("tall bar", 8, 0.1, 0.3),
        _bar("flat bar", 8, 0.3, 0.1),
        _ell(),
    ),
    "B": (_tapered(), _tee(), _arc("curved arm", 8, np.pi / 2, 0.5, 0.15, 0.2), _plate()),
    "C": (_zed(), _shelf(), _arc("hook", 12, np.pi, 0.4, 0.16, 0.12), _column()),
}
"""Shapes by when they were looked at; see ``docs/locking.md``."""
