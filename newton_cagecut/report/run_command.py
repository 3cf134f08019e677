# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The command ``python -m newton_cagecut run``: a stage in, its animation out."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import newton

    from ..stage import StageScene

DESCRIPTION = """\
Simulate the cage bodies of a stage, cut them by its blades along their tracks, and write
the animation.
"""
EPILOG = """\
example:
  python -m newton_cagecut run assets/stages/jelly_cut.usda -o cut.usda
"""
_STEPS = 2
"""Steps of a frame."""


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: The command's parser.
    """
    parser.add_argument("stage", metavar="STAGE", help="a USD file with cage bodies; see docs/usd.md")
    parser.add_argument("-o", "--out", metavar="OUT", required=True, help="the animation: a .usd, .usda or .usdc file")
    parser.add_argument("--frames", type=int, help="frames to simulate, by default those of the stage")
    parser.add_argument("--walks", type=int, help="walks a point, in the place of those that cages name")
    parser.add_argument("--device", help="device, such as cpu or cuda:0")
    parser.add_argument("--ground", type=float, metavar="HEIGHT", help="add a ground plane at this height [m]")


def run(options: Namespace) -> None:
    """Run the command.

    Args:
        options: The command's arguments.
    """
    import newton
    import warp as wp

    from ..stage import add_usd
    from ..usd import checked_path

    out = checked_path(options.out)
    if options.frames is not None and options.frames < 1:
        raise ValueError(f"--frames must be at least 1, got {options.frames}")
    with wp.ScopedDevice(options.device):
        builder = newton.ModelBuilder()
        scene = add_usd(builder, options.stage, walks=options.walks)
        if options.ground is not None:
            builder.add_ground_plane(height=options.ground)
        _simulate(builder.finalize(), scene, out, options.frames or scene.frame_count)
    print(f"{out}: {options.frames or scene.frame_count} frames")


def _simulate(model: newton.Model, scene: StageScene, out: str, frame_count: int) -> None:
    """Step and cut, frame by frame."""
    import newton
    from tqdm import tqdm

    from ..solver import SolverCageCut
    from ..usd import AnimationWriter

    solver, pipeline = SolverCageCut(model), newton.CollisionPipeline(model)
    states, contacts = [model.state(), model.state()], pipeline.contacts()
    cuts = [(track, solver.begin_cut(track.body, track.blade)) for track in scene.blades]
    dt = 1.0 / (scene.fps * _STEPS)
    with AnimationWriter(out, fps=scene.fps) as writer:
        for frame in tqdm(range(frame_count), desc="frames", unit="frame", disable=None):
            for track, cut in cuts:
                depth = track.depth_at(frame / scene.fps)
                if depth > cut.depth and not cut.complete:
                    solver.advance_cut(cut, to=depth, states=states)
            writer.write_frame(frame, solver, states[0])
            for _ in range(_STEPS):
                states[0].clear_forces()
                pipeline.collide(states[0], contacts)
                solver.step(states[0], states[1], None, contacts, dt)
                states.reverse()
