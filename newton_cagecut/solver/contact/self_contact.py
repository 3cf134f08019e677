# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Contact of a body with itself: between its pieces, between the sides of its cuts, and where it folds.

Samples on the surface as it is now, newly cut caps included, touch its triangles. The gap is without thickness, signed
by the triangle's outward normal; the nearest triangle that a sample projects into counts. On other pieces all do; on
the sample's own only those in whose front it lay at rest and that it is no corner of: so the sides of a slit, which
start on each other, touch, and what lies behind does not. A contact acts if its gap is closed by the end of the step.
It lets its sides come no closer than that, up to a stiffness, and pushes out a fifth of an overlap a step; all of it is
a part of the body's one solve, each contact a row of weights. Forces are equal and opposite: momentum is kept.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import warp as wp

from ...elastic import PointForces
from . import self_contact_kernels as kernels
from .touch_samples import touch_samples

if TYPE_CHECKING:
    from ..body.simulated_body import SimulatedBody

_SAMPLES = 3
"""Room for samples, in surface points."""
_FIRMNESS = 1000.0
"""Stiffness of an area that touches, in Young's modulus over the size of the body."""
_REACH = 0.1
"""Greatest overlap that is found, in the size of the body."""


class SelfContact:
    """Contacts of one body with itself, on its surface of now; steps only launch kernels.

    Args:
        body: The body, with surface particles.
        slots: Room for contacts.
    """

    def __init__(self, body: SimulatedBody, slots: int) -> None:
        self._body, self.room = body, slots
        points, triangles = body.capacity.surface_points, body.capacity.surface_triangles
        samples = _SAMPLES * points
        self.surface, self.touches = kernels.TouchingSurface(), kernels.Touches()
        with wp.ScopedDevice(body.device):
            surface, touches = self.surface, self.touches
            surface.triangles, surface.piece = wp.zeros(triangles, dtype=wp.vec3i), wp.zeros(triangles, dtype=int)
            surface.triangle_count, surface.piece_count, surface.sample_count = (
                wp.zeros(1, dtype=int) for _ in range(3)
            )
            surface.rest = wp.zeros(points, dtype=wp.vec3)
            surface.lower, surface.upper = (wp.zeros(triangles, dtype=wp.vec3) for _ in range(2))
            surface.sample_triangle = wp.zeros(samples, dtype=int)
            surface.sample_place, surface.sample_area = wp.zeros(samples, dtype=wp.vec3), wp.zeros(samples, dtype=float)
            touches.triangle, touches.acts, touches.rank = (wp.zeros(samples, dtype=int) for _ in range(3))
            touches.place, touches.normal = (wp.zeros(samples, dtype=wp.vec3) for _ in range(2))
            touches.gap = wp.zeros(samples, dtype=float)
            touches.listed, touches.count = wp.zeros(slots, dtype=int), wp.zeros(1, dtype=int)
            self._first_slot = wp.zeros(1, dtype=int)
        self._bvh: wp.Bvh | None = None
        self._stale = True

    def refresh(self) -> None:
        """Follow an edit of the surface; on the host."""
        body, surface = self._body, self.surface
        triangles = body.surface.site_triangles
        weights = body.coordinates.weights[body.surface_row : body.surface_row + body.surface.site_count]
        site_piece = np.asarray(body.cage.vertex_piece)[np.abs(weights).argmax(axis=1)]
        pieces = site_piece[triangles[:, 0]]
        found = touch_samples(
            body.surface.site_points, triangles, body.surface.triangle_cap >= 0, len(surface.sample_triangle)
        )
        _fill(surface.triangles, triangles)
        spare = np.full(len(surface.piece), pieces.max() + 1)
        spare[: len(pieces)] = pieces
        _fill(surface.piece, spare)
        surface.triangle_count.fill_(len(triangles))
        surface.piece_count.fill_(int(pieces.max()) + 1)
        _fill(surface.rest, body.surface.site_points)
        _fill(surface.sample_triangle, found.triangle)
        _fill(surface.sample_place, found.place)
        _fill(surface.sample_area, found.area)
        surface.sample_count.fill_(len(found.area))
        self._build()

    def _build(self) -> None:
        """The hierarchy of the triangles' boxes, each piece a group; at the rest positions."""
        surface = self.surface
        inputs = [surface.rest, surface]
        wp.launch(kernels.bound_triangles, dim=len(surface.piece), inputs=inputs, device=self._body.device)
        if self._bvh is None:
            self._bvh = wp.Bvh(surface.lower, surface.upper, groups=surface.piece)
        else:
            self._bvh.rebuild()

    def _law(self) -> kernels.TouchLaw:
        """What touches what, and how firmly."""
        body, law = self._body, kernels.TouchLaw()
        definition = body.definition
        size, material = definition.cage.diameter, definition.material
        law.own, law.others = int(definition.self_contact), int(definition.pieces_touch)
        law.reach, law.size = _REACH * size, size
        law.stiffness, law.density = _FIRMNESS * material.young / size, material.density * size
        friction = definition.contact_material.friction
        law.friction = body.model.soft_contact_mu if friction is None else friction
        return law

    def collect(self, positions: wp.array, velocities: wp.array, points: PointForces, dt: float) -> None:
        """Add the contacts that act in a step to the forces on points, behind those that are there.

        Args:
            positions: Positions of the surface's points [m].
            velocities: Velocities of the surface's points [m/s].
            points: Forces on the body's points.
            dt: Time step [s].
        """
        body, surface, touches, law = self._body, self.surface, self.touches, self._law()
        device, samples = body.device, touches.triangle.size
        wp.launch(kernels.bound_triangles, dim=surface.piece.size, inputs=[positions, surface], device=device)
        self._bvh.refit()
        inputs = [self._bvh.id, dt, positions, velocities, law, surface, touches]
        wp.launch(kernels.find_touches, dim=samples, inputs=inputs, device=device)
        wp.utils.array_scan(touches.acts, touches.rank, inclusive=False)
        wp.launch(kernels.list_touches, dim=samples, inputs=[touches], device=device)
        shape = (self.room, points.pair_weights.shape[1])
        inputs = [body.surface_rows, surface, touches, points]
        wp.launch(kernels.weigh_touches, dim=shape, inputs=inputs, device=device)
        wp.launch(kernels.note_first_slot, dim=1, inputs=[points, self._first_slot], device=device)
        inputs = [dt, self._first_slot, velocities, law, surface, touches, points]
        wp.launch(kernels.push_touches, dim=self.room, inputs=inputs, device=device)
        wp.launch(kernels.add_slots, dim=1, inputs=[touches, points], device=device)


def _fill(array: wp.array, rows: np.ndarray) -> None:
    """Write the first rows of a device array in place."""
    if len(rows):
        wp.copy(array[: len(rows)], wp.array(rows, dtype=array.dtype, device=array.device))
