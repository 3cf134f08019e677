# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages made around meshes: valid, coarse, and at a distance from every triangle of the mesh."""

from __future__ import annotations

import sys
from pathlib import Path

import newton.examples
import numpy as np
import pytest
from scipy.optimize import linprog

import newton_cagecut as cagecut
from newton_cagecut.cage import Cage, mesh_clearance
from newton_cagecut.usd import read_mesh
from newton_cagecut.wrap import wrap
from newton_cagecut.wrap.inequalities import Inequalities
from surface_shapes import icosphere, torus
from wrap_shapes import CUBE, CUBE_TRIANGLES, independent_gap, open_bowl, sheet, two_balls

Mesh = tuple[np.ndarray, np.ndarray]


def stored(name: str) -> Mesh:
    """A mesh of Newton's or of the assets."""
    path = Path(__file__).parent.parent / "assets" / name
    mesh = read_mesh(path if path.exists() else newton.examples.get_asset(name))
    return mesh.points, mesh.triangles


def check_holds(cage: Cage, mesh: Mesh, face_count: int, offset: float = 0.01) -> None:
    """Assert that a cage is valid by its own checks, coarse, and around the mesh by another library's."""
    points, triangles = mesh
    cage.validate()
    assert cage.face_count <= 1.1 * face_count
    assert cage.contains(points).all()
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    assert independent_gap(cage, points, triangles) >= (1.0 - 1e-9) * offset * diagonal


@pytest.mark.parametrize(
    ("name", "face_count", "growth"), [("starfish.usdc", 40, 2.6), ("bunny.usd", 20, 2.8), ("bear.usd", 30, 2.9)]
)
def test_cages_hold_detailed_meshes_closely(name, face_count, growth):
    """A starfish, a bunny and a bear lie in one component each, of a few times their volume."""
    mesh = stored(name)
    cage = cagecut.wrap_cage(*mesh, face_count)
    check_holds(cage, mesh, face_count)
    assert (cage.component_count, cage.euler_characteristic) == (1, 2)
    assert cage.volume < growth * np.linalg.det(mesh[0][mesh[1]]).sum() / 6.0


def test_a_cage_keeps_the_offset_that_is_asked_for():
    """A larger share of the diagonal leaves more room, a smaller one less, and both are kept."""
    mesh, volumes = icosphere(1), []
    for offset in (0.002, 0.03, 0.25):
        cage = cagecut.wrap_cage(*mesh, 12, offset=offset)
        check_holds(cage, mesh, 12, offset)
        volumes.append(cage.volume)
    assert volumes == sorted(volumes)


def test_the_fewest_faces_are_a_tetrahedron():
    """Four faces are enough for a cube."""
    cage = cagecut.wrap_cage(CUBE, CUBE_TRIANGLES, 4)
    check_holds(cage, (CUBE, CUBE_TRIANGLES), 4)
    assert cage.face_count == 4


def test_large_triangles_are_held_between_their_corners():
    """A cage of a cube of twelve triangles has no concave edge that reaches into its faces."""
    check_holds(cagecut.wrap_cage(CUBE, CUBE_TRIANGLES, 16), (CUBE, CUBE_TRIANGLES), 16)


def test_open_meshes_are_closed():
    """A bowl and a flat disc get a closed cage around both of their sides."""
    for mesh, face_count in ((open_bowl(), 24), (sheet(), 8)):
        cage = cagecut.wrap_cage(*mesh, face_count)
        check_holds(cage, mesh, face_count)
        assert cage.euler_characteristic == 2


def test_pieces_get_components_where_they_lie_apart():
    """Two balls far apart get two components, two that almost touch get one."""
    for distance, count in ((4.0, 2), (2.05, 1)):
        mesh = two_balls(distance)
        cage = cagecut.wrap_cage(*mesh, 24)
        check_holds(cage, mesh, 24)
        assert cage.component_count == count


def test_a_hole_stays_open():
    """The cage of a torus is one."""
    ring = torus(20, 8)
    cage = cagecut.wrap_cage(ring.points, ring.triangles, 36)
    check_holds(cage, (ring.points, ring.triangles), 36)
    assert cage.euler_characteristic == 0


