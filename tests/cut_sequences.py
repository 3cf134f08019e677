# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Random sequences of cuts: blades of every kind, steps, turns, cuts side by side; and what must hold after each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from cage_shapes import SHAPES, check_manifold, opened_characteristic, prism, voxels
from newton_cagecut.cage import Cage, CageEdit, Cut
from newton_cagecut.section import Blade
from newton_cagecut.usd import read_cage
from plane_shapes import PLANES, ring, segment_crossings
from surface_shapes import icosphere

ASSETS = Path(__file__).parent.parent / "assets"


def convex(seed: int = 1) -> Cage:
    """The convex hull of random points."""
    points = np.random.default_rng(seed).normal(size=(14, 3))
    points = points[ConvexHull(points).vertices]
    hull = ConvexHull(points)
    normal = np.cross(*np.moveaxis(points[hull.simplices[:, 1:]] - points[hull.simplices[:, :1]], 1, 0))
    outward = np.einsum("ij,ij->i", normal, hull.equations[:, :3]) > 0.0
    return Cage(points, np.where(outward[:, None], hull.simplices, hull.simplices[:, ::-1]))


def star_shaped(seed: int = 2) -> Cage:
    """A sphere of triangles with random radii."""
    points, triangles = icosphere(1)
    return Cage(points * np.random.default_rng(seed).uniform(0.4, 1.3, (len(points), 1)), triangles)


def twisted_prism() -> Cage:
    """A prism over an irregular polygon with collinear corners."""
    return prism(np.array([[0, 0], [1, 0], [2, 0], [2, 0.5], [2, 1.2], [1.1, 0.9], [0.4, 1.7], [0, 1]]), 0.9)


def long_torus() -> Cage:
    """A ring of ten voxels."""
    return voxels([(i, j, 0) for i in range(4) for j in range(3) if not (j == 1 and 0 < i < 3)], np.array([1, 1, 0.8]))


CAGES: dict[str, Callable[[], Cage]] = {
    **SHAPES,
    "convex": convex,
    "star_shaped": star_shaped,
    "twelve_sided_prism": lambda: prism(ring(12), 0.7),
    "collinear_prism": twisted_prism,
    "long_torus": long_torus,
    **{path.stem: (lambda path=path: read_cage(path)) for path in sorted(ASSETS.glob("*_cage.usda"))},
}
"""Every cage of the assets and generated ones."""
EVERY: dict[str, Callable[[], Cage]] = CAGES | PLANES
"""Those and the plane ones."""

_number = st.integers(-5, 5)
_vector = st.tuples(_number, _number, _number)
_share = st.integers(0, 100).map(lambda i: i / 100.0)
_blade = st.tuples(
    st.just("cut"), st.integers(0, 6), st.integers(0, 1000), st.tuples(_share, _share, _share), _vector, _vector
)
_advance = st.tuples(st.just("advance"), st.integers(0, 3), st.integers(0, 110).map(lambda i: i / 100.0))
_turn = st.tuples(st.just("turn"), st.integers(0, 3), st.integers(-16, 16).map(lambda i: i / 10.0))

SEQUENCES = st.tuples(_blade, st.lists(st.one_of(_advance, _advance, _blade, _turn), min_size=2, max_size=16))
"""A first blade and what follows."""


def make_blade(item: tuple, cage: Cage, earlier: list[Blade]) -> Blade | None:
    """A blade of some kind: free, through vertices, along an edge, in or almost in a face, beside an earlier blade."""
    _, kind, pick, share, edge, direction = item
    if cage.dimension == 2:
        return _make_plane_blade(item, cage, earlier)
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    corner = cage.vertices[pick % cage.vertex_count]
    face = cage.mesh.face_vertex[cage.mesh.face_start[pick % cage.face_count] :][:3]
    a, b, c = cage.vertices[face]
    small = [1e-8, 1e-6, 3e-6, 1e-4][pick % 4] * cage.diameter
    try:
        if kind == 1:
            return Blade(corner, edge, direction)
        if kind == 2:
            return Blade(a, b - a, direction)
        if kind == 3:
            return Blade(a, b - a, c - a)
        if kind == 4:
            return Blade(a + small * np.array(edge), b - a, c - a + small * np.array(direction))
        if kind >= 5 and earlier:
            blade = earlier[pick % len(earlier)]
            if kind == 5:
                return Blade(blade.origin + small * blade.normal, blade.edge, blade.direction)
            return Blade(blade.origin, blade.direction, blade.normal)
        return Blade(low + (high - low) * share, edge, direction)
    except ValueError:
        return None


