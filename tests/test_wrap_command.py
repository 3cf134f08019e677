# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""``python -m newton_cagecut cage``: files of many formats in, a USD cage and a report out; errors are lines."""

from __future__ import annotations

import base64
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pytest
from pxr import Usd, UsdGeom

from newton_cagecut.__main__ import main
from newton_cagecut.cage import mesh_clearance
from newton_cagecut.usd import read_cage, read_surface, write_mesh
from newton_cagecut.wrap.any_mesh import read_any_mesh
from wrap_shapes import CUBE, CUBE_TRIANGLES, sheet

HOUSE = CUBE * [1.0, 2.0, 3.0]


@pytest.fixture
def house(tmp_path) -> Path:
    """A box of 1 x 2 x 3 m in a USD file in centimetres, its height along y."""
    path = tmp_path / "house.usda"
    write_mesh(path, HOUSE[:, [1, 2, 0]], CUBE_TRIANGLES, up_axis="Y", meters_per_unit=0.01)
    return path


def write_gltf(path: Path, points: np.ndarray, triangles: np.ndarray) -> None:
    """Write a mesh as glTF, moved by one along x by its node."""
    data = points.astype("<f4").tobytes() + triangles.astype("<u2").tobytes()
    views = [{"buffer": 0, "byteLength": 12 * len(points)}]
    views.append({"buffer": 0, "byteOffset": 12 * len(points), "byteLength": 6 * len(triangles)})
    bounds = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    accessors = [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", **bounds}]
    accessors.append({"bufferView": 1, "componentType": 5123, "count": triangles.size, "type": "SCALAR"})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    scene = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1.0, 0.0, 0.0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": views,
        "accessors": accessors,
    }
    path.write_text(json.dumps(scene))


def test_a_cage_is_written_and_reported(house, tmp_path, capsys):
    """The file holds a guide around the mesh, turned as asked, and the report has its counts."""
    output = tmp_path / "cage.usda"
    output.write_text("what was there before")
    assert main(["cage", str(house), "--faces", "8", "--offset", "0.02", "--up-axis", "Z", "-o", str(output)]) == 0
    cage, surface = read_cage(output), read_surface(house, up_axis="Z")
    np.testing.assert_allclose(np.ptp(surface.points, axis=0)[2], 3.0, rtol=1e-6)
    assert cage.contains(surface.points).all()
    clearance = mesh_clearance(cage, surface.points, surface.triangles)
    assert clearance >= 0.0199 * np.linalg.norm([1.0, 2.0, 3.0])
    stage = Usd.Stage.Open(str(output))
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    assert UsdGeom.Mesh(stage.GetPrimAtPath("/World/cage")).GetPurposeAttr().Get() == UsdGeom.Tokens.guide
    printed = capsys.readouterr().out
    assert f"{cage.face_count} faces, {cage.vertex_count} vertices" in printed
    assert f"{cage.volume / 6.0:.2f} times the mesh's" in printed
    assert f"{clearance:.4g} m at least" in printed


def test_an_open_mesh_is_said_to_be_open(tmp_path, capsys):
    """There is no volume to compare with."""
    write_mesh(tmp_path / "sheet.usda", *sheet())
    assert main(["cage", str(tmp_path / "sheet.usda"), "--faces", "8", "-o", str(tmp_path / "cage.usd")]) == 0
    assert "the mesh is open" in capsys.readouterr().out


@pytest.mark.parametrize("ending", ["obj", "stl", "ply", "off", "dae"])
def test_other_formats_are_read(tmp_path, ending):
    """A box that PyMeshLab wrote is read back, its points as they stand and +Z up unless another axis is named."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(HOUSE, CUBE_TRIANGLES))
    path = str(tmp_path / f"house.{ending}")
    meshes.save_current_mesh(path)
    mesh, named = read_any_mesh(path), read_any_mesh(path, up_axis="Y")
    assert (len(mesh.points), len(mesh.triangles), mesh.up_axis, named.up_axis) == (8, 12, "Z", "Y")
    np.testing.assert_allclose(mesh.points.max(axis=0), [1.0, 2.0, 3.0], rtol=1e-6)
    np.testing.assert_array_equal(mesh.points, named.points)


def test_gltf_has_its_nodes_applied_and_y_up(tmp_path):
    """The node's translation moves the points, and +Y becomes +Z where that is asked for."""
    path = tmp_path / "house.gltf"
    write_gltf(path, HOUSE, CUBE_TRIANGLES)
    mesh, turned = read_any_mesh(path), read_any_mesh(path, up_axis="Z")
    assert (mesh.up_axis, turned.up_axis) == ("Y", "Z")
    np.testing.assert_allclose(mesh.points.max(axis=0), [2.0, 2.0, 3.0], rtol=1e-6)
    np.testing.assert_allclose(turned.points.max(axis=0), [2.0, 0.0, 2.0], atol=1e-6)


def test_all_meshes_of_other_formats_are_read_as_one(tmp_path):
    """Two objects of an OBJ file, one with a quad, give three triangles."""
    path = tmp_path / "two.obj"
    path.write_text("o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 0 0 5\nv 1 0 5\nv 1 1 5\nv 0 1 5\nf 4 5 6 7\n")
    mesh = read_any_mesh(path)
    assert (len(mesh.points), len(mesh.triangles)) == (7, 3)


