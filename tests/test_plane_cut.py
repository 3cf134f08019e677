# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cuts of chosen plane cages: what they leave, in which order, and how they are refused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cage_shapes import box, random_blade
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.section import Blade, BladePlane
from plane_shapes import PLANES, check_outline, comb, outline, rectangle, segment_crossings, square

UP = Blade([0.513, 0.5], [0, 3])


def test_blade_in_the_plane():
    """A blade is a point and a direction; its line's normal is to the left, and has the coordinate s alone."""
    blade = Blade([1.0, 2.0], direction=[0.0, 5.0])
    assert (blade.dimension, blade.window) == (2, None)
    np.testing.assert_array_equal(blade.direction, [0.0, 1.0])
    np.testing.assert_array_equal(blade.normal, [-1.0, 0.0])
    assert repr(blade) == "Blade(origin=[1.0, 2.0], direction=[0.0, 1.0])"
    plane = BladePlane.of(blade)
    np.testing.assert_array_equal(plane.coordinates(np.array([[1.0, 5.0], [9.0, 0.0]])), [[0.0, 3.0], [0.0, -2.0]])
    np.testing.assert_array_equal(plane.distance(np.array([[0.0, 5.0], [4.0, 0.0]])), [1.0, -3.0])


def test_slit_of_a_square():
    """A partial cut: two mouth vertices and a tip, a segment split, two sides that share only the tip."""
    cut = Cut(square(), UP)
    edit = cut.advance(to=0.3)
    cage = edit.cage
    check_outline(cage, 1.0)
    assert (cage.vertex_count, cage.component_count, cut.wall) == (7, 1, 4)
    assert edit.created.tolist() == [4, 5, 6]
    assert edit.source_faces.tolist() == [-1, 0, 0]
    assert edit.changed_keys.tolist() == [0, 8, 9]
    negative, positive = (cage.faces[int(np.flatnonzero(cage.face_key == key)[0])] for key in (8, 9))
    assert negative[0] == positive[1] == 4
    np.testing.assert_array_equal(cage.vertices[4], [0.513, 0.3])
    np.testing.assert_array_equal(cage.vertices[[negative[1], positive[0]]], [[0.513, 0.0]] * 2)
    left = cage.faces[0] if cage.faces[0][0] == 0 else None
    assert left == (0, positive[0])


def test_wall_of_a_cut():
    """A cut's wall is two-sided, along the blade's direction, with the normal to its left; swept segments run back."""
    cut = Cut(square(), UP)
    edit = cut.advance(to=0.3)
    wall = edit.cage.walls[cut.wall]
    assert wall.two_sided
    np.testing.assert_array_equal(wall.axes, [[0.0, 1.0]])
    np.testing.assert_array_equal(wall.normal, [-1.0, 0.0])
    np.testing.assert_array_equal(edit.swept_simplices, [[[0.513, 0.3], [0.513, 0.0]]])
    np.testing.assert_array_equal(edit.swept[0], edit.swept_simplices[0])
    assert edit.swept_wall.tolist() == edit.swept_simplex_wall.tolist() == [cut.wall]


def test_sides_face_what_they_bound():
    """Side 1 belongs to the piece on the positive side of the line."""
    cut = Cut(square(), UP)
    cage = cut.advance(to=2.0).cage
    assert cage.component_volumes.tolist() == pytest.approx([0.513, 0.487])
    for side, sign in ((0, -1.0), (1, 1.0)):
        face = int(np.flatnonzero(cage.face_key == 2 * cut.wall + side)[0])
        piece = cage.vertices[cage.vertex_piece == cage.face_piece[face]]
        assert (sign * cut.plane.distance(piece) > -1e-12).all()
        assert sign * cage.mesh.face_area_vector[face] @ cut.plane.normal < 0.0


def test_tip_travels_and_becomes_an_end():
    """A tip keeps its id while it moves and when it comes to rest on the far segment."""
    cut = Cut(square(), UP)
    cut.advance(to=0.3)
    step = cut.advance(to=0.7)
    assert (step.moved.tolist(), step.created.tolist(), step.source_faces.tolist()) == ([4], [], [-1])
    last = cut.advance(to=1.5)
    assert (last.moved.tolist(), last.created.tolist(), last.source_faces.tolist()) == ([4], [7], [2, 2])
    np.testing.assert_array_equal(last.cage.vertices[[4, 7]], [[0.513, 1.0]] * 2)
    assert last.separated
    assert last.complete


