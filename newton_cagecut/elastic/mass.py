# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of a reduced system that an edit makes run anew: masses, anchors and the number of pieces.

M_ij = sum_q rho V_q w_qi w_qj and the stabilising mass, whose rows sum to zero, so that every row's sum stays; it makes
M positive definite also where no quadrature point feels a vertex.
"""

from __future__ import annotations

import warp as wp

from .arrays import BodyArrays
from .launching import launch_later

wp.set_module_options({"enable_backward": False})

LEAST = wp.constant(wp.float64(1.0e-9))
"""Least sum of a row, in mean ones: who reads the masses of particles may take 0 for held."""


@wp.kernel(enable_backward=False)
def find_anchors(body: BodyArrays):
    """The vertex of greatest weight at each quadrature point: displacements are taken relative to its own."""
    q = wp.tid()
    best = int(0)
    for j in range(1, body.vertex_count[0]):
        if body.weights[q, j] > body.weights[q, best]:
            best = j
    body.anchors[q] = best


@wp.kernel(enable_backward=False)
def assemble_mass(body: BodyArrays):
    """Consistent mass matrix with the stabilising inertia; zero in the spare rows and columns."""
    i, j = wp.tid()
    total = wp.float64(0.0)
    if i < body.vertex_count[0] and j < body.vertex_count[0]:
        total = wp.float64(body.stabilizing_mass[i, j])
        for q in range(body.point_volumes.shape[0]):
            product = wp.float64(body.weights[q, i]) * wp.float64(body.weights[q, j])
            total += wp.float64(body.point_volumes[q]) * product
    body.mass[i, j] = float(body.material[0][3] * total)


@wp.kernel(enable_backward=False)
def sum_mass(body: BodyArrays):
    """Sum each row, and take the mean of all rows for a floor that keeps them positive."""
    i = wp.tid()
    row = wp.float64(0.0)
    if i < body.vertex_count[0]:
        total = wp.float64(0.0)
        for q in range(body.point_volumes.shape[0]):
            total += wp.float64(body.point_volumes[q])
        for j in range(body.vertex_count[0]):
            row += wp.float64(body.mass[i, j])
        row = wp.max(row, LEAST * body.material[0][3] * total / wp.float64(body.vertex_count[0]))
    body.vertex_mass[i] = float(row)


@wp.kernel(enable_backward=False)
def count_pieces(body: BodyArrays):
    """Number of pieces."""
    count = int(1)
    for i in range(body.vertex_count[0]):
        count = wp.max(count, body.piece[i] + 1)
    body.piece_count[0] = count


def record_masses(body: BodyArrays) -> tuple[wp.Launch, ...]:
    """The launches that bring anchors, masses and the number of pieces up to date, in their order."""
    capacity, points, device = body.rest.shape[0], body.point_volumes.shape[0], body.rest.device
    return (
        launch_later(find_anchors, points, [body], device),
        launch_later(assemble_mass, (capacity, capacity), [body], device),
        launch_later(sum_mass, capacity, [body], device),
        launch_later(count_pieces, 1, [body], device),
    )
