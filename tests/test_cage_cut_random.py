# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Random cuts of random cages, each crossing the ones before: what must hold after every edit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import CONVEX, SHAPES, check_manifold, opened_characteristic, random_blade
from newton_cagecut.cage import Cage, CageEdit, Cut, check_inside
from newton_cagecut.section import Blade
from plane_shapes import PLANES

EVERY = SHAPES | PLANES
RANDOM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}


def _random_blade(rng: np.random.Generator, cage: Cage) -> Blade:
    """A blade in any direction, or one along axes and perhaps through a vertex."""
    blade, dimension = random_blade(rng, cage, 0.1), cage.dimension
    if rng.random() < 0.3:
        axes = np.eye(dimension)[rng.permutation(dimension)] * rng.choice([-1.0, 1.0], dimension)[:, None]
        corner = cage.vertices[rng.integers(cage.vertex_count)]
        return Blade(corner if rng.random() < 0.5 else blade.origin, *axes[1:])
    return blade


def _awkward_blade(rng: np.random.Generator, cage: Cage, earlier: list[Blade]) -> Blade:
    """A blade in, almost in, parallel to or perpendicular to an earlier one, or through as many vertices as it can."""
    dimension = cage.dimension
    if not earlier or rng.random() < 0.3:
        corners = cage.vertices[rng.permutation(cage.vertex_count)[:dimension]]
        try:
            return Blade(corners[0], *(corners[1:] - corners[0]))
        except ValueError:
            return _random_blade(rng, cage)
    blade = earlier[rng.integers(len(earlier))]
    small = rng.choice([1e-7, 1e-6, 3e-6, 1e-5, 1e-3])
    edge = (blade.edge,)[: dimension - 2]
    corner = cage.vertices[rng.integers(cage.vertex_count)]
    return [
        blade,
        Blade(blade.origin, *edge, -blade.direction),
        Blade(blade.origin + small * cage.diameter * blade.normal, *edge, blade.direction),
        Blade(corner, *(blade.normal, blade.direction)[: dimension - 1]),
        Blade(corner, blade.direction, *edge),
        Blade(blade.origin, *(axis + small * rng.normal(size=dimension) for axis in (*edge, blade.direction))),
    ][rng.integers(6)]


def _depths(rng: np.random.Generator, cut: Cut) -> list[float]:
    """Depths of a few steps, some through the body, some next to where the front meets an edge."""
    depths = rng.uniform(0.0, 1.2 * cut.length, rng.integers(1, 4)).tolist()
    if rng.random() < 0.4:
        depths.append(1.3 * cut.length)
    if cut.section.node_count and rng.random() < 0.3:
        reached = cut.section.node_coordinates[:, 1]
        depths.append(float(rng.choice(reached) - reached.min() + rng.choice([0.0, 1e-9, -1e-9, 1e-6])))
    return sorted(max(0.0, depth) for depth in depths)


def _measure(simplices: np.ndarray) -> float:
    """Area of triangles, or length of segments."""
    if simplices.shape[1] == 2:
        return float(np.linalg.norm(simplices[:, 1] - simplices[:, 0], axis=1).sum())
    edges = np.cross(simplices[:, 1] - simplices[:, 0], simplices[:, 2] - simplices[:, 0])
    return 0.5 * float(np.linalg.norm(edges, axis=1).sum())


def _check_edit(edit: CageEdit, cut: Cut) -> None:
    """What an edit says of the two cages is so, found by plain loops."""
    before, now = edit.before, edit.cage
    count = before.vertex_count
    assert edit.created.tolist() == list(range(count, now.vertex_count))
    moved = set(np.flatnonzero((before.vertices != now.vertices[:count]).any(axis=1)).tolist())
    assert set(edit.moved.tolist()) == moved
    same = {
        f
        for f in range(min(before.face_count, now.face_count))
        if before.faces[f] == now.faces[f] and before.face_key[f] == now.face_key[f] and not moved & set(now.faces[f])
    }
    assert set(edit.changed_faces.tolist()) == set(range(now.face_count)) - same
    keys = [set(cage.face_key[[f for f in range(cage.face_count) if f not in same]].tolist()) for cage in (before, now)]
    assert edit.changed_keys.tolist() == sorted(keys[0] | keys[1])
    _check_sources(edit)
    assert (edit.cage is edit.before) == (len(edit.created) + len(edit.moved) == 0)


def _check_sources(edit: CageEdit) -> None:
    """Created and moved vertices lie in the plane of their source face, and within it; tips in 2D inside the body."""
    before = edit.before
    ids = np.concatenate([edit.created, edit.moved])
    assert edit.source_faces.shape == ids.shape
    inside = edit.source_faces < 0
    assert before.dimension == 2 or not inside.any()
    check_inside(before, edit.cage.vertices[ids[inside]])
    for vertex, face in zip(ids[~inside].tolist(), edit.source_faces[~inside].tolist(), strict=True):
        wall = before.walls[before.face_wall[face]]
        point = edit.cage.vertices[vertex]
        assert abs((point - wall.origin) @ wall.normal) < 1e-9 * before.diameter
        simplices = before.vertices[before.simplices[before.simplex_face == face]]
        assert min(_excess(point, s) for s in simplices) < 1e-9 * before.diameter**2


