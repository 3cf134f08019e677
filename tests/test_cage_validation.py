# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What makes a cage, and what it says when something is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import SHAPES, box, check_manifold, prism, square_torus, tetrahedron, voxels
from newton_cagecut.cage import Cage, boundary_distances, check_inside
from plane_shapes import PLANES


def _parts(cage: Cage) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    return np.array(cage.vertices), list(cage.faces)


@pytest.mark.parametrize("name", [*SHAPES, *PLANES])
def test_shapes_are_accepted(name):
    """Every shape of the tests is a valid cage with one wall a face."""
    cage = (SHAPES | PLANES)[name]()
    check_manifold(cage, cage.volume)
    assert cage.euler_characteristic == (0 if name == "square_torus" or cage.dimension == 2 else 2)
    assert len(cage.walls) == cage.face_count
    assert cage.face_wall.tolist() == list(range(cage.face_count))
    assert not any(wall.two_sided for wall in cage.walls)


def test_facts_of_a_box():
    """Counts, volume, diameter and walls of a box are what they must be."""
    cage = box((1.0, 2.0, 3.0))
    assert (cage.vertex_count, cage.face_count, cage.component_count, cage.dimension) == (8, 6, 1, 3)
    assert cage.volume == pytest.approx(6.0)
    assert cage.diameter == pytest.approx(np.sqrt(14.0))
    assert cage.triangles.shape == (12, 3)
    for face, wall in zip(cage.faces, cage.walls, strict=True):
        outward = cage.vertices[list(face)].mean(axis=0) - [0.5, 1.0, 1.5]
        assert wall.normal @ outward > 0.0
        np.testing.assert_allclose(np.cross(wall.axes[0], wall.axes[1]), wall.normal, atol=1e-14)


def test_volume_far_from_the_origin():
    """A small cage far away keeps its volume."""
    vertices, faces = _parts(box())
    cage = Cage(vertices * 1e-3 + 10.0, faces)
    assert cage.volume == pytest.approx(1e-9, rel=1e-9)


def test_arrays_are_frozen():
    """A cage is immutable and does not share the caller's array."""
    vertices, faces = _parts(box())
    cage = Cage(vertices, faces)
    vertices[0] = 5.0
    assert cage.vertices[0].max() < 5.0
    with pytest.raises(ValueError, match="read-only"):
        cage.vertices[0] = 1.0


@pytest.mark.parametrize("name", SHAPES)
def test_contains_agrees_with_ray_parity(name):
    """The winding number agrees with counting crossings of a ray."""
    cage = SHAPES[name]()
    rng = np.random.default_rng(3)
    low, high = cage.vertices.min(axis=0) - 0.2, cage.vertices.max(axis=0) + 0.2
    points = rng.uniform(low, high, (300, 3))
    ray = np.array([0.31, 0.52, 0.8])
    a, b, c = np.moveaxis(cage.vertices[cage.triangles], 1, 0)
    h = np.cross(ray, c - a)
    det = np.einsum("ij,ij->i", b - a, h)
    offset = points[:, None] - a
    u = np.einsum("pij,ij->pi", offset, h) / det
    q = np.cross(offset, b - a)
    v = q @ ray / det
    t = np.einsum("pij,ij->pi", q, c - a) / det
    hits = ((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)).sum(axis=1)
    inside = hits % 2 == 1
    assert 0 < inside.sum() < 300
    np.testing.assert_array_equal(cage.contains(points), inside)
    np.testing.assert_array_equal(cage.piece_of(points), np.where(inside, 0, -1))


