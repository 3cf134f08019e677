# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces for the tests, and what must hold of every surface that was cut."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from assets.sphere import icosphere
from cage_shapes import box
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from plane_shapes import square


def cut_through(surface: Surface, blades: Sequence[Blade], steps: int = 4) -> Iterator[Surface]:
    """Cut a surface in the unit box by blades, one after the other; yields the surface after each step."""
    cage = box() if surface.dimension == 3 else square()
    for blade in blades:
        cut = Cut(cage, blade)
        surface_cut = SurfaceCut(surface, cut.plane, cut.wall, window=cut.window)
        for depth in cut.length * np.linspace(0.2, 1.01, steps):
            edit = cut.advance(to=depth)
            surface = surface_cut.advance(edit.front).surface
            yield surface
        cage = edit.cage


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


def annulus(around: int = 40, across: int = 4, radius: float = 0.45, inner: float = 0.2) -> Surface:
    """A flat ring in the unit square; with an inner radius of zero, a disk."""
    angle = 2.0 * np.pi * np.arange(around) / around
    r = np.linspace(radius, inner, across + 1)[:, None, None]
    rings = 0.5 + r * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    i, j = np.meshgrid(np.arange(across), np.arange(around), indexing="ij")
    a, b = around * i + j, around * i + (j + 1) % around
    c, d = a + around, b + around
    triangles = np.concatenate([np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)]).reshape(-1, 3)
    if inner > 0.0:
        return Surface(rings.reshape(-1, 2), triangles)
    merged = np.minimum(triangles, around * across)
    used = (merged != np.roll(merged, 1, axis=1)).all(axis=1)
    return Surface(rings.reshape(-1, 2)[: around * across + 1], merged[used])


def disk(around: int = 40, across: int = 5, radius: float = 0.45) -> Surface:
    """A flat disk in the unit square."""
    return annulus(around, across, radius, 0.0)


def flower() -> Surface:
    """A flat disk with deep dents in the unit square, so that sections have several parts, with texture coordinates."""
    plain = disk(60, 6)
    offset = plain.points - 0.5
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    points = 0.5 + (0.7 + 0.3 * np.cos(5.0 * angle))[:, None] * offset
    return Surface(points, plain.triangles, uvs=points @ np.array([[0.3, 0.1], [-0.2, 0.7]]))


def grid(count: int = 6) -> Surface:
    """A flat square in the unit square, of squares that are halved along the same diagonal."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    points = 0.1 + 0.8 / count * np.stack([i, j], axis=-1).reshape(-1, 2)
    a = (i * (count + 1) + j)[:-1, :-1].reshape(-1)
    b, c, d = a + count + 1, a + count + 2, a + 1
    return Surface(points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))


def gridded_box(count: int = 4) -> Surface:
    """A box in the unit box, its sides gridded like that."""
    flat, sides = grid(count), []
    for axis in range(3):
        for height, order in ((0.1, [0, 2, 1]), (0.9, [0, 1, 2])):
            points = np.roll(np.c_[np.full(flat.point_count, height), flat.points], axis, axis=1)
            sides.append((points, flat.triangles[:, order]))
    points = np.concatenate([side[0] for side in sides])
    _, first, place = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    triangles = np.concatenate([side[1] + k * flat.point_count for k, side in enumerate(sides)])
    return Surface(points[first], place.reshape(-1)[triangles])


SURFACES = {"sphere": sphere, "bumpy_sphere": bumpy_sphere, "torus": torus}
FLAT = {"disk": disk, "annulus": annulus, "flower": flower}
EVERY = SURFACES | FLAT
"""Surfaces in the unit box, and flat ones in the unit square."""


def around(surface: Surface) -> Cage:
    """The unit box or the unit square."""
    return box() if surface.dimension == 3 else square()


def check_surface(surface: Surface, volume: float) -> None:
    """Assert what cuts keep: of a solid one that it is closed, of a flat one that it is a manifold with its area."""
    if surface.dimension == 3:
        check_closed(surface, volume)
        return
    mesh = surface.mesh
    surface.refuse_branches()
    assert np.bincount(mesh.face_vertex, minlength=surface.site_count).min() > 0
    assert mesh.face_area_vector[:, 2].min() > -1e-13
    assert (surface.triangle_cap == -1).all()
    border = mesh.twin < 0
    for ends in (mesh.face_vertex[border], mesh.destination[border]):
        assert np.bincount(ends).max() == 1
    np.testing.assert_allclose(surface.volume, volume, rtol=1e-11)


def check_sides(surface: Surface, plane, wall: int, *, tolerance: float = 1e-12) -> None:
    """Assert that both sides of a cut lie on its plane, face the right way, and are equally large."""
    if surface.dimension == 3:
        check_caps(surface, plane, wall)
        return
    mesh = surface.mesh
    height, s = plane.distance(surface.points), plane.coordinates(surface.points)[:, 1]
    on_wall = surface.point_key // 2 == wall
    assert np.abs(height[on_wall]).max(initial=0.0) < tolerance
    border = mesh.twin < 0
    ends = np.stack([mesh.face_vertex[border], mesh.destination[border]], axis=1)
    ends = ends[(np.abs(height) < tolerance)[ends].all(axis=1) & on_wall[ends].any(axis=1)]
    ends = ends[s[ends].max(axis=1) > s[on_wall].min(initial=np.inf) + tolerance]  # others lie on the strip before
    along = np.diff(s[ends], axis=1)[:, 0]
    side = np.where(on_wall[ends], surface.point_key[ends] % 2, 1).min(axis=1)
    assert (along[side == 0] <= tolerance).all()
    assert along.sum() == pytest.approx(0.0, abs=tolerance)


def check_closed(surface: Surface, volume: float) -> None:
    """Assert that a surface is a closed manifold without unused points around the volume."""
    mesh = surface.mesh
    assert surface.closed
    assert np.bincount(mesh.face_vertex, minlength=surface.site_count).min() > 0
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
    assert np.abs(plane.distance(surface.points[on_wall])).max(initial=0.0) < 1e-9
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
