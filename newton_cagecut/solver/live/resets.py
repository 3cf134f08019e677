# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Resets of states, per world: the rest pose and start velocity of each body as it is now."""

from __future__ import annotations

import newton
import warp as wp

from ..body.edit_stamps import state_edits
from ..body.simulated_body import SimulatedBody

wp.set_module_options({"enable_backward": False})

_Q = wp.constant(int(newton.StateFlags.PARTICLE_Q))
_QD = wp.constant(int(newton.StateFlags.PARTICLE_QD))
_F = wp.constant(int(newton.StateFlags.PARTICLE_F))


@wp.kernel(enable_backward=False)
def reset_rows(
    mask: wp.array[wp.bool],
    slot: int,
    flags: int,
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    state_positions: wp.array[wp.vec3],
    state_velocities: wp.array[wp.vec3],
    state_forces: wp.array[wp.vec3],
):
    """Give the rows of a body in a state those of the model, if its world is to be reset."""
    i = wp.tid()
    if mask[slot]:
        if flags & _Q != 0:
            state_positions[i] = positions[i]
        if flags & _QD != 0:
            state_velocities[i] = velocities[i]
        if flags & _F != 0:
            state_forces[i] = wp.vec3()


@wp.kernel(enable_backward=False)
def reset_edit(mask: wp.array[wp.bool], slot: int, edits: wp.array[wp.int32], state_edits: wp.array[wp.int32]):
    """Mark a body's row of a state as of the present edit, if its world is to be reset."""
    if mask[slot]:
        state_edits[0] = edits[0]


def reset_body(body: SimulatedBody, state: newton.State, mask: wp.array, flags: int) -> None:
    """Reset what a state holds of a body; launches only, so it can be captured.

    Args:
        body: The body.
        state: The state.
        mask: Worlds to reset, the global one last, shape (world_count + 1,), bool.
        flags: Which of the particles' attributes, as in ``newton.StateFlags``.
    """
    model, device, slot = body.model, body.device, slot_of(body)
    for part in body.parts:
        fields = [model.particle_q, model.particle_qd, state.particle_q, state.particle_qd, state.particle_f]
        inputs = [mask, slot, flags, *(field[part] for field in fields)]
        wp.launch(reset_rows, dim=part.stop - part.start, inputs=inputs, device=device)
    if flags & _Q and flags & _QD:
        row = slice(body.row, body.row + 1)
        wp.launch(reset_edit, dim=1, inputs=[mask, slot, body.edits, state_edits(state)[row]], device=device)


def slot_of(body: SimulatedBody) -> int:
    """The place of a body's world in masks and in the model's gravity."""
    return body.world if body.world >= 0 else body.model.world_count
