# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes as files have them: fans, doubled and turned triangles, walls within, sheets that touch or cross."""

from __future__ import annotations

import numpy as np

from assets.sphere import icosphere

_BOX = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6]]
    + [[1, 3, 5], [3, 7, 5]]
)

Mesh = tuple[np.ndarray, np.ndarray]


def box_mesh(low=(0.2, 0.2, 0.2), high=(0.8, 0.8, 0.8)) -> Mesh:
    """A box of 12 triangles; point 4 z + 2 y + x has the higher coordinates at the ones."""
    bits = (np.arange(8)[:, None] >> np.arange(3)) & 1
    return np.where(bits == 1, np.array(high), np.array(low)).astype(float), _BOX.copy()


def joined(*meshes: Mesh, merge: bool = True) -> Mesh:
    """Meshes as one; points at one place become one if they are to be merged."""
    counts = np.cumsum([0] + [len(points) for points, _ in meshes])
    points = np.concatenate([points for points, _ in meshes])
    triangles = np.concatenate([t + first for (_, t), first in zip(meshes, counts, strict=False)])
    if not merge:
        return points, triangles
    _, first, place = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
    return points[first], place.reshape(-1)[triangles]


def box_with_fin() -> Mesh:
    """A box with a triangle on one of its edges, which makes that a fan of three."""
    points, triangles = box_mesh()
    points = np.concatenate([points, [[0.9, 0.5, 0.9]]])
    return points, np.concatenate([triangles, [[5, 7, 8]]])


def box_with_wall() -> Mesh:
    """Two boxes that share a wall, which is there once."""
    left, right = box_mesh((0.2, 0.2, 0.2), (0.45, 0.8, 0.8)), box_mesh((0.45, 0.2, 0.2))
    points, triangles = joined(left, right)
    wall = (points[triangles][:, :, 0] == 0.45).all(axis=1)
    keep = ~wall
    keep[np.flatnonzero(wall)[:2]] = True
    return points, triangles[keep]


def book() -> Mesh:
    """Three pages at a spine, along which all run alike."""
    turns = np.array([0.0, 2.0, 4.0])
    spine = np.array([[0.5, 0.5, 0.2], [0.5, 0.5, 0.8]])
    out = 0.3 * np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=1)
    points = np.concatenate([spine, spine[0] + out, spine[1] + out])
    pages = [[[0, 2 + k, 5 + k], [0, 5 + k, 1]] for k in range(3)]
    return points, np.concatenate(pages)


def boxes_at_an_edge() -> Mesh:
    """Two boxes that share an edge."""
    return joined(box_mesh((0.15, 0.15, 0.2), (0.5, 0.5, 0.8)), box_mesh((0.5, 0.5, 0.2), (0.85, 0.85, 0.8)))


def boxes_at_a_point() -> Mesh:
    """Two boxes that share a corner."""
    return joined(box_mesh((0.15, 0.15, 0.15), (0.5, 0.5, 0.5)), box_mesh((0.5, 0.5, 0.5), (0.85, 0.85, 0.85)))


def boxes_at_a_face() -> Mesh:
    """Two boxes that share the points of a face, which is there twice, once for each."""
    return joined(box_mesh((0.2, 0.2, 0.2), (0.45, 0.8, 0.8)), box_mesh((0.45, 0.2, 0.2)))


def voxels() -> Mesh:
    """Cubes of which two touch along an edge around both of whose ends the solid hangs together."""
    full = np.ones((2, 2, 3), dtype=bool)
    full[0, 1, 1] = full[1, 0, 1] = False
    corners = [(0.2 + 0.2 * np.array(cell), 0.4 + 0.2 * np.array(cell)) for cell in np.argwhere(full)]
    points, triangles = joined(*(box_mesh(low, high) for low, high in corners))
    _, number, count = np.unique(np.sort(triangles, axis=1), axis=0, return_inverse=True, return_counts=True)
    return points, triangles[count[number.reshape(-1)] == 1]


def box_with_doubled_triangles() -> Mesh:
    """A box of which one triangle is there twice, another also the other way around, and one has no width."""
    points, triangles = box_mesh()
    return points, np.concatenate([triangles, triangles[[3]][:, [1, 2, 0]], triangles[[7]][:, ::-1], [[2, 3, 2]]])


