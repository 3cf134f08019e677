# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Whole scenes in USD: a solver's bodies, the model's shapes, rigid bodies, camera and lights."""

from __future__ import annotations

import subprocess
import sys

import newton
import numpy as np
import pytest
import warp as wp
from pxr import Gf, Usd, UsdGeom, UsdLux, UsdShade

import newton_cagecut as cagecut
from newton_cagecut.__main__ import main
from newton_cagecut.usd import AnimationWriter, BodyFrame, validate_animation
from solver_scenes import ball, make_solver, run, slanted_blade


def scene_builder() -> newton.ModelBuilder:
    """A ground, a stand, and a rigid body of two shapes that are seen and one that is not."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
    builder.add_ground_plane()
    builder.add_shape_cylinder(-1, xform=wp.transform((2.0, 0.0, 0.25)), radius=0.1, half_height=0.25, label="stand")
    pose = wp.transform((1.0, 2.0, 3.0), wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), 0.5 * np.pi))
    rigid = builder.add_body(xform=pose, label="world/rod no. 1")
    builder.add_shape_box(rigid, hx=0.3, hy=0.05, hz=0.02)
    builder.add_shape_sphere(rigid, xform=wp.transform((0.3, 0.0, 0.0)), radius=0.1)
    hidden = newton.ModelBuilder.ShapeConfig(is_visible=False)
    builder.add_shape_sphere(rigid, radius=0.5, cfg=hidden, label="unseen")
    return builder


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A stage of six frames of a ball that falls and is cut, and the solver with its last state."""
    path = tmp_path_factory.mktemp("scene") / "scene.usdc"
    points = ball().points
    surface = cagecut.Surface(points, ball().triangles, uvs=points[:, :2])
    pose = wp.transform((0.0, 0.0, 1.0))
    _, solver, *states = make_solver(
        builder=scene_builder(), gravity=-9.81, surface=surface, xform=pose, label="soft ball"
    )
    cut = solver.begin_cut(0, slanted_blade())
    with AnimationWriter(path, fps=30.0, meters_per_unit=0.01) as writer:
        for frame in range(6):
            if frame >= 2:
                solver.advance_cut(cut, 0.2, states=states)
            states = run(solver, states, 1)
            writer.write_frame(frame, solver, states[0])
    return Usd.Stage.Open(str(path)), solver, states[0]


def names_below(stage: Usd.Stage, path: str) -> list[str]:
    """Names of the prims below a path."""
    return [prim.GetName() for prim in stage.GetPrimAtPath(path).GetChildren()]


def test_all_of_the_scene_is_there(recorded):
    """Bodies, ground, stand, the rod with its visible shapes, lights and a camera, under names that USD takes."""
    stage, _, _ = recorded
    assert validate_animation(stage) == []
    expected = {"soft_ball", "world_rod_no__1", "ground_plane", "stand", "camera", "lights", "materials"}
    assert set(names_below(stage, "/World")) == expected
    assert len(names_below(stage, "/World/world_rod_no__1")) == 2
    assert set(names_below(stage, "/World/soft_ball")) == {"skin", "caps", "cage"}
    assert sum(prim.HasAPI(UsdLux.LightAPI) for prim in stage.Traverse()) == 2


def test_skin_and_caps_have_materials_and_texture_coordinates(recorded):
    """Skin and caps are bound to two materials; both have face-varying st, the caps' in metres in their plane."""
    stage, solver, _ = recorded
    surface = solver.bodies[0].surface
    is_cap = surface.triangle_cap >= 0
    bound = set()
    for name, mask in (("skin", ~is_cap), ("caps", is_cap)):
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath(f"/World/soft_ball/{name}"))
        bound.add(UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()[0].GetPath())
        st = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
        assert st.GetInterpolation() == UsdGeom.Tokens.faceVarying
        expected = surface.corner_uvs(solver.bodies[0].cage.walls)[mask].reshape(-1, 2)
        np.testing.assert_allclose(np.array(st.ComputeFlattened(5.0)), expected, atol=1e-6)
    assert len(bound) == 2
    assert (
        st.GetTimeSamples()
        == UsdGeom.Mesh(stage.GetPrimAtPath("/World/soft_ball/caps")).GetFaceVertexCountsAttr().GetTimeSamples()
    )
    corners = surface.points[surface.triangles[is_cap]]
    flat = np.array(st.ComputeFlattened(5.0)).reshape(-1, 3, 2)
    sides = [np.linalg.norm(a - np.roll(a, 1, axis=1), axis=2) for a in (corners, flat)]
    np.testing.assert_allclose(sides[1], sides[0], atol=1e-5)