def _excess(point: np.ndarray, simplex: np.ndarray) -> float:
    """Area or length that a point adds to a triangle or a segment; zero inside."""
    parts = np.repeat(simplex[None], len(simplex), axis=0)
    parts[np.arange(len(simplex)), np.arange(len(simplex))] = point
    return _measure(parts) - _measure(simplex[None])


def _check_sides(cut: Cut, swept: float) -> None:
    """Both sides of the cut have the swept area, or length."""
    area = np.linalg.norm(cut.cage.mesh.face_area_vector, axis=1)
    for side in (0, 1):
        np.testing.assert_allclose(area[cut.cage.face_key == 2 * cut.wall + side].sum(), swept, atol=1e-9)


def _side_vertices(cut: Cut, side: int) -> set[int]:
    """Vertices of one side of the cut; both sides share only the tips."""
    faces = np.flatnonzero(cut.cage.face_key == 2 * cut.wall + side)
    return {vertex for face in faces for vertex in cut.cage.faces[face]}


def _advance(cut: Cut, depths: list[float], volume: float, checked: bool) -> None:
    base, swept, fixed = cut.base, 0.0, {}
    for depth in depths:
        edit = cut.advance(to=depth)
        check_manifold(edit.cage, volume)
        if not edit.is_empty:
            assert edit.cage.euler_characteristic == opened_characteristic(base, edit.cage, cut.wall)
        tips = _side_vertices(cut, 0) & _side_vertices(cut, 1)
        for vertex, position in fixed.items():
            np.testing.assert_array_equal(edit.cage.vertices[vertex], position)
        fixed = {v: edit.cage.vertices[v] for v in range(edit.cage.vertex_count) if v not in tips}
        swept += _measure(edit.swept_simplices)
        if checked:
            _check_edit(edit, cut)
    _check_sides(cut, swept)


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=12, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_random_cuts(name, seed):
    """Random cuts in random steps, each crossing the ones before, keep a closed manifold of the same volume or area."""
    rng = np.random.default_rng(seed)
    cage = EVERY[name]()
    volume = cage.volume
    for number in range(rng.integers(1, 4)):
        cut = Cut(cage, _random_blade(rng, cage))
        _advance(cut, _depths(rng, cut), volume, checked=True)
        if number == 0 and name in CONVEX:
            assert cut.cage.euler_characteristic == 2 * cut.cage.component_count
        cage = cut.cage


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=10, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_awkward_cuts(name, seed):
    """Cuts in or almost in the plane of an earlier one, or through vertices, keep all that too."""
    rng = np.random.default_rng(seed)
    cage = EVERY[name]()
    volume, blades = cage.volume, []
    for _ in range(rng.integers(2, 5)):
        blades.append(_awkward_blade(rng, cage, blades))
        cut = Cut(cage, blades[-1])
        _advance(cut, _depths(rng, cut), volume, checked=False)
        cage = cut.cage


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=8, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_one_step_is_many(name, seed):
    """One advance gives exactly the cage that many give, ids and last bits included."""
    rng = np.random.default_rng(seed)
    cage = EVERY[name]()
    for _ in range(2):
        blade = _random_blade(rng, cage)
        many, one = Cut(cage, blade), Cut(cage, blade)
        depth = rng.uniform(0.1, 1.1) * many.length
        for part in np.linspace(0.0, 1.0, rng.integers(3, 12))[1:]:
            many.advance(to=part * depth)
        one.advance(to=depth)
        assert one.cage.faces == many.cage.faces
        np.testing.assert_array_equal(one.cage.vertices, many.cage.vertices)
        np.testing.assert_array_equal(one.cage.face_key, many.cage.face_key)
        cage = one.cage


@settings(max_examples=10, **RANDOM)
@given(st.integers(0, 2**32 - 1))
def test_swept_walls_leave_no_gap(seed):
    """Random points of the open part of the section lie in a swept triangle of some step."""
    rng = np.random.default_rng(seed)
    cage = SHAPES["star_prism"]()
    first = Cut(cage, _random_blade(rng, cage))
    cut = Cut(first.advance(to=0.6 * first.length).cage, _random_blade(rng, cage))
    triangles = [cut.advance(to=part * cut.length).swept_simplices for part in (0.2, 0.5, 0.9)]
    flat = cut.plane.coordinates(np.concatenate(triangles).reshape(-1, 3)).reshape(-1, 3, 2)
    sides = cut.cage.vertices[cut.cage.triangles[cut.cage.face_key[cut.cage.triangle_face] == 2 * cut.wall]]
    if not len(sides):
        return
    weights = rng.dirichlet(np.ones(3), (20, len(sides)))
    points = cut.plane.coordinates(np.einsum("ntc,tcd->ntd", weights, sides).reshape(-1, 3))
    u, v = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    w = points[:, None] - flat[:, 0]
    det = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    keep = det > 0.0
    s = (w[..., 0] * v[:, 1] - w[..., 1] * v[:, 0])[:, keep] / det[keep]
    t = (u[:, 0] * w[..., 1] - u[:, 1] * w[..., 0])[:, keep] / det[keep]
    assert (((s >= -1e-9) & (t >= -1e-9) & (s + t <= 1.0 + 1e-9)).any(axis=1)).all()
