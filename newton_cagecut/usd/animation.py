# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Animations whose topology changes: time-sampled meshes that are valid at every sample."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from typing import Any, Literal

import numpy as np
from pxr import UsdGeom

from ..geometry import as_finite, as_points, as_sequence, shown
from .body_frame import BodyFrame
from .body_prims import BodyOptions, BodyPrims
from .layers import (
    checked_name,
    checked_path,
    color,
    define_mesh,
    export_stage,
    flat_faces,
    free_name,
    new_file_stage,
    save_stage,
    write_arrays,
)
from .materials import bind_material
from .mesh_data import check_mesh
from .scene_frame import SceneFrame, SceneSource
from .scene_prims import RigidPrims, add_lights, frame_camera, place_camera

_CAMERA = "/World/camera"
_LOOK = ("skin_color", "cap_color", "skin_texture", "cap_texture")
_FLUSHED = 10  # frames between two times that the file is written


class AnimationWriter:
    """Writes bodies frame by frame to a USD file.

    Each body is ``/World/<name>`` with the meshes ``skin`` and ``caps`` and the guide ``cage``, a mesh or, of a plane
    body, curves. Points, normals and extents have a sample in every frame, the topology where it changes, with texture
    coordinates ``st`` of the corners. What is written is in the file after ten frames at most, so that a crash leaves a
    file that opens; files in text are written anew each time, and so less and less often. As a context manager it
    closes the file on the way out, after an error too, with the frames so far.

    Args:
        path: A file that ends in .usd, .usda or .usdc; its folder exists.
        fps: Frames a second of the stage.
        up_axis: ``"Y"`` or ``"Z"``; the points are written as they are.
        meters_per_unit: Unit of the stage [m].
        normals: Whether to write normals of the vertices: ``"compact"`` as numbers of a table of directions, within a
            degree; True in full, as many bytes as the points; or False. With normals the caps have vertices of their
            own for each side of a cut, so that they have sharp edges.
        velocities: Whether to write velocities of bodies that have them, for motion blur: ``"changes"`` in frames
            beside a change of topology, where renderers cannot take it from two samples; True in all; or False.
        separate_caps: Whether skin and caps are two meshes. False: they are one, ``surface``, with the subset ``cap``,
            whose samples not all programs follow.

    Raises:
        FileNotFoundError: The folder does not exist.
        ValueError: An argument is none of those named above.
    """

    def __init__(
        self,
        path: str | PathLike,
        *,
        fps: float = 60.0,
        up_axis: str = "Z",
        meters_per_unit: float = 1.0,
        normals: bool | Literal["compact"] = "compact",
        velocities: bool | Literal["changes"] = "changes",
        separate_caps: bool = True,
    ):
        fps = as_finite(fps, "fps")
        if fps <= 0.0:
            raise ValueError(f"fps must be positive, got {fps}")
        for name, value, word in (("normals", normals, "compact"), ("velocities", velocities, "changes")):
            if not (isinstance(value, bool) or (isinstance(value, str) and value == word)):
                raise ValueError(f'{name} must be True, False or "{word}", got {shown(value)}')
        self.path = checked_path(path)
        self.stage = new_file_stage(self.path, up_axis, meters_per_unit)
        self.stage.SetTimeCodesPerSecond(fps)
        self.stage.SetFramesPerSecond(fps)
        self.stage.SetStartTimeCode(0.0)
        self.stage.SetEndTimeCode(0.0)
        self.frame: float | None = None
        self._scale = 1.0 / meters_per_unit
        self._options = BodyOptions(normals, velocities, separate_caps)
        self._bodies: dict[str, BodyPrims] = {}
        self._names: dict[str, str] = {}
        self._looks: dict[str, dict[str, Any]] = {}
        self._rigid: RigidPrims | None = None
        self._box: np.ndarray | None = None
        self._has_own_camera = False
        self._frame_count = self._flushed_count = 0
        self._closed = False

    def __enter__(self) -> AnimationWriter:
        """Return the writer."""
        return self

    def __exit__(self, *_error) -> None:
        """Write the file, after an error too."""
        self.close()

    def add_static_mesh(
        self,
        name: str,
        points: np.ndarray,
        faces: np.ndarray | Sequence[Sequence[int]],
        *,
        mesh_color: tuple[float, float, float] = (0.5, 0.5, 0.5),
    ) -> None:
        """Write a mesh that does not move, once.

        Args:
            name: Name of the prim below ``/World``.
            points: Vertices [m], shape ``(n, 3)``.
            faces: Triangles, shape ``(m, 3)``, or polygons.
            mesh_color: Linear RGB.

        Raises:
            RuntimeError: The writer is closed.
            ValueError: The name is taken or no identifier, or the mesh is empty or invalid.
        """
        points = as_points(points, "points", rows="n", widths=(3,))
        counts, indices = flat_faces(faces)
        check_mesh(f"mesh {name}", points, counts, indices)
        mesh = define_mesh(self.stage, self._new_path(name))
        mesh.CreateDoubleSidedAttr(True)
        write_arrays(mesh, points * self._scale, counts, indices)
        mesh.CreateDisplayColorAttr([color(mesh_color)])
        bind_material(mesh.GetPrim(), mesh_color)

    def add_ground_plane(self, height: float = 0.0, *, size: float = 4.0, name: str = "ground") -> None:
        """Write a square that faces up.

        Args:
            height: Where it lies on the up axis [m].
            size: Length of its sides [m].
            name: Name of the prim below ``/World``.

        Raises:
            RuntimeError: The writer is closed.
            ValueError: The name is taken or no identifier.
        """
        half = 0.5 * size
        corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
        if UsdGeom.GetStageUpAxis(self.stage) == UsdGeom.Tokens.z:
            points = [(x, y, height) for x, y in corners]
        else:
            points = [(x, height, -y) for x, y in corners]
        self.add_static_mesh(name, np.array(points), [(0, 1, 2, 3)], mesh_color=(0.22, 0.24, 0.27))

    def set_camera(self, eye: Sequence[float], target: Sequence[float]) -> None:
        """Place the camera ``/World/camera``; without it, scenes get one that sees the bodies in all frames.

        Args:
            eye: Where it is [m].
            target: What it looks at [m].

        Raises:
            RuntimeError: The writer is closed.
            ValueError: Both are at one place, or not three numbers.
        """
        self._require_open()
        places = as_points([eye, target], "eye and target", rows="2", widths=(3,)) * self._scale
        distance = float(np.linalg.norm(places[1] - places[0]))
        if not (np.isfinite(distance) and distance > 0.0):
            raise ValueError(f"the camera must look from one place to another, got eye {eye} and target {target}")
        place_camera(self.stage, _CAMERA, places[0], places[1], distance)
        self._has_own_camera = True

    def set_look(self, label: str, **look: Any) -> None:
        """Say how a solver's body is to look, before its first frame.

        Args:
            label: Label of the body.
            look: ``skin_color``, ``cap_color``, ``skin_texture`` and ``cap_texture``, as in
                :class:`~newton_cagecut.usd.BodyFrame`.

        Raises:
            TypeError: There is no such look.
            ValueError: The body has been written already.
        """
        for name in look:
            if name not in _LOOK:
                raise TypeError(f"{name} is no look of a body; there are {', '.join(_LOOK)}")
        if label in self._names:
            raise ValueError(f"{label} has been written already; say how it looks before its first frame")
        self._looks[label] = {**self._looks.get(label, {}), **look}

    def write_frame(self, frame: float, *bodies: BodyFrame | SceneSource | Any) -> None:
        """Write one frame: of a solver in a state, ``write_frame(frame, solver, state)``, or of some bodies.

        Of a solver all is written: its bodies with their cages, the model's shapes, the poses of its rigid bodies, and
        once a camera and lights. Further bodies may follow the state.

        A body that is not among them stays as it was; one that comes later than the first frame is invisible before.
        Either all bodies are written or, after an error, none.

        Args:
            frame: Time code: the frame's number, larger than those before.
            bodies: A solver and a state of its model, or the bodies as they are now.

        Raises:
            RuntimeError: The writer is closed.
            TypeError: What is to be written is neither.
            ValueError: The frame is not after the last one, a body's arrays do not fit together, or the state missed an
                edit of a body.
        """
        self._require_open()
        as_finite(frame, "frame, the number of a frame,")
        if self.frame is not None and frame <= self.frame:
            raise ValueError(f"frame must be larger than the last one ({self.frame}), got {frame}")
        scene = self._scene_of(bodies)
        checked = tuple(body.checked() for body in as_sequence(scene.bodies, BodyFrame, "bodies"))
        names = [body.name for body in checked]
        if len(set(names)) < len(names):
            raise ValueError(f"each body comes once a frame, got {', '.join(names)}")
        new_paths = {body.name: self._new_path(body.name) for body in checked if body.name not in self._bodies}
        for body in checked:
            if body.name in new_paths:
                since = None if self.frame is None else frame
                options = {"frame": frame, "since": since, "options": self._options}
                self._bodies[body.name] = BodyPrims(self.stage, new_paths[body.name], body, **options)
            self._bodies[body.name].write(frame, body, self._scale)
        if bodies and not isinstance(bodies[0], BodyFrame):
            self._dress(frame, scene)
        if self.frame is None:
            self.stage.SetStartTimeCode(frame)
        self.stage.SetEndTimeCode(frame)
        self.frame = frame
        self._frame_count += 1
        self._flush()

    def save(self) -> None:
        """Write the file with the frames so far.

        Raises:
            OSError: The file cannot be written.
        """
        self._flushed_count = self._frame_count
        save_stage(self.stage, self.path)

    def close(self) -> None:
        """Write the file; nothing can be added after that.

        Raises:
            OSError: The file cannot be written.
        """
        if not self._closed:
            self._closed = True
            self._aim_camera()
            export_stage(self.stage, self.path)

    def _scene_of(self, bodies: tuple) -> SceneFrame:
        """Return what is to be written: bodies, or what a solver gives of a state and bodies behind it."""
        if all(isinstance(body, BodyFrame) for body in bodies):
            return SceneFrame(bodies=bodies)
        source, state, *further = bodies if len(bodies) > 1 else (bodies[0], None)
        if not hasattr(source, "scene_frame") or state is None or isinstance(state, BodyFrame):
            kinds = ", ".join(type(body).__name__ for body in bodies)
            raise TypeError(f"write_frame takes a frame with a solver and a state, or with BodyFrames; got {kinds}")
        scene = source.scene_frame(state)
        named = tuple(
            replace(body, name=self._name_of(body.name), **self._looks.get(body.name, {})) for body in scene.bodies
        )
        return replace(scene, bodies=(*named, *further))

    def _name_of(self, label: str) -> str:
        """Return the name of a solver's body as USD takes it, the same in all frames."""
        if label not in self._names:
            self._names[label] = self._free_name(label)
        return self._names[label]

    def _dress(self, frame: float, scene: SceneFrame) -> None:
        """Write what a scene has beside its cage bodies."""
        points = np.concatenate([body.points for body in scene.bodies]) * self._scale
        box = np.stack([points.min(axis=0), points.max(axis=0)])
        first = self._box is None
        self._box = box if first else np.stack([np.minimum(self._box[0], box[0]), np.maximum(self._box[1], box[1])])
        if first:
            diagonal = float(np.linalg.norm(box[1] - box[0])) / self._scale
            options = {"scale": self._scale, "diagonal": diagonal}
            self._rigid = RigidPrims(self.stage, lambda name: f"/World/{self._free_name(name)}", scene, **options)
            add_lights(self.stage)
            self._aim_camera()
        self._rigid.write(frame, scene.rigid_poses)

    def _aim_camera(self) -> None:
        """Make the camera see all that there has been, unless it was placed."""
        if self._box is not None and not self._has_own_camera:
            frame_camera(self.stage, _CAMERA, *self._box)

    def _flush(self) -> None:
        """Write the file if some frames are not in it."""
        in_text = self.path.endswith(".usda")
        wait = max(_FLUSHED, self._flushed_count // 2) if in_text else _FLUSHED
        if self._flushed_count == 0 or self._frame_count - self._flushed_count >= wait:
            self.save()

    def _free_name(self, label: str) -> str:
        """Return a name below ``/World`` that is not taken, as near to a label as USD takes it."""
        return free_name(
            label.strip("/") or "body",
            lambda name: name in ("materials", "lights", "camera") or bool(self.stage.GetPrimAtPath(f"/World/{name}")),
        )

    def _require_open(self) -> None:
        if self._closed:
            raise RuntimeError(f"{self.path} is closed: write before close() or inside the with block")

    def _new_path(self, name: str) -> str:
        """Return the path of a prim to be made below ``/World``."""
        self._require_open()
        path = f"/World/{checked_name(name)}"
        if name == "materials" or self.stage.GetPrimAtPath(path):
            raise ValueError(f"the name {name!r} is taken in {self.path}")
        return path
