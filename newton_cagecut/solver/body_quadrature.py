# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The quadrature points of a body that falls into pieces.

Each piece weighs what its volume says, and has enough points of its own to be a solid: spare points, reserved with the
others and without volume until then, go to pieces that were cut off between the points.
"""

from __future__ import annotations

import numpy as np

from ..cage import Cage
from ..elastic import sample_quadrature
from ..harmonic import HarmonicCoordinates

SPARE_COUNT = 64
"""Spare points that a body which can be cut reserves."""

_FEWEST = 8
"""Points that a piece should have, of which four, in 2D three, are the least that hold it together."""

_CANDIDATE_COUNT = 4096


class Quadrature:
    """Quadrature points and volumes [m^3] in a cage's rest frame.

    Args:
        cage: The cage before any cut.
        count: Wanted number of points.
        spare_count: Points to keep for later pieces.
        seed: Seed of the sample.
        thickness: Thickness of a plane body [m]; None for a solid one.
    """

    def __init__(self, cage: Cage, count: int, *, spare_count: int, seed: int, thickness: float | None) -> None:
        sampled, volumes = sample_quadrature(cage, count, seed=seed)
        self._used = len(sampled)
        self._rng = np.random.default_rng(seed)
        self._thickness = 1.0 if thickness is None else thickness
        self._shares = np.concatenate([volumes, np.zeros(spare_count)])
        self.points = np.concatenate([sampled, np.repeat(sampled[:1], spare_count, axis=0)])
        self.volumes = self._thickness * self._shares

    def distribute(self, cage: Cage, coordinates: HarmonicCoordinates) -> None:
        """Give every piece of a cage enough points and its own volume.

        Args:
            cage: The cage as it is now.
            coordinates: Coordinates whose first points are these; spare points are moved in them.
        """
        piece = cage.piece_of(self.points)
        piece[self._used :] = -1
        for index, volume in enumerate(cage.piece_volumes):
            own = np.flatnonzero(piece == index)
            if len(own) < _FEWEST:
                own = np.concatenate([own, self._place(cage, index, _FEWEST - len(own), coordinates)])
                self._shares[own] = 1.0
            total = self._shares[own].sum()
            if total > 0.0:
                self.volumes[own] = self._shares[own] * (self._thickness * volume / total)

    def _place(self, cage: Cage, piece: int, count: int, coordinates: HarmonicCoordinates) -> np.ndarray:
        """Move spare points into a piece, away from its faces and from each other; returns their indices."""
        count = min(count, len(self.points) - self._used)
        corners = cage.vertices[cage.vertex_piece == piece]
        low, high = corners.min(axis=0), corners.max(axis=0)
        candidates = low + (high - low) * self._rng.random((_CANDIDATE_COUNT, len(low)))
        candidates = candidates[cage.piece_of(candidates) == piece]
        if count <= 0 or not len(candidates):
            return np.zeros(0, dtype=np.int64)
        depth = coordinates.domain.distance_to_walls(candidates)
        chosen = _spread(candidates[depth >= 0.4 * depth.max()], count)
        indices = np.arange(self._used, self._used + len(chosen))
        self._used += len(chosen)
        self.points[indices] = chosen
        coordinates.set_points(indices, chosen)
        return indices


def _spread(candidates: np.ndarray, count: int) -> np.ndarray:
    """Choose candidates one by one, each the farthest from those before."""
    chosen = [0]
    distance = np.linalg.norm(candidates - candidates[0], axis=1)
    while len(chosen) < min(count, len(candidates)):
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(candidates - candidates[chosen[-1]], axis=1))
    return candidates[chosen]
