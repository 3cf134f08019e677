# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cuts of chosen cages: what the first ones leave, and how they are refused."""

from __future__ import annotations

import numpy as np
import pytest

from cage_shapes import SHAPES, box, check_manifold, opened_characteristic, square_torus, u_shape, voxels
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.section import Blade


def _down_the_middle(cage: Cage) -> Cut:
    center = 0.5 * (cage.vertices.min(axis=0) + cage.vertices.max(axis=0))
    return Cut(cage, Blade(center + [0.013, 0.0, 0.0], [0, 1, 0], [0, 0, -1]))


def test_slit_of_a_box():
    """A partial cut of a box: four mouth vertices, two tips, two slit faces, two sides that share only the tips."""
    cut = _down_the_middle(box())
    edit = cut.advance(to=0.4)
    cage = edit.cage
    check_manifold(cage, 1.0)
    assert (cage.vertex_count, cage.face_count, cage.component_count) == (14, 9, 1)
    assert edit.created.tolist() == list(range(8, 14))
    assert sorted(len(face) for face in cage.faces) == [4, 4, 4, 4, 4, 4, 4, 7, 7]
    one, two = (set(cage.faces[f]) for f in np.flatnonzero(cage.face_wall == cut.wall))
    tips = one & two
    assert len(tips) == 2
    np.testing.assert_allclose(cage.vertices[sorted(tips), 2], 0.6)
    assert len(cage.walls) == 7
    assert cage.walls[6].two_sided
    assert cut.wall == 6


def test_complete_cut_of_a_box():
    """A complete cut leaves two boxes."""
    cut = _down_the_middle(box())
    cage = cut.advance(to=np.inf).cage
    check_manifold(cage, 1.0)
    assert cut.complete
    assert cage.component_count == 2
    np.testing.assert_allclose(sorted(cage.component_volumes), [0.487, 0.513])
    assert all(len(face) == 4 for face in cage.faces)


def test_sides_face_what_they_bound():
    """Side 1 belongs to the piece on the positive side of the plane, whose walks see it from there."""
    cut = _down_the_middle(box())
    cage = cut.advance(to=2.0).cage
    for side, sign in ((0, -1.0), (1, 1.0)):
        face = int(np.flatnonzero((cage.face_wall == cut.wall) & (cage.face_side == side))[0])
        piece = cage.vertex_component == cage.face_component[face]
        distance = cut.plane.distance(cage.vertices[piece])
        assert (sign * distance > -1e-12).all()
        assert cage.mesh.face_area_vector[face] @ cut.plane.normal * sign < 0.0


def test_tip_travels_and_becomes_a_mouth():
    """A tip keeps its id while it moves and when it comes to rest on the far edge."""
    cut = _down_the_middle(box())
    tips = set(np.flatnonzero(np.isclose(cut.advance(to=0.3).cage.vertices[:, 2], 0.7)).tolist())
    step = cut.advance(to=0.7)
    assert set(step.moved.tolist()) == tips
    assert len(step.created) == 0
    last = cut.advance(to=1.5)
    assert set(last.moved.tolist()) == tips
    np.testing.assert_allclose(last.cage.vertices[sorted(tips), 2], 0.0, atol=1e-12)


def test_unchanged_faces_stay_in_place():
    """Faces that the cut does not touch keep their numbers and loops."""
    base = SHAPES["merged_cube"]()
    cut = Cut(base, Blade([0.4, 0.5, 0.5], [0.1, 1, 0], [1, 0, 0.2]))
    cage = cut.advance(to=0.6).cage
    untouched = set(range(base.face_count)) - set(cut.section.chord_face.tolist())
    assert len(untouched) > 20
    assert all(cage.faces[f] == base.faces[f] for f in untouched)
    np.testing.assert_array_equal(cage.face_key[: base.face_count], base.face_key)


