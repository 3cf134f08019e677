# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows of a state that belong to no cage body: rigid bodies, joints, and other particles.

The solver integrates none of them. It copies them through, because callers swap states, or leaves what another solver
has written to ``state_out`` before.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import newton
import numpy as np
import warp as wp

FOREIGN_ROWS = ("copy", "keep")
"""What a step can do with foreign rows; see ``Config.foreign``."""

_RIGID = ("body_q", "body_qd", "joint_q", "joint_qd")
_NAMED = 4
"""Bodies and particles that the warning names."""


@wp.kernel(enable_backward=False)
def copy_rows(
    rows: wp.array[wp.int32],
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    positions_out: wp.array[wp.vec3],
    velocities_out: wp.array[wp.vec3],
):
    """Copy some particles."""
    i = rows[wp.tid()]
    positions_out[i] = positions[i]
    velocities_out[i] = velocities[i]


class ForeignRows:
    """The foreign rows of a model, and what a step does with them.

    Args:
        model: The model.
        own: Particles of the cage bodies.
        foreign: One of ``FOREIGN_ROWS``.
    """

    def __init__(self, model: newton.Model, own: Sequence[slice], foreign: str) -> None:
        self._copies, self.device = foreign == "copy", model.device
        is_foreign = np.ones(model.particle_count, dtype=bool)
        for part in own:
            is_foreign[part] = False
        rows = np.flatnonzero(is_foreign) if self._copies else np.zeros(0)
        self._rows = wp.array(rows, dtype=wp.int32, device=self.device) if len(rows) else None
        if self._copies:
            self._warn(model, is_foreign)

    def copy(self, state_in: newton.State, state_out: newton.State) -> None:
        """Copy the foreign rows to another state, if that is wanted; launches only."""
        if not self._copies:
            return
        for name in _RIGID:
            source, target = getattr(state_in, name, None), getattr(state_out, name, None)
            if source is not None and target is not None:
                wp.copy(target, source)
        if self._rows is not None:
            fields = [state_in.particle_q, state_in.particle_qd, state_out.particle_q, state_out.particle_qd]
            wp.launch(copy_rows, dim=self._rows.size, inputs=[self._rows, *fields], device=self.device)

    @staticmethod
    def _warn(model: newton.Model, is_foreign: np.ndarray) -> None:
        """Name what could move, but nobody integrates."""
        found = []
        if model.body_count:
            moves = (model.body_flags.numpy() & int(newton.BodyFlags.KINEMATIC)) == 0
            labels = list(model.body_label)
            found += _listed("rigid body", "rigid bodies", [labels[i] for i in np.flatnonzero(moves)])
        if is_foreign.any():
            moves = is_foreign & ((model.particle_flags.numpy() & int(newton.ParticleFlags.ACTIVE)) != 0)
            moves &= model.particle_inv_mass.numpy() > 0.0
            found += _listed("particle", "particles", np.flatnonzero(moves).tolist())
        if found:
            warnings.warn(
                f"SolverCageCut integrates cage bodies only; it copies {' and '.join(found)} from state to state as "
                'they are. Step them by another solver first, and make this one with foreign="keep".',
                stacklevel=4,
            )


def _listed(one: str, many: str, names: list) -> list[str]:
    """How many there are and the first names, as a list of one text, or none."""
    if not names:
        return []
    more = ", ..." if len(names) > _NAMED else ""
    return [f"{len(names)} {one if len(names) == 1 else many} ({', '.join(map(str, names[:_NAMED]))}{more})"]
