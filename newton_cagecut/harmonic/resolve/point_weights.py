# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Weights of points on a device, and what is known of each."""

from __future__ import annotations

import warp as wp


class PointWeights:
    """Weights and gradients of points, and the degree and the least weight of each.

    Args:
        point_capacity: Points that there is room for.
        gradient_count: Points that have gradients.
        vertex_capacity: Cage vertices that there is room for.
        device: Where to put them.
    """

    def __init__(
        self, point_capacity: int, gradient_count: int, vertex_capacity: int, *, device: wp.context.Device
    ) -> None:
        self.weights = wp.zeros((point_capacity, vertex_capacity), dtype=float, device=device)
        self.gradients = wp.zeros((gradient_count, vertex_capacity), dtype=wp.vec3, device=device)
        self.degrees = wp.zeros(point_capacity, dtype=wp.int32, device=device)
        self.lowest = wp.zeros(point_capacity, dtype=float, device=device)

    @property
    def vertex_capacity(self) -> int:
        """Cage vertices that there is room for."""
        return self.weights.shape[1]

    @property
    def arrays(self) -> dict[str, wp.array]:
        """The arrays, by name."""
        return vars(self)

    def copied(self) -> PointWeights:
        """A copy."""
        return self._copied(self.vertex_capacity)

    def grown(self, vertex_count: int) -> PointWeights:
        """These where so many cage vertices fit in; else a copy with room for them and some more.

        Args:
            vertex_count: Number of cage vertices.
        """
        if vertex_count <= self.vertex_capacity:
            return self
        return self._copied(max(vertex_count, self.vertex_capacity * 3 // 2))

    def _copied(self, vertex_capacity: int) -> PointWeights:
        (point_capacity, used), gradient_count = self.weights.shape, self.gradients.shape[0]
        copy = PointWeights(point_capacity, gradient_count, vertex_capacity, device=self.weights.device)
        for old, array in ((self.weights, copy.weights), (self.gradients, copy.gradients)):
            if old.size:
                wp.copy(array[:, :used], old)
        wp.copy(copy.degrees, self.degrees)
        wp.copy(copy.lowest, self.lowest)
        return copy