def test_u_shape_opens_two_legs_at_once():
    """A blade across both legs opens two sheets, which the cut of the second leg completes one after the other."""
    cut = Cut(u_shape(), Blade([1.5, 2.0, 0.4], [0, 0, 1], [1, 0, 0]))
    first = cut.advance(to=1.5)
    check_manifold(first.cage, first.before.volume)
    assert first.cage.component_count == 2
    assert len(first.swept) == 1
    second = cut.advance(to=2.5)
    assert second.cage.component_count == 2
    assert second.cage.euler_characteristic == 4
    assert cut.advance(to=3.5).cage.component_count == 3
    both = Cut(u_shape(), Blade([1.5, 2.0, 0.4], [1, 0, 0], [0, 0, 1])).advance(to=0.3)
    assert len(both.swept) == 2
    assert both.cage.component_count == 1
    assert both.cage.euler_characteristic == 2


def test_front_between_two_legs():
    """A front that crosses the gap between two legs changes nothing."""
    cut = Cut(u_shape(), Blade([1.5, 2.0, 0.4], [0, 0, 1], [1, 0, 0]))
    cut.advance(to=1.2)
    step = cut.advance(to=1.8)
    assert step.is_empty
    assert not step.complete
    assert not cut.advance(to=2.2).is_empty


def test_split_off_faces_keep_their_numbers():
    """Faces that the cut splits off are appended in the order of their completion, and stay where they are."""
    base = SHAPES["merged_cube"]()
    cut = Cut(base, Blade([0.5, 0.45, 0.5], [0.1, 0.3, 1], [-1, 0.1, 0.2]))
    known: list[tuple[int, ...]] = []
    for part in np.linspace(0.05, 1.0, 20):
        cage = cut.advance(to=part * cut.length).cage
        split = np.flatnonzero(cage.face_wall[base.face_count :] != cut.wall)
        loops = [cage.faces[base.face_count + i] for i in split]
        assert split.tolist() == list(range(len(loops)))
        assert [sorted(loop) for loop in loops[: len(known)]] == [sorted(loop) for loop in known]
        known = loops
    assert len(known) == 10


def test_legs_cut_from_between_make_a_handle():
    """A blade that slits the bottom of a U and both legs along the plane of the U keeps true handles."""
    base = u_shape()
    cut = Cut(base, Blade([1.5, 1.0, 0.43], [0, 1, 0.01], [1, 0, 0]))
    for part in (0.1, 0.3, 0.45, 0.5, 0.6, 0.8, 1.0):
        cage = cut.advance(to=part * cut.length).cage
        check_manifold(cage, base.volume)
        assert cage.euler_characteristic == opened_characteristic(base, cage, cut.wall)


def test_torus_cut_into_two_rings():
    """A torus sliced like a bagel: the section is an annulus, its sides are bridged, both halves are tori."""
    base = square_torus()
    cut = Cut(base, Blade([1.5, 1.5, 0.31], [1, 0.2, 0], [0, 1, 0.001]))
    for part in (0.2, 0.4, 0.6, 0.7, 0.9, 1.1):
        cage = cut.advance(to=part * cut.length).cage
        check_manifold(cage, base.volume)
        assert cage.euler_characteristic == opened_characteristic(base, cage, cut.wall)
    assert cage.component_count == 2
    assert cage.euler_characteristic == 0
    sides = np.flatnonzero(cage.face_wall == cut.wall)
    assert len(sides) == 2
    for face in sides:
        edges = set(zip(cage.faces[face], cage.faces[face][1:] + cage.faces[face][:1], strict=True))
        assert sum(e[::-1] in edges for e in edges) == 2
    again = Cut(cage, Blade([1.5, 1.5, 0.3], [0, 0, 1], [1, 0.3, 0]))
    for part in (0.2, 0.5, 0.8, 1.1):
        check_manifold(again.advance(to=part * again.length).cage, base.volume)
    assert again.cage.component_count == 4
    assert again.cage.euler_characteristic == 8


