# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces for the tests, and what must hold of every surface that was cut."""

from __future__ import annotations

import numpy as np

from assets.sphere import icosphere
from newton_cagecut.surface import Surface


def sphere(level: int = 3, radius: float = 0.45, center=(0.5, 0.5, 0.5)) -> Surface:
    """A sphere in the unit box."""
    points, triangles = icosphere(level)
    return Surface(radius * points + center, triangles)


def bumpy_sphere(level: int = 4) -> Surface:
    """A star-shaped surface with deep bumps in the unit box, so that sections have several loops."""
    points, triangles = icosphere(level)
    x, y, z = points.T
    radius = 0.33 + 0.12 * np.sin(9.0 * x) * np.cos(8.0 * y + 1.0) * np.cos(7.0 * z)
    return Surface(radius[:, None] * points + 0.5, triangles, uvs=points[:, :2])


def torus(around: int = 60, across: int = 24) -> Surface:
    """A torus in the unit box."""
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    u, v = 2.0 * np.pi * i / around, 2.0 * np.pi * (j + 0.5 * (i % 2)) / across
    r = 0.3 + 0.13 * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), 0.13 * np.sin(v)], axis=-1).reshape(-1, 3) + 0.5
    following = (i + 1) % around
    odd = i % 2 == 1
    a, b = i * across + j, i * across + (j + 1) % across
    c, d = following * across + j, following * across + (j + 1) % across
    even_rows = np.stack([np.stack([a, c, b], -1), np.stack([b, c, d], -1)])
    odd_rows = np.stack([np.stack([a, c, d], -1), np.stack([a, d, b], -1)])
    return Surface(points, np.where(odd[None, ..., None], odd_rows, even_rows).reshape(-1, 3))


def outward(surface: Surface, name: str) -> np.ndarray:
    """A direction that points out of the shape at each triangle's centre, shape (triangle_count, 3)."""
    center = surface.points[surface.triangles].mean(axis=1) - 0.5
    if name != "torus":
        return center
    ring = center * [1.0, 1.0, 0.0]
    return center - 0.3 * ring / np.linalg.norm(ring, axis=1, keepdims=True)


SURFACES = {"sphere": sphere, "bumpy_sphere": bumpy_sphere, "torus": torus}


def check_closed(surface: Surface, volume: float) -> None:
    """Assert that a surface is a closed manifold without unused points around the volume."""
    mesh = surface.mesh
    assert surface.closed
    assert np.bincount(mesh.face_vertex, minlength=surface.point_count).min() > 0
    fans = mesh.face_vertex[np.unique(mesh.fan)]
    assert len(np.unique(fans)) == len(fans)
    np.testing.assert_allclose(surface.volume, volume, rtol=1e-11)


def check_outward(surface: Surface, name: str) -> None:
    """Assert that no triangle of the original surface was inverted."""
    facing = np.einsum("ij,ij->i", surface.mesh.face_area_vector, outward(surface, name))
    assert facing[surface.triangle_cap < 0].min() > -1e-13


def check_caps(surface: Surface, plane, wall: int) -> None:
    """Assert that caps lie on the plane, face the right way and have equal areas on both sides."""
    mesh = surface.mesh
    on_wall = surface.point_key // 2 == wall
    assert np.abs(plane.distance(surface.points[on_wall])).max(initial=0.0) < 1e-12
    cap = surface.triangle_cap == wall
    assert on_wall[surface.triangles[cap]].all()
    facing = mesh.face_area_vector[cap] @ plane.normal
    np.testing.assert_allclose(facing[facing > 0].sum(), -facing[facing < 0].sum(), rtol=1e-9, atol=1e-15)
    sides = surface.point_key[surface.triangles[cap]]
    front = (sides == 2 * wall).any(axis=1)
    assert facing[front].min(initial=0.0) > -1e-12
    back = ~front & ~_touches_tips_only(surface, cap, wall)
    assert facing[back].max(initial=0.0) < 1e-12


def _touches_tips_only(surface: Surface, cap: np.ndarray, wall: int) -> np.ndarray:
    """Cap triangles of which every corner is shared by both sides."""
    triangles = surface.triangles[cap]
    minus = np.unique(triangles[(surface.point_key[triangles] == 2 * wall).any(axis=1)])
    return np.isin(triangles, minus).all(axis=1)
