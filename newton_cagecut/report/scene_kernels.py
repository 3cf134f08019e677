# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Compiling the kernels of scenes that are named on the command line."""

from __future__ import annotations

from collections.abc import Sequence

import newton
import numpy as np
import warp as wp

from ..cage import Cage
from ..solver import SolverCageCut, add_cage_body
from .machine import chosen_device
from .scenes.building import build_of, built
from .stability.shapes import bar, surface_in

_POINTS = {"walks": 16, "quadrature": 20, "contact_radius": 0.01}
"""Numbers that no kernel depends on, as small as they may be."""


def warm_up_scenes(scenes: Sequence[str], *, device: str | None = None) -> None:
    """Compile and load every kernel that scenes can need, with a progress bar, and print where they are.

    Args:
        scenes: Paths of scripts with ``build(builder)``, or names of examples; a body and a plane one without any.
        device: For which device.

    Raises:
        OSError: A script is not there.
        ValueError: There is no such scene or device, or it has no cage bodies.
    """
    with wp.ScopedDevice(chosen_device(device)):
        for build in [build_of(name) for name in scenes] or [_solid, _plane]:
            SolverCageCut(built(build).finalize()).warm_up()
    print(f"the kernels are in {wp.config.kernel_cache_dir}")


def _solid(builder: newton.ModelBuilder) -> None:
    cage = bar(1, (1.0, 0.2, 0.2)).cage()
    add_cage_body(builder, cage, surface_in(cage), **_POINTS)
    builder.add_ground_plane()


def _plane(builder: newton.ModelBuilder) -> None:
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    cage = Cage(corners, [(0, 1), (1, 2), (2, 3), (3, 0)])
    triangles = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
    add_cage_body(builder, cage, (0.5 + 0.9 * (corners - 0.5), triangles), thickness=0.1, **_POINTS)
    builder.add_ground_plane()
