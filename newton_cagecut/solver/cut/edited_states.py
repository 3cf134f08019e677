# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The states that an edit of a body carries over, checked before anything changes."""

from __future__ import annotations

from collections.abc import Sequence

import newton

from ..body.simulated_body import SimulatedBody


def checked_states(body: SimulatedBody, states: Sequence[newton.State]) -> tuple[newton.State, ...]:
    """States of the body's model that are of its present edit, each of them once.

    Args:
        body: The body.
        states: What was passed.

    Raises:
        TypeError: Something is no state with particles.
        ValueError: A state is of another model, or missed an edit; or the body was edited through another solver.
    """
    if isinstance(states, newton.State):
        raise TypeError("states must be a sequence of states, got one state; pass states=(state,)")
    body.require_own_edits()
    count = body.model.particle_count
    found: list[newton.State] = []
    for number, state in enumerate(states):
        for name in ("particle_q", "particle_qd"):
            array = getattr(state, name, None)
            if array is None:
                raise TypeError(f"states[{number}] must be a state with particles, got {type(state).__name__}")
            if array.shape != (count,):
                raise ValueError(
                    f"states[{number}].{name} has the shape {array.shape}, the model has {count} particles; pass "
                    "states of the body's own model"
                )
        body.require_current(state, f"states[{number}]")
        if not any(state is other for other in found):
            found.append(state)
    return tuple(found)
