# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Compiling and loading what coordinates launch, before the clock runs.

Kernels are compiled when they are first launched. So all that coordinates do, cuts included, is done once beforehand
for a few points, with a few walks each.
"""

from __future__ import annotations

import numpy as np

from ..cage import Cage, Cut
from ..section import Blade
from .coordinates import HarmonicCoordinates
from .point_change import PointChange

_POINT_COUNT = 8
_WALKS = 8
_DEPTHS = (0.3, 0.6, 1.1)
"""Parts of its length to which a blade is advanced."""


def warm_up_coordinates(
    cage: Cage, points: np.ndarray, *, gradients: bool = False, cuttable: bool = True, **options: object
) -> None:
    """Launch once everything that coordinates launch, until the cage is cut through.

    Args:
        cage: The cage; it stays as it is.
        points: Points in it [m], shape (n, dimension), of which a few are taken.
        gradients: Whether any point has gradients.
        cuttable: Whether the coordinates follow edits of the cage.
        options: Further keyword options of ``HarmonicCoordinates``.
    """
    points = np.asarray(points)[:: max(1, len(points) // _POINT_COUNT)][:_POINT_COUNT]
    count = len(points)
    options |= {"gradients": (np.arange(count) < max(1, count // 2)) & gradients, "cuttable": cuttable}
    coordinates = HarmonicCoordinates(cage, points, _WALKS, point_capacity=count + 1, **options)
    coordinates.domain.distance_to_walls(points)
    if not cuttable:
        return
    cut = Cut(cage, _middle_blade(cage))
    for number, part in enumerate(_DEPTHS):
        now = coordinates.cage
        corner = now.vertices[now.mesh.face_vertex[:1]]
        coordinates.boundary_weights(corner, np.asarray(now.face_key[:1]), walks=_WALKS)
        coordinates.weights_at(points[:1], walks=_WALKS)
        change = PointChange(np.array([0 if number else count]), points[:1])
        coordinates.update(cut.advance(to=part * cut.length), points=change)
    coordinates.recompute()


def _middle_blade(cage: Cage) -> Blade:
    """A blade across the longest side of a cage's bounding box, a little off its middle."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    axes = np.eye(cage.dimension)[np.argsort(high - low)]
    middle = low + 0.513 * (high - low)
    return Blade(middle, axes[0]) if cage.dimension == 2 else Blade(middle, axes[1], axes[0])
