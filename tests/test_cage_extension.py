# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Faces that are extruded or moved outward."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from cage_shapes import SHAPES, box, check_manifold, hexagonal_prism, prism, tetrahedron, u_shape, voxels
from cut_sequences import CAGES, crossings
from extension_checks import check_edit
from newton_cagecut.cage import Cage, CageEdit, Cut
from newton_cagecut.geometry import edge_distances
from newton_cagecut.section import Blade
from plane_shapes import PLANES, outline, rectangle, ring, square

EVERY = SHAPES | PLANES | {"collinear_prism": CAGES["collinear_prism"]}
MOVABLE = {"box": 6, "hexagonal_prism": 2, "star_prism": 2, "u_shape": 7, "square": 4, "l_shape": 4, "holed_square": 4}
MOVABLE |= {"comb": 7, "island": 8, "collinear_prism": 2}
"""How many faces have only neighbours that are at right angles to them and go straight back."""


def _area(cage: Cage, face: int) -> float:
    return float(np.linalg.norm(cage.mesh.face_area_vector[face]))


def _attempt(edit: Callable[[int, float], CageEdit], face: int, distance: float) -> tuple[CageEdit | None, str]:
    """The edit, or None and why it was refused."""
    try:
        return edit(face, distance), ""
    except ValueError as error:
        return None, str(error)


def _halves(edit: CageEdit, blade: Blade) -> list[float]:
    """Volumes of the pieces after a cut in three steps."""
    cut = Cut(edit.cage, blade)
    for part in (0.4, 0.7, 1.1):
        cage = cut.advance(to=part * cut.length).cage
        check_manifold(cage, edit.cage.volume)
        assert crossings(cage) == 0
    return sorted(cage.piece_volumes.tolist())


def _overhangs(cage: Cage, face: int) -> bool:
    """Whether a neighbour rises from the face at a right angle or less, so that it is in the way of any motion."""
    normal = cage.walls[face].normal
    place = cage.vertices[list(cage.faces[face])]
    directions = []
    if cage.dimension == 2:
        for before, after in cage.faces:
            if after == cage.faces[face][0]:
                directions.append((cage.vertices[before] - place[0], place[0] - place[1]))
            if before == cage.faces[face][1]:
                directions.append((cage.vertices[after] - place[1], place[1] - place[0]))
    else:
        for half in range(cage.mesh.face_start[face], cage.mesh.face_start[face + 1]):
            edge = cage.vertices[cage.mesh.destination[half]] - cage.vertices[cage.mesh.face_vertex[half]]
            neighbour = cage.walls[cage.mesh.face[cage.mesh.twin[half]]].normal
            directions.append((np.cross(edge, neighbour), np.cross(edge, normal)))
    return any(into @ normal > 1e-9 and into @ outward <= 1e-9 for into, outward in directions)


@pytest.mark.parametrize("name", EVERY)
def test_extrude_every_face(name):
    """Each face of each shape grows by a prism, or is refused where a neighbour hangs over it or it would fold."""
    cage = EVERY[name]()
    distance = 0.02 * cage.diameter
    for face in range(cage.face_count):
        edit, reason = _attempt(cage.extrude, face, distance)
        if edit is None:
            assert "fold" in reason
        assert (edit is None) == _overhangs(cage, face)
        if edit is None:
            continue
        check_edit(edit, _area(cage, face) * distance)
        size = len(cage.faces[face])
        grown = edit.cage
        assert grown.volume == pytest.approx(cage.volume + _area(cage, face) * distance, rel=1e-13)
        assert grown.euler_characteristic == cage.euler_characteristic
        assert (grown.vertex_count, grown.face_count) == (cage.vertex_count + size, cage.face_count + size)
        np.testing.assert_array_equal(grown.vertices[: cage.vertex_count], cage.vertices)
        assert edit.swept_wall.tolist() == list(range(len(cage.walls), len(cage.walls) + size + 1))
        assert edit.retired_walls.tolist() == [face]
        assert grown.face_wall[face] == len(cage.walls)
        assert crossings(grown) == 0
        assert len(edit.pieces) == cage.piece_count
        assert not edit.separated


