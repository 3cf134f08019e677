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
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.section import Blade
from plane_shapes import PLANES, outline, rectangle

EVERY = SHAPES | PLANES


def _placed(shape: Cage, center, size: float = 1.0) -> Cage:
    """A shape scaled and moved so that its box has its center somewhere."""
    middle = 0.5 * (shape.vertices.min(axis=0) + shape.vertices.max(axis=0))
    return Cage((shape.vertices - middle) * size + np.array(center)[: shape.dimension], shape.faces)


def _room(dimension: int, size: float = 4.0) -> Cage:
    """A cube, or a square, with a corner at the origin."""
    return outline(rectangle((0, 0), (size, size))) if dimension == 2 else box((size, size, size))


def _unit(dimension: int) -> Cage:
    """A unit cube or square."""
    return _room(dimension, 1.0)


def _two(dimension: int) -> Cage:
    """Two unit cubes, or squares, a unit apart."""
    if dimension == 2:
        return outline(rectangle((0, 0), (1, 1)), rectangle((2, 0), (3, 1)))
    return voxels([(0, 0, 0), (2, 0, 0)], np.ones(3))


def _hollow(dimension: int) -> Cage:
    """A cube of 3 x 3 x 3 with the middle voxel missing, or a square with the middle missing."""
    if dimension == 2:
        return PLANES["holed_square"]()
    cells = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i, j, k) != (1, 1, 1)]
    return voxels(cells, np.ones(3))


@pytest.mark.parametrize("name", EVERY)
def test_insert_every_shape(name):
    """Each shape becomes cavities: its faces are reversed, its room is outside, what it encloses are pieces."""
    obstacle = EVERY[name]()
    cage, obstacle = _room(obstacle.dimension), _placed(obstacle, [2.0, 2.1, 1.9], min(1.0, 4.0 / obstacle.diameter))
    first, enclosed = cage.face_count, int(np.count_nonzero(obstacle.component_volumes < 0.0))
    edit = cage.insert(obstacle)
    check_edit(edit, -obstacle.volume)
    result = edit.cage
    assert result.volume == pytest.approx(cage.volume - obstacle.volume, rel=1e-13)
    assert result.euler_characteristic == cage.euler_characteristic + obstacle.euler_characteristic
    np.testing.assert_array_equal(result.vertices, np.concatenate([cage.vertices, obstacle.vertices]))
    for face, loop in enumerate(obstacle.faces):
        assert result.faces[first + face] == tuple(vertex + cage.vertex_count for vertex in loop[::-1])
        wall = result.walls[result.face_wall[first + face]]
        np.testing.assert_array_equal(wall.normal, -obstacle.walls[face].normal)
        assert not wall.two_sided
    assert edit.swept_wall.tolist() == list(range(first, result.face_count))
    assert len(edit.retired_walls) == 0
    assert result.component_count == 1 + obstacle.component_count
    assert result.piece_count == len(edit.pieces) == 1 + enclosed
    assert sum(piece.volume for piece in edit.pieces) == pytest.approx(result.volume)
    assert edit.separated == (enclosed > 0)
    inside = np.random.default_rng(0).uniform(0.5, 3.5, (200, cage.dimension))
    np.testing.assert_array_equal(result.contains(inside), ~obstacle.contains(inside))
    np.testing.assert_array_equal(result.piece_of(inside) < 0, obstacle.contains(inside))
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


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_hollow_obstacle_encloses_a_piece(dimension):
    """What is inside a hollow obstacle is a piece of its own; obstacles of two parts make two cavities."""
    cage = _room(dimension, 5.0)
    edit = cage.insert(_placed(_hollow(dimension), [2.5, 2.5, 2.5]))
    check_edit(edit, 1.0 - 3.0**dimension)
    assert edit.separated
    assert [piece.volume for piece in edit.pieces] == pytest.approx([5.0**dimension - 3.0**dimension, 1.0])
    points = np.array([[2.5, 2.5, 2.5], [1.5, 2.5, 2.5], [0.5, 2.5, 2.5]])[:, :dimension]
    assert edit.cage.piece_of(points).tolist() == [1, -1, 0]
    two = cage.insert(_placed(_two(dimension), [2.5, 2.5, 2.5]))
    check_edit(two, -2.0)
    assert (two.cage.component_count, two.cage.piece_count) == (3, 1)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    ("center", "size", "match"),
    [
        ([9.0, 2.0, 2.0], 1.0, "vertex 0 of the obstacle lies outside the cage, at ["),
        ([3.8, 2.0, 2.0], 1.0, "of the obstacle meets face {right} of the cage"),
        ([3.5, 2.0, 2.0], 1.0, "meets face {right} of the cage"),
        ([3.5 - 1e-6, 2.0, 2.0], 1.0, "meets face {right} of the cage"),
        ([2.0, 2.0, 2.0], 4.0, "meets face"),
        ([2.0, 2.0, 2.0], 6.0, "outside the cage"),
        ([2.0, 2.0, 2.0], 1e-6, "too small for a cage with a tolerance of"),
    ],
)
def test_obstacles_that_are_not_inside(center, size, match, dimension):
    """An obstacle outside, across, touching, around or too small for the cage is refused, by face or vertex."""
    cage = _room(dimension)
    right = next(f for f, wall in enumerate(cage.walls) if wall.normal[0] > 0.5)
    with pytest.raises(ValueError, match=re.escape(match.format(right=right))):
        cage.insert(_placed(_unit(dimension), center, size))