@pytest.mark.parametrize("name", ["box", "u_shape", "star_prism", *PLANES])
def test_points_off_the_boundary(name):
    """Points a hair inside of a face or outside are told apart, and lie as far from the boundary as they were moved."""
    cage = (SHAPES | PLANES)[name]()
    center = cage.vertices[cage.simplices].mean(axis=1)
    normal = np.array([cage.walls[face].normal for face in cage.simplex_face])
    assert not cage.contains(center + 1e-3 * normal).any()
    assert cage.contains(center - 1e-3 * normal).all()
    np.testing.assert_allclose(boundary_distances(cage, center - 1e-3 * normal), 1e-3, rtol=1e-9)
    check_inside(cage, center - 1e-3 * normal)
    with pytest.raises(ValueError, match=rf"{len(center)} of {len(center)} points lie outside .* by 0.001 m"):
        check_inside(cage, center + 1e-3 * normal)


def test_points_in_the_plane_of_a_concave_face_are_outside():
    """A point beside a concave face, in its plane, is outside."""
    cage = SHAPES["u_shape"]()
    assert cage.contains([[1.5, 2.0, 0.8], [1.5, 2.0, 0.0], [1.5, 2.0, 0.4]]).tolist() == [False] * 3


def test_two_bodies_side_by_side():
    """Two bodies are two components."""
    cage = voxels([(0, 0, 0), (2, 0, 0)], np.ones(3))
    assert cage.component_count == 2
    np.testing.assert_allclose(cage.component_volumes, 1.0)
    assert cage.piece_of([[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [2.5, 0.5, 0.5]]).tolist() == [0, -1, 1]


def test_hollow_body():
    """A cavity is a component of negative volume inside which points are outside."""
    cells = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i, j, k) != (1, 1, 1)]
    cage = voxels(cells, np.ones(3))
    assert cage.volume == pytest.approx(26.0)
    assert sorted(cage.component_volumes.tolist()) == pytest.approx([-1.0, 27.0])
    assert cage.contains([[1.5, 1.5, 1.5], [0.5, 1.5, 1.5]]).tolist() == [False, True]


def _refused(match: str, vertices, faces, error=ValueError, **options):
    with pytest.raises(error, match=match):
        Cage(vertices, faces, **options)


def test_open_cage_names_the_edge():
    """A missing face leaves edges with one face; the first is named."""
    vertices, faces = _parts(tetrahedron())
    _refused(r"open: edge \(0, 1\) belongs to face 0 only", vertices, [faces[1], *faces[2:]])


def test_inconsistent_orientation_names_both_faces():
    """A reversed face is named with its neighbour."""
    vertices, faces = _parts(tetrahedron())
    faces[2] = faces[2][::-1]
    _refused(r"faces 0 and 2 .* same direction", vertices, faces)


def test_edge_with_three_faces_is_named():
    """An edge of more than two faces is not manifold."""
    vertices, faces = _parts(tetrahedron())
    vertices = np.concatenate([vertices, [[2.0, 2.0, 2.0]]])
    _refused(r"edge \(0, 1\) .* belongs to 3 faces \[0, 1, 4\]", vertices, [*faces, (0, 1, 4)])


def test_nonplanar_face_names_face_and_vertex():
    """A bent quad is named with the vertex that stands out and the spread."""
    vertices, faces = _parts(box())
    lifted = faces[0][0]
    vertices[lifted] += [0.01, 0.02, 0.03]
    _refused(r"face \d+ of the cage is not planar: .* spread over 0\.0.*triangulate", vertices, faces)


