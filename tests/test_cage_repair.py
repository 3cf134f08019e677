# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages from elsewhere: bent quads, inside out, and smaller than their mesh."""

from __future__ import annotations

import re

import numpy as np
import pytest

from assets.sphere import icosphere
from cage_shapes import box
from newton_cagecut.cage import Cage, Cut, boundary_distances, check_inside
from newton_cagecut.section import Blade
from plane_shapes import square


def quad_ball(per_side: int = 3, bumps: float = 0.2) -> tuple[np.ndarray, list[list[int]]]:
    """A cube of quads, as artists make cages, moved onto a ball with bumps, so that hardly a quad is planar."""
    ids: dict[tuple, int] = {}
    faces = []
    grid = np.linspace(-1.0, 1.0, per_side + 1)
    for axis in range(3):
        for side in (-1.0, 1.0):
            for i in range(per_side):
                for j in range(per_side):
                    corners = [
                        tuple(np.roll([side, grid[a], grid[b]], axis).round(9))
                        for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
                    ]
                    loop = [ids.setdefault(corner, len(ids)) for corner in corners]
                    faces.append(loop if side > 0.0 else loop[::-1])
    points = np.array(list(ids))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    return points * (1.0 + bumps * np.sin(5.0 * points[:, :1]) * np.cos(4.0 * points[:, 1:2])), faces


def test_bent_quads_are_cut_outwards():
    """The refusal names repair=True, with which vertices stay, planar faces stay, and the volume is the larger one."""
    points, faces = quad_ball()
    with pytest.raises(ValueError, match=r"face \d+ of the cage is not planar.*repair=True"):
        Cage(points, faces)
    cage = Cage(points, faces, repair=True)
    np.testing.assert_array_equal(cage.vertices, points)
    for a, b in ((0, 2), (1, 3)):
        parts = [[f[a], f[(a + 1) % 4], f[b]] for f in faces] + [[f[b], f[(b + 1) % 4], f[a]] for f in faces]
        other = np.linalg.det(points[np.array(parts)]).sum() / 6.0
        assert cage.volume > other
    assert cage.face_count <= 2 * len(faces)
    assert Cage(points, [face[::-1] for face in faces], repair=True).volume == pytest.approx(cage.volume)


def test_planar_faces_stay_whole():
    """Only what is bent is cut: a box with one vertex moved keeps the three faces without it."""
    points, faces = box().vertices.copy(), box().faces
    moved = int(faces[0][0])
    points[moved] += 0.3 * (points[moved] - points.mean(axis=0)) * [1.0, 0.5, 0.2]
    cage = Cage(points, faces, repair=True)
    assert sorted(map(len, cage.faces)) == [3] * 6 + [4] * 3
    assert box().faces == Cage(box().vertices, box().faces, repair=True).faces


def test_plane_cage_inside_out_is_turned():
    """Segments that run clockwise are reversed."""
    cage = square()
    turned = Cage(cage.vertices, [face[::-1] for face in cage.faces], repair=True)
    assert turned.volume == pytest.approx(cage.volume)


def test_what_cannot_be_repaired_is_refused():
    """A hole stays one."""
    with pytest.raises(ValueError, match="the cage is open"):
        Cage(box().vertices, box().faces[1:], repair=True)


def test_triangulated():
    """All faces become triangles in their planes; a cage that was cut is refused."""
    cage = box().triangulated()
    assert {len(face) for face in cage.faces} == {3}
    assert (cage.face_count, cage.vertex_count) == (12, 8)
    assert cage.volume == pytest.approx(1.0)
    cut = Cut(box(), Blade((0.5, 0.5, 2.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0))).advance(to=0.4).cage
    for deed, text in ((cut.triangulated, "cut it into triangles"), (lambda: cut.inflated(0.1), "inflate it")):
        with pytest.raises(ValueError, match=f"has been cut .*; {text} before"):
            deed()
    with pytest.raises(ValueError, match="segments, not triangles"):
        square().triangulated()


@pytest.mark.parametrize("make", [box, square])
def test_inflated_box_is_a_box(make):
    """Faces at right angles stay planar polygons, each moved by the distance."""
    cage = make().inflated(0.1)
    assert cage.face_count == make().face_count
    assert cage.volume == pytest.approx(1.2**cage.dimension)


def test_every_face_moves_by_the_distance_at_least():
    """A ball of bent quads keeps at least the distance from what it was, and holds it."""
    points, faces = quad_ball()
    cage = Cage(points, faces, repair=True)
    for distance in (0.01, 0.1):
        wider = cage.inflated(distance)
        assert wider.contains(points).all()
        assert boundary_distances(wider, points).min() > 0.999 * distance


def test_error_names_the_distance_that_is_needed():
    """A cage smaller than its mesh is told to be inflated, by a length with which it holds the mesh."""
    cage, (points, _) = Cage(*quad_ball(), repair=True), icosphere(3)
    with pytest.raises(ValueError, match=r"points lie outside the cage") as caught:
        check_inside(cage, 1.05 * points)
    distance = float(re.search(r"cage\.inflated\(([\d.e-]+)\) holds them", str(caught.value))[1])
    assert len(check_inside(cage.inflated(distance), 1.05 * points)) == 0


@pytest.mark.parametrize("distance", [0.0, -1.0, float("nan")])
def test_bad_distances_are_named(distance):
    """A distance that is none is refused."""
    with pytest.raises(ValueError, match="the distance"):
        box().inflated(distance)
