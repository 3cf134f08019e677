# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom

from newton_cagecut.cage import Cage
from newton_cagecut.usd import read_cage, read_mesh, read_meshes, read_surface, write_cage, write_mesh

BOX = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 2.0) for x in (0.0, 3.0)])
BOX_FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6))


def stage_with_box(path: str = "/World/box") -> Usd.Stage:
    """Return a stage in metres, +Z up, with a box."""
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, "Z")
    add_box(stage, path)
    return stage


def add_box(stage: Usd.Stage, path: str) -> UsdGeom.Mesh:
    """Add a box to a stage."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr([Gf.Vec3f(*map(float, point)) for point in BOX])
    mesh.CreateFaceVertexCountsAttr([4] * 6)
    mesh.CreateFaceVertexIndicesAttr([v for face in BOX_FACES for v in face])
    return mesh


def volume(points: np.ndarray, triangles: np.ndarray) -> float:
    """Return the volume that triangles enclose."""
    return float(np.linalg.det(points[triangles]).sum() / 6.0)


def test_cage_survives_a_round_trip(tmp_path):
    """A cage that is written and read has the same vertices and polygons."""
    write_cage(tmp_path / "box.usda", Cage(BOX, BOX_FACES))
    cage = read_cage(tmp_path / "box.usda")
    np.testing.assert_array_equal(cage.vertices, BOX)
    assert tuple(tuple(face) for face in cage.faces) == BOX_FACES
    stage = Usd.Stage.Open(str(tmp_path / "box.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/cage"))
    assert mesh.GetPurposeAttr().Get() == UsdGeom.Tokens.guide


def test_units_survive_a_round_trip(tmp_path):
    """A mesh in a stage of millimetres is read in metres."""
    write_mesh(tmp_path / "box.usdc", BOX, BOX_FACES, name="box", meters_per_unit=0.001)
    stage = Usd.Stage.Open(str(tmp_path / "box.usdc"))
    stored = UsdGeom.Mesh(stage.GetPrimAtPath("/World/box"))
    np.testing.assert_allclose(np.array(stored.GetPointsAttr().Get()), 1000.0 * BOX)
    np.testing.assert_allclose(read_mesh(tmp_path / "box.usdc").points, BOX, rtol=1e-6)


def test_world_transform_and_unit_are_applied():
    """Points go through the transforms of all parents, then into metres."""
    stage = stage_with_box()
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    UsdGeom.Xform.Define(stage, "/World").AddTranslateOp().Set(Gf.Vec3d(100.0, 0.0, 0.0))
    UsdGeom.Xformable(stage.GetPrimAtPath("/World/box")).AddRotateZOp().Set(90.0)
    expected = np.stack([100.0 - BOX[:, 1], BOX[:, 0], BOX[:, 2]], axis=1) * 0.01
    np.testing.assert_allclose(read_mesh(stage).points, expected, atol=1e-12)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("left_handed", [False, True])
def test_faces_stay_outward(mirrored, left_handed):
    """Mirroring transforms and left-handed meshes are turned so that faces look outward."""
    stage = stage_with_box()
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/box"))
    if mirrored:
        mesh.AddScaleOp().Set(Gf.Vec3f(-1.0, 1.0, 1.0))
    if left_handed:
        mesh.CreateOrientationAttr("leftHanded")
        mesh.GetFaceVertexIndicesAttr().Set([v for face in BOX_FACES for v in face[::-1]])
    data = read_mesh(stage)
    assert volume(data.points, data.triangles) == pytest.approx(6.0)


def test_up_axis_is_kept_or_turned():
    """A stage with +Y up is read as it is, or rotated to +Z up."""
    stage = stage_with_box()
    UsdGeom.SetStageUpAxis(stage, "Y")
    kept, turned = read_mesh(stage), read_mesh(stage, up_axis="Z")
    assert (kept.up_axis, turned.up_axis) == ("Y", "Z")
    np.testing.assert_array_equal(kept.points, BOX)
    np.testing.assert_allclose(turned.points, np.stack([BOX[:, 0], -BOX[:, 2], BOX[:, 1]], axis=1))
    assert volume(turned.points, turned.triangles) == pytest.approx(6.0)


def test_prim_path_chooses_among_meshes():
    """A path names a mesh or a parent of one mesh; the name is the mesh's."""
    stage = stage_with_box("/World/a/box")
    add_box(stage, "/World/b/crate")
    assert read_mesh(stage, "/World/b/crate").name == "crate"
    assert read_mesh(stage, "/World/a").name == "box"