def test_a_star_that_pokes_through():
    """Edges that pass through a face between its vertices, and faces that edges of the cage pass through, are found."""
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        box((4.0, 4.0, 0.5)).insert(_placed(star_prism(), [2.0, 2.0, 0.25]))
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        square_torus().insert(_placed(box(), [0.5, 1.5, 0.35], 0.9))


@pytest.mark.parametrize("dimension", [2, 3])
def test_cavities_and_other_obstacles(dimension):
    """An obstacle does not fit into a cavity, around one or into another obstacle."""
    cage = _hollow(dimension)
    with pytest.raises(ValueError, match="lies outside the cage"):
        cage.insert(_placed(_unit(dimension), [1.5, 1.5, 1.5], 0.5))
    with pytest.raises(ValueError, match="the obstacle encloses vertex .* of the cage"):
        cage.insert(_placed(_unit(dimension), [1.5, 1.5, 1.5], 2.0))
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        cage.insert(_placed(_unit(dimension), [1.1, 1.5, 1.5], 0.5))


def test_what_is_no_obstacle():
    """Things that are no cages, and cages with cuts, are refused with the reason."""
    cage = box((4.0, 4.0, 4.0))
    with pytest.raises(TypeError, match="obstacle must be a Cage, got tuple"):
        cage.insert((cage.vertices, cage.faces))
    with pytest.raises(ValueError, match="obstacle of dimension 2 does not fit a cage of 3"):
        cage.insert(_unit(2))
    with pytest.raises(ValueError, match=r"the obstacle, checked as a cage .* face 0 of the cage is degenerate"):
        cage.insert(Cage(tetrahedron().vertices * [1, 1e-6, 1e-6] + 1.5, tetrahedron().faces, tolerance=1e-8))
    cut = Cut(_placed(box(), [2.0, 2.0, 2.0]), Blade([2.1, 2.0, 2.0], [0, 1, 0], [0, 0, 1]))
    with pytest.raises(ValueError, match="of the obstacle is a side of a cut"):
        cage.insert(cut.advance(to=0.5).cage)


def _blade(dimension: int, x: float) -> Blade:
    """A blade that comes down, or along y in the plane, at some x."""
    return Blade([x, 2.0], [0, -1]) if dimension == 2 else Blade([x, 2.0, 2.0], [0, 0, 1], [0, -1, 0])


@pytest.mark.parametrize("dimension", [2, 3])
def test_obstacles_beside_cuts(dimension):
    """An obstacle that crosses the open part of a cut is refused; beside it and ahead of its front it is not."""
    cut = Cut(_room(dimension), _blade(dimension, 2.0))
    slit = cut.advance(to=1.5).cage
    with pytest.raises(ValueError, match="of the obstacle meets face"):
        slit.insert(_placed(_unit(dimension), [2.0, 3.0, 2.0], 0.9))
    for center in ([1.0, 3.0, 2.0], [2.0, 1.0, 2.0]):
        check_edit(slit.insert(_placed(_unit(dimension), center, 0.9)), -(0.9**dimension))
    halves = cut.advance(to=9.0).cage
    edit = halves.insert(_placed(_two(dimension), [2.0, 2.0, 2.0], 0.9))
    check_edit(edit, -2 * 0.9**dimension)
    assert edit.cage.piece_volumes.tolist() == pytest.approx([0.5 * 4.0**dimension - 0.9**dimension] * 2)


@pytest.mark.parametrize("shape", [tetrahedron, star_prism, PLANES["star"], PLANES["l_shape"]])
def test_a_cut_goes_on_through_an_obstacle(shape):
    """A cut in progress goes on through an obstacle put in its way, and parts the body around it."""
    obstacle = shape()
    cage = _room(obstacle.dimension)
    cut = Cut(cage, _blade(cage.dimension, 2.03))
    cut.advance(to=1.0)
    obstacle = _placed(obstacle, [2.0, 1.7, 2.0], 2.0 / obstacle.diameter)
    cut.resume(cut.cage.insert(obstacle).cage)
    separated = []
    for depth in np.linspace(1.2, 6.0, 9):
        last = cut.advance(to=depth)
        separated.append(last.separated)
        check_manifold(last.cage, cage.volume - obstacle.volume, hollow=True)
        assert crossings(last.cage) == 0
    assert cut.complete
    assert sum(separated) == 1
    assert last.cage.piece_count == last.cage.component_count == 2
