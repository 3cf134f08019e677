# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages for the tests, and what must hold of every cage that was cut."""

from __future__ import annotations

import numpy as np

from newton_cagecut.cage import Cage
from newton_cagecut.section import Blade
from plane_shapes import check_outline, ring


def box(size=(1.0, 1.0, 1.0)) -> Cage:
    """A box with one corner at the origin."""
    return voxels([(0, 0, 0)], np.array(size))


def tetrahedron() -> Cage:
    """An irregular tetrahedron."""
    vertices = [[0, 0, 0], [1, 0.1, 0], [0.2, 0.9, 0.1], [0.3, 0.3, 1.1]]
    return Cage(np.array(vertices), [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


def prism(polygon: np.ndarray, height: float = 1.0) -> Cage:
    """A prism over a counterclockwise polygon."""
    n = len(polygon)
    vertices = np.concatenate([np.c_[polygon, np.zeros(n)], np.c_[polygon, np.full(n, height)]])
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return Cage(vertices, [tuple(range(n))[::-1], tuple(range(n, 2 * n)), *sides])


def hexagonal_prism() -> Cage:
    """A regular hexagonal prism."""
    return prism(ring(6))


def star_prism() -> Cage:
    """A prism over a five-pointed star."""
    return prism(ring(5, inner=0.45))


def u_shape() -> Cage:
    """A U extruded from one eight-cornered polygon."""
    return prism(np.array([[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]], dtype=float), 0.8)


def square_torus() -> Cage:
    """A square ring of eight voxels."""
    return voxels([(i, j, 0) for i in range(3) for j in range(3) if (i, j) != (1, 1)], np.array([1.0, 1.0, 0.7]))


def merged_cube() -> Cage:
    """A cube of 3 x 3 quads a side of which some were merged to hexagons and to an L of eight corners."""
    quads = voxels([(i, j, k) for i in range(3) for j in range(3) for k in range(3)], np.ones(3) / 3)
    groups: dict[tuple, list[int]] = {}
    for i, loop in enumerate(quads.faces):
        center = quads.vertices[list(loop)].mean(axis=0) * 3
        axis = int(np.argmax(np.abs(quads.walls[i].normal)))
        side = int(center[axis] > 1.5)
        u, v = np.delete(center, axis).astype(int)
        part = 0 if (u, v) in ((0, 0), (1, 0), (0, 1)) else (1 if (u, v) in ((1, 1), (2, 1)) else 10 + 3 * u + v)
        groups.setdefault((axis, side, part), []).append(i)
    return Cage(*_compact(quads.vertices, [_merge([quads.faces[i] for i in group]) for group in groups.values()]))


def _merge(loops: list[tuple[int, ...]]) -> tuple[int, ...]:
    """The loop around faces that share edges."""
    edges = {(a, b) for loop in loops for a, b in zip(loop, loop[1:] + loop[:1], strict=True)}
    after = {a: b for a, b in edges if (b, a) not in edges}
    loop = [min(after)]
    while after[loop[-1]] != loop[0]:
        loop.append(after[loop[-1]])
    return tuple(loop)


def _compact(vertices: np.ndarray, loops: list[tuple[int, ...]]) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    used = np.unique(np.concatenate(loops))
    return vertices[used], [tuple(np.searchsorted(used, loop).tolist()) for loop in loops]


def voxels(cells, size: np.ndarray) -> Cage:
    """The surface of a set of grid cells, with one quad a cell side."""
    filled, ids, loops = set(cells), {}, []
    for cell in cells:
        for axis in range(3):
            for side in (0, 1):
                other = list(cell)
                other[axis] += 2 * side - 1
                if tuple(other) in filled:
                    continue
                u, v = (axis + 1) % 3, (axis + 2) % 3
                corners = [(0, 0), (1, 0), (1, 1), (0, 1)][:: 2 * side - 1]
                loop = []
                for du, dv in corners:
                    corner = list(cell)
                    corner[axis] += side
                    corner[u] += du
                    corner[v] += dv
                    loop.append(ids.setdefault(tuple(corner), len(ids)))
                loops.append(tuple(loop))
    return Cage(np.array(list(ids), dtype=float) * size, loops)


SHAPES = {
    "tetrahedron": tetrahedron,
    "box": box,
    "hexagonal_prism": hexagonal_prism,
    "merged_cube": merged_cube,
    "star_prism": star_prism,
    "u_shape": u_shape,
    "square_torus": square_torus,
}


CONVEX = ("tetrahedron", "box", "hexagonal_prism", "merged_cube")


def random_blade(rng: np.random.Generator, cage: Cage, margin: float = 0.2) -> Blade:
    """A blade in any direction through the middle of a cage of either dimension."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    origin = low + (high - low) * rng.uniform(margin, 1.0 - margin, cage.dimension)
    return Blade(origin, *rng.normal(size=(cage.dimension - 1, cage.dimension)))


def opened_characteristic(base: Cage, cage: Cage, wall: int) -> int:
    """Euler characteristic that opening a wall of a cut must leave.

    Each opened sheet adds twice its own characteristic (one, less one for each hole) less one for each stretch of its
    border along which its two sides stay together, vertices inside the body not counted: those that both sides share
    there lie between two such stretches, and those of one side are hubs, of which the edge is no bridge. In 2D every
    loop is closed and has none.
    """
    if cage.dimension == 2:
        return 0
    mesh = cage.mesh
    on_wall = cage.face_wall == wall
    side, face = cage.face_side[mesh.face], mesh.face
    counts = on_wall[face] & (side == 0)
    bridges = np.count_nonzero(counts & (face[mesh.twin] == face)) // 2
    fronts = np.count_nonzero(counts & on_wall[face[mesh.twin]] & (side[mesh.twin] == 1))
    elsewhere = np.zeros(cage.vertex_count, dtype=bool)
    elsewhere[mesh.face_vertex[~on_wall[face]]] = True
    shared = np.isin(np.arange(cage.vertex_count), mesh.face_vertex[on_wall[face] & (side == 1)])
    own = np.isin(np.arange(cage.vertex_count), mesh.face_vertex[counts])
    fronts -= np.count_nonzero(~elsewhere & own & shared)
    bridges -= np.count_nonzero(~elsewhere & own & ~shared)
    sheets = np.count_nonzero(on_wall & (cage.face_side == 0))
    return base.euler_characteristic + 2 * (sheets - bridges - fronts)


def check_manifold(cage: Cage, volume: float, rtol: float = 1e-9, *, hollow: bool = False) -> None:
    """Assert what every edit must preserve; faces that were only nearly planar keep the volume only nearly.

    Only where the cage may be hollow, components may be the boundaries of cavities, as they always may in 2D; sides of
    a cut that lies wholly inside may always be.
    """
    if cage.dimension == 2:
        check_outline(cage, volume, rtol)
        return
    cage.validate()
    faces = cage.faces
    edges: dict[tuple[int, int], int] = {}
    for loop in faces:
        for a, b in zip(loop, loop[1:] + loop[:1], strict=True):
            assert a != b
            edges[a, b] = edges.get((a, b), 0) + 1
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)
    euler = cage.vertex_count - len(edges) // 2 + cage.face_count
    assert euler == cage.euler_characteristic
    assert euler % 2 == 0
    assert euler <= 2 * cage.component_count
    np.testing.assert_allclose(cage.component_volumes.sum(), volume, rtol=rtol)
    assert (cage.piece_volumes > 0.0).all()
    if not hollow:
        inner = cage.component_volumes[~cage.mesh.component_outward]
        np.testing.assert_allclose(inner, 0.0, atol=1e-12 * cage.diameter**3)
    normals = np.array([cage.walls[w].normal for w in cage.face_wall]) * (1 - 2 * cage.face_side)[:, None]
    assert (np.einsum("ij,ij->i", normals, cage.mesh.face_area_vector) > 0.0).all()
    area = np.zeros(cage.face_count)
    corner = cage.vertices[cage.triangles]
    signed = 0.5 * np.einsum(
        "ij,ij->i", np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), normals[cage.triangle_face]
    )
    assert signed.min() > -1e-12 * cage.diameter**2
    np.add.at(area, cage.triangle_face, signed)
    exact = np.linalg.norm(cage.mesh.face_area_vector, axis=1)
    np.testing.assert_allclose(area, exact, rtol=1e-9, atol=1e-12 * cage.diameter**2)
