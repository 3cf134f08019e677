# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of a reduced system that depend on the cage's weights only: masses and anchors.

M_ij = sum_q rho V_q w_qi w_qj, of which a thousandth is lumped onto the diagonal: the total mass and every row's sum
stay, and M is positive definite also where no quadrature point feels a vertex.
"""

from __future__ import annotations

import warp as wp

wp.set_module_options({"enable_backward": False})

LUMPED = wp.constant(wp.float64(1.0e-3))
"""Share of the mass that is lumped; also the least mass of a row, in mean masses, before lumping."""


@wp.kernel(enable_backward=False)
def find_anchors(weights: wp.array2d[float], vertex_count: wp.array[int], anchors: wp.array[int]):
    """The vertex of greatest weight at each quadrature point: displacements are taken relative to its own."""
    q = wp.tid()
    best = int(0)
    for j in range(1, vertex_count[0]):
        if weights[q, j] > weights[q, best]:
            best = j
    anchors[q] = best


@wp.kernel(enable_backward=False)
def assemble_mass(
    weights: wp.array2d[float],
    stabilizing: wp.array2d[float],
    volumes: wp.array[float],
    material: wp.array[wp.vec4d],
    vertex_count: wp.array[int],
    mass: wp.array2d[float],
):
    """Consistent mass matrix with the stabilising inertia; zero in the spare rows and columns."""
    i, j = wp.tid()
    total = wp.float64(0.0)
    if i < vertex_count[0] and j < vertex_count[0]:
        total = wp.float64(stabilizing[i, j])
        for q in range(weights.shape[0]):
            total += wp.float64(volumes[q]) * (wp.float64(weights[q, i]) * wp.float64(weights[q, j]))
    mass[i, j] = float(material[0][3] * total)


@wp.kernel(enable_backward=False)
def lump_mass(
    volumes: wp.array[float],
    material: wp.array[wp.vec4d],
    vertex_count: wp.array[int],
    mass: wp.array2d[float],
    vertex_mass: wp.array[float],
):
    """Move the lumped share of each row to the diagonal, and note the row's sum."""
    i = wp.tid()
    vertex_mass[i] = 0.0
    if i >= vertex_count[0]:
        return
    total = wp.float64(0.0)
    for q in range(volumes.shape[0]):
        total += wp.float64(volumes[q])
    least = LUMPED * material[0][3] * total / wp.float64(vertex_count[0])
    row = wp.float64(0.0)
    for j in range(vertex_count[0]):
        row += wp.float64(mass[i, j])
        mass[i, j] = float((wp.float64(1.0) - LUMPED) * wp.float64(mass[i, j]))
    lumped = LUMPED * wp.max(row, least)
    mass[i, i] = float(wp.float64(mass[i, i]) + lumped)
    vertex_mass[i] = float((wp.float64(1.0) - LUMPED) * row + lumped)
