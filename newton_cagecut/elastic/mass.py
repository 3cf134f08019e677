# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernels of a reduced system that an edit makes run anew: masses, anchors and the number of pieces.

M_ij = sum_q rho V_q w_qi w_qj, of which a thousandth is lumped onto the diagonal: the total mass and every row's sum
stay, and M is positive definite also where no quadrature point feels a vertex.
"""

from __future__ import annotations

import warp as wp

from .arrays import BodyArrays
from .launching import launch_later

wp.set_module_options({"enable_backward": False})

LUMPED = wp.constant(wp.float64(1.0e-3))
"""Share of the mass that is lumped; also the least mass of a row, in mean masses, before lumping."""


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
def take_points(body: BodyArrays):
    """Gradients and volumes of the points as they are, for strain that is not averaged."""
    q, j = wp.tid()
    if body.averaged[0] == 0:
        body.gradients[q, j] = body.point_gradients[q, j]
        if j == 0:
            body.volumes[q] = body.point_volumes[q]


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
def lump_mass(body: BodyArrays):
    """Move the lumped share of each row to the diagonal, and note the row's sum."""
    i = wp.tid()
    body.vertex_mass[i] = 0.0
    if i >= body.vertex_count[0]:
        return
    total = wp.float64(0.0)
    for q in range(body.point_volumes.shape[0]):
        total += wp.float64(body.point_volumes[q])
    least = LUMPED * body.material[0][3] * total / wp.float64(body.vertex_count[0])
    row = wp.float64(0.0)
    for j in range(body.vertex_count[0]):
        entry = wp.float64(body.mass[i, j])
        row += entry
        body.mass[i, j] = float((wp.float64(1.0) - LUMPED) * entry)
    lumped = LUMPED * wp.max(row, least)
    body.mass[i, i] = float(wp.float64(body.mass[i, i]) + lumped)
    body.vertex_mass[i] = float((wp.float64(1.0) - LUMPED) * row + lumped)


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
        launch_later(take_points, (points, capacity), [body], device),
        launch_later(assemble_mass, (capacity, capacity), [body], device),
        launch_later(lump_mass, capacity, [body], device),
        launch_later(count_pieces, 1, [body], device),
    )