def test_teeth_come_off_one_by_one():
    """A blade across a comb frees tooth after tooth; between them it touches nothing."""
    cut = Cut(comb(), Blade([-1.0, 2.0], [1, 0]))
    pieces, known = [], ()
    for depth in (0.5, 1.5, 1.9, 2.5, 4.2, 7.0):
        edit = cut.advance(to=depth)
        check_outline(edit.cage, comb().volume)
        pieces.append((len(edit.pieces), edit.separated, edit.is_empty))
        faces, first = edit.cage.faces[comb().face_count :], comb().face_count
        split = [face for face, wall in zip(faces, edit.cage.face_wall[first:], strict=True) if wall != cut.wall]
        assert [face[1] for face in split[: len(known)]] == [face[1] for face in known]
        known = split
    assert pieces == [
        (1, False, False),
        (2, True, False),
        (2, False, True),
        (2, False, False),
        (3, True, False),
        (5, True, False),
    ]
    assert sorted(cut.cage.piece_volumes) == pytest.approx([1.0, 1.0, 1.0, 1.0, comb().volume - 4.0])


def test_cut_into_a_hole_joins_the_loops():
    """A cut from outside to a hole makes one loop of two; a second one makes two pieces."""
    base = PLANES["holed_square"]()
    cut = Cut(base, Blade([1.5, -1.0], [0.01, 1.0]))
    first = cut.advance(to=1.5).cage
    assert (first.component_count, first.piece_count) == (1, 1)
    check_outline(first, 8.0)
    second = cut.advance(to=9.0)
    check_outline(second.cage, 8.0)
    assert second.separated
    assert second.cage.piece_count == 2


def test_crossing_slits():
    """A cut across a slit cuts off the part beside the slit on each side only where it has passed."""
    slit = Cut(square(), UP).advance(to=0.8).cage
    cut = Cut(slit, Blade([0.0, 0.5], [1, 0.01]))
    pieces = []
    for depth in (0.4, 0.6, 1.5):
        cage = cut.advance(to=depth).cage
        check_outline(cage, 1.0)
        pieces.append(cage.component_count)
    assert pieces == [1, 2, 3]


@pytest.mark.parametrize("name", PLANES)
@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_swept_lengths_are_the_sections(name, seed):
    """The steps of a complete cut sweep, together, the length of the line inside the cage."""
    rng = np.random.default_rng(seed)
    cage = PLANES[name]()
    cut = Cut(cage, random_blade(rng, cage))
    swept = []
    for part in (*np.sort(rng.uniform(0.0, 1.0, rng.integers(1, 6))), 1.1):
        corners = cut.advance(to=part * cut.length).swept_simplices
        np.testing.assert_allclose(cut.plane.distance(corners.reshape(-1, 2)), 0.0, atol=1e-12)
        swept.append(cut.plane.coordinates(corners.reshape(-1, 2))[:, 1].reshape(-1, 2))
    a, b = np.moveaxis(cage.vertices[cage.simplices], 1, 0)
    one, two = cut.plane.distance(a), cut.plane.distance(b)
    hit = one * two < 0.0
    point = a[hit] + (one[hit] / (one[hit] - two[hit]))[:, None] * (b[hit] - a[hit])
    along = np.sort(cut.plane.coordinates(point)[:, 1]).reshape(-1, 2)
    intervals = np.concatenate(swept)[:, ::-1]
    assert np.ptp(intervals, axis=1).sum() == pytest.approx(np.ptp(along, axis=1).sum(), rel=1e-9)
    intervals = intervals[np.argsort(intervals[:, 0])]
    assert (intervals[1:, 0] >= intervals[:-1, 1] - 1e-12).all()


def test_scalpel_writes_a_letter():
    """Strips that turn left and right by up to 150 degrees, crossing their own wall, free what they enclose."""
    base = outline(rectangle((0, 0), (4, 4)))
    cut = Cut(base, Blade([1.0, -1.0], [0, 1]))
    cut.advance(to=3.0)
    for turn in (-60.0, -150.0, 100.0, 0.0):
        angle = np.deg2rad(turn)
        cut.turn([np.cos(angle), np.sin(angle)])
        cut.advance(to=cut.depth + 1.5)
        check_outline(cut.cage, 16.0)
        assert segment_crossings(cut.cage) == 0
    assert len(cut.cage.walls) == 9
    assert cut.cage.piece_count == 4