@pytest.mark.parametrize("name", EVERY)
def test_move_what_can_move(name):
    """A face that moves takes its vertices along; the cage is one that could have been built so."""
    cage = EVERY[name]()
    moved = 0
    for face in range(cage.face_count):
        edit, reason = _attempt(cage.move_face, face, 0.3)
        if edit is None:
            assert any(text in reason for text in ("would not stay planar", "would shrink"))
            continue
        check_edit(edit, 0.3 * _area(cage, face))
        assert edit.cage.faces == cage.faces
        assert edit.moved.tolist() == sorted(cage.faces[face])
        assert len(edit.created) == 0
        assert edit.swept_wall[-1] == len(cage.walls) == edit.cage.face_wall[face]
        again = Cage(edit.cage.vertices, edit.cage.faces)
        assert again.volume == edit.cage.volume
        moved += 1
    assert moved == MOVABLE.get(name, 0)


def test_moved_cap_of_a_prism():
    """The cap of a prism moves to where that of a higher prism is, with strips as wide as the distance."""
    edit = prism(ring(5), 1.0).move_face(1, 0.5)
    expected = prism(ring(5), 1.5)
    np.testing.assert_allclose(edit.cage.vertices, expected.vertices, atol=1e-15)
    assert edit.cage.faces == expected.faces
    assert edit.swept_wall.tolist() == [2, 3, 4, 5, 6, 7]
    for strip in edit.swept[:-1]:
        np.testing.assert_allclose(sorted(strip[:, 2]), [1.0, 1.0, 1.5, 1.5], atol=1e-15)
    assert edit.retired_walls.tolist() == [1]


def test_neighbours_with_collinear_vertices_and_seams():
    """A cap moves where the side below it is one polygon with a vertex within its edge, or two beside each other."""
    base = box()
    vertices = np.concatenate([base.vertices, [[0.5, 0.0, 1.0], [0.5, 0.0, 0.0]]])
    front = next(f for f, wall in enumerate(base.walls) if wall.normal[1] < -0.5)
    top, low = (next(f for f, wall in enumerate(base.walls) if wall.normal[2] * s > 0.5) for s in (1, -1))
    corner = {tuple(point): i for i, point in enumerate(base.vertices.tolist())}
    left, right = corner[0.0, 0.0, 1.0], corner[1.0, 0.0, 1.0]
    loops = list(base.faces)

    def widen(face: int, vertex: int, ends: set[int]) -> None:
        loop = loops[face]
        at = next(i for i in range(len(loop)) if {loop[i], loop[(i + 1) % len(loop)]} == ends)
        loops[face] = (*loop[: at + 1], vertex, *loop[at + 1 :])

    for face in (top, front):
        widen(face, 8, {left, right})
    one = Cage(vertices[:9], loops).move_face(top, 0.25)
    check_edit(one, 0.25)
    assert np.count_nonzero(one.swept_wall == front) == 2
    below = {corner[0.0, 0.0, 0.0], corner[1.0, 0.0, 0.0]}
    widen(low, 9, below)
    a, b = corner[0.0, 0.0, 0.0], corner[1.0, 0.0, 0.0]
    loops[front] = (a, 9, 8, left)
    two = Cage(vertices, [*loops, (9, b, right, 8)]).move_face(top, 0.25)
    check_edit(two, 0.25)
    assert two.cage.volume == pytest.approx(1.25, rel=1e-14)


def test_sloping_seam_is_refused():
    """A cap does not move where the seam between two faces below it slopes, since one of them would shrink."""
    base = prism(np.array([[0, 0], [0.5, 0], [1, 0], [1, 1], [0, 1]]))
    assert base.move_face(1, 0.1).cage.volume == pytest.approx(1.1)
    vertices = base.vertices.copy()
    vertices[1, 0] = 0.3
    with pytest.raises(ValueError, match=r"face \d of the cage would not just gain a strip .* use extrude\(1, 0.1\)"):
        Cage(vertices, base.faces).move_face(1, 0.1)


@pytest.mark.parametrize(("shape", "faces"), [(hexagonal_prism, (1, 1, 1, 10, 10, 30)), (square, (1, 1, 1, 5, 5, 13))])
def test_extrusions_in_a_row(shape, faces):
    """A face extruded again and again, and then a side of it, keeps all its walls and volumes."""
    cage = shape()
    for face in faces:
        edit = cage.extrude(face, 0.3)
        check_edit(edit, 0.3 * _area(cage, face))
        assert edit.retired_walls.tolist() == [cage.face_wall[face]]
        assert crossings(edit.cage) == 0
        assert len(edit.cage.walls) == len(cage.walls) + len(cage.faces[face]) + 1
        cage = edit.cage
    check_edit(cage.move_face(1, 0.2), 0.2 * _area(cage, 1))