def test_one_of_several_meshes_is_chosen(tmp_path, capsys):
    """Without ``--prim`` the error lists them; with it, that one gets a cage; other formats have no prims."""
    path, output = tmp_path / "two.usda", tmp_path / "cage.usda"
    write_mesh(path, HOUSE, CUBE_TRIANGLES, name="house")
    stage = Usd.Stage.Open(str(path))
    UsdGeom.Mesh.Define(stage, "/World/other")
    stage.Save()
    assert main(["cage", str(path), "--faces", "4", "-o", str(output)]) == 1
    assert "--prim): /World/house, /World/other" in capsys.readouterr().err
    assert main(["cage", str(path), "--faces", "8", "--prim", "/World/house", "-o", str(output)]) == 0
    assert read_cage(output).face_count == 8
    assert main(["cage", str(tmp_path / "two.obj"), "--prim", "/World/house", "-o", str(output)]) == 1
    assert "is no USD file, so there is no prim" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "name", "text"),
    [
        (None, "none.usda", "no such USD file"),
        (None, "none.obj", "no such file"),
        ("hello", "bad.usda", "cannot be read as USD"),
        ("hello", "bad.obj", "cannot be read as a mesh"),
        ("ply\nformat", "bad.ply", "cannot be read as a mesh"),
        ("", "mesh.xyzzy", "Unknown format for load: xyzzy"),
        ("v 0 0 0\nv 1 0 0\n", "points.obj", "no triangles"),
        ("#usda 1.0\n", "empty.usda", "has no mesh"),
    ],
)
def test_unreadable_meshes_are_one_line(content, name, text, tmp_path, capsys):
    """The exit status is 1, the line says what is wrong, and what was at the output's place stays."""
    output = tmp_path / "cage.usda"
    output.write_text("before")
    if content is not None:
        (tmp_path / name).write_text(content)
    assert main(["cage", str(tmp_path / name), "-o", str(output)]) == 1
    error = capsys.readouterr().err
    assert text in error
    assert error.count("\n") == 1
    assert output.read_text() == "before"


def test_the_output_is_checked_before_anything_is_done(house, tmp_path, capsys):
    """A folder that is not there, and the mesh itself, are refused; the mesh stays as it was."""
    content = house.read_bytes()
    assert main(["cage", str(house), "-o", str(tmp_path / "nowhere" / "cage.usda")]) == 1
    assert "there is no folder" in capsys.readouterr().err
    assert main(["cage", str(house), "-o", str(house.parent / "." / house.name)]) == 1
    assert "is the mesh itself" in capsys.readouterr().err
    assert house.read_bytes() == content


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ([], "COMMAND"),
        (["cage", "mesh.usda"], "-o"),
        (["cage", "mesh.usda", "-o", "cage.obj"], "must end in .usd, .usda, .usdc"),
        (["cage", "mesh.usda", "-o", "cage.usda", "--faces", "3"], "between 4 and 500, got 3"),
        (["cage", "mesh.usda", "-o", "cage.usda", "--faces", "many"], "many"),
        (["cage", "mesh.usda", "-o", "cage.usda", "--offset", "0.7"], "between 0.001 and 0.25"),
        (["cage", "mesh.usda", "-o", "cage.usda", "--up-axis", "X"], "--up-axis"),
        (["carve"], "carve"),
    ],
)
def test_wrong_usage_exits_with_2(arguments, text, capsys):
    """The error stream says which argument is wrong."""
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2
    assert text in capsys.readouterr().err


def test_a_cage_too_far_away_for_32_bits_is_not_written(tmp_path, capsys):
    """A box of a metre in a file that moves it by 100 000 km would be off by metres."""
    path, output = tmp_path / "far.usda", tmp_path / "cage.usda"
    write_mesh(path, HOUSE, CUBE_TRIANGLES, name="house")
    stage = Usd.Stage.Open(str(path))
    UsdGeom.Xformable(stage.GetPrimAtPath("/World/house")).AddTranslateOp().Set((1e8, 0.0, 0.0))
    stage.Save()
    assert main(["cage", str(path), "--faces", "8", "-o", str(output)]) == 1
    assert "move the mesh nearer to the origin" in capsys.readouterr().err
    assert not output.exists()


def test_the_missing_extra_is_one_line(house, tmp_path, monkeypatch, capsys):
    """Without PyMeshLab the line says what to install."""
    monkeypatch.setitem(sys.modules, "pymeshlab", None)
    assert main(["cage", str(house), "-o", str(tmp_path / "cage.usda")]) == 1
    assert "pip install 'newton_cagecut[wrap]'" in capsys.readouterr().err


def test_help_needs_neither_newton_nor_the_extra():
    """The module runs from a shell, lists its commands and imports little."""
    code = "import sys, runpy; sys.argv = ['x', '--help']; sys.modules.update(newton=None, pymeshlab=None); "
    code += "runpy.run_module('newton_cagecut', run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "make a coarse cage around a mesh" in done.stdout
