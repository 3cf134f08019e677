# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Obstacles that are put into cages."""

from __future__ import annotations

import re

import numpy as np
import pytest

from cage_shapes import SHAPES, box, check_manifold, square_torus, star_prism, tetrahedron, voxels
from cut_sequences import crossings
from extension_checks import check_edit
from newton_cagecut.cage import Blade, Cage, Cut


def _placed(shape: Cage, center, size: float = 1.0) -> Cage:
    """A shape scaled and moved so that its box has its center somewhere."""
    middle = 0.5 * (shape.vertices.min(axis=0) + shape.vertices.max(axis=0))
    return Cage((shape.vertices - middle) * size + center, shape.faces)


def _hollow() -> Cage:
    """A box of 3 x 3 x 3 with the middle voxel missing."""
    cells = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i, j, k) != (1, 1, 1)]
    return voxels(cells, np.ones(3))


@pytest.mark.parametrize("name", SHAPES)
def test_insert_every_shape(name):
    """Each shape becomes a cavity: its faces are reversed, its room is outside, and the body is one piece."""
    cage, obstacle = box((4.0, 4.0, 4.0)), _placed(SHAPES[name](), [2.0, 2.1, 1.9])
    edit = cage.insert(obstacle)
    check_edit(edit, -obstacle.volume)
    result = edit.cage
    assert result.volume == pytest.approx(64.0 - obstacle.volume, rel=1e-13)
    assert result.euler_characteristic == cage.euler_characteristic + obstacle.euler_characteristic
    np.testing.assert_array_equal(result.vertices, np.concatenate([cage.vertices, obstacle.vertices]))
    for face, loop in enumerate(obstacle.faces):
        assert result.faces[6 + face] == tuple(vertex + 8 for vertex in loop[::-1])
        wall = result.walls[result.face_wall[6 + face]]
        np.testing.assert_array_equal(wall.normal, -obstacle.walls[face].normal)
        assert not wall.two_sided
    assert edit.swept_wall.tolist() == list(range(6, 6 + obstacle.face_count))
    assert len(edit.retired_walls) == 0
    assert (result.piece_count, result.component_count, len(edit.components)) == (1, 2, 1)
    assert edit.components[0].volume == pytest.approx(result.volume)
    assert not edit.separated
    inside = np.random.default_rng(0).uniform(0.5, 3.5, (200, 3))
    np.testing.assert_array_equal(result.contains(inside), ~obstacle.contains(inside))
    np.testing.assert_array_equal(result.piece_of(inside), np.where(obstacle.contains(inside), -1, 0))
    again = Cage(result.vertices, result.faces)
    assert again.volume == result.volume


def test_two_obstacles_and_a_growing_cavity():
    """A second obstacle joins the first; faces of the cage and of a cavity can still be extruded."""
    cage = box((4.0, 4.0, 4.0)).insert(_placed(tetrahedron(), [1.2, 1.2, 1.2])).cage
    edit = cage.insert(_placed(box(), [2.7, 2.7, 2.7]))
    check_edit(edit, -1.0)
    assert edit.cage.component_count == 3
    assert edit.cage.piece_count == 1
    check_edit(edit.cage.extrude(0, 0.5), 8.0)
    check_edit(edit.cage.move_face(0, 0.5), 8.0)
    with pytest.raises(ValueError, match="fold onto it"):
        edit.cage.extrude(10, 0.5)


def test_a_hollow_obstacle_encloses_a_piece():
    """What is inside a hollow obstacle is a piece of its own; obstacles of two parts make two cavities."""
    cage = box((5.0, 5.0, 5.0))
    edit = cage.insert(_placed(_hollow(), [2.5, 2.5, 2.5]))
    check_edit(edit, -26.0)
    assert edit.separated
    assert [piece.volume for piece in edit.components] == pytest.approx([125.0 - 27.0, 1.0])
    assert edit.cage.piece_of([[2.5, 2.5, 2.5], [1.5, 2.5, 2.5], [0.5, 2.5, 2.5]]).tolist() == [1, -1, 0]
    two = cage.insert(_placed(voxels([(0, 0, 0), (2, 0, 0)], np.ones(3)), [2.5, 2.5, 2.5]))
    check_edit(two, -2.0)
    assert (two.cage.component_count, two.cage.piece_count) == (3, 1)