def test_velocities_stand_beside_changes_of_topology(recorded):
    """The skin has velocities from the frame before the first change on, in units of the stage, and none earlier."""
    stage, solver, state = recorded
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/soft_ball/skin"))
    attribute, changes = mesh.GetVelocitiesAttr(), mesh.GetFaceVertexCountsAttr().GetTimeSamples()
    assert 1.0 < changes[1] < 5.0
    assert [frame for frame in range(6) if attribute.Get(float(frame))] == list(range(int(changes[1]) - 1, 6))
    body = solver.bodies[0]
    vertices = state.particle_qd[body.vertices].numpy()[: body.cage.vertex_count]
    used = np.unique(body.surface.triangles[body.surface.triangle_cap < 0])
    expected = 100.0 * (body.surface_weights @ vertices)[used]
    np.testing.assert_allclose(np.array(attribute.Get(5.0)), expected, atol=1e-2)


def test_rigid_bodies_move_their_shapes(recorded):
    """A shape's point is where the body's pose puts it, in units of the stage."""
    stage, _, _ = recorded
    sphere = stage.GetPrimAtPath("/World/world_rod_no__1").GetChildren()[1]
    points = np.array(UsdGeom.Mesh(sphere).GetPointsAttr().Get())
    matrix = UsdGeom.Xformable(sphere).ComputeLocalToWorldTransform(3.0)
    placed = np.array([matrix.Transform(Gf.Vec3d(*point.tolist())) for point in points])
    np.testing.assert_allclose(0.5 * (placed.min(axis=0) + placed.max(axis=0)), [100.0, 230.0, 300.0], atol=1e-3)
    np.testing.assert_allclose(np.ptp(placed, axis=0), 20.0, atol=0.2)


def test_camera_sees_every_frame(recorded):
    """All points of the body in all frames are in the camera's picture, and the box around them fills half of it."""
    stage, _, _ = recorded
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/World/camera")).GetCamera(0.0)
    skin = UsdGeom.Mesh(stage.GetPrimAtPath("/World/soft_ball/skin")).GetPointsAttr()
    points = np.concatenate([np.array(skin.Get(float(frame))) for frame in range(6)])
    view = np.array(camera.frustum.ComputeViewMatrix() * camera.frustum.ComputeProjectionMatrix())
    clip = np.c_[points, np.ones(len(points))] @ view
    seen = clip[:, :2] / clip[:, 3:]
    assert np.abs(seen).max() < 1.0
    assert np.ptp(seen[:, 1]) > 1.0


