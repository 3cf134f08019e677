# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Quadrature points: an even sample of a cage's inside, each with its share of the volume, in 2D the area.

The paper (section 6.1) takes Poisson-disk samples after Bridson 2007 and keeps gradients off the boundary. Here many
points inside the cage are thinned to the wanted number, so that arms and shells which fill little of their box cost no
more than their own points and are covered to their ends. The many points also measure each point's share, the part of
the cage nearest to it.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .dense import QuadratureCage, dense_inside, near_surface
from .thinning import thin
from .volumes import exact_volumes

_CELLS = 8  # of the dense sample for each quadrature point
_FEWEST_CELLS = 4096
_JITTER = 1e-4  # in mean spacings; no two distances are equal, so that rounding decides nothing


def sample_quadrature(
    cage: QuadratureCage, count: int, *, seed: int = 0, margin: float = 0.25
) -> tuple[np.ndarray, np.ndarray]:
    """Spread quadrature points over the inside of a cage.

    Args:
        cage: The cage.
        count: Wanted number of points; fewer only where the cage has no more places that keep the margin.
        seed: Seed of the sample.
        margin: Least distance of a point from the cage's faces, in units of the mean spacing
            (volume / count)^(1/dimension).

    Returns:
        Points, shape (point_count, dimension) [m], and their volumes, shape (point_count,) [m^3, in 2D m^2]. These sum
        to the cage's and integrate linear functions exactly, quadratic ones too unless the points are few.

    Raises:
        ValueError: If the count is less than 1, the margin is not in [0, 1), or no point keeps the margin.
    """
    if count < 1:
        raise ValueError(f"The quadrature point count is {count}; it must be at least 1.")
    if not 0.0 <= margin < 1.0:
        raise ValueError(f"The quadrature margin is {margin}; it must lie in [0, 1).")
    rng = np.random.default_rng(seed)
    inside = rng.permutation(dense_inside(cage, max(count * _CELLS, _FEWEST_CELLS), rng))
    spacing = (cage.volume / count) ** (1.0 / inside.shape[1])
    boundary = cage.vertices[cage.simplices]
    candidates = inside[~near_surface(inside, boundary, margin * spacing)]
    if not len(candidates):
        raise ValueError(
            f"No point of the cage is {margin * spacing:.6g} m away from its faces: it is too thin for {count} "
            f"quadrature points at margin {margin}. Raise the count or lower the margin."
        )
    scaled = (candidates - candidates[0]) / spacing
    points = candidates[thin(scaled + _JITTER * rng.random(scaled.shape), count)]
    shares = np.bincount(cKDTree(points).query(inside)[1], minlength=len(points))
    return points, exact_volumes(points, np.maximum(shares, 1), boundary)