def _make_plane_blade(item: tuple, cage: Cage, earlier: list[Blade]) -> Blade | None:
    """The same in the plane: free, through one or two vertices, along a segment, beside or across an earlier blade."""
    _, kind, pick, share, edge, direction = item
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    a, b = cage.vertices[list(cage.faces[pick % cage.face_count])]
    small = [1e-8, 1e-6, 3e-6, 1e-4][pick % 4] * cage.diameter
    try:
        if kind == 1:
            return Blade(a, direction[:2])
        if kind == 2:
            return Blade(a, b - a)
        if kind == 3:
            return Blade(a, cage.vertices[(7 * pick + 3) % cage.vertex_count] - a)
        if kind == 4:
            return Blade(a + small * np.array(edge[:2]), b - a + small * np.array(direction[:2]))
        if kind >= 5 and earlier:
            blade = earlier[pick % len(earlier)]
            if kind == 5:
                return Blade(blade.origin + small * blade.normal, blade.direction)
            return Blade(blade.origin, blade.normal)
        return Blade(low + (high - low) * share[:2], direction[:2])
    except ValueError:
        return None


def play(cage: Cage, sequence: tuple, check: Callable[[CageEdit, Cut, Cage], None]) -> Cage:
    """Carry a sequence out.

    Args:
        cage: The cage.
        sequence: One of ``SEQUENCES``.
        check: Called with every edit, its cut and the cage before the cut's present plane.

    Returns:
        The cage at the end.
    """
    cuts: list[Cut] = []
    blades: list[Blade] = []
    for item in (sequence[0], *sequence[1]):
        if item[0] == "cut":
            blade = make_blade(item, cage, blades)
            if blade is not None:
                blades.append(blade)
                cuts.append(Cut(cage, blade))
            continue
        if not cuts:
            continue
        cut = cuts[-1 - item[1] % len(cuts)]
        if cut.cage is not cage:
            cut.resume(cage)
        if item[0] == "turn":
            if not cut.complete:
                cut.turn(np.cos(item[2]) * cut.plane.across + np.sin(item[2]) * cut.plane.normal)
            continue
        base = cut._strips[-1][0].base
        edit = cut.advance(to=cut.depth + item[2] * max(0.0, cut.length - cut.depth))
        check(edit, cut, base)
        cage = cut.cage
    return cage


def check_step(edit: CageEdit, cut: Cut, base: Cage, volume: float) -> None:
    """Assert what every step must keep."""
    assert edit.complete == cut.complete
    if edit.is_empty:
        return
    check_manifold(edit.cage, volume, rtol=1e-7)
    assert edit.cage.euler_characteristic == opened_characteristic(base, edit.cage, cut.wall)
    assert crossings(edit.cage) == 0


def crossings(cage: Cage) -> int:
    """Number of edges that pierce a face away from its border and their own ends, in 2D of segments that cross."""
    if cage.dimension == 2:
        return segment_crossings(cage)
    edges = cage.vertices[cage.mesh.edges] / cage.diameter
    return sum(_pierced(cage, edges[first : first + 128]) for first in range(0, len(edges), 128))


def _pierced(cage: Cage, edges: np.ndarray) -> int:
    corner = cage.vertices[cage.triangles] / cage.diameter
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    normal = np.cross(u, v)
    area = np.linalg.norm(normal, axis=1)
    keep = area > 1e-9
    corner, u, v, normal, area = corner[keep], u[keep], v[keep], normal[keep], area[keep]
    unit = normal / area[:, None]
    height = [edges[:, k] @ unit.T - np.einsum("ij,ij->i", corner[:, 0], unit) for k in (0, 1)]
    e, t = np.nonzero((height[0] * height[1] < 0.0) & (np.minimum(np.abs(height[0]), np.abs(height[1])) > 1e-7))
    share = height[0][e, t] / (height[0][e, t] - height[1][e, t])
    point = edges[e, 0] + share[:, None] * (edges[e, 1] - edges[e, 0]) - corner[t, 0]
    b = np.einsum("ij,ij->i", np.cross(point, v[t]), unit[t]) / area[t]
    c = np.einsum("ij,ij->i", np.cross(u[t], point), unit[t]) / area[t]
    longest = np.linalg.norm(np.stack([u, v, u - v]), axis=2).max(axis=0)[t]
    margin = 1e-7 * longest / area[t]
    return int(np.count_nonzero((b > margin) & (c > margin) & (b + c < 1.0 - margin)))


def long_sequence(seed: int) -> tuple:
    """A sequence of 26 operations from a seed, for the tests and for nightly runs."""
    rng = np.random.default_rng(seed)

    def vector() -> tuple:
        return tuple(rng.integers(-5, 6, 3)) if rng.random() < 0.4 else tuple(rng.normal(size=3))

    def blade() -> tuple:
        kind, pick = int(rng.integers(7)), int(rng.integers(1000))
        return ("cut", kind, pick, tuple(rng.uniform(0.1, 0.9, 3)), vector(), vector())

    steps = []
    for _ in range(25):
        share = rng.random()
        if share < 0.3:
            steps.append(blade())
        elif share < 0.45:
            steps.append(("turn", int(rng.integers(3)), float(rng.uniform(-1.6, 1.6))))
        else:
            which, parts = int(rng.integers(3)), [rng.uniform(0, 0.5), rng.uniform(0, 1.1), 1.1]
            steps.append(("advance", which, float(rng.choice(parts))))
    return blade(), steps
