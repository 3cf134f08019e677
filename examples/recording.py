# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a scene leaves in files: an animation whose topology changes, and a picture."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import newton
import numpy as np

from examples.picture import Mesh, render_png
from newton_cagecut.usd import AnimationWriter, BodyFrame, SceneFrame, validate_animation

if TYPE_CHECKING:
    from examples.scene import CutScene

PICTURE_SIZE = (1120, 630)
STATIC_COLOR = (0.30, 0.33, 0.37)  # linear RGB


class StaticMesh(NamedTuple):
    """A part of a scene that does not move.

    Args:
        points: Vertices [m], shape (n, 3).
        triangles: Triangles, shape (m, 3).
    """

    points: np.ndarray
    triangles: np.ndarray

    @staticmethod
    def of(mesh: newton.Mesh, place: Sequence[float]) -> StaticMesh:
        """Return a mesh of Newton's at a place.

        Args:
            mesh: The mesh.
            place: Where its origin is [m].
        """
        return StaticMesh(np.asarray(mesh.vertices) + place, np.asarray(mesh.indices).reshape(-1, 3))


class Recording:
    """Records a scene.

    Args:
        scene: The scene.
        usd: The USD file, or None for none.
        picture: The PNG file, or None for none.
        picture_frame: Frame of the picture, or None for the last one.

    Raises:
        FileNotFoundError: The folder of a file does not exist.
    """

    def __init__(self, scene: CutScene, *, usd: str | None, picture: str | None, picture_frame: int | None):
        if picture is not None and not Path(picture).absolute().parent.is_dir():
            raise FileNotFoundError(f"the folder of the picture {picture} does not exist")
        self._scene, self._picture = scene, picture
        self._picture_frame = picture_frame
        self._drawn = False
        self._writer = AnimationWriter(usd, fps=scene.fps) if usd else None
        if self._writer is not None:
            self._writer.set_camera(scene.camera.eye, scene.camera.target)

    def add_frame(self, frame: int) -> None:
        """Record the scene as it is.

        Args:
            frame: Number of the frame.
        """
        if self._writer is not None:
            self._writer.write_frame(frame, self, self._scene.state_0)
        if self._picture is not None and frame == self._picture_frame:
            self._draw()

    def close(self) -> None:
        """Write the files, check the USD file and say what was written."""
        if self._picture is not None and not self._drawn:
            self._draw()
        if self._writer is None or self._writer.frame is None:
            return
        self._writer.close()
        problems = validate_animation(self._writer.path)
        verdict = "valid at every sample" if not problems else f"{len(problems)} problems, the first: {problems[0]}"
        print(f"{self._writer.path}: {_megabytes(self._writer.path)}, {verdict}")

    def scene_frame(self, state: newton.State) -> SceneFrame:
        """Return the scene in a state, with paint as bodies of their own.

        Args:
            state: The state.
        """
        scene = self._scene
        whole = scene.solver.scene_frame(state)
        frames = []
        for body, frame in zip(scene.solver.bodies, whole.bodies):
            frame, paint = replace(frame, skin_color=scene.skin_color, cap_color=scene.cap_color), scene.painted(body)
            frames.append(_part(frame, ~paint))
            if paint.any():
                painted = {"name": f"{body.label}_paint", "skin_color": scene.paint_color, "cage_points": None}
                frames.append(replace(_part(frame, paint), **painted))
        return replace(whole, bodies=tuple(frames))

    def _draw(self) -> None:
        scene = self._scene
        meshes: list[Mesh] = [(mesh.points, mesh.triangles, STATIC_COLOR) for mesh in scene.static_meshes]
        for body in scene.solver.bodies:
            points, triangles = scene.solver.surface(scene.state_0, body.label)
            colors = np.tile(scene.skin_color, (len(triangles), 1))
            colors[body.surface.triangle_cap >= 0] = scene.cap_color
            paint = scene.painted(body)
            if paint.any():
                colors[paint] = scene.paint_color
            meshes.append((points, triangles, colors))
        render_png(self._picture, meshes, scene.camera, PICTURE_SIZE, ground=0.0, ray_count=6)
        self._drawn = True
        print(f"{self._picture}: {_megabytes(self._picture)}, frame {scene.frame}")


def _part(frame: BodyFrame, triangles: np.ndarray) -> BodyFrame:
    """Return a body with some of its triangles, given as a mask."""
    uvs = None if frame.uvs is None else frame.uvs[triangles]
    return replace(frame, triangles=frame.triangles[triangles], triangle_cap=frame.triangle_cap[triangles], uvs=uvs)


def _megabytes(path: str | os.PathLike) -> str:
    return f"{os.path.getsize(path) / 1e6:.1f} MB"