def test_orientation_and_degenerate_triangles_do_not_matter():
    """A cube inside out is held with triangles outside it that are a line and a point."""
    points = np.concatenate([CUBE, [[1.2, 1.2, 1.2], [1.1, 1.1, 1.1]], np.tile([[-0.2, 0.5, 0.5]], (3, 1))])
    triangles = np.concatenate([CUBE_TRIANGLES[:, ::-1], [[7, 8, 9], [10, 11, 12]]])
    cage = cagecut.wrap_cage(points, triangles, 12)
    assert cage.contains(points).all()
    assert mesh_clearance(cage, points, triangles) >= 0.01 * np.linalg.norm([1.4, 1.2, 1.2])
    assert cage.volume > 1.0


def test_a_line_can_be_held():
    """A mesh of one triangle without area has a cage too."""
    points, triangles = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]])
    cage = cagecut.wrap_cage(points, triangles, 8)
    assert cage.contains(points).all()
    assert mesh_clearance(cage, points, triangles) >= 0.02


@pytest.mark.parametrize(("scale", "place"), [(1e-9, 0.0), (1e9, 0.0), (1.0, 1e6)])
def test_scale_and_place_do_not_matter(scale, place):
    """A sphere of a nanometre, of a million kilometres, and a thousand kilometres away has a cage around it."""
    points, triangles = icosphere(1)
    points = scale * points + place * np.array([1.0, -1.0, 1.0])
    check_holds(cagecut.wrap_cage(points, triangles, 12), (points, triangles), 12)


def test_the_same_mesh_has_the_same_cage():
    """Nothing is left to chance."""
    one, other = (cagecut.wrap_cage(*icosphere(1), 8) for _ in range(2))
    np.testing.assert_array_equal(one.vertices, other.vertices)
    assert one.faces == other.faces


def test_points_without_triangles_are_refused_outside_the_cage():
    """A stray point inside does not matter; one outside is named."""
    points = np.concatenate([CUBE, [[0.5, 0.5, 0.5]]])
    cagecut.wrap_cage(points, CUBE_TRIANGLES, 4)
    with pytest.raises(ValueError, match=r"1 points of the mesh, the first of them point 8, belong to no triangle"):
        cagecut.wrap_cage(np.concatenate([CUBE, [[9.0, 9.0, 9.0]]]), CUBE_TRIANGLES, 4)


def test_meshes_that_are_none_are_refused():
    """Nothing to hold, no extent, and what is no mesh: each with what is wrong."""
    one = np.array([[0, 1, 2]])
    for points, triangles, text in (
        (CUBE[:0], one[:0], "triangle"),
        (np.ones((3, 3)), one, "all points of the mesh coincide"),
        (CUBE, np.array([[0, 1, 8]]), "only 8 points"),
        (np.where(CUBE > 0.0, np.nan, CUBE), CUBE_TRIANGLES, "not finite"),
    ):
        with pytest.raises(ValueError, match=text):
            cagecut.wrap_cage(points, triangles)


def test_options_out_of_their_range_are_refused():
    """The text says what the range is."""
    for error, options, text in (
        (ValueError, {"face_count": 3}, "must lie between 4 and 500, got 3"),
        (TypeError, {"face_count": 12.5}, "must be an integer"),
        (ValueError, {"offset": 0.0}, "must lie between 0.001 and 0.25"),
        (ValueError, {"offset": float("nan")}, "must lie between"),
        (TypeError, {"offset": "wide"}, "must be a number"),
    ):
        with pytest.raises(error, match=text):
            cagecut.wrap_cage(CUBE, CUBE_TRIANGLES, **options)


def test_what_cannot_be_held_is_an_error_with_the_worst_point(monkeypatch):
    """Where every try fails, the text has the points outside, the farthest one and its distance."""
    monkeypatch.setattr(wrap, "tighten", lambda shell, *_, **__: shell.moved(np.array([9.0, 0.0, 0.0])))
    with pytest.raises(ValueError, match=r"in 8 tries; in the last one \d+ of 8 points lie outside .* \(point \d\)"):
        cagecut.wrap_cage(CUBE, CUBE_TRIANGLES, 12)


