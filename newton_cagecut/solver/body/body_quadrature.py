# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The quadrature points of a body that falls into pieces.

Each piece has the mass, the centre of mass and, unless its points are few, the inertia that its shape says. It has
enough points of its own to be a solid: spare points, reserved with the others and without volume until then, go to
pieces that were cut off between the points.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...cage import Cage
from ...elastic import exact_volumes, sample_quadrature

SPARE_COUNT = 64
"""Spare points that a body which can be cut reserves."""

_FEWEST = 8
"""Points that a piece should have, of which four, in 2D three, are the least that hold it together."""

_CANDIDATE_COUNT = 4096

DistanceToWalls = Callable[[np.ndarray], np.ndarray]
"""Distances of points, shape (n, dimension), to the nearest wall, shape (n,) [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyQuadrature:
    """Quadrature points and volumes in a cage's rest frame; immutable.

    Args:
        points: The points, spare ones at the end, shape (point_count, dimension) [m].
        volumes: Their volumes, shape (point_count,) [m^3].
        shares: How volumes are shared within a piece, 0 for spare points not in use, shape (point_count,).
        used_count: Number of points that are not spare ones, or no longer.
        thickness: Thickness of a plane body, 1 of a solid one [m].
        generator: Where spare points' places are drawn from.
    """

    points: np.ndarray
    volumes: np.ndarray
    shares: np.ndarray
    used_count: int
    thickness: float
    generator: np.random.Generator

    @classmethod
    def sampled(cls, cage: Cage, count: int, *, spare_count: int, seed: int, thickness: float | None) -> BodyQuadrature:
        """Sample a cage.

        Args:
            cage: The cage.
            count: Wanted number of points.
            spare_count: Points to keep for later pieces.
            seed: Seed of the sample.
            thickness: Thickness of a plane body [m]; None for a solid one.
        """
        sampled, volumes = sample_quadrature(cage, count, seed=seed)
        shares = np.concatenate([volumes, np.zeros(spare_count)])
        thickness = 1.0 if thickness is None else thickness
        quadrature = cls(
            points=np.concatenate([sampled, np.repeat(sampled[:1], spare_count, axis=0)]),
            volumes=thickness * shares,
            shares=shares,
            used_count=len(sampled),
            thickness=thickness,
            generator=np.random.default_rng(seed),
        )
        if cage.piece_count == 1:
            return quadrature
        piece = quadrature._piece_of_points(cage)
        for index in range(cage.piece_count):
            own = np.flatnonzero(piece == index)
            if len(own):
                quadrature.volumes[own] = thickness * _piece_volumes(cage, index, sampled[own], volumes[own])
        return quadrature

    def distributed(self, cage: Cage, distance_to_walls: DistanceToWalls) -> BodyQuadrature:
        """The same points, with enough of them and its own volume in every piece of a cage.

        Args:
            cage: The cage as it is now.
            distance_to_walls: Distances in that cage.
        """
        generator = copy.deepcopy(self.generator)
        points, shares, volumes = self.points.copy(), self.shares.copy(), self.volumes.copy()
        used = self.used_count
        piece = self._piece_of_points(cage)
        for index in range(cage.piece_count):
            own = np.flatnonzero(piece == index)
            if len(own) < _FEWEST:
                wanted = min(_FEWEST - len(own), len(points) - used)
                placed = _places(cage, index, wanted, distance_to_walls, generator)
                fresh = np.arange(used, used + len(placed))
                points[fresh], used = placed, used + len(placed)
                own = np.concatenate([own, fresh])
                shares[own] = 1.0
            if len(own):
                volumes[own] = self.thickness * _piece_volumes(cage, index, points[own], shares[own])
        return replace(self, points=points, volumes=volumes, shares=shares, used_count=used, generator=generator)

    def _piece_of_points(self, cage: Cage) -> np.ndarray:
        """Piece of each point in use, -1 of the others, shape (point_count,)."""
        piece = cage.piece_of(self.points)
        piece[self.used_count :] = -1
        return piece


def _piece_volumes(cage: Cage, piece: int, points: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Volumes, in 2D areas, of the points of a piece."""
    boundary = cage.vertices[cage.simplices[cage.face_piece[cage.simplex_face] == piece]]
    return exact_volumes(points, shares, boundary)


def _places(
    cage: Cage, piece: int, count: int, distance_to_walls: DistanceToWalls, generator: np.random.Generator
) -> np.ndarray:
    """Places in a piece, away from its faces and from each other, at most ``count``, shape (n, dimension)."""
    corners = cage.vertices[cage.vertex_piece == piece]
    low, high = corners.min(axis=0), corners.max(axis=0)
    candidates = low + (high - low) * generator.random((_CANDIDATE_COUNT, len(low)))
    candidates = candidates[cage.piece_of(candidates) == piece]
    if count <= 0 or not len(candidates):
        return np.zeros((0, cage.dimension))
    depth = distance_to_walls(candidates)
    return _spread(candidates[depth >= 0.4 * depth.max()], count)


def _spread(candidates: np.ndarray, count: int) -> np.ndarray:
    """Choose candidates one by one, each the farthest from those before."""
    chosen = [0]
    distance = np.linalg.norm(candidates - candidates[0], axis=1)
    while len(chosen) < min(count, len(candidates)):
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(candidates - candidates[chosen[-1]], axis=1))
    return candidates[chosen]