def test_extrude_is_pure():
    """The same extrusion twice gives the same bits, and the cage before is as it was."""
    cage = tetrahedron()
    arrays = [cage.vertices.copy(), cage.face_key.copy(), cage.mesh.face_vertex.copy()]
    one, other = cage.extrude(2, 0.1), cage.extrude(2, 0.1)
    np.testing.assert_array_equal(one.cage.vertices, other.cage.vertices)
    np.testing.assert_array_equal(one.swept_simplices, other.swept_simplices)
    assert one.cage.faces == other.cage.faces
    for array, now in zip(arrays, (cage.vertices, cage.face_key, cage.mesh.face_vertex), strict=True):
        np.testing.assert_array_equal(array, now)
    assert not one.cage.vertices.flags.writeable


@pytest.mark.parametrize(("scale", "shift"), [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e4)])
def test_scale_and_place(scale, shift):
    """The same extrusions of a tiny, a huge and a far cage give the same faces, or the same refusals."""
    base = u_shape()
    cage = Cage(base.vertices * scale + shift, base.faces)
    for face in range(base.face_count):
        outcome = []
        for one, unit in ((base, 1.0), (cage, scale)):
            outcome.append(_attempt(one.extrude, face, 0.4 * unit)[0])
        if outcome[0] is None or outcome[1] is None:
            assert outcome[0] is outcome[1]
            continue
        here, there = (edit.cage for edit in outcome)
        assert here.faces == there.faces
        np.testing.assert_allclose(there.vertices, here.vertices * scale + shift, rtol=1e-12)


@pytest.mark.parametrize("method", ["extrude", "move_face"])
@pytest.mark.parametrize(
    ("arguments", "error", "match"),
    [
        (("1", 0.1), TypeError, "face must be an integer"),
        ((1.0, 0.1), TypeError, "face must be an integer"),
        ((6, 0.1), ValueError, "faces 0 to 5, there is no face 6"),
        ((-1, 0.1), ValueError, "there is no face -1"),
        ((1, "far"), TypeError, "distance that a face moves must be a number"),
        ((1, None), TypeError, "distance that a face moves must be a number"),
        ((1, np.nan), ValueError, "must be a number, got nan"),
        ((1, 0.0), ValueError, "moves outward by a finite distance"),
        ((1, -0.5), ValueError, "put an obstacle in or cut to take from the body"),
        ((1, 1e-7), ValueError, "beyond the cage's tolerance"),
        ((1, np.inf), ValueError, "finite distance"),
    ],
)
def test_bad_arguments(method, arguments, error, match):
    """Faces and distances that are none are refused with what is wrong."""
    with pytest.raises(error, match=match):
        getattr(box(), method)(*arguments)


def test_neighbours_that_lean_are_named():
    """A face whose neighbours are not parallel to the motion is not moved; the text points to extrude."""
    with pytest.raises(ValueError, match=r"face 1 of the cage would not stay planar .* use extrude\(0, 0.2\)"):
        tetrahedron().move_face(0, 0.2)
    with pytest.raises(ValueError, match="would shrink if face 6 moved"):
        u_shape().move_face(6, 0.2)


def _two_boxes(dimension: int) -> Cage:
    """Two unit boxes, or squares, a unit apart."""
    if dimension == 2:
        return outline(rectangle((0, 0), (1, 1)), rectangle((2, 0), (3, 1)))
    return voxels([(0, 0, 0), (2, 0, 0)], np.ones(3))


def _points_in_prism(cage: Cage, face: int, distance: float, rng: np.random.Generator) -> np.ndarray:
    """Random points of what a face sweeps."""
    corners = cage.vertices[cage.simplices[cage.simplex_face == face]]
    weights = rng.dirichlet(np.ones(cage.dimension), (100, len(corners)))
    points = np.einsum("ntc,tcd->ntd", weights, corners).reshape(-1, cage.dimension)
    return points + rng.uniform(0.01, 0.99, (len(points), 1)) * distance * cage.walls[face].normal


@pytest.mark.parametrize("name", ["u_shape", "square_torus", "star_shaped", "comb", "island", "annulus"])
def test_the_way_is_free_up_to_some_distance(name):
    """What a face sweeps was outside and is inside; from the distance on at which it is refused, it always is."""
    cage, rng = (CAGES | PLANES)[name](), np.random.default_rng(1)
    any_refused = False
    for face in rng.permutation(cage.face_count)[:12].tolist():
        ended = False
        for distance in np.array([0.01, 0.1, 0.25, 0.5, 1.5]) * cage.diameter:
            edit, _ = _attempt(cage.extrude, face, distance)
            assert edit is None or not ended
            ended |= edit is None
            points = _points_in_prism(cage, face, distance, rng)
            if edit is not None:
                assert not cage.contains(points).any()
                assert edit.cage.contains(points).all()
        any_refused |= ended
    assert any_refused == (name != "star_shaped")


