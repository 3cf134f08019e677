# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Where a cage's rest frame is in the world; a plane cage lies in the frame's plane z = 0."""

from __future__ import annotations

import numpy as np
import warp as wp
from scipy.spatial.transform import Rotation

from ...geometry import lifted

_ROUNDING = 1.0e-6
"""Entries of a rotation matrix that are zeros, rounded in float32: planes normal to an axis of the world stay so."""


_MOVED = 1.0e-4
"""Share of a cage's size that a particle may be off its place."""
_MOVED_WORLD = 1.0e-6
"""The same of the distance from the world's origin: rounding in float32."""


class RestFrame:
    """Rigid map from a cage's rest frame to the world.

    Args:
        rotation: Rotation to the world, shape (3, 3).
        center: A point in the rest frame [m], shape (3,).
        world_center: The same point in the world [m], shape (3,).
    """

    def __init__(self, rotation: np.ndarray, center: np.ndarray, world_center: np.ndarray) -> None:
        rotation = np.where(np.abs(rotation) < _ROUNDING, 0.0, rotation)
        self.rotation = rotation / np.linalg.norm(rotation, axis=0)
        self._center, self._world_center = center, world_center

    @classmethod
    def of_pose(cls, xform: wp.transform) -> RestFrame:
        """The frame that a pose puts in the world."""
        rotation = np.array(wp.quat_to_matrix(wp.transform_get_rotation(xform)), dtype=np.float64).reshape(3, 3)
        return cls(rotation, np.zeros(3), np.array(wp.transform_get_translation(xform), dtype=np.float64))

    @classmethod
    def of_particles(cls, vertices: np.ndarray, particles: np.ndarray, *, what: str = "the body") -> RestFrame:
        """The frame fitted to the particles that stand for a cage's vertices.

        Fitting makes it right however the body came into the model: by a pose, a world's offset or replication.

        Args:
            vertices: The vertices in the rest frame [m], shape (vertex_count, dimension).
            particles: The particles in the world [m], shape (at least vertex_count, 3).
            what: Name of the body, for the error.

        Raises:
            ValueError: The particles are not the vertices, turned and moved.
        """
        rest, world = lifted(vertices), particles[: len(vertices)].astype(np.float64)
        center, world_center = rest.mean(axis=0), world.mean(axis=0)
        if not np.isfinite(world).all():
            bad = np.flatnonzero(~np.isfinite(world).all(axis=1))[0]
            raise ValueError(f"{what}: the model's particle of cage vertex {bad} is not finite; make the model anew")
        frame = cls(Rotation.align_vectors(world - world_center, rest - center)[0].as_matrix(), center, world_center)
        distance = np.linalg.norm(frame.to_world(vertices) - world, axis=1)
        allowed = _MOVED * np.ptp(rest, axis=0).max() + _MOVED_WORLD * np.abs(world).max()
        if distance.max() > allowed:
            raise ValueError(
                f"{what}: the model's particle of cage vertex {distance.argmax()} is {distance.max():.3g} m from where "
                "the cage at rest has it; a solver takes model.particle_q for the rest pose, so make it before moving "
                "particles, move those of states, or finalize the builder again"
            )
        return frame

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Points of the rest frame in the world [m], shape (n, 3).

        Args:
            points: The points [m], shape (n, dimension).
        """
        return (lifted(points) - self._center) @ self.rotation.T + self._world_center

    def in_plane(self, vector: np.ndarray) -> np.ndarray:
        """What of a vector in the world lies in the plane of plane cages, shape (3,)."""
        normal = self.rotation[:, 2]
        return vector - (normal @ vector) * normal