def test_plate_with_tunnels():
    """A plate with three tunnels split in its plane: the section has three holes, bridged one after the other."""
    cells = [(i, j, 0) for i in range(7) for j in range(3) if not (j == 1 and i % 2 == 1)]
    base = voxels(cells, np.array([1.0, 1.0, 0.5]))
    assert base.euler_characteristic == -4
    cut = Cut(base, Blade([3.5, 1.5, 0.22], [0.1, 1, 0], [1, 0, 0.01]))
    for part in (0.1, 0.25, 0.4, 0.6, 0.8, 1.1):
        edit = cut.advance(to=part * cut.length)
        check_manifold(edit.cage, base.volume)
        assert edit.cage.euler_characteristic == opened_characteristic(base, edit.cage, cut.wall)
    assert edit.cage.component_count == 2
    assert edit.cage.euler_characteristic == -8
    whole = Cut(base, Blade([3.5, 1.5, 0.22], [0.1, 1, 0], [1, 0, 0.01])).advance(to=np.inf)
    assert len(whole.swept) == 1
    across = Cut(edit.cage, Blade([3.4, 1.5, 0.2], [0.2, 0.1, 1], [0, 1, 0.1]))
    for part in (0.3, 0.6, 1.1):
        check_manifold(across.advance(to=part * across.length).cage, base.volume)


def test_hollow_body_can_be_cut():
    """A cavity in the section is a hole; a complete cut joins the cavity's surface to both halves."""
    cells = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i, j, k) != (1, 1, 1)]
    base = voxels(cells, np.ones(3))
    cut = Cut(base, Blade([1.5, 1.5, 1.4], [1, 0.1, 0.02], [0, 1, 0.1]))
    for part in (0.2, 0.5, 0.8, 1.1):
        cage = cut.advance(to=part * cut.length).cage
        cage.validate()
        assert cage.volume == pytest.approx(26.0, rel=1e-12)
    assert cage.component_count == 2
    assert cage.euler_characteristic == 4


def test_second_cut_through_a_partial_first():
    """A horizontal cut below a vertical slit's mouth leaves three pieces, above its tip two."""
    slit = _down_the_middle(box()).advance(to=0.5).cage
    for height, pieces in ((0.8, 3), (0.2, 2)):
        cut = Cut(slit, Blade([0.5, 0.5, height], [0.1, 1, 0], [1, 0, 0]))
        for part in (0.3, 0.6, 1.1):
            check_manifold(cut.advance(to=part * cut.length).cage, 1.0)
        assert cut.cage.component_count == pieces


def test_crossing_slits_make_a_true_handle():
    """A cut from below that meets the slit of a cut from above leaves a handle, and the characteristic says so."""
    slit = Cut(box(), Blade([0.5, 0.51, 0.5], [1, 0, 0], [0, 0, -1])).advance(to=0.6).cage
    cut = Cut(slit, Blade([0.52, 0.5, 0.5], [0, 1, 0.01], [0, 0, 1]))
    cage = cut.advance(to=0.6).cage
    check_manifold(cage, 1.0)
    assert cage.component_count == 1
    assert cage.euler_characteristic == 0


def test_vertex_on_the_plane_moves_the_plane():
    """A blade through vertices is moved by about the tolerance, and the cut succeeds."""
    cage = SHAPES["merged_cube"]()
    cut = Cut(cage, Blade([1 / 3, 0.5, 0.5], [0, 1, 0], [0, 0, 1]))
    offset = cut.plane.distance(np.array([[1 / 3, 0.5, 0.5]]))[0]
    assert cage.length_tolerance < abs(offset) < 2.0 * cage.length_tolerance
    assert np.abs(cut.plane.distance(cage.vertices)).min() > cage.length_tolerance
    check_manifold(cut.advance(to=2.0).cage, cage.volume)
    assert cut.cage.component_count == 2