def test_concave_polygons_are_cut_into_triangles():
    """A prism over an L has the triangles of its volume, though the L is not convex."""
    outline = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 3], [0, 3]], dtype=float)
    points = np.concatenate([np.column_stack([outline, np.full(6, z)]) for z in (0.0, 1.0)])
    sides = [(i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6) for i in range(6)]
    stage = stage_with_box()
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/box"))
    faces = [(5, 4, 3, 2, 1, 0), (6, 7, 8, 9, 10, 11), *sides]
    for turn in range(3):
        mesh.GetPointsAttr().Set([Gf.Vec3f(*map(float, p)) for p in np.roll(points, turn, axis=1)])
        mesh.GetFaceVertexCountsAttr().Set([len(face) for face in faces])
        mesh.GetFaceVertexIndicesAttr().Set([v for face in faces for v in face])
        data = read_mesh(stage)
        corners = data.points[data.triangles]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        assert volume(data.points, data.triangles) == pytest.approx(4.0)
        assert area.sum() == pytest.approx(2 * 4.0 + 10.0)


def test_texture_coordinates_belong_to_vertices(tmp_path):
    """Coordinates of vertices are read, and those of corners where each vertex has one."""
    uvs = BOX[:, :2] / 3.0
    write_mesh(tmp_path / "box.usda", BOX, BOX_FACES, uvs=uvs)
    surface = read_surface(tmp_path / "box.usda")
    np.testing.assert_allclose(surface.uvs, uvs, atol=1e-7)
    stage = stage_with_box()
    primvars = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/World/box"))
    st = primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
    st.Set([Gf.Vec2f(*map(float, uvs[v])) for face in BOX_FACES for v in face])
    np.testing.assert_allclose(read_mesh(stage).uvs, uvs, atol=1e-7)


def test_texture_seams_are_left_out_with_a_warning():
    """Coordinates that differ at one vertex are not made up."""
    stage = stage_with_box()
    primvars = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/World/box"))
    st = primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
    st.Set([Gf.Vec2f(corner % 4, 0.0) for corner in range(24)])
    with pytest.warns(UserWarning, match="/World/box .* do not belong to vertices"):
        assert read_mesh(stage).uvs is None


def test_all_meshes_are_read_with_their_seams():
    """Two meshes, one of them mirrored, and each corner keeps its texture coordinate."""
    stage = stage_with_box()
    mesh = add_box(stage, "/World/mirrored")
    mesh.AddScaleOp().Set(Gf.Vec3f(-1.0, 1.0, 1.0))
    st = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
    st.Set([Gf.Vec2f(corner % 4, vertex) for corner, vertex in enumerate(v for face in BOX_FACES for v in face)])
    box, mirrored = read_meshes(stage)
    assert (box.name, mirrored.name, box.corner_uvs) == ("box", "mirrored", None)
    np.testing.assert_array_equal(mirrored.corner_uvs[:, 1], np.ravel(mirrored.faces))
    np.testing.assert_array_equal(mirrored.corner_uvs[:4, 0], [3, 2, 1, 0])


@pytest.mark.parametrize("scale", [(0.0, 0.0, 0.0), (1.0, 0.0, 1.0)])
def test_zero_scales_are_named(scale):
    """A parent that flattens a mesh is an error with the mesh in it; a mesh that is flat itself is none."""
    stage = stage_with_box()
    UsdGeom.Xform.Define(stage, "/World").AddScaleOp().Set(Gf.Vec3f(*scale))
    with pytest.raises(ValueError, match=r"mesh /World/box of .* has a scale of zero"):
        read_mesh(stage)
    UsdGeom.Xformable(stage.GetPrimAtPath("/World")).ClearXformOpOrder()
    stage.GetPrimAtPath("/World/box").GetAttribute("points").Set([Gf.Vec3f(*map(float, p)) for p in BOX * [1, 1, 0]])
    assert read_mesh(stage).points[:, 2].max() == 0.0


