# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a scene leaves in files: an animation whose topology changes, and a picture."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from newton_cagecut.usd import AnimationWriter, SceneFrame, validate_animation

from .drawing import drawn_meshes
from .picture import render_png

if TYPE_CHECKING:
    from .scene import Scene

PICTURE_SIZE = (1120, 630)


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

    def __init__(self, scene: Scene, *, usd: str | None, picture: str | None, picture_frame: int | None):
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
            self._writer.write_frame(frame, self, self._scene)
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

    def scene_frame(self, scene: Scene) -> SceneFrame:
        """Return what a scene looks like: what the writer asks for.

        Args:
            scene: The scene.
        """
        return scene.scene_frame()

    def _draw(self) -> None:
        scene = self._scene
        meshes = drawn_meshes(scene.scene_frame(), cages=scene.shows_cages)
        render_png(self._picture, meshes, scene.camera, PICTURE_SIZE, ground=scene.ground, ray_count=6)
        self._drawn = True
        print(f"{self._picture}: {_megabytes(self._picture)}, frame {scene.frame}")


def _megabytes(path: str | os.PathLike) -> str:
    return f"{os.path.getsize(path) / 1e6:.1f} MB"
