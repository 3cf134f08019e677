# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes and cages from files of every format, and what is said of files that are none."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom

import mesh_files
import newton_cagecut as cagecut
from mesh_files import BOX, NORMALS, QUADS, TRIANGLES, UVS
from newton_cagecut import read_cage, read_mesh
from newton_cagecut.usd import write_cage

WRITERS = {
    "box.obj": mesh_files.write_obj,
    "box.off": mesh_files.write_off,
    "little.ply": mesh_files.write_ply,
    "big.ply": partial(mesh_files.write_ply, order="binary_big_endian"),
    "text.ply": partial(mesh_files.write_ply, order="ascii"),
    "box.stl": mesh_files.write_stl,
    "text.stl": partial(mesh_files.write_stl, text=True),
    "box.gltf": lambda path: mesh_files.write_gltf(path, *mesh_files.gltf_box()),
    "box.GLB": lambda path: mesh_files.write_glb(path, *mesh_files.gltf_box()),
    "box.usda": mesh_files.write_usd,
}
TWO_OBJECTS = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 0 0 5\nv 1 0 5\nv 1 1 5\nv 0 1 5\nf -4 -3 -2 -1\n"


@pytest.mark.parametrize("name", WRITERS)
def test_meshes_are_read_back(tmp_path, name):
    """Points in their order, the volume, texture coordinates and normals where the format has them, and a scale."""
    path = tmp_path / name
    WRITERS[name](path)
    surface = cagecut.read_mesh(path)
    assert surface.closed
    assert (surface.point_count, surface.triangle_count) == (8, 12)
    assert surface.volume == pytest.approx(6.0)
    if name.endswith(".stl"):
        assert {tuple(point) for point in surface.points} == {tuple(point) for point in BOX}
        assert surface.uvs is None
    else:
        np.testing.assert_allclose(surface.points, BOX, rtol=1e-6)
        np.testing.assert_allclose(surface.uvs, UVS, atol=1e-7)
    if name.endswith((".stl", ".usda")):
        assert surface.normals is None
    else:
        np.testing.assert_allclose(surface.normals, NORMALS, atol=1e-6)
    assert cagecut.read_mesh(path, scale=0.1).volume == pytest.approx(0.006)


@pytest.mark.parametrize("name", WRITERS)
def test_cages_keep_their_polygons(tmp_path, name):
    """Quads stay quads but in STL and glTF, which have triangles alone."""
    path = tmp_path / name
    WRITERS[name](path)
    cage = cagecut.read_cage(path, scale=2.0, tolerance=1e-5)
    assert cage.volume == pytest.approx(48.0)
    assert cage.tolerance == 1e-5
    if name.lower().endswith((".stl", ".gltf", ".glb")):
        assert cage.face_count == 12
    else:
        assert cage.faces == QUADS
        np.testing.assert_allclose(cage.vertices, 2.0 * BOX, rtol=1e-6)


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_polygons_of_different_lengths(tmp_path, order):
    """A face of a binary or a text file in two triangles, the others as quads."""
    faces = (*QUADS[1:], (0, 2, 3), (0, 3, 1))
    mesh_files.write_ply(tmp_path / "mixed.ply", order=order, faces=faces)
    assert cagecut.read_cage(tmp_path / "mixed.ply").faces == faces
    assert cagecut.read_mesh(tmp_path / "mixed.ply").volume == pytest.approx(6.0)


def write_seams(path) -> None:
    """The box with texture coordinates of its own for each face."""
    if path.suffix == ".obj":
        rows = [f"v {x} {y} {z}" for x, y, z in BOX.tolist()] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
        rows += ["f " + " ".join(f"{v + 1}/{i + 1}" for i, v in enumerate(face)) for face in QUADS]
        path.write_text("\n".join(rows))
        return
    mesh_files.write_usd(path)
    stage = Usd.Stage.Open(str(path))
    prim = stage.GetPrimAtPath("/World/box")
    UsdGeom.PrimvarsAPI(prim).RemovePrimvar("st")
    st = UsdGeom.PrimvarsAPI(prim).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
    st.Set([Gf.Vec2f(*corner) for _ in QUADS for corner in ((0, 0), (1, 0), (1, 1), (0, 1))])
    stage.Save()


