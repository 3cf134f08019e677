# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arrays of the user go along with points, corners and triangles through cuts."""

import numpy as np
import pytest

from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from solver_scenes import box_cage, make_solver
from surface_shapes import bumpy_sphere, gridded_box, sphere
from test_surface_seams import BLADES, cut_through, split_everywhere

COLORS = np.array([[0.3, 0.1, 0.0], [-0.2, 0.7, 0.4], [0.5, 0.0, -0.6]])
KNIVES = (Blade([0.3, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0], width=0.3), BLADES[1])


def with_data(surface: Surface, **options) -> Surface:
    """The surface with linear colours of its points and corners, and numbers of its points, corners and triangles."""
    points, triangles, count = surface.points, surface.triangles, surface.triangle_count
    data = {
        "color": (points @ COLORS).astype(np.float32),
        "point_number": np.arange(len(points)),
        "corner_color": (points @ COLORS)[triangles],
        "place": points[triangles],
        "matrix": np.broadcast_to(points[triangles][..., None], (count, 3, 3, 2)),
        "triangle_number": ("triangle", np.arange(count, dtype=np.uint16)),
        "normal": ("triangle", surface.mesh.face_area_vector / surface.mesh.face_volume.std()),
    }
    return Surface(points, triangles, data=data, **options)


@pytest.mark.parametrize("blades", [BLADES, KNIVES], ids=["blades", "knives"])
@pytest.mark.parametrize("shape", [bumpy_sphere, lambda: split_everywhere(sphere(2))], ids=["whole", "split"])
def test_data_goes_along(shape, blades):
    """Linear arrays stay so on the skin, types stay, triangles hand theirs on, caps have zeros."""
    surface = with_data(shape())
    for now in cut_through(surface, blades):
        data, skin = now.data, now.triangle_cap < 0
        corners = now.points[now.triangles]
        assert {name: array.dtype for name, array in data.items()} == {n: a.dtype for n, a in surface.data.items()}
        on_skin = np.unique(now.triangles[skin])
        np.testing.assert_allclose(data["color"][on_skin], (now.points @ COLORS)[on_skin], atol=1e-6)
        np.testing.assert_allclose(data["place"][skin], corners[skin], atol=1e-12)
        np.testing.assert_allclose(data["corner_color"][skin], corners[skin] @ COLORS, atol=1e-12)
        np.testing.assert_array_equal(data["matrix"][..., 0], data["place"])
        number = data["triangle_number"]
        np.testing.assert_array_equal(data["normal"][skin], surface.data["normal"][number[skin]])
        facing = np.einsum("ij,ij->i", now.mesh.face_area_vector, surface.mesh.face_area_vector[number])
        assert facing[skin].min() > -1e-18
        for name in ("corner_color", "place", "triangle_number", "normal"):
            assert not data[name][~skin].any()
        nearest = surface.points[data["point_number"]]
        longest = np.linalg.norm(np.diff(surface.points[surface.triangles], axis=1), axis=2).max()
        assert np.linalg.norm(nearest - now.points, axis=1)[on_skin].max() < longest
        np.testing.assert_array_equal(data["point_number"][: surface.point_count], np.arange(surface.point_count))


def test_corner_uvs_across_a_seam():
    """Texture coordinates of corners, which differ on the two sides of an edge, stay with their own triangles."""
    plain = gridded_box(3)
    uvs = plain.points[plain.triangles][..., :2] + np.arange(plain.triangle_count)[:, None, None]
    surface = Surface(
        plain.points, plain.triangles, uvs=uvs, data={"id": ("triangle", np.arange(plain.triangle_count))}
    )
    assert surface.uvs is None
    walls = box_cage().walls
    np.testing.assert_array_equal(surface.corner_uvs(walls), uvs)
    cut = Cut(box_cage(), BLADES[0])
    surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
    for depth in (0.3, 0.6, 2.0):
        now = surface_cut.advance(cut.advance(to=depth).front).surface
        skin = now.triangle_cap < 0
        wanted = now.points[now.triangles][..., :2] + now.data["id"][:, None, None]
        np.testing.assert_allclose(now.corner_uvs(cut.cage.walls)[skin], wanted[skin], atol=1e-12)
        assert np.abs(now.corner_uvs(cut.cage.walls)[~skin]).max() < 2.0


def test_data_without_a_cut_is_untouched_and_read_only():
    """Arrays come back as they were given, copies that cannot be written to."""
    given = np.arange(12.0)
    points, triangles = sphere(0).points, sphere(0).triangles
    surface = Surface(points, triangles, data={"given": given})
    given[:] = 0.0
    np.testing.assert_array_equal(surface.data["given"], np.arange(12.0))
    with pytest.raises(ValueError, match="read-only"):
        surface.data["given"][0] = 1.0


@pytest.mark.parametrize(
    ("data", "error", "text"),
    [
        ([1], TypeError, "data must be a dictionary of arrays by name, got list"),
        ({3: np.zeros(12)}, TypeError, "the names of data must be strings, got 3"),
        ({"a": np.zeros(7)}, ValueError, r"data 'a' must have the shape \(12, ...\) of points, .*; got \(7,\)"),
        ({"a": ["x"] * 12}, TypeError, "data 'a' must be an array of numbers, got <U1"),
        ({"a": [[1], [1, 2]]}, TypeError, "data 'a' must be an array of numbers: "),
        ({"a": ("corner", np.zeros(20))}, ValueError, r"data 'a' must have the shape \(20, 3\) .*, got \(20,\)"),
        ({"a": ("face", np.zeros(20))}, ValueError, "data 'a' belongs to 'face'; it can be to 'point', 'corner' or"),
        ({"a": np.zeros((20, 3))}, ValueError, r"could belong to each corner or triangle; say which: \('corner', arr"),
    ],
)
def test_bad_data_is_refused(data, error, text):
    """What is wrong is said with the array's name."""
    ball = sphere(0)
    with pytest.raises(error, match=text):
        Surface(ball.points, ball.triangles, data=data)


def test_data_of_a_body():
    """Arrays are registered with the body, follow its cuts and their undoing, and come back beside the surface."""
    ball = sphere(1, radius=0.4)
    data = {"color": ball.points, "id": ("triangle", np.arange(ball.triangle_count))}
    _, solver, *states = make_solver(surface=(ball.points, ball.triangles), data=data)
    snapshot = solver.snapshot(0)
    cut = solver.begin_cut(0, BLADES[0])
    solver.advance_cut(cut, to=0.7, states=states)
    points, triangles, found = solver.surface(states[0], data=True)
    assert found["color"].shape == points.shape
    assert found["id"].shape == (len(triangles),)
    skin = solver.bodies[0].surface.triangle_cap < 0
    on_skin = np.unique(triangles[skin])
    np.testing.assert_allclose(found["color"][on_skin], points[on_skin], atol=1e-3)
    found["color"][:] = 0.0
    assert solver.surface(states[0], data=True)[2]["color"].any()
    solver.restore(snapshot)
    assert len(solver.bodies[0].surface.data["id"]) == ball.triangle_count
    with pytest.raises(ValueError, match=r"data 'a' must have the shape \(42, ...\) of points"):
        make_solver(surface=ball, data={"a": np.zeros(3)})
