# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A scene in the form of Newton's examples: its command line, viewer, recording and end."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from argparse import ArgumentParser, Namespace

import newton
import newton.examples
import numpy as np
import warp as wp

from newton_cagecut.usd import SceneFrame

from .options import CPU_WALKS, add_options
from .picture import Camera
from .progress import frame_bar
from .recording import Recording

_WHAT_NEXT = """
Open {picture} for a look, and {usd} in usdview, Blender or any other viewer of USD for the animation.
Next, in the environment that make has made (source .venv/bin/activate):
  python -m examples                      lists the scenes
  python -m examples texture --viewer gl  shows one in a window; --viewer viser in a browser
README.md has a body that is cut in 25 lines, to start from."""
_NO_DISPLAY = ("NoSuchDisplayException", "NoSuchConfigException", "NoSuchScreenModeException")


class Scene(ABC):
    """What all scenes have in common: a scene says what is in it and what happens, this does the rest.

    Args:
        viewer: One of Newton's viewers.
        args: Options, those of ``create_parser()``.
    """

    name: str
    fps = 30
    frame_count: int
    camera: Camera
    shows_cages = False
    ground = 0.0  # height of the ground in pictures [m]

    def __init__(self, viewer: newton.viewer.ViewerBase, args: Namespace):
        self.viewer, self.args = viewer, args
        self.walks = CPU_WALKS if args.walks is None and not wp.get_device().is_cuda else args.walks
        self.frame = 0
        self.recording = Recording(self, usd=args.usd, picture=args.picture, picture_frame=args.picture_frame)
        self.build()
        unwatched = args.headless or args.viewer in ("null", "usd")
        self._bar = frame_bar(args.num_frames) if unwatched else None
        self._aim_viewer()

    @property
    def time(self) -> float:
        """Time at the end of the last frame [s]."""
        return self.frame / self.fps

    @abstractmethod
    def build(self) -> None:
        """Make what is in the scene."""

    @abstractmethod
    def advance(self) -> None:
        """Advance the scene by a frame."""

    @abstractmethod
    def show(self) -> None:
        """Log the scene to the viewer."""

    @abstractmethod
    def scene_frame(self) -> SceneFrame:
        """Return what the scene looks like now, in its colours."""

    @abstractmethod
    def test_final(self) -> None:
        """Check the success criteria."""

    def step(self) -> None:
        """Advance the scene by a frame, and count it."""
        self.advance()
        self.frame += 1

    def render(self) -> None:
        """Show the frame, and record it."""
        self.viewer.begin_frame(self.time)
        self.show()
        self.viewer.end_frame()
        self.recording.add_frame(self.frame)
        if self._bar is not None:
            self._bar.update()

    def close(self) -> None:
        """Write the files; also after an error, with what there is."""
        if self._bar is not None:
            self._bar.close()
        self.recording.close()

    @classmethod
    def create_parser(cls) -> ArgumentParser:
        """Return the parser of the scene's options: Newton's and a few more."""
        parser = newton.examples.create_parser()
        parser.prog = f"python -m examples {cls.name}"
        parser.description = sys.modules[cls.__module__].__doc__
        parser.set_defaults(num_frames=cls.frame_count)
        add_options(parser, cls.name)
        return parser

    @classmethod
    def main(cls) -> Scene:
        """Run the scene with the options of the command line, and return it as it is at the end."""
        try:
            viewer, args = newton.examples.init(cls.create_parser())
        except Exception as error:
            if type(error).__name__ not in _NO_DISPLAY:  # classes of pyglet, which other viewers do without
                raise
            raise SystemExit(
                f"{cls.name}: a window needs a display, and there is none ({error}); --headless draws without one, "
                "--viewer null shows nothing, and --usd and --picture write files"
            ) from None
        scene = cls(viewer, args)
        try:
            newton.examples.run(scene, args)
        finally:
            scene.close()
        if args.demo:
            print(_WHAT_NEXT.format(picture=args.picture, usd=args.usd))
        return scene

    def _aim_viewer(self) -> None:
        """Point an interactive viewer's camera to where the picture is taken from."""
        ahead = np.subtract(self.camera.target, self.camera.eye)
        yaw = np.degrees(np.arctan2(ahead[1], ahead[0]))
        pitch = np.degrees(np.arctan2(ahead[2], np.hypot(ahead[0], ahead[1])))
        self.viewer.set_camera(wp.vec3(*map(float, self.camera.eye)), float(pitch), float(yaw))


def require(true: bool, text: str) -> None:
    """Raise if something is not true that should be at the end of a scene."""
    if not true:
        raise ValueError(f"the scene's test failed: {text}")