def test_a_failed_try_is_followed_by_a_wider_one(monkeypatch):
    """The first shell is spoilt; the next one is decimated from a wrap farther out and leads to a cage."""
    offsets, tighten, alpha_wrap = [], wrap.tighten, wrap.alpha_wrap

    def spoil_first(shell, *arguments, **options):
        return tighten(shell, *arguments, **options) if len(offsets) > 2 else shell.moved(np.ones(3))

    def note(*arguments, offset, **options):
        offsets.append(offset)
        return alpha_wrap(*arguments, offset=offset, **options)

    monkeypatch.setattr(wrap, "tighten", spoil_first)
    monkeypatch.setattr(wrap, "alpha_wrap", note)
    check_holds(cagecut.wrap_cage(*icosphere(1), 12), icosphere(1), 12)
    assert len(offsets) == 3
    assert offsets == sorted(offsets)


def test_the_missing_extra_is_named(monkeypatch):
    """Without PyMeshLab the error says what to install."""
    monkeypatch.setitem(sys.modules, "pymeshlab", None)
    with pytest.raises(ImportError, match=r"pip install 'newton_cagecut\[wrap\]'"):
        cagecut.wrap_cage(CUBE, CUBE_TRIANGLES)


def test_components_are_kept_apart_where_that_is_asked():
    """Two balls 0.3 m apart get one piece of the cage, or one each; a ball in a ball shares its cage."""
    mesh = two_balls(2.3)
    assert cagecut.wrap_cage(*mesh, 24).component_count == 1
    cage = cagecut.wrap_cage(*mesh, 24, separate=True)
    check_holds(cage, mesh, 24)
    assert (cage.component_count, cage.piece_count) == (2, 2)
    points, triangles = icosphere(1)
    nested = np.concatenate([points, 0.3 * points]), np.concatenate([triangles, triangles + len(points)])
    assert cagecut.wrap_cage(*nested, 12, separate=True).component_count == 1


def test_components_that_cannot_be_apart_are_named():
    """Too near, or too many for the faces: the text has the distance, and what to do."""
    with pytest.raises(ValueError, match=r"points 0 and 162 of the mesh come within 0\.0\d+ m .* smaller offset"):
        cagecut.wrap_cage(*two_balls(2.05), 24, separate=True)
    with pytest.raises(ValueError, match="ask for at least 8 faces"):
        cagecut.wrap_cage(*two_balls(4.0), 6, separate=True)


def test_planar_regions_become_polygons():
    """A cube has faces of more than three sides, fewer than its triangles, in a cage that holds it."""
    cage = cagecut.wrap_cage(CUBE, CUBE_TRIANGLES, 12, polygons=True)
    check_holds(cage, (CUBE, CUBE_TRIANGLES), 12)
    assert cage.face_count < 12
    assert max(map(len, cage.faces)) > 3
    ball = icosphere(2)
    plain, flat = (cagecut.wrap_cage(*ball, 30, polygons=polygons) for polygons in (False, True))
    check_holds(flat, ball, 30)
    assert flat.face_count < plain.face_count
    assert flat.volume < 1.3 * plain.volume


def test_rows_that_bind_are_enough():
    """The program solved with few rows at a time has the optimum of all of them."""
    rng = np.random.default_rng(3)
    rows = Inequalities(6)
    directions = rng.normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    vertices, weights = rng.integers(0, 6, size=(4000, 2)), rng.uniform(-1.0, 1.0, size=(4000, 2))
    bounds = rng.uniform(-0.5, 0.05, size=4000)
    rows.require(vertices, weights, directions, bounds, soft=True)
    cost = rng.normal(size=(6, 3))
    moves, shortfall = rows.least(cost, 0.3)
    matrix = np.zeros((4000, 19))
    for k in range(2):
        for axis in range(3):
            np.add.at(matrix, (np.arange(4000), 3 * vertices[:, k] + axis), weights[:, k] * directions[:, axis])
    matrix[:, 18] = 1.0
    limits = [(-0.3, 0.3)] * 18 + [(0.0, None)]
    every = linprog(np.append(cost, 100.0), A_ub=-matrix, b_ub=-bounds, bounds=limits, method="highs")
    assert (cost * moves).sum() + 100.0 * shortfall == pytest.approx(every.fun, abs=1e-7)