def sphere_mesh(level: int = 2, radius: float = 0.3, center=(0.5, 0.5, 0.5)) -> Mesh:
    """A sphere."""
    points, triangles = icosphere(level)
    return radius * points + center, triangles


def sphere_with_turned_triangles() -> Mesh:
    """A sphere of which every seventh triangle runs the other way."""
    points, triangles = sphere_mesh()
    triangles = triangles.copy()
    triangles[::7] = triangles[::7, ::-1]
    return points, triangles


def overlapping_spheres() -> Mesh:
    """Two spheres that overlap."""
    return joined(sphere_mesh(2, 0.25, (0.38, 0.5, 0.5)), sphere_mesh(2, 0.25, (0.62, 0.5, 0.5)), merge=False)


def crossed_tube(around: int = 48, across: int = 12) -> Mesh:
    """A closed tube along a curve that crosses itself, so that one component passes through itself."""
    t = 2.0 * np.pi * np.arange(around) / around
    middle = np.stack([0.3 * np.cos(t), 0.25 * np.sin(2.0 * t), 0.02 * np.sin(t)], axis=1) + 0.5
    along = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross([0.0, 0.0, 1.0], along)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(along, side)
    s = 2.0 * np.pi * np.arange(across) / across
    points = middle[:, None] + 0.07 * (np.cos(s)[:, None] * side[:, None] + np.sin(s)[:, None] * up[:, None])
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = i * across + j, i * across + (j + 1) % across
    c, d = (i + 1) % around * across + j, (i + 1) % around * across + (j + 1) % across
    triangles = np.stack([np.stack([a, b, c], axis=-1), np.stack([b, d, c], axis=-1)]).reshape(-1, 3)
    return points.reshape(-1, 3), triangles


def moebius(around: int = 30) -> Mesh:
    """A Moebius strip."""
    t = 2.0 * np.pi * np.arange(around) / around
    out = np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    tilt = np.cos(t / 2.0)[:, None] * out + np.sin(t / 2.0)[:, None] * [0.0, 0.0, 1.0]
    points = 0.5 + 0.3 * out[None] + np.array([-0.1, 0.1])[:, None, None] * tilt
    i = np.arange(around)
    a, b = i, i + around
    c, d = np.where(i + 1 < around, a + 1, around), np.where(i + 1 < around, b + 1, 0)
    return points.reshape(-1, 3), np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])


def bow_tie() -> Mesh:
    """Two triangles that share a point."""
    points = [[0.5, 0.5, 0.5], [0.2, 0.3, 0.4], [0.2, 0.7, 0.4], [0.8, 0.3, 0.6], [0.8, 0.7, 0.6]]
    return np.array(points), np.array([[0, 1, 2], [0, 3, 4]])


def hemisphere() -> Mesh:
    """Half of a sphere, open."""
    points, triangles = sphere_mesh(3)
    used, triangles = np.unique(triangles[(points[triangles][:, :, 2] >= 0.5 - 1e-9).all(axis=1)], return_inverse=True)
    return points[used], triangles.reshape(-1, 3)


CLOSED = {
    "boxes_at_an_edge": (boxes_at_an_edge, 2),
    "boxes_at_a_point": (boxes_at_a_point, 2),
    "boxes_at_a_face": (boxes_at_a_face, 2),
    "overlapping_spheres": (overlapping_spheres, 2),
    "sphere_with_turned_triangles": (sphere_with_turned_triangles, 1),
    "voxels": (voxels, 1),
    "crossed_tube": (crossed_tube, 1),
}
"""Meshes that become closed sheets, and how many."""

PARTLY_OPEN = {
    "box_with_fin": (box_with_fin, 2, 0.216),
    "box_with_wall": (box_with_wall, 2, 0.216),
    "box_with_doubled_triangles": (box_with_doubled_triangles, 2, 0.216),
    "book": (book, 3, 0.0),
    "moebius": (moebius, 1, 0.0),
    "bow_tie": (bow_tie, 2, 0.0),
    "hemisphere": (hemisphere, 1, 0.0),
}
"""Meshes of which some sheets are open: how many sheets there are, and the volume in closed ones."""
