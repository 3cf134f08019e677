# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Which edit of each body a state is of.

A cut changes what the rows of a state mean: new vertices take over spare rows, and displacements count from new rest
positions. So every edit of a body has a number, which its row of ``state.cagecut.edit`` carries: ``State.assign``
copies it with the rest, and ``model.state()`` starts with that of now. A body whose row has another number is left
where it is, in a captured replay too; the next call that is not captured says so.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence

import newton
import warp as wp

from ...geometry import as_instance

wp.set_module_options({"enable_backward": False})


@wp.kernel(enable_backward=False)
def compare_edits(
    edits: wp.array[wp.int32],
    state_edits: wp.array[wp.int32],
    is_current: wp.array[wp.int32],
    missed: wp.array[wp.int32],
):
    """Find whether each body's row of a state is of its present edit, and count where it is not."""
    row = wp.tid()
    current = wp.where(state_edits[row] == edits[row], 1, 0)
    is_current[row] = current
    missed[row] = missed[row] + 1 - current


@wp.kernel(enable_backward=False)
def hold_rows(
    is_current: wp.array[wp.int32],
    positions: wp.array[wp.vec3],
    velocities: wp.array[wp.vec3],
    positions_out: wp.array[wp.vec3],
    velocities_out: wp.array[wp.vec3],
):
    """Carry particles over as they are, where the state is of another edit."""
    i = wp.tid()
    if is_current[0] == 0:
        positions_out[i] = positions[i]
        velocities_out[i] = velocities[i]


class EditStamps:
    """The present edit of every body of a solver, and which of them a state is of.

    Args:
        model: The model.
        labels: Names of the bodies, in the order of their rows.
    """

    def __init__(self, model: newton.Model, labels: Sequence[str]) -> None:
        self.device = model.device
        self.edits = wp.clone(model.cagecut.edit)
        """Number of each body's present edit, shape (body_count,), int32."""
        self.is_current = wp.ones(len(labels), dtype=wp.int32, device=self.device)
        """Whether the state of the last step was of that edit, shape (body_count,), int32."""
        self.labels = self._labels = tuple(labels)
        self._particle_count = model.particle_count
        self._known: weakref.WeakKeyDictionary[newton.State, tuple] = weakref.WeakKeyDictionary()
        self._missed = wp.zeros(len(labels), dtype=wp.int32, device=self.device)
        self._seen = wp.zeros(len(labels), dtype=wp.int32, device="cpu", pinned=self.device.is_cuda)
        self._seen_counts = self._seen.numpy()  # a view, of host memory on every device

    def require_own(self, state: newton.State, what: str) -> None:
        """Refuse what is no state of the model, by its arrays; those that were looked at once are known again.

        Args:
            state: What was passed.
            what: What it is, for the error.

        Raises:
            TypeError: It is no state, or one without particles.
            ValueError: Its arrays are of another size or on another device than the model's.
        """
        as_instance(state, newton.State, what, hint="model.state() makes one")
        arrays = (state.particle_q, state.particle_qd, state.particle_f, getattr(state, "cagecut", None))
        known = self._known.get(state)
        if known is not None and all(array is other for array, other in zip(arrays, known, strict=True)):
            return
        edits = state_edits(state, what)
        for name, array in zip(("particle_q", "particle_qd", "particle_f"), arrays, strict=False):
            if array is None:
                raise TypeError(f"{what} must be a state with particles, but {what}.{name} is None")
            if array.shape != (self._particle_count,):
                raise ValueError(
                    f"{what}.{name} has the shape {array.shape}, the model has {self._particle_count} particles; pass "
                    "states of the solver's own model, from model.state()"
                )
            if array.device != self.device:
                raise ValueError(f"{what}.{name} is on {array.device}, the model on {self.device}; pass its own states")
        if edits.shape != self.edits.shape:
            raise ValueError(
                f"{what} is of a model with {edits.size} cage bodies, the solver's has {self.edits.size}; pass states "
                "of the solver's own model, from model.state()"
            )
        self._known[state] = arrays

    def compare(self, state: newton.State) -> None:
        """Find which bodies a step may move, with kernels alone; outside of a capture raise where it may not.

        Args:
            state: The state that the step starts from.

        Raises:
            TypeError: The state is none of the model's.
            ValueError: A body's row of the state is of another edit, now or in an earlier replay.
        """
        inputs = [self.edits, state_edits(state), self.is_current, self._missed]
        wp.launch(compare_edits, dim=len(self._labels), inputs=inputs, device=self.device)
        wp.copy(self._seen, self._missed)
        if not self.device.is_capturing:
            self.raise_missed()

    def raise_missed(self) -> None:
        """Raise if a step has left a body where it was, and start counting anew.

        Raises:
            ValueError: It has; the text says which body, and what to do.
        """
        counts = self._seen_counts
        if not counts.any():
            return
        wp.synchronize_device(self.device)
        found = ", ".join(f"{label} ({count})" for label, count in zip(self._labels, counts, strict=True) if count)
        self._missed.zero_()
        self._seen.zero_()
        raise ValueError(
            f"steps from states that missed an edit, in which the body was left where it was: {found}. {_WHAT_TO_DO}"
        )

    def require(self, state: newton.State, row: int, what: str) -> None:
        """Refuse a state of which a body's row is of another edit; reads it on the host.

        Args:
            state: The state.
            row: Row of the body.
            what: What the state is, for the error.

        Raises:
            TypeError: The state is none of the model's.
            ValueError: The row is of another edit.
        """
        self.require_own(state, what)
        found, edit = (int(array.numpy()[row]) for array in (state_edits(state), self.edits))
        if found != edit:
            raise ValueError(
                f"{what} holds {self._labels[row]} as of edit {found}, the body is at edit {edit}. {_WHAT_TO_DO}"
            )


_WHAT_TO_DO = (
    "Pass every state in use to edits: advance_cut(cut, ..., states=(state_0, state_1)), snapshot(body, states=...). "
    "A state that missed one can be assigned from one that did not, or from model.state(), which starts from rest as "
    "the body is now. Edit a model's bodies through one solver."
)


def state_edits(state: newton.State, what: str = "the state") -> wp.array:
    """The edit that each body's row of a state is of, shape (body_count,), int32.

    Args:
        state: A state of a model with cage bodies.
        what: What it is, for the error.

    Raises:
        TypeError: It is none.
    """
    rows = getattr(state, "cagecut", None)
    if rows is None:
        raise TypeError(
            f"{what} must be a state of a model with cage bodies, from model.state(); got {type(state).__name__}"
        )
    return rows.edit
