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
        errors: Whether weights have standard errors.
    """

    def __init__(
        self,
        point_capacity: int,
        gradient_count: int,
        vertex_capacity: int,
        *,
        device: wp.context.Device,
        errors: bool = False,
    ) -> None:
        self.weights = wp.zeros((point_capacity, vertex_capacity), dtype=float, device=device)
        self.gradients = wp.zeros((gradient_count, vertex_capacity), dtype=wp.vec3, device=device)
        self.errors = wp.zeros((point_capacity if errors else 0, vertex_capacity), dtype=float, device=device)
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
        device, errors = self.weights.device, self.errors.size > 0
        copy = PointWeights(point_capacity, gradient_count, vertex_capacity, device=device, errors=errors)
        for name in ("weights", "gradients", "errors"):
            old, array = getattr(self, name), getattr(copy, name)
            if old.size:
                wp.copy(array[:, :used], old)
        wp.copy(copy.degrees, self.degrees)
        wp.copy(copy.lowest, self.lowest)
        return copy