def test_start_between_teeth():
    """A blade that starts between two teeth leaves those behind it alone; depth counts from the next one."""
    cut = Cut(comb(), Blade([0.0, 2.0], [1, 0], start=3.5))
    assert cut.length == pytest.approx(3.0)
    edit = cut.advance(to=9.0)
    check_outline(edit.cage, comb().volume)
    assert edit.cage.piece_count == 3
    assert edit.cage.vertices[comb().vertex_count :, 0].min() == 4.0
    late = Cut(comb(), Blade([0.0, 2.0], [1, 0], start=8.0))
    assert late.advance(to=1.0).is_empty
    assert late.complete
    turned = Cut(comb(), Blade([0.0, 2.0], [1, 0], start=3.5))
    turned.advance(to=0.5)
    turned.turn([1, -1])
    check_outline(turned.advance(to=9.0).cage, comb().volume)


def test_refusals():
    """Widths, starts inside the body and blades of another dimension are refused with the reason."""
    with pytest.raises(ValueError, match="is a point, which has no width"):
        Blade([0, 0], [1, 0], width=0.2)
    with pytest.raises(ValueError, match="starts inside the body, at 0.4 between 0 and 1 along its line"):
        Cut(comb(), Blade([0.0, 2.0], [1, 0], start=0.4))
    with pytest.raises(ValueError, match="the cage is of dimension 2 and the blade of dimension 3"):
        Cut(square(), Blade([0, 0, 0], [1, 0, 0], [0, 1, 0]))
    with pytest.raises(ValueError, match="the cage is of dimension 3 and the blade of dimension 2"):
        Cut(box(), UP)
    cut = Cut(square(), UP)
    cage = cut.advance(to=0.4).cage
    for direction, text in (([0.05, -1], "back into its own cut"), ([0, 0], "zero"), ([0, 1, 0], "must have shape")):
        with pytest.raises(ValueError, match=text):
            cut.turn(direction)
    with pytest.raises(TypeError, match="direction must be two numbers"):
        cut.turn("left")
    assert cut.cage is cage
    cut.advance(to=2.0)
    with pytest.raises(ValueError, match="no front to turn about"):
        cut.turn([1, 0])


def test_growing_across_the_front():
    """A cut whose front stands between bodies of which one grows across it refuses to go on, and stays as it was."""
    base = outline(rectangle((0, 0), (1, 1)), rectangle((3, 0), (4, 1)))
    cut = Cut(base, Blade([0.0, 0.5], [1, 0]))
    cage = cut.advance(to=2.0).cage
    with pytest.raises(ValueError, match="begin a new cut where the cage has grown across the tip"):
        cut.resume(cage.extrude(7, 1.5).cage)
    assert cut.cage is cage
    cut.resume(cage.extrude(7, 0.5).cage)
    check_outline(cut.advance(to=9.0).cage, 2.5)
    assert cut.cage.piece_count == 4


def _carve(scale: float, shift: float) -> list[Cage]:
    """A bent cut and one across it, of a star of some size at some place."""
    plain = PLANES["star"]()
    offset = shift * np.array([1.0, -0.3])
    cage, cages = Cage(scale * plain.vertices + offset, plain.faces), []
    for origin, direction, turned in (([0.1, 0.0], [0.2, -1.0], [1.0, -0.4]), ([0.0, 0.1], [1.0, 0.1], None)):
        cut = Cut(cage, Blade(scale * np.array(origin) + offset, direction))
        for depth in (0.7, 3.0):
            if turned is not None and depth == 3.0:
                cut.turn(turned)
            cages.append(cut.advance(to=depth * scale).cage)
        cage = cut.cage
    return cages


@pytest.mark.parametrize(("scale", "shift"), [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e4)])
def test_every_scale_and_place(scale, shift):
    """A cage of 1 mm or 1 km, or 10 km from the origin, is cut like one of 1 m at home."""
    home, away = _carve(1.0, 0.0), _carve(scale, shift)
    for one, two in zip(home, away, strict=True):
        assert one.faces == two.faces
        np.testing.assert_array_equal(one.face_key, two.face_key)
        np.testing.assert_allclose((two.vertices - shift * np.array([1.0, -0.3])) / scale, one.vertices, atol=1e-9)
    assert home[-1].piece_count > 2