def test_own_camera_stays(tmp_path):
    """A camera that was placed is kept, looks at its target, and y can be up."""
    frame = BodyFrame(name="body", points=np.eye(3), triangles=[[0, 1, 2]])
    with AnimationWriter(tmp_path / "own.usda", up_axis="Y") as writer:
        writer.set_camera((1.0, 2.0, 3.0), (1.0, 2.0, 0.0))
        writer.write_frame(0, frame)
        with pytest.raises(ValueError, match="from one place to another"):
            writer.set_camera((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))
    stage = Usd.Stage.Open(str(tmp_path / "own.usda"))
    matrix = UsdGeom.Camera(stage.GetPrimAtPath("/World/camera")).ComputeLocalToWorldTransform(0.0)
    np.testing.assert_allclose(matrix.TransformDir(Gf.Vec3d(0, 0, -1)), [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(matrix.TransformDir(Gf.Vec3d(0, 1, 0)), [0, 1, 0], atol=1e-12)


def test_look_of_a_body(tmp_path):
    """Colours and textures that were set for a label are those of its materials; what is no look is refused."""
    _, solver, state, _ = make_solver(label="ball")
    with AnimationWriter(tmp_path / "look.usda") as writer:
        writer.set_look("ball", skin_color=(0.1, 0.2, 0.3), skin_texture="./skin.png")
        with pytest.raises(TypeError, match="points is no look"):
            writer.set_look("ball", points=3)
        writer.write_frame(0, solver, state)
        with pytest.raises(ValueError, match="ball has been written already"):
            writer.set_look("ball", skin_color=(0.1, 0.2, 0.3))
    stage = Usd.Stage.Open(str(tmp_path / "look.usda"))
    material, _ = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath("/World/ball/skin")).ComputeBoundMaterial()
    diffuse = material.ComputeSurfaceSource()[0].GetInput("diffuseColor")
    assert diffuse.Get() == Gf.Vec3f(0.1, 0.2, 0.3)
    picture = UsdShade.Shader(diffuse.GetConnectedSources()[0][0].source.GetPrim())
    assert picture.GetInput("file").Get().path == "./skin.png"


@pytest.mark.parametrize("what", [(object(), object()), ("solver",), (BodyFrame(name="a", points=[], triangles=[]), 1)])
def test_other_things_are_refused(tmp_path, what):
    """What is neither a solver with a state nor bodies is named."""
    with AnimationWriter(tmp_path / "no.usda") as writer, pytest.raises(TypeError, match="a solver and a state"):
        writer.write_frame(0, *what)


KILLED = """
import os, signal, sys
import numpy as np
from newton_cagecut.usd import AnimationWriter, BodyFrame
writer = AnimationWriter(sys.argv[1])
for frame in range(1000):
    points = np.eye(3) + frame
    writer.write_frame(frame, BodyFrame(name="body", points=points, triangles=np.array([[0, 1, 2]])))
    if frame == int(sys.argv[2]):
        os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.parametrize(
    ("ending", "last", "least"), [("usdc", 0, 0), ("usdc", 57, 48), ("usd", 30, 21), ("usda", 57, 40)]
)
def test_killed_process_leaves_a_readable_file(tmp_path, ending, last, least):
    """A process that is killed has lost ten frames at most, in text a few more, and the file is valid."""
    path = tmp_path / f"killed.{ending}"
    done = subprocess.run([sys.executable, "-c", KILLED, str(path), str(last)], capture_output=True, text=True)
    assert done.returncode < 0, done.stderr
    stage = Usd.Stage.Open(str(path))
    assert validate_animation(stage) == []
    assert least <= stage.GetEndTimeCode() <= last
    points = UsdGeom.Mesh(stage.GetPrimAtPath("/World/body/skin")).GetPointsAttr()
    assert points.GetNumTimeSamples() == stage.GetEndTimeCode() + 1


def test_validate_tells_what_is_wrong(tmp_path, capsys):
    """The command exits with 0 for a valid file, and with 1 and a line for each problem, however often it comes."""
    path = tmp_path / "cut.usda"
    with AnimationWriter(path) as writer:
        for frame in range(3):
            writer.write_frame(frame, BodyFrame(name="body", points=np.eye(3) + frame, triangles=[[0, 1, 2]]))
    assert main(["validate", str(path)]) == 0
    assert f"{path}: valid at every sample from 0 to 2" in capsys.readouterr().out
    stage = Usd.Stage.Open(str(path))
    extent = UsdGeom.Mesh(stage.GetPrimAtPath("/World/body/skin")).GetExtentAttr()
    extent.Clear()
    extent.Set([(50, 50, 50), (60, 60, 60)])
    stage.GetRootLayer().Save()
    assert main(["validate", str(path)]) == 1
    out = capsys.readouterr().out
    assert "/World/body/skin at 0.0 and 4 other times: points leave the extent" in out
    assert len(out.splitlines()) == 2


def test_validate_refuses_what_is_no_usd(tmp_path, capsys):
    """A file that is missing or no USD is one line and exit status 1."""
    text = tmp_path / "text.usd"
    text.write_text("no stage")
    for path, message in ((text, "cannot be read as USD"), (tmp_path / "none.usd", "no such USD file")):
        assert main(["validate", str(path)]) == 1
        err = capsys.readouterr().err
        assert message in err
        assert len(err.splitlines()) == 1