def test_missing_prim_lists_the_meshes():
    """A path that is not there is answered with those that are."""
    with pytest.raises(ValueError, match=r"has no prim /World/bax; its meshes: /World/box"):
        read_mesh(stage_with_box(), "/World/bax")


def test_prim_without_mesh_is_refused():
    """A prim that holds no mesh is answered with the meshes that there are."""
    stage = stage_with_box()
    UsdGeom.Xform.Define(stage, "/World/empty")
    with pytest.raises(ValueError, match="no mesh at or below /World/empty; its meshes: /World/box"):
        read_mesh(stage, "/World/empty")


def test_several_meshes_are_named():
    """Without a path, several meshes are an error that names them."""
    stage = stage_with_box()
    add_box(stage, "/World/crate")
    with pytest.raises(ValueError, match="2 meshes; choose one by its path .*: /World/box, /World/crate"):
        read_mesh(stage)


@pytest.mark.parametrize(
    ("attribute", "value", "message"),
    [
        ("points", [], "is empty: it has 0 points"),
        ("faceVertexCounts", [], "is empty: it has 8 points and 0 faces"),
        ("faceVertexCounts", [4] * 5, "add up to 20, but there are 24 indices"),
        ("faceVertexCounts", [4, 2, 6, 4, 4, 4], "face 1 has 2 vertices"),
        ("faceVertexIndices", [0] * 9 + [8] + [0] * 14, "face 2 refers to vertex 8, but there are 8"),
        ("points", [Gf.Vec3f(0.0)] * 7 + [Gf.Vec3f(0.0, float("nan"), 0.0)], "vertex 7 is not finite"),
    ],
)
def test_invalid_meshes_are_refused(attribute, value, message):
    """Each kind of invalid mesh is named with its face or vertex."""
    stage = stage_with_box()
    stage.GetPrimAtPath("/World/box").GetAttribute(attribute).Set(value)
    with pytest.raises(ValueError, match=message):
        read_mesh(stage)


def test_files_that_cannot_be_read(tmp_path):
    """A missing file and one that is no USD are errors of Python."""
    with pytest.raises(FileNotFoundError, match=r"no such USD file: .*none.usda"):
        read_mesh(tmp_path / "none.usda")
    (tmp_path / "text.usda").write_text("not USD")
    with pytest.raises(ValueError, match=r"text.usda cannot be read as USD: it is damaged, cut short, or no USD file$"):
        read_mesh(tmp_path / "text.usda")


def test_unknown_up_axis_is_refused():
    """Only Y and Z can point up."""
    with pytest.raises(ValueError, match='up_axis must be "Y", "Z" or None'):
        read_mesh(stage_with_box(), up_axis="X")


def test_writing_refuses_what_usd_cannot_take(tmp_path):
    """Wrong endings, folders, names and units are refused before a file is made."""
    with pytest.raises(ValueError, match=r"must end in \.usd, \.usda, \.usdc"):
        write_mesh(tmp_path / "box.obj", BOX, BOX_FACES)
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        write_mesh(tmp_path / "none" / "box.usda", BOX, BOX_FACES)
    with pytest.raises(ValueError, match="'my_box' would be"):
        write_mesh(tmp_path / "box.usda", BOX, BOX_FACES, name="my box")
    with pytest.raises(ValueError, match="meters_per_unit must be positive"):
        write_mesh(tmp_path / "box.usda", BOX, BOX_FACES, meters_per_unit=0.0)
    assert list(tmp_path.iterdir()) == []


def test_file_can_be_written_again(tmp_path):
    """A second write replaces the first, even while the first is open."""
    write_mesh(tmp_path / "box.usda", BOX, BOX_FACES)
    opened = Usd.Stage.Open(str(tmp_path / "box.usda"))
    write_mesh(tmp_path / "box.usda", 2.0 * BOX, BOX_FACES)
    np.testing.assert_array_equal(read_mesh(tmp_path / "box.usda").points, 2.0 * BOX)
    assert opened.GetPrimAtPath("/World/mesh")
