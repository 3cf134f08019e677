# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What makes a plane cage, its conventions, and what it says when something is wrong."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from newton_cagecut.cage import Cage, check_inside
from plane_shapes import PLANES, outline, rectangle, square


def _refused(match: str, vertices, faces, error=ValueError):
    with pytest.raises(error, match=match):
        Cage(vertices, faces)


def _parts(cage: Cage) -> tuple[np.ndarray, list[tuple[int, int]]]:
    return np.array(cage.vertices), list(cage.faces)


def test_facts_of_a_rectangle():
    """Counts, area, segments and walls of a rectangle are what they must be."""
    cage = outline(rectangle((0, 0), (3, 2)))
    assert (cage.vertex_count, cage.face_count, cage.component_count, cage.dimension) == (4, 4, 1, 2)
    assert (cage.volume, cage.euler_characteristic, cage.piece_count) == (6.0, 0, 1)
    assert cage.faces == ((0, 1), (1, 2), (2, 3), (3, 0))
    assert cage.simplices.tolist() == [[0, 1], [1, 2], [2, 3], [3, 0]]
    assert cage.simplex_face.tolist() == [0, 1, 2, 3]
    assert cage.mesh.face_start.tolist() == [0, 2, 4, 6, 8]
    assert cage.mesh.edges.tolist() == [[0, 1], [0, 3], [1, 2], [2, 3]]
    bottom = cage.walls[0]
    np.testing.assert_array_equal(bottom.axes, [[1.0, 0.0]])
    np.testing.assert_array_equal(bottom.normal, [0.0, -1.0])
    np.testing.assert_array_equal(bottom.origin, [1.5, 0.0])
    assert not bottom.two_sided


def test_no_triangles_in_the_plane():
    """A plane cage has segments, and says so when asked for triangles."""
    with pytest.raises(ValueError, match="segments, not triangles; use simplices"):
        _ = square().triangles


def test_hole_and_island_belong_to_pieces():
    """A hole is a component of negative area that bounds the piece around it; an island is a piece of its own."""
    cage = PLANES["island"]()
    np.testing.assert_allclose(cage.component_volumes, [25.0, -9.0, 0.5])
    assert cage.component_piece.tolist() == [0, 0, 1]
    np.testing.assert_allclose(cage.piece_volumes, [16.0, 0.5])
    points = [[0.5, 0.5], [1.5, 1.5], [2.5, 2.2], [9.0, 9.0]]
    assert cage.contains(points).tolist() == [True, False, True, False]
    assert cage.piece_of(points).tolist() == [0, -1, 1, -1]


