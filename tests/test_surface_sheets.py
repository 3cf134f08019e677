# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes of any kind become sheets, which are cut as what they are."""

import newton
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import newton_cagecut as cagecut
from cage_shapes import box
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface
from odd_meshes import CLOSED, PARTLY_OPEN, box_mesh, box_with_doubled_triangles, hemisphere, joined, sphere_mesh
from solver_scenes import make_solver
from surface_shapes import check_closed, cut_through

BLADES = (
    Blade([0.45, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0]),
    Blade([0.5, 0.47, 0.5], [1.0, 0.1, -0.05], [0.0, 0.2, -1.0]),
    Blade([0.5, 0.5, 0.53], [0.1, 1.0, 0.15], [1.0, -0.1, 0.1]),
)


def closed_volume(surface: Surface) -> float:
    """Volume in the closed components."""
    mesh = surface.mesh
    is_open = np.zeros(mesh.component_count, dtype=bool)
    is_open[mesh.face_component[mesh.face[mesh.twin < 0]]] = True
    return float(mesh.component_volumes[~is_open].sum())


def check_sheets(surface: Surface) -> None:
    """Assert that every edge has one triangle, or two in opposite directions, and every site one fan."""
    mesh = surface.mesh
    surface.refuse_branches()
    border = mesh.twin < 0
    for ends in (mesh.face_vertex[border], mesh.destination[border]):
        assert np.bincount(ends).max(initial=0) <= 1


def skin_area(surface: Surface) -> float:
    """Area of what is no cap."""
    return float(np.linalg.norm(surface.mesh.face_area_vector[surface.triangle_cap < 0], axis=1).sum())


@pytest.mark.parametrize("name", CLOSED)
def test_closed_sheets_stay_closed(name):
    """Solids that touch or cross, or of which triangles are turned, are cut into closed pieces of the same volume."""
    make, count = CLOSED[name]
    points, triangles = make()
    surface = Surface(points, triangles)
    np.testing.assert_array_equal(surface.points[: len(points)], points)
    assert (surface.closed, surface.mesh.component_count) == (True, count)
    assert surface.volume > 0.0
    area = skin_area(surface)
    for now in cut_through(surface, BLADES):
        check_closed(now, surface.volume)
        assert skin_area(now) == pytest.approx(area)
    assert len(np.unique(now.triangle_cap)) == 1 + len(BLADES)
    assert now.mesh.component_outward.all()


@pytest.mark.parametrize("name", PARTLY_OPEN)
def test_open_sheets_get_no_caps(name):
    """Fins, walls within and open sheets are cut without caps; what is closed beside them stays so."""
    make, count, volume = PARTLY_OPEN[name]
    points, triangles = make()
    surface = Surface(points, triangles)
    np.testing.assert_array_equal(surface.points[: len(points)], points)
    assert surface.mesh.component_count == count
    assert closed_volume(surface) == pytest.approx(volume)
    area = skin_area(surface)
    check_sheets(surface)
    for now in cut_through(surface, BLADES):
        check_sheets(now)
        assert skin_area(now) == pytest.approx(area)
        assert closed_volume(now) == pytest.approx(volume)
    assert (now.triangle_cap >= 0).any() == (volume > 0.0)
    assert now.mesh.component_count > count


def is_cuttable(surface: Surface) -> bool:
    """Whether a surface is not refused for an edge along which a sheet touches itself."""
    try:
        surface.refuse_branches()
    except ValueError:
        return False
    return True


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_any_triangles_become_sheets(seed):
    """Random triangles over few points, boxes of a lattice, turned and doubled at random: sheets, before and after."""
    rng = np.random.default_rng(seed)
    is_soup = bool(rng.integers(2))
    if is_soup:
        points = rng.uniform(0.2, 0.8, (rng.integers(4, 9), 3))
        triangles = rng.integers(0, len(points), (rng.integers(1, 25), 3))
        if not ((triangles != np.roll(triangles, 1, axis=1)).all(axis=1)).any():
            triangles[0] = [0, 1, 2]
    else:
        cells = rng.integers(0, 2, (rng.integers(2, 7), 3))
        points, triangles = joined(*(box_mesh(0.2 + 0.3 * c, 0.5 + 0.3 * c) for c in cells))
        triangles = triangles[rng.permutation(len(triangles))]
        turned = rng.random(len(triangles)) < rng.choice([0.0, 0.1])
        triangles[turned] = triangles[turned, ::-1]
    surface = Surface(points, triangles)
    if not is_cuttable(surface):  # boxes in a ring around one that is missing touch themselves so, too
        return
    check_sheets(surface)
    volume = closed_volume(surface)
    area = skin_area(surface)
    for now in cut_through(surface, BLADES[:2], steps=3):
        if is_soup and not is_cuttable(now):
            return
        check_sheets(now)
        assert skin_area(now) == pytest.approx(area)
        if surface.closed:  # of an open sheet a cut may take a closed piece off, such as the end of a cone
            assert now.closed
            assert closed_volume(now) == pytest.approx(volume, abs=1e-12)


