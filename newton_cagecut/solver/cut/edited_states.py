# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The states that an edit of a body carries over, checked before anything changes."""

from __future__ import annotations

from collections.abc import Sequence

import newton

from ...geometry import as_sequence
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
    states = as_sequence(states, newton.State, "states")
    body.require_own_edits()
    found: list[newton.State] = []
    for number, state in enumerate(states):
        body.require_current(state, f"states[{number}]")
        if not any(state is other for other in found):
            found.append(state)
    return tuple(found)
