# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Animations in Blender; CAGECUT_BLENDER_PYTHON names a Python with the extra ``blender``, if it is another one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom

from newton_cagecut.cage import Cage, Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from newton_cagecut.usd import AnimationWriter, BodyFrame, validate_animation

pytestmark = pytest.mark.blender

QUADS = np.array([(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)])
DEPTHS = (None, None, 0.3, 0.7, 0.7)


def cut_box_frames() -> list[BodyFrame]:
    """Return frames of a box that moves, with texture coordinates, and is cut from the third one on."""
    points = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
    triangles = QUADS[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    cut = Cut(Cage(points, QUADS.tolist()), Blade((0.5, 0.0, -0.5), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    surface = Surface(points, triangles, uvs=points[:, :2] + 0.5 * points[:, 2:])
    surface_cut, frames = SurfaceCut(surface, cut.plane, cut.wall), []
    for number, depth in enumerate(DEPTHS):
        now = surface if depth is None else surface_cut.advance(cut.advance(to=depth).front).surface
        lip = np.where(now.point_key % 2 == 1, 0.1, -0.1) * (now.point_key >= 0)
        opened = now.points + np.stack([lip, 0.0 * lip, np.full(len(lip), 0.05 * number)], axis=1)
        frames.append(
            BodyFrame(
                name="box",
                points=opened,
                triangles=now.triangles,
                triangle_cap=now.triangle_cap,
                rest_points=now.points,
                velocities=np.tile([0.0, 0.0, 1.2], (len(opened), 1)),
                uvs=now.corner_uvs(cut.cage.walls),
            )
        )
    return frames


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """The stage of an animation, and the arrays that Blender has in each frame."""
    folder = tmp_path_factory.mktemp("blender")
    path, out = folder / "box.usdc", folder / "blender.npz"
    with AnimationWriter(path, fps=24.0) as writer:
        for number, frame in enumerate(cut_box_frames()):
            writer.write_frame(number, frame)
    assert validate_animation(path) == []
    python = os.environ.get("CAGECUT_BLENDER_PYTHON", sys.executable)
    command = [python, str(Path(__file__).parent / "blender_reader.py"), str(path), str(out), *map(str, range(5))]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, f"pip install 'newton_cagecut[blender]' gets Blender\n{run.stderr[-2000:]}"
    return Usd.Stage.Open(str(path)), np.load(out)


@pytest.mark.parametrize("frame", range(5))
@pytest.mark.parametrize("part", ["skin", "caps"])
def test_blender_has_each_frame(both, part, frame):
    """Points, triangles, texture coordinates, normals within a degree and the material are those of the file."""
    stage, blender = both
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(f"/World/box/{part}"))
    found = {key: blender[f"{frame}/{part}/{key}"] for key in ("points", "corners", "uvs", "normals", "materials")}
    points, corners = (np.array(a.Get(frame)) for a in (mesh.GetPointsAttr(), mesh.GetFaceVertexIndicesAttr()))
    assert (len(points) > 0) == (part == "skin" or frame >= 2)
    assert len(found["points"]) == len(points)
    assert list(found["materials"]) == [f"box_{part}"]
    np.testing.assert_array_equal(found["corners"], corners)
    if len(points):
        np.testing.assert_allclose(found["points"], points, atol=1e-6)
        primvars = UsdGeom.PrimvarsAPI(mesh)
        np.testing.assert_array_equal(found["uvs"], np.array(primvars.GetPrimvar("st").ComputeFlattened(frame)))
        normals = np.array(primvars.GetPrimvar("normals").ComputeFlattened(frame))[corners]
        assert np.einsum("ij,ij->i", found["normals"], normals).min() > np.cos(np.radians(1.0))


def test_blender_has_velocities_where_the_topology_changes(both):
    """The skin has a velocity in the frames beside a change."""
    _, blender = both
    for frame in (1, 2, 3):
        velocities = blender[f"{frame}/skin/velocities"]
        assert len(velocities) == len(blender[f"{frame}/skin/points"])
        np.testing.assert_allclose(velocities, np.tile([0.0, 0.0, 1.2], (len(velocities), 1)), atol=1e-6)


def test_blender_keeps_its_frame_rate(both):
    """Blender takes the range of the stage; its frames a second stay 24, as the guide says."""
    _, blender = both
    assert blender["fps"] == 24
    assert blender["range"].tolist() == [0, 4]