@pytest.mark.parametrize("name", ["box.obj", "box.usda"])
def test_seams_get_points_or_are_welded(tmp_path, name):
    """Texture coordinates are kept on copies behind the points, at one site; welded, on the corners of a closed box."""
    write_seams(tmp_path / name)
    split = cagecut.read_mesh(tmp_path / name)
    whole = cagecut.read_mesh(tmp_path / name, weld=True)
    np.testing.assert_allclose(split.points[:8], BOX, rtol=1e-6)
    assert split.point_count > 8
    assert (split.site_count, split.closed) == (8, True)
    corners = split.uvs[split.triangles].reshape(6, 6, 2)
    for face in corners:
        assert {tuple(uv) for uv in face.tolist()} == {(0, 0), (1, 0), (1, 1), (0, 1)}
    assert whole.closed
    assert whole.uvs is None
    np.testing.assert_array_equal(whole.own_corner_uvs.reshape(6, 6, 2), corners)
    np.testing.assert_allclose(whole.points, BOX, rtol=1e-6)
    assert cagecut.read_cage(tmp_path / name).faces == QUADS


def test_gltf_nodes_are_applied(tmp_path):
    """Boxes moved, mirrored and turned by their nodes face outward, with their normals; +Y becomes +Z if asked for."""
    nodes = [{"mesh": 0, "translation": [10, 0, 0]}, {"mesh": 1, "scale": [-1, 2, 1]}]
    mesh_files.write_glb(tmp_path / "two.glb", *mesh_files.gltf_box(nodes=nodes, names=("moved", "mirrored")))
    both = cagecut.read_mesh(tmp_path / "two.glb")
    assert both.volume == pytest.approx(6.0 + 12.0)
    moved = cagecut.read_mesh(tmp_path / "two.glb", name="moved", up_axis="Z")
    np.testing.assert_allclose(moved.points.min(axis=0), [10.0, -1.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(moved.normals[:, 2], NORMALS[:, 1], atol=1e-6)
    mirrored = cagecut.read_mesh(tmp_path / "two.glb", name="mirrored")
    outward = ((mirrored.points - mirrored.points.mean(axis=0)) * mirrored.normals).sum(axis=1)
    assert (outward > 0.0).all()
    with pytest.raises(
        ValueError, match=r"two.glb has 2 meshes; choose the cage by its name \(name=\): moved, mirrored$"
    ):
        cagecut.read_cage(tmp_path / "two.glb")
    assert cagecut.read_cage(tmp_path / "two.glb", name="mirrored").volume == pytest.approx(12.0)


def test_objects_are_joined_or_chosen(tmp_path):
    """Two objects of an OBJ file keep its order of points, and one alone has only its own."""
    path = tmp_path / "two.obj"
    path.write_text(TWO_OBJECTS)
    both, one = cagecut.read_mesh(path), cagecut.read_mesh(path, name="b")
    assert (both.point_count, both.triangle_count) == (7, 3)
    assert (one.point_count, one.triangle_count, one.points[:, 2].min()) == (4, 2, 5.0)
    with pytest.raises(ValueError, match="two.obj has no mesh 'c'; its meshes: a, b"):
        cagecut.read_mesh(path, name="c")


def test_usd_meshes_are_joined_or_chosen(tmp_path):
    """Instances are read too; a mesh is chosen by its name or its path, and curves are a plane cage."""
    path = tmp_path / "two.usda"
    mesh_files.write_usd(path)
    stage = Usd.Stage.Open(str(path))
    copy = stage.DefinePrim("/Copies/one", "Xform")
    copy.GetReferences().AddInternalReference("/World")
    copy.SetInstanceable(True)
    UsdGeom.Xformable(copy).AddTranslateOp().Set((1000.0, 0.0, 0.0))
    stage.Save()
    assert cagecut.read_mesh(path).volume == pytest.approx(12.0)
    one = cagecut.read_mesh(path, name="/Copies/one")
    np.testing.assert_allclose(one.points.min(axis=0), [10.0, 0.0, 0.0], rtol=1e-6)
    assert cagecut.read_cage(path, name="/World/box").faces == QUADS
    with pytest.raises(ValueError, match="has no mesh 'bax'; its meshes: box"):
        cagecut.read_mesh(path, name="bax")
    square = cagecut.Cage([[0, 0], [1, 0], [1, 1], [0, 1]], [(0, 1), (1, 2), (2, 3), (3, 0)])
    write_cage(tmp_path / "square.usda", square)
    assert cagecut.read_cage(tmp_path / "square.usda", scale=2.0).volume == pytest.approx(4.0)


@pytest.mark.parametrize("interpolation", ["vertex", "faceVarying"])
def test_usd_normals_are_kept(tmp_path, interpolation):
    """Those of a mirrored, stretched and turned mesh go with it, of its points or of its corners."""
    path = tmp_path / "box.usda"
    mesh_files.write_usd(path)
    stage = Usd.Stage.Open(str(path))
    UsdGeom.SetStageUpAxis(stage, "Y")
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/box"))
    mesh.AddScaleOp().Set(Gf.Vec3f(-1.0, 4.0, 1.0))
    corners = NORMALS if interpolation == "vertex" else NORMALS[np.ravel(QUADS)]
    mesh.CreateNormalsAttr([Gf.Vec3f(*map(float, normal)) for normal in corners])
    mesh.SetNormalsInterpolation(interpolation)
    stage.Save()
    surface = cagecut.read_mesh(path, up_axis="Z")
    expected = NORMALS * [-1.0, 0.25, 1.0]
    expected = np.column_stack([expected[:, 0], -expected[:, 2], expected[:, 1]])
    np.testing.assert_allclose(surface.normals, expected / np.linalg.norm(expected, axis=1)[:, None], atol=1e-6)
    assert surface.point_count == 8
    assert surface.volume == pytest.approx(24.0)


def test_triangles_without_area_by_their_points_are_left_out(tmp_path):
    """A quad with a corner twice gives one triangle."""
    (tmp_path / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2 3\nf 1 1 2\n")
    assert cagecut.read_mesh(tmp_path / "mesh.obj").triangle_count == 1


def test_the_missing_extra_is_named(tmp_path, monkeypatch):
    """Without trimesh, STL and glTF say what to install, and OBJ is read."""
    mesh_files.write_stl(tmp_path / "box.stl")
    mesh_files.write_obj(tmp_path / "box.obj")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ImportError, match=r"pip install 'newton_cagecut\[files\]'"):
        cagecut.read_mesh(tmp_path / "box.stl")
    assert cagecut.read_mesh(tmp_path / "box.obj").point_count == 8


PLY_HEAD = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.mark.parametrize(
    ("name", "content", "text"),
    [
        ("mesh.xyzzy", "", r"files that end in .xyzzy are not read; .usd, .* and .glb are"),
        ("mesh", "", "files that end in nothing are not read"),
        ("hello.obj", "hello", "is empty: it has 0 points and 0 faces"),
        ("points.obj", "v 0 0 0\nv 1 0 0\n", "is empty: it has 2 points and 0 faces"),
        ("short.obj", "v 0 0 0\nv 1 0\n", "line 2 is cut short or damaged: 'v 1 0'"),
        ("word.obj", "v 0 0 zero\n", "line 1 is cut short or damaged: 'v 0 0 zero'"),
        ("face.obj", TRIANGLE + "f 1 2\n", "line 5 is cut short or damaged: 'f 1 2'"),
        ("far.obj", TRIANGLE + "f 1 2 9\n", "face 1 refers to point 9, but there are 3; the file is cut short"),
        ("uv.obj", TRIANGLE + "f 1/1 2/1 3/1\n", "face 1 refers to texture coordinate 1, but there are 0"),
        ("back.obj", TRIANGLE + "f -1 -2 -9\n", "line 5 is cut short or damaged: 'f -1 -2 -9'"),
        ("nan.obj", TRIANGLE.replace("1 0 0", "nan 0 0"), "vertex 1 is not finite"),
        ("twice.obj", TRIANGLE.replace("1 2 3", "1 2 2"), "has no triangle whose points differ"),
        ("hello.off", "hello", "cannot be read as OFF: its first line must be OFF"),
        ("none.off", "OFF", "its counts is cut short"),
        ("short.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "is cut short: it promises 3 points and 1 faces, but has 2 lines"),
        ("face.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "face 0 is cut short or damaged: '0 1'"),
        ("far.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "face 0 refers to vertex 7, but there are 3"),
        ("hello.ply", "ply\nformat", "cannot be read as PLY: its header is damaged or cut short"),
        (
            "short.ply",
            PLY_HEAD + "property float z\nend_header\n0 0 0\n",
            "does not hold the 3 rows of its element 'ver",
        ),
        ("flat.ply", PLY_HEAD + "end_header\n0 0\n0 0\n0 0\n", "its points have no z"),
        ("hello.stl", "hello", "is cut short or no STL: it promises 0 triangles and holds 0"),
        ("short.stl", "solid a\nfacet", "is cut short: it does not end with endsolid"),
        ("hello.gltf", "{", "cannot be read as glTF: its JSON is damaged or cut short"),
        ("none.gltf", '{"asset": {"version": "2.0"}}', "none.gltf has no meshes"),
        ("hello.glb", "hello", "is cut short or no binary glTF"),
        ("hello.usda", "hello", "cannot be read as USD: it is damaged, cut short, or no USD file"),
        ("none.usda", "#usda 1.0\n", "none.usda has no meshes"),
    ],
)
def test_bad_files_are_one_line(tmp_path, name, content, text):
    """The line says which file and what is wrong with it, in no library's words."""
    (tmp_path / name).write_text(content)
    with pytest.raises(ValueError, match=text) as caught:
        cagecut.read_mesh(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert name in str(caught.value)


@pytest.mark.parametrize("name", [name for name in WRITERS if name != "box.usda"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.95])
def test_files_cut_short_are_one_line(tmp_path, name, share):
    """Wherever a file ends too early, one line says so, or that what is left is no cage."""
    WRITERS[name](tmp_path / name)
    content = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(content[: int(share * len(content))])
    with pytest.raises(ValueError, match=name) as caught:
        cagecut.read_cage(tmp_path / name)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"nodes": [{"mesh": 0, "scale": [1, 0, 1]}]}, "a node of mesh 'box', or one above it, has a scale of zero"),
        ({"nodes": [{"name": "empty"}]}, "has 1 meshes, but its scene shows no triangles of them"),
        ({"extensionsRequired": ["KHR_draco_mesh_compression"]}, "is compressed .* export it without compression"),
        ({"bufferViews": []}, "cannot be read as gltf: it, or a file that it names, is damaged, cut short or missing"),
        ({"buffers": [{"byteLength": 9, "uri": "nowhere.bin"}]}, "it, or a file that it names, is damaged"),
    ],
)
def test_bad_gltf_is_one_line(tmp_path, change, text):
    """What is wrong inside of a glTF file is said of it."""
    content, data = mesh_files.gltf_box()
    mesh_files.write_gltf(tmp_path / "box.gltf", content, data)
    if "buffers" in change:
        (tmp_path / "box.bin").unlink()
    else:
        mesh_files.write_gltf(tmp_path / "box.gltf", {**content, **change}, data)
    with pytest.raises(ValueError, match=text) as caught:
        cagecut.read_mesh(tmp_path / "box.gltf")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("options", "error", "text"),
    [
        ({"scale": 0.0}, ValueError, "scale must be positive and finite, got 0.0"),
        ({"scale": float("inf")}, ValueError, "scale must be positive and finite, got inf"),
        ({"scale": "big"}, TypeError, "scale must be a number, got 'big'"),
        ({"up_axis": "X"}, ValueError, 'up_axis must be "Y", "Z" or None'),
        ({"name": 3}, TypeError, "name must be the name of a mesh, got 3"),
    ],
)
def test_bad_arguments_are_named(tmp_path, options, error, text):
    """They are found before the file is looked at."""
    for read in (cagecut.read_mesh, cagecut.read_cage):
        with pytest.raises(error, match=text):
            read(tmp_path / "none.obj", **options)


def test_missing_files_and_bad_cages(tmp_path):
    """No file, a folder, and an open mesh as a cage."""
    with pytest.raises(FileNotFoundError, match=r"no such file: .*none.obj"):
        cagecut.read_mesh(tmp_path / "none.obj")
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(ValueError, match=r"folder.obj is a folder, not a file"):
        cagecut.read_mesh(tmp_path / "folder.obj")
    (tmp_path / "open.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n")
    with pytest.raises(ValueError, match=r"open.obj is no valid cage: the cage is open"):
        cagecut.read_cage(tmp_path / "open.obj")


def ring(path: Path) -> None:
    """A flat ring of triangles at z = 0.5, clockwise seen from +z."""
    corners = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)]
    rows = [f"v {x} {y} 0.5" for x, y in corners]
    for i in range(4):
        a, b, c, d = i + 1, (i + 1) % 4 + 1, i + 5, (i + 1) % 4 + 5
        rows += [f"f {a} {c} {b}", f"f {b} {c} {d}"]
    path.write_text("\n".join(rows))


