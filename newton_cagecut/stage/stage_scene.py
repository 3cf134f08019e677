# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a stage added to a builder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..section import Blade


@dataclass(frozen=True, kw_only=True, eq=False)
class StageBlade:
    """A blade of a stage, with the track of its depth.

    Args:
        path: Path of its prim.
        body: Index of the body that it cuts.
        blade: The blade, in the rest frame of that body.
        times: Times of the track from the start of the stage, ascending, shape (n,) [s].
        depths: Depths at these times, from where the blade first touches, shape (n,) [m].
    """

    path: str
    body: int
    blade: Blade
    times: np.ndarray
    depths: np.ndarray

    def depth_at(self, seconds: float) -> float:
        """Depth at a time [m]: linear between the track's times, never less than before."""
        return float(np.interp(seconds, self.times, np.maximum.accumulate(self.depths)))


@dataclass(frozen=True, kw_only=True)
class StageScene:
    """What ``add_usd`` found in a stage.

    Args:
        bodies: Index of each body by the path of its prim.
        blades: The blades.
        fps: Frames a second.
        frame_count: Frames from the start to the end of the stage.
    """

    bodies: dict[str, int]
    blades: tuple[StageBlade, ...]
    fps: float
    frame_count: int
