# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The nested walk: on circles in a face's plane, until an edge is near (paper, section 5.1, figure 7).

It is replayable as the walk in the volume is, with counters of its own.
"""

from __future__ import annotations

import warp as wp

from ..walks.random import NESTED_STREAM, direction_on_circle
from .face_tables import FaceTables, cross2

wp.set_module_options({"enable_backward": False})

_WRONG_SIDE = wp.constant(4.0e-6)


@wp.struct
class EdgeHit:
    """The edge of a face nearest to a point of its plane."""

    distance: float
    row: int
    param: float


@wp.func
def nearest_edge(tables: FaceTables, face: int, x: wp.vec2) -> EdgeHit:
    """Nearest edge of a face's loop. Of the two coincident edges of a slit it is the one whose inner side x is on."""
    first = tables.loop_start[face]
    last = tables.loop_start[face + 1]
    orientation = tables.orientation[face]
    hit = EdgeHit()
    nearest = float(1.0e30)
    for row in range(first, last):
        a = tables.loop_point[row]
        b = tables.loop_point[wp.where(row + 1 == last, first, row + 1)]
        ab = b - a
        ax = x - a
        t = wp.clamp(wp.dot(ab, ax) / wp.max(wp.dot(ab, ab), 1.0e-30), 0.0, 1.0)
        distance = wp.length(ax - ab * t)
        ranked = distance
        if cross2(ab, ax) * orientation < 0.0:
            ranked = distance + _WRONG_SIDE
        if ranked < nearest:
            nearest = ranked
            hit.distance = distance
            hit.row = row - first
            hit.param = t
    return hit


@wp.func
def walk_on_face(
    tables: FaceTables,
    face: int,
    start: wp.vec2,
    seed: wp.uint32,
    point: wp.uint32,
    walk: wp.uint32,
    epsilon: float,
    max_steps: int,
) -> EdgeHit:
    """Walk on circles in a face's plane until an edge is within ``epsilon``."""
    x = start
    hit = nearest_edge(tables, face, x)
    step = int(0)
    while hit.distance >= epsilon and step < max_steps:
        x += hit.distance * direction_on_circle(seed + NESTED_STREAM, point, walk, wp.uint32(step))
        hit = nearest_edge(tables, face, x)
        step += 1
    return hit