def test_front_keeps_off_edges():
    """A front that would stop next to an edge is moved past it by the tolerance, at most."""
    cut = Cut(SHAPES["hexagonal_prism"](), Blade([0, 0, 0.5], [0, 0, 1], [1, 0, 0]))
    reached = np.sort(cut.section.node_coordinates[:, 1])
    tolerance = cut.base.length_tolerance
    for node in np.unique(reached):
        for offset in (-0.9 * tolerance, 0.0, 0.9 * tolerance):
            fresh = Cut(cut.base, Blade([0, 0, 0.5], [0, 0, 1], [1, 0, 0]))
            depth = node + offset - reached[0]
            if depth <= 0.0:
                continue
            fresh.advance(to=depth)
            assert np.abs(fresh.front - reached).min() >= 0.999 * tolerance
            assert 0.0 <= fresh.front - (reached[0] + depth) <= 2.0 * tolerance


def test_blade_that_misses():
    """A blade beside the cage makes empty edits."""
    cage = box()
    cut = Cut(cage, Blade([5, 0, 0], [0, 1, 0], [0, 0, 1]))
    edit = cut.advance(to=3.0)
    assert cut.length == 0.0
    assert edit.is_empty
    assert edit.complete
    assert edit.cage is cage
    assert edit.swept_simplices.shape == (0, 3, 3)
    assert len(edit.changed_faces) == len(edit.changed_keys) == len(edit.source_faces) == 0


def test_empty_steps():
    """Depth zero, the same depth twice and depths beyond the end change nothing."""
    cut = _down_the_middle(box())
    assert cut.advance(to=0.0).is_empty
    assert not cut.advance(to=0.3).is_empty
    assert cut.advance(to=0.3).is_empty
    assert not cut.advance(to=1.5).is_empty
    last = cut.advance(to=7.0)
    assert last.is_empty
    assert last.complete


def test_depth_is_checked():
    """A cut never goes back, and wants a number."""
    cut = _down_the_middle(box())
    cut.advance(to=0.5)
    with pytest.raises(ValueError, match="never goes back: it has reached depth 0.5, asked for 0.4"):
        cut.advance(to=0.4)
    with pytest.raises(ValueError, match="got nan"):
        cut.advance(to=np.nan)
    with pytest.raises(TypeError, match="must be a number"):
        cut.advance(to="deep")
    assert cut.depth == 0.5


def test_types_are_checked():
    """A cut wants a cage and a blade."""
    with pytest.raises(TypeError, match="cage must be a Cage, got str"):
        Cut("box", Blade([0, 0, 0], [1, 0, 0], [0, 1, 0]))
    with pytest.raises(TypeError, match="blade must be a Blade, got tuple"):
        Cut(box(), ([0, 0, 0], [1, 0, 0], [0, 1, 0]))


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_scale_and_offset_do_not_matter(scale):
    """A tiny cage far from the origin is cut like the one at home."""
    home = SHAPES["star_prism"]()
    shift = np.array([10.0, -20.0, 5.0]) * scale
    away = Cage(home.vertices * scale + shift, home.faces)
    origin, edge, direction = np.array([0.05, 0.1, 0.5]), np.array([0.1, 0.3, 1.0]), np.array([1.0, 0.2, 0.1])
    one = Cut(home, Blade(origin, edge, direction)).advance(to=0.7)
    two = Cut(away, Blade(origin * scale + shift, edge, direction)).advance(to=0.7 * scale)
    assert one.cage.faces == two.cage.faces
    np.testing.assert_allclose((two.cage.vertices - shift) / scale, one.cage.vertices, atol=1e-9)


def test_piece_of_points():
    """Points on both sides of a complete cut lie in different components, those of a partial cut in one."""
    points = [[0.2, 0.5, 0.9], [0.8, 0.5, 0.9], [2.0, 0.0, 0.0]]
    cut = _down_the_middle(box())
    assert cut.advance(to=0.5).cage.piece_of(points).tolist() == [0, 0, -1]
    parts = cut.advance(to=1.5).cage.piece_of(points)
    assert sorted(parts[:2].tolist()) == [0, 1]
    assert parts[2] == -1
