# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Closed forms of single and double layers against quadrature, finite differences and their limits."""

from functools import cache

import numpy as np
import pytest
import warp as wp

from newton_cagecut.harmonic.fit.layers.segment_layers import Segment, segment_layers, segment_rows, segment_slopes
from newton_cagecut.harmonic.fit.layers.triangle_layers import (
    Triangle,
    triangle_layers,
    triangle_rows,
    triangle_slopes,
)

KINDS = {
    2: (Segment, wp.vec2d, wp.mat22d, segment_layers, segment_slopes, segment_rows),
    3: (Triangle, wp.vec3d, wp.types.matrix((3, 3), wp.float64), triangle_layers, triangle_slopes, triangle_rows),
}


@cache
def make_kernels(dimension: int) -> tuple[wp.Kernel, wp.Kernel]:
    """Kernels that evaluate all panels at all points, and the gradients."""
    Panel, Vector, Matrix, layers_at, slopes_at, _ = KINDS[dimension]

    @wp.kernel(enable_backward=False)
    def evaluate(panels: wp.array[Panel], x: wp.array[Vector], out: wp.array3d[Vector]):
        i, j = wp.tid()
        layers = layers_at(panels[j], x[i])
        out[i, j, 0] = layers.charge
        out[i, j, 1] = layers.dipole

    @wp.kernel(enable_backward=False)
    def differentiate(panels: wp.array[Panel], x: wp.array[Vector], out: wp.array3d[Matrix]):
        i, j = wp.tid()
        slopes = slopes_at(panels[j], x[i])
        out[i, j, 0] = slopes.charge
        out[i, j, 1] = slopes.dipole

    return evaluate, differentiate


def layers(corners: np.ndarray, points: np.ndarray, *, slopes: bool = False) -> np.ndarray:
    """Layers of panels at points, shape (point, panel, 2, hat function), charges first; or their gradients."""
    dimension = points.shape[1]
    Panel, Vector, Matrix, _, _, rows_of = KINDS[dimension]
    out = wp.zeros((len(points), len(corners), 2), dtype=Matrix if slopes else Vector, device="cpu")
    at = wp.array(points, dtype=Vector, device="cpu")
    kernel = make_kernels(dimension)[int(slopes)]
    wp.launch(kernel, out.shape[:2], [wp.array(rows_of(corners), dtype=Panel, device="cpu"), at, out], device="cpu")
    return out.numpy().copy()