def test_degenerate_face_is_named():
    """A face without area is named."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 0], [0.3, 0.4, 1.0]])
    _refused("face 0 of the cage is degenerate", vertices, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


def test_coincident_neighbours_are_named():
    """An edge without length is named."""
    vertices, faces = _parts(tetrahedron())
    vertices[1] = vertices[0]
    _refused(r"edge \(\d, \d\) of face 0 of the cage has no length", vertices, faces)


def test_unused_vertex_is_named():
    """A vertex of no face is named."""
    vertices, faces = _parts(tetrahedron())
    _refused("vertex 4 of the cage belongs to no face", np.concatenate([vertices, [[0, 0, 0]]]), faces)


def test_bow_tie_vertex_is_named():
    """Two bodies that share one vertex are refused with the vertex."""
    one = tetrahedron()
    far = 2.0 * one.vertices[0] - one.vertices
    vertices = np.concatenate([one.vertices, far[1:]])
    other = [tuple(v if v == 0 else v + 3 for v in face[::-1]) for face in one.faces]
    _refused("vertex 0 of the cage joins 2 separate fans", vertices, [*one.faces, *other])


def test_inside_out_cage_is_refused():
    """A cage with all faces reversed has negative volume."""
    vertices, faces = _parts(box())
    _refused("inside out: its volume is -1", vertices, [face[::-1] for face in faces])


def test_one_inside_out_component_is_refused():
    """An inside-out body beside a bigger sound one is found."""
    big, small = box((2.0, 2.0, 2.0)), tetrahedron()
    faces = [*big.faces, *[tuple(v + 8 for v in face[::-1]) for face in small.faces]]
    _refused("vertex 8 .* lies inside out", np.concatenate([big.vertices, small.vertices + 5.0]), faces)


def test_body_inside_a_body_is_refused():
    """A sound body inside another is found."""
    big, small = box((4.0, 4.0, 4.0)), tetrahedron()
    faces = [*big.faces, *[tuple(v + 8 for v in face) for face in small.faces]]
    _refused("lies inside another", np.concatenate([big.vertices, small.vertices + 1.0]), faces)


def test_self_intersecting_face_names_its_edges():
    """A face whose loop crosses itself is named with the edges that meet."""
    polygon = np.array([[0, 0], [2, 0], [2, 2], [1, -1], [0, 2]], dtype=float)
    with pytest.raises(ValueError, match=r"face 0 of the cage intersects itself: its edges \(\d, \d\) and \(\d, \d\)"):
        prism(polygon)


def test_intersecting_faces_are_named():
    """A spike through the opposite side is found."""
    vertices, faces = _parts(SHAPES["u_shape"]())
    torus = square_torus()
    moved = np.array(torus.vertices) * 0.5 + [0.3, 0.2, 0.1]
    both = [*faces, *[tuple(v + len(vertices) for v in face) for face in torus.faces]]
    _refused(r"faces \d+ and \d+ of the cage intersect: edge \(\d+, \d+\)", np.concatenate([vertices, moved]), both)


def test_repeated_vertex_is_named():
    """A face that visits a vertex twice is refused."""
    vertices, faces = _parts(tetrahedron())
    _refused("face 0 of the cage visits vertex 0 twice", vertices, [(0, 2, 0, 1), *faces[1:]])


def test_bad_indices_and_numbers():
    """Indices out of range, short faces, wrong types and values that are not finite are refused by name."""
    vertices, faces = _parts(tetrahedron())
    _refused("face 3 of the cage uses vertex 9", vertices, [*faces[:3], (2, 0, 9)])
    _refused("face 3 of the cage uses vertex -1", vertices, [*faces[:3], (2, 0, -1)])
    _refused("face 1 of the cage has 2 vertices", vertices, [faces[0], (0, 1), *faces[2:]])
    _refused("no faces", vertices, [])
    _refused("face 0 of the cage must be a sequence of integers", vertices, [(0.0, 1.0, 2.0)], TypeError)
    _refused("must be numbers", [["a", "b", "c"]], faces, TypeError)
    _refused(r"shape \(vertex_count, 3\), or \(vertex_count, 2\), got \(4, 1\)", vertices[:, :1], faces)
    _refused("face 0 of the cage has 3 vertices; a face of a plane cage is a segment", vertices[:, :2], faces)
    vertices[2, 1] = np.nan
    _refused("vertex 2 of the cage is not finite", vertices, faces)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan, 1.0])
def test_tolerance_is_checked(tolerance):
    """A tolerance that makes no sense is refused."""
    _refused("tolerance must lie between", *_parts(tetrahedron()), tolerance=tolerance)
