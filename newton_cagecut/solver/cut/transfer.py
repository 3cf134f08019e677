# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What new and moved cage vertices inherit of a body's motion.

They take position and velocity from the deformed shape at their rest position, an advancing tip those of its new rest
position. Displacements from rest are what is interpolated, so a body at rest stays at rest exactly.
"""

from __future__ import annotations

from collections.abc import Sequence

import newton
import numpy as np
import warp as wp

from ...cage import CageEdit
from ..body.simulated_body import SimulatedBody

_TRANSFER_WALKS = 4096
_HELD = 0.999
"""Weight of fixed vertices from which a vertex on a face is fixed too."""


class Transfer:
    """Rows of new and moved vertices, worked out on the cage before the edit.

    Args:
        body: The body, before the edit.
        edit: The edit.
    """

    def __init__(self, body: SimulatedBody, edit: CageEdit) -> None:
        self._body = body
        self._vertices = np.concatenate([edit.created, edit.moved])
        self._vertex_count = edit.cage.vertex_count
        points = edit.cage.vertices[self._vertices]
        self._on_face = edit.source_faces >= 0
        self._rest = body.to_world(points)
        self._weights = np.zeros((0, edit.before.vertex_count))
        self.piece_before = np.zeros(edit.cage.vertex_count, dtype=np.int64)
        """The piece that each vertex belonged to, or comes from, before the edit, shape (vertex_count,)."""
        self.piece_before[: edit.before.vertex_count] = edit.before.vertex_piece
        if len(points):
            keys = np.where(self._on_face, edit.before.face_key[edit.source_faces], -1)
            weights = body.coordinates.weights_at(points, keys, walks=_TRANSFER_WALKS)
            self._weights = weights.astype(np.float64)
            self.piece_before[self._vertices] = edit.before.vertex_piece[np.abs(weights).argmax(axis=1)]

    def apply(self, states: Sequence[newton.State]) -> None:
        """Write the vertices' rest positions and constraints, and their rows of states and of the model.

        Args:
            states: States whose rows are carried over.
        """
        body, model, count = self._body, self._body.model, self._weights.shape[1]
        body.vertex_count.fill_(self._vertex_count)
        if not len(self._vertices):
            return
        rest, fixed = body.rest.numpy(), body.fixed.numpy().copy()
        old_rest = rest[:count].astype(np.float64)
        rest = rest.copy()
        rest[self._vertices] = self._rest
        new_rest = rest[self._vertices].astype(np.float64)
        still = np.zeros_like(old_rest)
        for owner in (model, *states):
            self._write(owner.particle_qd, still, 0.0)
        for state in states:
            self._write(state.particle_q, old_rest, new_rest)
        fixed[self._vertices] = self._on_face & (self._weights @ (fixed[:count] != 0) > _HELD)
        body.rest.assign(rest)
        body.fixed.assign(fixed)
        wp.copy(model.particle_q[body.vertices], body.rest)

    def _write(self, field: wp.array, before: np.ndarray, after: np.ndarray | float) -> None:
        """Write what the vertices inherit of a field, given as a change from ``before`` and added to ``after``."""
        array = field[self._body.vertices]
        rows = array.numpy().copy()
        rows[self._vertices] = after + self._weights @ (rows[: len(before)] - before)
        array.assign(rows)