def test_flat_meshes_are_plane_cages_of_their_border(tmp_path):
    """A triangulated ring that faces down is a square with a hole; one that stands upright is told to be turned."""
    ring(tmp_path / "ring.obj")
    cage = read_cage(tmp_path / "ring.obj", scale=2.0)
    assert (cage.dimension, cage.vertex_count, cage.face_count) == (2, 8, 8)
    assert cage.volume == pytest.approx(4.0 * (9.0 - 1.0))
    text = (tmp_path / "ring.obj").read_text()
    upright = [f"v {r.split()[1]} 0.5 {r.split()[2]}" if r.startswith("v") else r for r in text.splitlines()]
    (tmp_path / "upright.obj").write_text("\n".join(upright))
    with pytest.raises(ValueError, match="is not flat.*turn it"):
        read_cage(tmp_path / "upright.obj")


def test_cage_and_mesh_in_one_file(tmp_path):
    """Of two objects of which one is named a cage, each reader takes its own; a name takes any."""
    small = 0.5 * BOX + 0.2
    rows = [
        "o body",
        *(f"v {x} {y} {z}" for x, y, z in small),
        *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in TRIANGLES),
    ]
    rows += ["o BodyCage", *(f"v {x} {y} {z}" for x, y, z in BOX)]
    rows += ["f " + " ".join(str(v + 9) for v in face) for face in QUADS]
    (tmp_path / "both.obj").write_text("\n".join(rows))
    cage, mesh = read_cage(tmp_path / "both.obj"), read_mesh(tmp_path / "both.obj")
    assert (cage.volume, cage.face_count) == (pytest.approx(6.0), 6)
    assert (mesh.volume, mesh.point_count) == (pytest.approx(6.0 / 8.0), 8)
    assert cage.contains(mesh.points).all()
    assert read_mesh(tmp_path / "both.obj", name="BodyCage").volume == pytest.approx(6.0)


def test_bent_quads_are_repaired_while_reading(tmp_path):
    """Options go on to the cage."""
    bent = BOX.copy()
    bent[7] += 0.4
    rows = [*(f"v {x} {y} {z}" for x, y, z in bent), *("f " + " ".join(str(v + 1) for v in f) for f in QUADS)]
    (tmp_path / "bent.obj").write_text("\n".join(rows))
    with pytest.raises(ValueError, match="repair=True"):
        read_cage(tmp_path / "bent.obj")
    assert read_cage(tmp_path / "bent.obj", repair=True).face_count == 9