def test_distances_between_edges():
    """Distances between segments agree with a dense sample, parallel, crossing and collinear ones included."""
    rng = np.random.default_rng(5)
    one, other = rng.normal(size=(2, 60, 2, 3))
    other[:10, 1] = other[:10, 0] + 2.0 * (one[:10, 1] - one[:10, 0])
    other[10:20] = one[10:20, :1] + np.array([[1.3], [2.1]]) * (one[10:20, 1:] - one[10:20, :1])
    other[20:30, 0] = one[20:30].mean(axis=1) - (other[20:30, 1] - one[20:30].mean(axis=1))
    t = np.linspace(0.0, 1.0, 101)[:, None]
    samples = [ends[:, None, 0] + t * (ends[:, None, 1] - ends[:, None, 0]) for ends in (one, other)]
    sampled = np.linalg.norm(samples[0][:, :, None] - samples[1][:, None], axis=3).min(axis=(1, 2))
    found = edge_distances(one, other)
    assert (found <= sampled + 1e-12).all()
    np.testing.assert_allclose(found, sampled, atol=0.06)
    np.testing.assert_allclose(found[20:30], 0.0, atol=1e-12)
    np.testing.assert_allclose(found[10:20], 0.3 * np.linalg.norm(one[10:20, 1] - one[10:20, 0], axis=1))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("method", ["extrude", "move_face"])
def test_bodies_in_the_way(method, dimension):
    """A face moves up to just before another body, not to it, into it or through it."""
    cage = _two_boxes(dimension)
    face = next(f for f, wall in enumerate(cage.walls) if wall.normal[0] > 0.5 and wall.origin[0] == 1.0)
    other = next(f for f, wall in enumerate(cage.walls) if wall.normal[0] < -0.5 and wall.origin[0] == 2.0)
    move = getattr(cage, method)
    check_edit(move(face, 1.0 - 1e-5), 1.0 - 1e-5)
    for distance in (1.0 - 1e-7, 1.0, 1.3, 2.0):
        with pytest.raises(ValueError, match=f"face {face} of the cage would run into face"):
            move(face, distance)
    narrow = cage.vertices.copy()
    narrow[narrow[:, 0] < 1.5, 1:] = 0.25 + 0.5 * narrow[narrow[:, 0] < 1.5, 1:]
    with pytest.raises(ValueError, match=f"run into face {other} "):
        Cage(narrow, cage.faces).extrude(face, 1.2)


@pytest.mark.parametrize("shape", [box, square])
def test_a_body_inside_the_prism(shape):
    """A body that lies within what the face would sweep, touching none of it, is in the way."""
    base = shape()
    shift = np.array([2.0, 0.4, 0.4])[: base.dimension]
    faces = [tuple(base.vertex_count + vertex for vertex in loop) for loop in base.faces]
    cage = Cage(np.concatenate([base.vertices, 0.2 * base.vertices + shift]), [*base.faces, *faces])
    right = next(f for f, wall in enumerate(base.walls) if wall.normal[0] > 0.5)
    check_edit(cage.extrude(right, 0.9), 0.9)
    for distance in (1.05, 5.0):
        reason = _attempt(cage.extrude, right, distance)[1]
        assert f"face {right} of the cage would run into face" in reason
        assert int(reason.split("into face ")[1].split()[0]) >= base.face_count


def test_a_cavity_that_is_filled_is_refused():
    """A cavity's base moves into it up to what leans over it, not so far that all of the cavity is swept."""
    hole = tetrahedron()
    cage = box((3.0, 3.0, 3.0)).insert(Cage(hole.vertices + 1.0, hole.faces)).cage
    base = 6
    for distance in (0.3, 0.9, 1.5):
        with pytest.raises(ValueError, match=f"face {base} of the cage would run into face"):
            cage.extrude(base, distance)


