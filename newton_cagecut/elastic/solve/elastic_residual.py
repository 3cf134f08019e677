# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What the quadrature points' stress does to the vertices."""

import functools

import warp as wp

from ..arrays import BodyArrays, LinearSystem
from ..plane_confinement import in_plane
from .lanes import lane_struct, make_scatter

wp.set_module_options({"enable_backward": False})


@functools.cache
def make_residual_kernel(width: int) -> wp.Kernel:
    """The kernel that keeps the residual as it is and then adds the quadrature's part; one thread a vertex."""
    Lanes, scatter = lane_struct(width), make_scatter(width)

    @wp.kernel(enable_backward=False, module="unique")
    def add_elastic_residual(body: BodyArrays, system: LinearSystem, lanes: Lanes):
        i = wp.tid()
        r = system.residual[i]
        system.kept[i] = r
        if i < body.vertex_count[0]:
            r -= scatter(i, lanes)
        if body.normal.shape[0] > 0:
            r = in_plane(r, body.normal[0])
        system.residual[i] = r

    return add_elastic_residual