@pytest.mark.parametrize(
    ("center", "size", "match"),
    [
        ([2.0, 2.0, 9.0], 1.0, "vertex 0 of the obstacle lies outside the cage, at [1.5, 1.5, 9.5]"),
        ([2.0, 2.0, 3.8], 1.0, "of the obstacle meets face 5 of the cage"),
        ([2.0, 2.0, 3.5], 1.0, "meets face 5 of the cage"),
        ([2.0, 2.0, 3.5 - 1e-6], 1.0, "meets face 5 of the cage"),
        ([2.0, 2.0, 2.0], 4.0, "meets face"),
        ([2.0, 2.0, 2.0], 6.0, "outside the cage"),
        ([2.0, 2.0, 2.0], 1e-6, "not a cage within the tolerance"),
    ],
)
def test_obstacles_that_are_not_inside(center, size, match):
    """An obstacle outside, across, touching, around or too small for the cage is refused, by face or vertex."""
    cage = box((4.0, 4.0, 4.0))
    with pytest.raises(ValueError, match=re.escape(match)):
        cage.insert(_placed(box(), center, size))
    assert (cage.vertex_count, len(cage.walls)) == (8, 6)


def test_a_star_that_pokes_through():
    """Edges that pass through a face between its vertices, and faces that edges of the cage pass through, are found."""
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        box((4.0, 4.0, 0.5)).insert(_placed(star_prism(), [2.0, 2.0, 0.25]))
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        square_torus().insert(_placed(box(), [0.5, 1.5, 0.35], 0.9))


def test_cavities_and_other_obstacles():
    """An obstacle does not fit into a cavity, around one or into another obstacle."""
    cage = _hollow()
    with pytest.raises(ValueError, match="lies outside the cage"):
        cage.insert(_placed(box(), [1.5, 1.5, 1.5], 0.5))
    with pytest.raises(ValueError, match="the obstacle encloses vertex .* of the cage"):
        cage.insert(_placed(box(), [1.5, 1.5, 1.5], 2.0))
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        cage.insert(_placed(box(), [1.1, 1.5, 1.5], 0.5))


def test_what_is_no_obstacle():
    """Things that are no cages, and cages with cuts, are refused with the reason."""
    cage = box((4.0, 4.0, 4.0))
    with pytest.raises(TypeError, match="obstacle must be a Cage, got tuple"):
        cage.insert((cage.vertices, cage.faces))
    cut = Cut(_placed(box(), [2.0, 2.0, 2.0]), Blade([2.1, 2.0, 2.0], [0, 1, 0], [0, 0, 1]))
    with pytest.raises(ValueError, match="of the obstacle is a side of a cut"):
        cage.insert(cut.advance(to=0.5).cage)


def test_obstacles_beside_cuts():
    """An obstacle that crosses the open part of a cut is refused; beside it and ahead of its front it is not."""
    cage = box((4.0, 4.0, 4.0))
    cut = Cut(cage, Blade([2.0, 2.0, 2.0], [0, 1, 0], [0, 0, -1]))
    slit = cut.advance(to=1.5).cage
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        slit.insert(_placed(box(), [2.0, 2.0, 3.0], 0.9))
    for center in ([1.0, 2.0, 3.0], [2.0, 2.0, 1.0]):
        check_edit(slit.insert(_placed(box(), center, 0.9)), -(0.9**3))
    halves = cut.advance(to=9.0).cage
    edit = halves.insert(_placed(voxels([(0, 0, 0), (2, 0, 0)], np.ones(3)), [2.0, 2.0, 2.0], 0.9))
    check_edit(edit, -2 * 0.9**3)
    assert edit.cage.piece_volumes.tolist() == pytest.approx([32.0 - 0.9**3] * 2)


def test_a_cut_goes_on_through_an_obstacle():
    """A cut in progress goes on through an obstacle put in its way, and parts the body around it."""
    cage = box((4.0, 4.0, 4.0))
    cut = Cut(cage, Blade([2.03, 2.0, 2.0], [0, 1, 0.1], [0, 0.05, -1]))
    cut.advance(to=1.0)
    obstacle = _placed(tetrahedron(), [2.0, 2.0, 1.7], 1.5)
    cut.resume(cut.cage.insert(obstacle).cage)
    separated = []
    for depth in np.linspace(1.2, 6.0, 9):
        last = cut.advance(to=depth)
        separated.append(last.separated)
        check_manifold(last.cage, 64.0 - obstacle.volume, hollow=True)
        assert crossings(last.cage) == 0
    assert cut.complete
    assert sum(separated) == 1
    assert last.cage.piece_count == last.cage.component_count == 2