def normals_of(corners: np.ndarray) -> np.ndarray:
    """Unit normals of panels."""
    edge = corners[:, 1] - corners[:, 0]
    if corners.shape[2] == 2:
        normal = edge[:, ::-1] * [1.0, -1.0]
    else:
        normal = np.cross(edge, corners[:, 2] - corners[:, 0])
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def quadrature(dimension: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Hat functions at points of a panel, and their weights, which add up to 1; exact for polynomials."""
    place, weight = np.polynomial.legendre.leggauss(count)
    place, weight = (place + 1.0) / 2.0, weight / 2.0
    if dimension == 2:
        return np.stack([1.0 - place, place], axis=1), weight
    a, b = (grid.ravel() for grid in np.meshgrid(place, place, indexing="ij"))
    return np.stack([1.0 - a, a * (1.0 - b), a * b], axis=1), (2.0 * np.outer(weight * place, weight)).ravel()


def summed(corners: np.ndarray, points: np.ndarray, count: int = 40) -> np.ndarray:
    """What ``layers`` gives, by Gauss quadrature of the kernels."""
    dimension = points.shape[1]
    hats, weight = quadrature(dimension, count)
    size = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    if dimension == 3:
        edge = corners - corners[:, :1]
        size = np.linalg.norm(np.cross(edge[:, 1], edge[:, 2]), axis=1) / 2.0
    offset = points[:, None, None] - np.einsum("qk,jkd->jqd", hats, corners)
    r = np.linalg.norm(offset, axis=3)
    above = np.einsum("ijqd,jd->ijq", offset, normals_of(corners))
    charge = -np.log(r) / (2.0 * np.pi) if dimension == 2 else 1.0 / (4.0 * np.pi * r)
    dipole = above / (2.0 * (dimension - 1) * np.pi * r**dimension)
    return np.einsum("ijlq,qk,q,j->ijlk", np.stack([charge, dipole], axis=2), hats, weight, size)


def random_panels(dimension: int, count: int, seed: int) -> np.ndarray:
    """Panels of sizes from 0.01 to 1, some of them slivers."""
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.uniform(-2.0, 0.0, (count, 1, 1))
    stretch = 10.0 ** rng.uniform(-1.5, 0.0, (count, 1, dimension))
    return rng.normal(size=(count, 1, dimension)) + size * stretch * rng.normal(size=(count, dimension, dimension))


@pytest.mark.parametrize("dimension", [2, 3])
def test_layers_are_their_integrals(dimension):
    """Away from panels the closed forms equal a quadrature of high order."""
    corners = random_panels(dimension, 40, 1)
    rng = np.random.default_rng(2)
    points = corners.mean(axis=(0, 1)) + rng.normal(size=(60, dimension)) * 3.0
    distance = np.linalg.norm(points[:, None] - corners.mean(axis=1), axis=2)
    span = np.linalg.norm(corners - corners.mean(axis=1, keepdims=True), axis=2).max(axis=1)
    far = distance > 2.0 * span
    assert far.mean() > 0.5
    off = np.abs(layers(corners, points) - summed(corners, points))[far]
    assert off.max() < 2e-12


@pytest.mark.parametrize("dimension", [2, 3])
def test_layers_near_a_panel(dimension):
    """Close to a panel, over it and beside it, they equal the sum over small parts of it."""
    corners = random_panels(dimension, 6, 3)
    rng = np.random.default_rng(4)
    for panel in corners:
        hats = rng.dirichlet(np.ones(dimension), 8) * 1.6 - 0.6 / dimension
        width = np.linalg.norm(panel[1] - panel[0])
        heights = width * 10.0 ** rng.uniform(-1.3, -0.7, (8, 1)) * rng.choice([-1.0, 1.0], (8, 1))
        points = hats @ panel + heights * normals_of(panel[None])
        parts, share = np.eye(dimension)[None], 7 if dimension == 2 else 5
        for _ in range(share):
            middle = (parts + np.roll(parts, -1, axis=1)) / 2.0
            if dimension == 2:
                parts = np.concatenate(
                    [np.stack([parts[:, 0], middle[:, 0]], 1), np.stack([middle[:, 0], parts[:, 1]], 1)]
                )
            else:
                corner = [np.stack([parts[:, k], middle[:, k], middle[:, k - 1]], 1) for k in range(3)]
                parts = np.concatenate([*corner, middle])
        whole = np.einsum("ijlk,jkm->ilm", summed(parts @ panel, points, 8), parts)
        np.testing.assert_allclose(layers(panel[None], points)[:, 0], whole, atol=1e-8, rtol=1e-6)


@pytest.mark.parametrize("dimension", [2, 3])
def test_slopes_are_derivatives(dimension):
    """Gradients equal finite differences, over panels and beside them."""
    corners = random_panels(dimension, 30, 5)
    points = np.random.default_rng(6).normal(size=(50, dimension)) * 1.5
    clear = np.linalg.norm(points[:, None, None] - corners, axis=3).min(axis=2) > 0.3
    slope = layers(corners, points, slopes=True)
    step = 1e-5
    for axis in range(dimension):
        shift = step * np.eye(dimension)[axis]
        change = (layers(corners, points + shift) - layers(corners, points - shift)) / (2.0 * step)
        off = np.abs(slope[..., axis] - change)[clear]
        assert np.median(off) < 1e-9
        assert np.quantile(off, 0.99) < 1e-6


@pytest.mark.parametrize("dimension", [2, 3])
def test_layers_on_the_panel(dimension):
    """The single layer is continuous across a panel, the double one jumps by the density from below to above."""
    (panel,) = random_panels(dimension, 1, 7)
    panel[:, -1] = 0.0
    hats = np.random.default_rng(8).dirichlet(np.full(dimension, 3.0), 12)
    normal = normals_of(panel[None])
    on, above, below = (layers(panel[None], hats @ panel + h * normal)[:, 0] for h in (0.0, 1e-10, -1e-10))
    np.testing.assert_allclose(above[:, 0], below[:, 0], atol=1e-9)
    np.testing.assert_allclose(on[:, 0], above[:, 0], atol=1e-9)
    np.testing.assert_allclose(above[:, 1] - below[:, 1], hats, atol=1e-6)
    np.testing.assert_allclose(above[:, 1] + below[:, 1], 2.0 * on[:, 1], atol=1e-6)


@pytest.mark.parametrize("dimension", [2, 3])
def test_layers_on_edges_and_in_the_plane(dimension):
    """On corners and edges, and on their continuation, everything is finite and near to its surroundings."""
    (panel,) = random_panels(dimension, 1, 9)
    hats = (
        [[1.0, 0.0], [0.0, 1.0], [1.7, -0.7]]
        if dimension == 2
        else [[1, 0, 0], [0.5, 0.5, 0], [0, 0.2, 0.8], [1.5, -0.5, 0]]
    )
    points = np.array(hats) @ panel
    there = layers(panel[None], points)
    nearby = layers(panel[None], points + 1e-9 * normals_of(panel[None]))
    assert np.isfinite(there).all()
    np.testing.assert_allclose(there[:, :, 0], nearby[:, :, 0], atol=1e-7)
    beyond = layers(panel[None], points[-1:])
    np.testing.assert_allclose(beyond[:, :, 1], 0.0, atol=1e-14)


def closed_surface(dimension: int) -> np.ndarray:
    """A square, or a tetrahedron, with outward normals."""
    if dimension == 2:
        corner = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        return np.stack([corner, np.roll(corner, -1, axis=0)], axis=1)
    corner = np.array([[0, 0, 0], [1, 0.1, 0], [0.2, 0.9, 0.1], [0.3, 0.3, 1.1]])
    return corner[[(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]]


@pytest.mark.parametrize("dimension", [2, 3])
def test_closed_surfaces_represent_linear_functions(dimension):
    """Green's formula with the data of a linear function: the function inside, and nothing outside."""
    corners = closed_surface(dimension)
    slope = np.array([0.7, -1.3, 0.4])[:dimension]
    inside = corners.mean(axis=(0, 1)) + np.random.default_rng(0).uniform(-0.05, 0.05, (20, dimension))
    outside = inside + 3.0
    for points, value in ((inside, inside @ slope + 2.0), (outside, np.zeros(20))):
        found = layers(corners, points)
        charge = np.broadcast_to((normals_of(corners) @ slope)[:, None], corners.shape[:2])
        total = np.einsum("ijk,jk->i", found[:, :, 0], charge)
        total -= np.einsum("ijk,jk->i", found[:, :, 1], corners @ slope + 2.0)
        np.testing.assert_allclose(total, value, atol=1e-13)
        total = np.einsum("ijkd,jk->id", layers(corners, points, slopes=True)[:, :, 0], charge)
        total -= np.einsum("ijkd,jk->id", layers(corners, points, slopes=True)[:, :, 1], corners @ slope + 2.0)
        np.testing.assert_allclose(total, np.broadcast_to(slope * (value != 0.0)[:, None], total.shape), atol=1e-12)