@pytest.mark.parametrize("name", [*CLOSED, *PARTLY_OPEN])
def test_triangles_apart_become_the_same_sheets(name):
    """A mesh whose triangles have points of their own gives the sheets of the one that shares them."""
    points, triangles = {**CLOSED, **PARTLY_OPEN}[name][0]()
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    whole = Surface(points, triangles)
    apart = Surface(points[triangles.reshape(-1)], np.arange(3 * len(triangles)).reshape(-1, 3))
    check_sheets(apart)
    assert (apart.closed, apart.mesh.component_count) == (whole.closed, whole.mesh.component_count)
    assert closed_volume(apart) == pytest.approx(closed_volume(whole))


def test_what_is_given_of_triangles_goes_along():
    """Arrays of points, corners and triangles are those of the triangles that are left, turned with them."""
    points, triangles = box_with_doubled_triangles()
    triangles[5] = triangles[5, ::-1]
    number = np.arange(len(triangles))
    data = {"corner": ("corner", 10 * number[:, None] + triangles), "triangle": number, "point": np.arange(8.0)}
    surface = Surface(points, triangles, uvs=points[triangles][..., :2], data=data)
    kept = surface.data["triangle"]
    assert set(number) - set(kept) == {12, 14}
    np.testing.assert_array_equal(np.sort(surface.data["corner"] % 10), np.sort(triangles[kept]))
    np.testing.assert_array_equal(surface.own_corner_uvs, surface.points[surface.triangles][..., :2])
    np.testing.assert_array_equal(surface.data["corner"] // 10, np.repeat(kept[:, None], 3, axis=1))
    np.testing.assert_array_equal(surface.points[:8], points)
    np.testing.assert_array_equal(points[surface.data["point"].astype(int)], surface.points)


def test_notes_name_what_was_done():
    """Each repair is told with the numbers of the triangles and edges that were given."""
    points, triangles = box_with_doubled_triangles()
    triangles[5] = triangles[5, ::-1]
    notes = " ".join(Surface(points, triangles).notes)
    for text in ("triangle 14 uses a point twice", "triangle 12 is there twice", "triangle 5 ran the other way"):
        assert text in notes
    assert "3 edges have three triangles or more" in notes
    assert Surface(*sphere_mesh()).notes == ()
    open_ones = Surface(*hemisphere()).notes
    assert len(open_ones) == 1
    assert "have one triangle: where a cut meets such edges it makes no caps" in open_ones[0]


@pytest.mark.parametrize("ends", ["elsewhere", "apart"])
def test_cracks_are_counted(ends):
    """Edges that lie along others without ending where they end, or next to them, are cracks, which stay open."""
    points, triangles = box_mesh()
    top = np.flatnonzero((points[triangles][:, :, 2] == 0.8).all(axis=1))
    if ends == "elsewhere":
        points = np.concatenate([points, [[0.5, 0.2, 0.8]]])  # halfway along one edge of the lid, on the lid alone
        lid = [[4, 8, 6], [8, 7, 6], [8, 5, 7]]
    else:
        points = np.concatenate([points, points[4:] + [1e-4, 0.0, 1e-4]])
        lid = [[8, 9, 10], [9, 11, 10]]
    surface = Surface(points, np.concatenate([np.delete(triangles, top, axis=0), lid]))
    assert not surface.closed
    crack = surface.notes[-1]
    assert f"{3 if ends == 'elsewhere' else 8} edges, the first" in crack
    assert "a crack, which stays open" in crack
    assert Surface(points, surface.triangles, weld=2e-4).closed == (ends == "apart")


def test_bodies_warn_and_refuse_before_walks():
    """A body that can be cut says what was done and what stays open; one that cannot be cut says nothing."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    with pytest.warns(UserWarning, match="edges, the first .* have one triangle: where a cut meets"):
        cagecut.add_cage_body(builder, box(), hemisphere(), walks=4, quadrature=10)
    cagecut.add_cage_body(builder, box(), hemisphere(), walks=4, quadrature=10, cuttable=False)


@pytest.mark.filterwarnings("ignore:the mesh of the body")
@pytest.mark.parametrize("name", ["boxes_at_an_edge", "boxes_at_a_face"])
def test_sheets_that_touch_move_as_one(name):
    """Points of two sheets at one place stay there under a twist, before a cut and on each side of it after."""
    points, triangles = CLOSED[name][0]()
    _, solver, *states = make_solver(surface=Surface(points, triangles), walks=16, quadrature=0, seed=1)
    cut = solver.begin_cut(0, BLADES[1])
    for share in (0.0, 0.6, 1.0):
        if share:
            solver.advance_cut(cut, to=share * cut.length, states=states)
        body, q = solver.bodies[0], states[0].particle_q.numpy()
        corners = body.cage.vertices
        turn = 0.7 * (corners[:, 2] - 0.5)
        twisted = corners.copy()
        twisted[:, 0] += (
            np.cos(turn) * (corners[:, 0] - 0.5) - np.sin(turn) * (corners[:, 1] - 0.5) + 0.5 - corners[:, 0]
        )
        q[: len(corners)] = body.to_world(twisted)
        states[0].particle_q.assign(q)
        surface, moved = body.surface, solver.surface(states[0])[0]
        _, place, count = np.unique(
            np.column_stack([surface.points, surface.point_key]), axis=0, return_inverse=True, return_counts=True
        )
        together = 0
        for number in np.flatnonzero(count > 1):
            mine = place.reshape(-1) == number
            together += 1
            assert np.ptp(moved[mine], axis=0).max() == 0.0
        assert together >= 2
