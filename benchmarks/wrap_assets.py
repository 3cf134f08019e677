# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Ten meshes to make cages around, by formulas: solid, thin, open, knotted and in pieces."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from assets.sphere import icosphere
from newton_cagecut.usd import read_mesh

Mesh = tuple[np.ndarray, np.ndarray]

_ASSETS = Path(__file__).parent.parent / "assets"


def tube(centres: np.ndarray, radius: float, sides: int, *, closed: bool) -> Mesh:
    """A round tube along a curve, its ends capped where it is open.

    Args:
        centres: Points of the curve, shape (n, 3) [m].
        radius: Of the tube [m].
        sides: Points around it.
        closed: Whether the curve is.
    """
    n = len(centres)
    if closed:
        along = np.roll(centres, -1, axis=0) - np.roll(centres, 1, axis=0)
    else:
        along = np.gradient(centres, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    first = np.cross(along, [0.31, 0.17, 0.93])
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(along, first)
    angle = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.cos(angle)[:, None, None] * first + np.sin(angle)[:, None, None] * second
    points = (centres + radius * ring).transpose(1, 0, 2).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n if closed else n - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    c, d = (i + 1) % n * sides + j, (i + 1) % n * sides + (j + 1) % sides
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([b, d, c], -1)]).reshape(-1, 3)
    if not closed:
        turn = np.arange(1, sides - 1)
        start, end = np.stack([0 * turn, turn + 1, turn], 1), np.stack([0 * turn, turn, turn + 1], 1)
        triangles = np.concatenate([triangles, start, end + (n - 1) * sides])
    return points, triangles


def extruded(outline: np.ndarray, triangles: np.ndarray, height: float) -> Mesh:
    """A prism over a plane outline.

    Args:
        outline: Corners, counterclockwise, shape (n, 2) [m].
        triangles: What fills it.
        height: Of the prism [m].
    """
    n, i = len(outline), np.arange(len(outline))
    points = np.concatenate([np.c_[outline, np.zeros(n)], np.c_[outline, np.full(n, height)]])
    j = (i + 1) % n
    sides = np.concatenate([np.stack([i, j, j + n], 1), np.stack([i, j + n, i + n], 1)])
    return points, np.concatenate([triangles[:, ::-1], triangles + n, sides])


def merged(*meshes: Mesh) -> Mesh:
    """Meshes as one."""
    start = np.cumsum([0, *(len(points) for points, _ in meshes)])
    points = np.concatenate([points for points, _ in meshes])
    return points, np.concatenate([triangles + offset for (_, triangles), offset in zip(meshes, start)])


def box() -> Mesh:
    """A box of twelve triangles."""
    return extruded(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), np.array([[0, 1, 2], [0, 2, 3]]), 0.6)


def bracket() -> Mesh:
    """An L of twenty triangles."""
    outline = np.array([[0.0, 0], [2, 0], [2, 0.5], [0.5, 0.5], [0.5, 2], [0, 2]])
    return extruded(outline, np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]), 0.7)


def ball() -> Mesh:
    """A sphere of 1280 triangles."""
    return icosphere(3)


def bowl() -> Mesh:
    """The lower half of a sphere, open above."""
    points, triangles = icosphere(3)
    triangles = triangles[points[triangles][:, :, 2].mean(axis=1) < 0.0]
    used, corner = np.unique(triangles, return_inverse=True)
    return points[used], corner.reshape(-1, 3)


def leaf() -> Mesh:
    """A bent sheet without thickness."""
    u, v = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-0.5, 0.5, 11), indexing="ij")
    points = np.stack([u, v, 0.4 * u**2 + 0.2 * v], -1).reshape(-1, 3)
    a = (np.arange(20)[:, None] * 11 + np.arange(10)).reshape(-1)
    return points, np.concatenate([np.stack([a, a + 11, a + 12], 1), np.stack([a, a + 12, a + 1], 1)])


def ring(centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mesh:
    """A torus.

    Args:
        centre: Its middle [m].
    """
    u = 2.0 * np.pi * np.arange(48) / 48
    return tube(np.stack([np.cos(u), np.sin(u), 0.0 * u], 1) + centre, 0.3, 16, closed=True)


def rings() -> Mesh:
    """Two tori with 0.4 m between them."""
    return merged(ring(), ring((3.0, 0.0, 0.0)))


def knot() -> Mesh:
    """A trefoil."""
    t = 2.0 * np.pi * np.arange(160) / 160
    curve = np.stack([np.sin(t) + 2.0 * np.sin(2.0 * t), np.cos(t) - 2.0 * np.cos(2.0 * t), -np.sin(3.0 * t)], 1)
    return tube(curve, 0.35, 12, closed=True)


def spring() -> Mesh:
    """A helix of three turns."""
    t = np.linspace(0.0, 6.0 * np.pi, 121)
    return tube(np.stack([np.cos(t), np.sin(t), 0.2 * t], 1), 0.2, 12, closed=False)


def starfish() -> Mesh:
    """The starfish of the demo, which ``assets/starfish.py`` makes."""
    mesh = read_mesh(_ASSETS / "starfish.usdc")
    return mesh.points, mesh.triangles


MESHES: dict[str, Callable[[], Mesh]] = {
    make.__name__: make for make in (box, bracket, ball, bowl, leaf, ring, rings, knot, spring, starfish)
}
"""How each mesh is made, by its name."""
