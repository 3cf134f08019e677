# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Draws the scenes of Table 1 with their cages and cuts: figure 11 of the paper.

``python -m benchmarks.pictures`` writes ``<scene>.png`` for each scene.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from benchmarks.progressive import add_scenes
from benchmarks.scenes import SCENES, BenchmarkScene
from examples.base.picture import Camera, cage_edges, render_png, tube_mesh
from newton_cagecut.report.paper.cutting import edits
from newton_cagecut.usd import read_mesh

_SKIN, _CAGE, _CUT = (0.55, 0.2, 0.06), (0.02, 0.02, 0.02), (0.05, 0.35, 0.6)
_DIRECTION = (-0.45, -1.0, 0.75)  # to the camera


def draw(scene: BenchmarkScene, path: Path, size: tuple[int, int] = (960, 720)) -> None:
    """Draw the mesh, the edges of the cage and where the blades go.

    Args:
        scene: The scene.
        path: The file.
        size: Width and height in pixels.
    """
    cage, mesh = scene.cage, read_mesh(scene.mesh_path)
    swept = np.concatenate([edit.swept_simplices for edit in edits(cage, scene.blades, 1.0)]).reshape(-1, 3)
    tubes = tube_mesh(cage.vertices, cage_edges(cage.faces), 0.002 * cage.diameter, _CAGE)
    cuts = (swept, np.arange(len(swept)).reshape(-1, 3), _CUT)
    camera = Camera.framing(cage.vertices, direction=_DIRECTION, aspect=size[0] / size[1])
    render_png(path, [(mesh.points, mesh.triangles, _SKIN), tubes, cuts], camera, size)


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the scenes of the command line.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add_scenes(parser)
    parser.add_argument("--folder", type=Path, default=Path(), help="where to (default: here)")
    options = parser.parse_args(arguments)
    for name in tqdm(options.scene, unit="scene"):
        draw(SCENES[name], options.folder / f"{name}.png")


if __name__ == "__main__":
    main()
