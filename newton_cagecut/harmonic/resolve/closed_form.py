# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What walks say of a fit without tables: the fit is evaluated at every landing, which costs more than the walks.

For references, and to measure what tables leave out.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import warp as wp

from ..fit.boundary_fit import BoundaryFit
from ..launch import launch
from ..walks.random import make_direction
from ..walls.frame import UnitFrame

_SHORTEST = 1e-6
"""Least distance from the walls that gradients divide by: nearer points have none that anyone uses."""


@dataclass(frozen=True, eq=False)
class LandingResiduals:
    """Means of a fit's residuals over the landings of points, and their squared standard errors.

    Args:
        values: What corrects the weights, shape (n, vertex_count).
        slopes: What corrects the gradients [1/m], shape (n, vertex_count, dimension).
        squared_errors: Squared standard errors of ``values``.
        squared_slope_errors: The same of ``slopes``, summed over vertices and axes, shape (n,).
    """

    values: np.ndarray
    slopes: np.ndarray
    squared_errors: np.ndarray
    squared_slope_errors: np.ndarray


def landing_residuals(
    fit: BoundaryFit,
    frame: UnitFrame,
    landings: dict[str, np.ndarray],
    *,
    indices: np.ndarray,
    walks: int,
    seed: int,
    radius: np.ndarray,
) -> LandingResiduals:
    """Evaluate a fit's residuals where walks have landed.

    Args:
        fit: The fit.
        frame: The unit frame of the walks.
        landings: Landings of the walks of the points, "point" in the frame and "face", a row a walk.
        indices: Numbers of the points, all inside, that their walks' randomness is made of, shape (n,).
        walks: Walks a point, two or more.
        seed: Seed of the walks.
        radius: Distance of the points from the walls in the frame, shape (n,).
    """
    cage = fit.cage
    place = landings["point"][:, : cage.dimension].astype(np.float64) * frame.half_side + frame.center
    residual = fit.residuals_at(place, landings["face"])
    residual = residual.reshape(len(indices), walks, -1)
    values = residual.mean(axis=1)
    spread = residual - values[:, None]
    squared_errors = (spread**2).sum(axis=1) / (walks * (walks - 1))
    scale = cage.dimension / (np.maximum(radius, _SHORTEST) * frame.half_side)
    direction = _directions(indices, walks, seed, cage.dimension)
    slopes = np.einsum("iwv,iwd->ivd", spread, direction) / (walks - 1) * scale[:, None, None]
    return LandingResiduals(values, slopes, squared_errors, squared_errors.sum(axis=1) * scale**2)


@cache
def _direction_kernel(dimension: int) -> wp.Kernel:
    direction = make_direction(dimension)

    @wp.kernel(enable_backward=False, module="unique")
    def first_directions(
        offset: int, points: wp.array[wp.uint32], walks: int, seed: wp.uint32, out: wp.array2d[wp.vec3]
    ):
        i = offset + wp.tid()
        for walk in range(walks):
            out[i, walk] = direction(seed, points[i], wp.uint32(walk), wp.uint32(0))

    return first_directions


def _directions(indices: np.ndarray, walks: int, seed: int, dimension: int) -> np.ndarray:
    """First directions of walks, shape (n, walks, dimension)."""
    device = wp.get_device("cpu")
    out = wp.empty((len(indices), walks), dtype=wp.vec3, device=device)
    numbers = wp.array(indices.astype(np.uint32), dtype=wp.uint32, device=device)
    launch(_direction_kernel(dimension), len(indices), [numbers, walks, wp.uint32(seed), out], device=device)
    return out.numpy()[..., :dimension].astype(np.float64)
