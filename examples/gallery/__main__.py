# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Renders loops of the scenes to animated WebP files: ``python -m examples.gallery [NAME ...]``; all without names.

The pictures are drawn by the path tracer of the scenes, on the CPU or on CUDA; a scene takes about a minute.
"""

from __future__ import annotations

import sys
import time
from argparse import ArgumentParser
from dataclasses import dataclass
from pathlib import Path

import newton.examples
from PIL import Image

from ..__main__ import SCENES, scene_class
from ..base import Camera
from ..base.drawing import drawn_meshes
from ..base.picture import render_pixels

FOLDER = Path(__file__).parent
SIZE, RAY_COUNT, QUALITY = (384, 240), 3, 82
HOLD = 1500  # how long the last picture stays [ms]


@dataclass(frozen=True)
class Loop:
    """What a loop shows of a scene.

    Attributes:
        first: First frame.
        last: Last frame.
        every: Frames from picture to picture.
        options: Further options of the scene.
    """

    first: int = 0
    last: int = 100
    every: int = 4
    options: tuple[str, ...] = ("--walks", "32")


LOOPS = {
    "minimal": Loop(last=96, options=()),
    "keyframed": Loop(first=6, last=132),
    "own_mesh": Loop(first=9, last=96),
    "texture": Loop(first=6, last=110),
    "extrude": Loop(last=126),
    "starfish": Loop(first=21, last=165),
    "dude": Loop(last=96),
    "key": Loop(last=165),
    "octopus": Loop(first=9, last=129),
    "jelly": Loop(first=12, last=120),
    "sphere": Loop(first=9, last=120),
    "gingerbread": Loop(first=6, last=258, every=6),
    "bunny": Loop(first=12, last=108),
    "loaf": Loop(last=150),
    "surgery": Loop(last=120),
    "worlds": Loop(first=4, last=74, every=3, options=("--worlds", "36")),
}


def render_loop(name: str, loop: Loop) -> list[Image.Image]:
    """Run a scene and return the pictures of its loop.

    Args:
        name: The scene.
        loop: What to show of it.
    """
    kind = scene_class(name)
    sys.argv = [name, "--viewer", "null", "--quiet", "--num-frames", str(loop.last + 1), *loop.options]
    viewer, args = newton.examples.init(kind.create_parser() if hasattr(kind, "create_parser") else None)
    scene = kind(viewer, args)
    pictures = []
    for frame in range(loop.last + 1):
        if frame >= loop.first and (frame - loop.first) % loop.every == 0:
            pictures.append(Image.fromarray(draw(scene)))
        if frame < loop.last:
            scene.step()
    scene.test_final()
    return pictures


def draw(scene: object):
    """Return the pixels of a scene as it is; one without the base class is looked at from a little above."""
    shown = scene.scene_frame() if hasattr(scene, "scene_frame") else scene.solver.scene_frame(scene.state_0)
    camera = getattr(scene, "camera", Camera(eye=(0.6, -2.1, 1.25), target=(0.0, 0.0, 0.2)))
    meshes = drawn_meshes(shown, cages=getattr(scene, "shows_cages", False))
    return render_pixels(meshes, camera, SIZE, ground=getattr(scene, "ground", 0.0), ray_count=RAY_COUNT)


def main() -> None:
    """Render what the command line names."""
    parser = ArgumentParser(prog="python -m examples.gallery", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenes; all by default")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where to (default: the gallery)")
    options = parser.parse_args()
    for name in options.names or [name for name in SCENES if name in LOOPS]:
        start, loop = time.perf_counter(), LOOPS[name]
        pictures = render_loop(name, loop)
        path = options.folder / f"{name}.webp"
        durations = [1000 * loop.every // 30] * (len(pictures) - 1) + [HOLD]
        pictures[0].save(
            path, save_all=True, append_images=pictures[1:], duration=durations, loop=0, quality=QUALITY, method=4
        )
        print(
            f"{path.name}: {len(pictures)} pictures, {path.stat().st_size / 1e3:.0f} kB, "
            f"{time.perf_counter() - start:.0f} s",
            flush=True,
        )


if __name__ == "__main__":
    main()
