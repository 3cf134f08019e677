# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The embedded surface in the world: each point is the weighted sum of the cage's vertices (paper, equation 1)."""

from __future__ import annotations

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.kernel(enable_backward=False)
def embed(
    enabled: wp.array[wp.int32],
    weights: wp.array2d[float],
    first_row: int,
    point_count: wp.array[wp.int32],
    vertex_count: wp.array[wp.int32],
    vertices: wp.array[wp.vec3],
    points: wp.array[wp.vec3],
):
    """Sum a vertex field with the weights of each surface point."""
    i = wp.tid()
    if i >= point_count[0] or enabled[0] == 0:
        return
    total = wp.vec3()
    for j in range(vertex_count[0]):
        total += weights[first_row + i, j] * vertices[j]
    points[i] = total
