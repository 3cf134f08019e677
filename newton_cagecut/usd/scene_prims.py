# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Prims of what moves without bending, and of what makes a stage open well: camera and lights."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdLux

from .layers import color, define_mesh, free_name, vectors, write_arrays
from .materials import bind_material
from .scene_frame import SceneFrame, SceneShape

_FOCAL, _APERTURE = 35.0, (36.0, 20.25)  # [mm], as wide as a small picture, 16 : 9
_VIEW = (0.5, -1.0, 0.55)  # from the middle to the camera, where z is up
_MARGIN = 1.1
_ENDLESS = 30.0  # half width of a plane without an end, in diagonals of the bodies
_SKY, _SUN = 0.7, 1.0  # intensities


class RigidPrims:
    """Writes the poses of rigid bodies, with their shapes below them; shapes of the world are written once.

    Args:
        stage: The stage.
        new_path: Gives a name a path that is free.
        scene: The first frame.
        scale: Units of the stage in a metre.
        diagonal: That of the box around the bodies [m].
    """

    def __init__(
        self,
        stage: Usd.Stage,
        new_path: Callable[[str], str],
        scene: SceneFrame,
        *,
        scale: float,
        diagonal: float,
    ):
        self._stage, self._scale, self._ops = stage, scale, []
        for name in scene.rigid_names:
            xform = UsdGeom.Xform.Define(stage, new_path(name))
            self._ops.append((xform.AddTranslateOp(), xform.AddOrientOp(UsdGeom.XformOp.PrecisionFloat)))
        for shape in scene.shapes:
            body = self._ops[shape.body][0].GetAttr().GetPrim() if shape.body >= 0 else None
            path = new_path(shape.name) if body is None else _free_child(body, shape.name)
            self._add_shape(path, shape, _ENDLESS * diagonal if shape.endless else 1.0)

    def write(self, frame: float, poses: np.ndarray | None) -> None:
        """Write the poses of one frame, shape ``(k, 7)`` [m]."""
        for (translate, orient), pose in zip(self._ops, () if poses is None else poses.tolist()):
            translate.Set(Gf.Vec3d(*(self._scale * value for value in pose[:3])), frame)
            orient.Set(Gf.Quatf(pose[6], *pose[3:6]), frame)

    def _add_shape(self, path: str, shape: SceneShape, size: float) -> None:
        mesh = define_mesh(self._stage, path)
        mesh.CreateDoubleSidedAttr(True)
        middle = shape.points.mean(axis=0) if shape.endless else np.zeros(3)
        points = (middle + size * (shape.points - middle)) * self._scale
        write_arrays(mesh, points, np.full(len(shape.triangles), 3), shape.triangles.reshape(-1))
        if shape.normals is not None:
            mesh.CreateNormalsAttr(vectors(shape.normals))
            mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        mesh.CreateDisplayColorAttr([color(shape.color)])
        bind_material(mesh.GetPrim(), shape.color)


def add_lights(stage: Usd.Stage) -> None:
    """Add a sky and a sun from behind the camera's left shoulder, if the stage has no lights."""
    if any(prim.HasAPI(UsdLux.LightAPI) for prim in stage.Traverse()):
        return
    UsdGeom.Scope.Define(stage, "/World/lights")
    sky = UsdLux.DomeLight.Define(stage, "/World/lights/sky")
    sky.CreateIntensityAttr(_SKY)
    sun = UsdLux.DistantLight.Define(stage, "/World/lights/sun")
    sun.CreateIntensityAttr(_SUN)
    sun.CreateAngleAttr(3.0)
    sun.CreateNormalizeAttr(True)
    sun.AddTransformOp().Set(_looking((0.0, 0.0, 0.0), (0.6, 0.75, -1.0), stage))


def frame_camera(stage: Usd.Stage, path: str, low: np.ndarray, high: np.ndarray) -> None:
    """Put a camera where it sees a box whole; one that is there is moved.

    Args:
        stage: The stage.
        path: Path of the camera.
        low: The box's lowest corner, in units of the stage.
        high: Its highest corner.
    """
    middle = 0.5 * (low + high)
    half = 0.5 * (high - low) + 1e-3 * max(float(np.linalg.norm(high - low)), 1e-6)
    away = np.array(_VIEW) if UsdGeom.GetStageUpAxis(stage) == "Z" else np.array((_VIEW[0], _VIEW[2], -_VIEW[1]))
    right, up, away = _axes(away, stage)
    corners = half * np.array(list(product((-1.0, 1.0), repeat=3)))
    slopes = 0.5 * np.array(_APERTURE) / _FOCAL
    aside = np.abs(np.stack([corners @ right, corners @ up], axis=1)) / slopes
    distance = _MARGIN * float((corners @ away + aside.max(axis=1)).max())
    place_camera(stage, path, middle + distance * away, middle, distance)


def place_camera(stage: Usd.Stage, path: str, eye: np.ndarray, target: np.ndarray, distance: float) -> None:
    """Put a camera to a place; one that is there is moved.

    Args:
        stage: The stage.
        path: Path of the camera.
        eye: Its place, in units of the stage.
        target: What it looks at.
        distance: How far the scene is, for what it clips.
    """
    camera = UsdGeom.Camera.Define(stage, path)
    camera.CreateFocalLengthAttr(_FOCAL)
    camera.CreateHorizontalApertureAttr(_APERTURE[0])
    camera.CreateVerticalApertureAttr(_APERTURE[1])
    camera.CreateClippingRangeAttr(Gf.Vec2f(0.01 * distance, 100.0 * distance))
    camera.CreateFocusDistanceAttr(distance)
    ops = camera.GetOrderedXformOps()
    op = ops[0] if ops else camera.AddTransformOp()
    op.Set(_looking(eye, target, stage))


def _looking(eye: np.ndarray, target: np.ndarray, stage: Usd.Stage) -> Gf.Matrix4d:
    """Return the placement of what looks along its -z from one point to another."""
    rows = np.zeros((4, 4))
    rows[:3, :3], rows[3] = _axes(np.subtract(eye, target), stage), (*eye, 1.0)
    return Gf.Matrix4d(*rows.reshape(-1).tolist())


def _axes(back: np.ndarray, stage: Usd.Stage) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return right, up and back of what looks along its -z; straight up or down, right is x."""
    up = (0.0, 0.0, 1.0) if UsdGeom.GetStageUpAxis(stage) == "Z" else (0.0, 1.0, 0.0)
    back = np.asarray(back) / np.linalg.norm(back)
    right = np.cross(up, back)
    right = right / np.linalg.norm(right) if np.linalg.norm(right) > 1e-9 else np.array([1.0, 0.0, 0.0])
    return right, np.cross(back, right), back


def _free_child(parent: Usd.Prim, name: str) -> str:
    """Return the path of a child that is not there yet."""
    taken = {child.GetName() for child in parent.GetChildren()}
    free = free_name(name.strip("/").split("/")[-1], taken.__contains__)
    return str(parent.GetPath().AppendChild(free))