def test_a_cavity_shrinks():
    """A face of a box-shaped cavity with others beside it that lean away moves into the cavity."""
    hole = tetrahedron()
    flared = np.concatenate([0.6 * hole.vertices[:3] + [1.2, 1.2, 1.0], hole.vertices[:3] + [1.0, 1.0, 2.0]])
    flared[:, 2] = [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    walls = Cage(flared, [(0, 2, 1), (3, 4, 5), (0, 1, 3), (1, 4, 3), (1, 2, 4), (2, 5, 4), (2, 0, 5), (0, 3, 5)])
    cage = box((3.0, 3.0, 3.0)).insert(walls).cage
    edit = cage.extrude(6, 0.4)
    check_edit(edit, 0.4 * _area(cage, 6))
    assert edit.cage.component_volumes[1] == pytest.approx(cage.component_volumes[1] + 0.4 * _area(cage, 6))
    assert edit.cage.piece_count == 1


def _halfway(dimension: int) -> tuple[Cage, Blade]:
    """A box of 2 x 1 x 1, or its side view, and a blade that parts it at 0.9 from above."""
    if dimension == 2:
        return outline(rectangle((0, 0), (2, 1))), Blade([0.9, 0.5], [0, -1])
    return box((2.0, 1.0, 1.0)), Blade([0.9, 0.5, 0.5], [0, 1, 0], [0, 0, -1])


@pytest.mark.parametrize(
    ("dimension", "expected"),
    [
        (2, {"side of a cut": 2 + 2, "has slit": 0, "has split": 2 + 4}),
        (3, {"side of a cut": 2 + 2, "has slit": 2, "has split": 2 + 8}),
    ],
)
def test_faces_that_cuts_touched_are_refused(dimension, expected):
    """Sides of cuts, slit faces and split faces do not move, by name; others of the same cage do."""
    cage, blade = _halfway(dimension)
    cut = Cut(cage, blade)
    reasons = dict.fromkeys(expected, 0)
    for partly in (cut.advance(to=0.4).cage, cut.advance(to=2.0).cage):
        for face in range(partly.face_count):
            edit, refusal = _attempt(partly.extrude, face, 0.2)
            if edit is None:
                assert f"face {face} of the cage" in refusal
                reasons[next(text for text in reasons if text in refusal)] += 1
            else:
                check_edit(edit, 0.2 * _area(partly, face))
    assert reasons == expected


def test_extrude_then_cut():
    """Cuts pass through the extruded part and the old body as if they had been built as one."""
    right = next(f for f, wall in enumerate(box().walls) if wall.normal[0] > 0.5)
    edit = box().extrude(right, 1.0)
    assert _halves(edit, Blade([0.5, 0.3, 0.5], [1, 0, 0], [0, 0, -1])) == pytest.approx([0.6, 1.4])
    assert _halves(edit, Blade([1.4, 0.5, 0.5], [0, 1, 0], [0, 0, -1])) == pytest.approx([0.6, 1.4])
    assert _halves(edit, Blade([1.0, 0.5, 0.5], [0, 1, 0], [0, 0, -1])) == pytest.approx([1.0, 1.0], rel=1e-5)
    assert _halves(square().extrude(1, 1.0), Blade([1.4, 0.5], [0, -1])) == pytest.approx([0.6, 1.4])


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("method", ["extrude", "move_face"])
def test_a_cut_goes_on_after_an_extension(dimension, method):
    """A cut in progress goes on in the cage that an extension has changed, in the new part too."""
    cage, blade = _halfway(dimension)
    cut = Cut(cage, blade)
    cut.advance(to=0.4)
    bottom = next(f for f, wall in enumerate(cage.walls) if wall.normal[-1] < -0.5)
    edit = getattr(cut.cage, method)(bottom, 0.5)
    check_edit(edit, 1.0)
    cut.resume(edit.cage)
    separated = []
    for depth in (0.6, 0.99, 1.2, 3.0):
        last = cut.advance(to=depth)
        check_manifold(last.cage, 3.0)
        separated.append(last.separated)
    assert cut.complete
    assert separated == [False, False, False, True]
    assert sorted(last.cage.piece_volumes) == pytest.approx([0.9 * 1.5, 1.1 * 1.5])
    assert cut.rewind(0.3).volume == pytest.approx(2.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_growth_across_the_front(dimension):
    """A cut does not go on where the cage has grown across its front, beside where it has come; the text says so."""
    cage = _two_boxes(dimension)
    blade = Blade([-1, 0.5], [1, 0]) if dimension == 2 else Blade([-1, 0.5, 0.5], [0, 1, 0], [1, 0, 0])
    cut = Cut(cage, blade)
    half = cut.advance(to=1.5).cage
    face = next(f for f in range(cage.face_count) if cage.walls[f].normal[0] < -0.5 and cage.walls[f].origin[0] > 1.5)
    grown = half.extrude(face, 0.7).cage
    with pytest.raises(ValueError, match=r"begin a new cut where the cage has grown across the (front|tip)"):
        cut.resume(grown)
    assert cut.cage is half
    cut.resume(half.extrude(face, 0.4).cage)
    assert cut.advance(to=9.0).cage.piece_count == 4