@pytest.mark.parametrize("name", PLANES)
@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_contains_agrees_with_parity(name, seed):
    """The winding number agrees with counting crossings of a ray."""
    cage = PLANES[name]()
    low, high = cage.vertices.min(axis=0) - 0.2, cage.vertices.max(axis=0) + 0.2
    points = np.random.default_rng(seed).uniform(low, high, (50, 2))
    a, b = np.moveaxis(cage.vertices[cage.simplices], 1, 0)
    straddles = (a[:, 1] > points[:, 1:]) != (b[:, 1] > points[:, 1:])
    rise = np.where(a[:, 1] == b[:, 1], 1.0, b[:, 1] - a[:, 1])
    x = a[:, 0] + (points[:, 1:] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    inside = np.count_nonzero(straddles & (x > points[:, :1]), axis=1) % 2 == 1
    np.testing.assert_array_equal(cage.contains(points), inside)


def test_far_and_tiny():
    """A millimetre of a cage, ten kilometres away, keeps its area and its inside."""
    cage = Cage(PLANES["star"]().vertices * 1e-3 + 1e4, PLANES["star"]().faces)
    assert cage.volume == pytest.approx(1e-6 * PLANES["star"]().volume, rel=1e-7)
    check_inside(cage, np.full((1, 2), 1e4))


def test_open_loop_names_the_vertex():
    """A missing segment leaves a vertex with one segment."""
    vertices, faces = _parts(square())
    _refused("the cage is open: vertex 0 belongs to face 0 only", vertices, faces[:3])


def test_branch_names_vertex_and_faces():
    """A vertex of two loops is named with its segments."""
    vertices = np.concatenate([rectangle((0, 0), (1, 1)), [[2, 1], [2, 2], [1, 2]]])
    faces = [(0, 1), (1, 2), (2, 3), (3, 0), (2, 4), (4, 5), (5, 6), (6, 2)]
    _refused(r"vertex 2 of the cage joins 4 segments \(faces \[1, 2, 4, 7\]\)", vertices, faces)


def test_reversed_segment_names_both_faces():
    """A segment that runs against its neighbours is named with one of them."""
    vertices, faces = _parts(square())
    faces[1] = faces[1][::-1]
    _refused("faces 0 and 1 of the cage both end at vertex 1: .* reverse one", vertices, faces)
    faces[0], faces[1] = faces[0][::-1], faces[1][::-1]
    _refused("faces 0 and 3 of the cage both end at vertex 0", vertices, faces)


def test_no_length_names_the_segment():
    """A segment without length, by one vertex or by two in one place, is named."""
    vertices, faces = _parts(square())
    _refused("face 4 of the cage visits vertex 1 twice; give it two ends", vertices, [*faces, (1, 1)])
    doubled = np.concatenate([vertices, vertices[1:2] + 1e-9])
    faces[1:2] = [(1, 4), (4, 2)]
    _refused(r"edge \(1, 4\) of face 1 of the cage has no length", doubled, faces)


def test_crossings_are_named():
    """Loops that cross or touch themselves or each other are named by both segments."""
    bow_tie = [[0, 0], [1, 1], [1, 0], [0, 1]]
    _refused(r"faces 0 \(0, 1\) and 2 \(2, 3\) of the cage meet", *_loop(bow_tie))
    pinched = [[0, 0], [2, 0], [1, 1], [2, 2], [0, 2], [1, 1]]
    _refused("of the cage meet; move the vertices apart", *_loop(pinched))
    resting = [[0, 0], [4, 0], [4, 3], [2, 0], [0, 3]]
    _refused(r"faces 0 \(0, 1\) and 2 \(2, 3\) of the cage meet", *_loop(resting))
    with pytest.raises(ValueError, match=r"faces 2 \(2, 3\) and 4 \(4, 5\) of the cage meet"):
        outline(rectangle((0, 0), (1, 1)), rectangle((0.2, 1), (0.8, 2)))
    with pytest.raises(ValueError, match="of the cage meet"):
        outline(rectangle((0, 0), (2, 2)), rectangle((1, 1), (3, 3)))


def test_spike_is_named():
    """Segments that run back along each other enclose nothing."""
    spike = [[0, 0], [1, 0], [1, 1], [1, 3], [1, 2], [0, 2]]
    _refused(r"faces 2 \(2, 3\) and 3 \(3, 4\) of the cage run back along each other", *_loop(spike))


def _loop(points) -> tuple[np.ndarray, list[tuple[int, int]]]:
    count = len(points)
    return np.array(points, dtype=float), [(i, (i + 1) % count) for i in range(count)]


def test_wrong_nesting_is_named():
    """A clockwise outer loop, a hole outside of every body and a body inside another are refused."""
    outer = rectangle((0, 0), (3, 3))
    _refused("inside out: its area is -9; reverse all 4 faces", *_loop(outer[::-1]))
    with pytest.raises(ValueError, match=r"vertex 4 of the cage \(area -1\) lies inside out"):
        outline(outer, rectangle((5, 5), (6, 6))[::-1])
    with pytest.raises(ValueError, match=r"vertex 4 of the cage \(area 1\) lies inside another one"):
        outline(outer, rectangle((1, 1), (2, 2)))


def test_bad_indices_and_numbers():
    """Ids out of range, faces that are no segments, unused vertices and values that are not finite are named."""
    vertices, faces = _parts(square())
    _refused("face 3 of the cage uses vertex 9", vertices, [*faces[:3], (3, 9)])
    _refused(
        "face 1 of the cage has 3 vertices; a face of a plane cage is a segment of 2", vertices, [(0, 1), (1, 2, 3)]
    )
    _refused("vertex 4 of the cage belongs to no face", np.concatenate([vertices, [[5.0, 5.0]]]), faces)
    _refused("face 0 of the cage must be a sequence of integers", vertices, [(0.0, 1.0)], TypeError)
    vertices[2, 1] = np.nan
    _refused("vertex 2 of the cage is not finite", vertices, faces)
