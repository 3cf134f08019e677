# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Animations whose topology changes: time-sampled meshes that are valid at every sample."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

import numpy as np
from pxr import UsdGeom

from ..geometry import as_finite, as_flag, as_points, as_sequence
from .body_frame import BodyFrame
from .body_prims import BodyPrims
from .layers import (
    checked_name,
    checked_path,
    color,
    define_mesh,
    export_stage,
    flat_faces,
    new_stage,
    write_arrays,
)
from .materials import bind_material
from .mesh_data import check_mesh


class AnimationWriter:
    """Writes bodies frame by frame to a USD file.

    Each body is ``/World/<name>`` with the mesh ``surface``, its subset ``cap`` and the guide ``cage``, a mesh or, of a
    plane body, curves. Points, normals and extents have a sample in every frame, the topology where it changes. As a
    context manager it writes the file on the way out, after an error too, with the frames so far.

    Args:
        path: A file that ends in .usd, .usda or .usdc; its folder exists.
        fps: Frames a second of the stage.
        up_axis: ``"Y"`` or ``"Z"``; the points are written as they are.
        meters_per_unit: Unit of the stage [m].
        normals: Whether to write normals of the vertices, half of the file. The vertices of caps are then copied
            behind those of the body, for each side of a cut, so that the caps have sharp edges.

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
        normals: bool = True,
    ):
        fps = as_finite(fps, "fps")
        if fps <= 0.0:
            raise ValueError(f"fps must be positive, got {fps}")
        normals = as_flag(normals, "normals")
        self.path = checked_path(path)
        self.stage = new_stage(up_axis, meters_per_unit)
        self.stage.SetTimeCodesPerSecond(fps)
        self.stage.SetFramesPerSecond(fps)
        self.stage.SetStartTimeCode(0.0)
        self.stage.SetEndTimeCode(0.0)
        self.frame: float | None = None
        self._scale = 1.0 / meters_per_unit
        self._normals = normals
        self._bodies: dict[str, BodyPrims] = {}
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

    def write_frame(self, frame: float, *bodies: BodyFrame) -> None:
        """Write one frame of some bodies.

        A body that is not among them stays as it was; one that comes later than the first frame is invisible before.
        Either all bodies are written or, after an error, none.

        Args:
            frame: Time code: the frame's number, larger than those before.
            bodies: The bodies as they are now.

        Raises:
            RuntimeError: The writer is closed.
            ValueError: The frame is not after the last one, or a body's arrays do not fit together.
        """
        if self._closed:
            raise RuntimeError(f"{self.path} is closed: write before close() or inside the with block")
        frame = as_finite(frame, "frame, the number of a frame,")
        if self.frame is not None and frame <= self.frame:
            raise ValueError(f"frame must be larger than the last one ({self.frame}), got {frame}")
        bodies = tuple(body.checked() for body in as_sequence(bodies, BodyFrame, "bodies"))
        names = [body.name for body in bodies]
        if len(set(names)) < len(names):
            raise ValueError(f"each body comes once a frame, got {', '.join(names)}")
        new_paths = {body.name: self._new_path(body.name) for body in bodies if body.name not in self._bodies}
        for body in bodies:
            if body.name in new_paths:
                since = None if self.frame is None else frame
                options = {"since": since, "normals": self._normals}
                self._bodies[body.name] = BodyPrims(self.stage, new_paths[body.name], body, **options)
            self._bodies[body.name].write(frame, body, self._scale)
        if self.frame is None:
            self.stage.SetStartTimeCode(frame)
        self.stage.SetEndTimeCode(frame)
        self.frame = frame

    def save(self) -> None:
        """Write the file with the frames so far.

        Raises:
            OSError: The file cannot be written.
        """
        export_stage(self.stage, self.path)

    def close(self) -> None:
        """Write the file; nothing can be added after that.

        Raises:
            OSError: The file cannot be written.
        """
        if not self._closed:
            self._closed = True
            self.save()

    def _new_path(self, name: str) -> str:
        """Return the path of a prim to be made below ``/World``."""
        if self._closed:
            raise RuntimeError(f"{self.path} is closed: write before close() or inside the with block")
        path = f"/World/{checked_name(name)}"
        if name == "materials" or self.stage.GetPrimAtPath(path):
            raise ValueError(f"the name {name!r} is taken in {self.path}")
        return path
