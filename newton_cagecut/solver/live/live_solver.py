# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The part of ``SolverCageCut`` for running scenes: resets, notifications and edits that are no cuts."""

from __future__ import annotations

from collections.abc import Sequence

import newton
import numpy as np
import warp as wp

from ...elastic import Material
from ..body.edit_stamps import EditStamps
from ..body.simulated_body import SimulatedBody
from . import live_edits
from .resets import reset_body, slot_of


class LiveSolver(newton.solvers.SolverBase):
    """A solver of cage bodies that can be reset and edited between steps; see ``SolverCageCut``."""

    CAGE_PROPERTIES = 1 << 20
    """Bit of ``notify_model_changed``: another solver of the model has changed materials or fixed vertices."""

    _simulated: list[SimulatedBody]
    _stamps: EditStamps

    def reset(
        self,
        state: newton.State,
        world_mask: wp.array[wp.bool] | None = None,
        flags: newton.StateFlags | int | None = None,
        *,
        uncut: bool = False,
    ) -> None:
        """Give a state the rest pose and start velocity of each cage body as it is now; forces are cleared.

        A state that missed edits is of the present one then, unless ``flags`` leave out positions or velocities. Rows
        that are not of cage bodies are left alone. Without ``uncut`` only kernels are launched, so it can be captured.

        Args:
            state: The state.
            world_mask: Worlds to reset, shape (world_count + 1,), the last for what is in no world; all if not given.
            flags: Which of PARTICLE_Q, PARTICLE_QD and PARTICLE_F to reset; all if not given.
            uncut: Whether to undo the cuts of the bodies as well. It is an edit: other states from after a cut cannot
                be stepped then, and cuts are to be begun anew. The first time computes weights, which are kept.

        Raises:
            TypeError: The state is none of a model with cage bodies, or the mask is no array of ``wp.bool``.
            ValueError: The state is of another model, the mask has another length or device, or ``uncut`` was asked for
                while a graph is captured or after a body was edited through another solver.
        """
        self._stamps.require_own(state, "state")
        mask = self._normalize_reset_world_mask(world_mask)
        if mask is None:
            mask = self._all_worlds()
        if uncut:
            if self.model.device.is_capturing:
                raise ValueError("reset(uncut=True) is an edit of the model: it cannot be captured")
            chosen = mask.numpy()
            for body in self._simulated:
                if chosen[slot_of(body)]:
                    live_edits.undo_cuts(body)
        wanted = int(newton.StateFlags.ALL if flags is None else flags)
        for body in self._simulated:
            reset_body(body, state, mask, wanted)

    def notify_model_changed(self, flags: newton.ModelFlags | int) -> None:
        """Take over what has changed in the model.

        Gravity, shapes and particle limits are read in every step and need no notification; a captured graph keeps
        using the arrays that there were.

        Args:
            flags: Bits of ``newton.ModelFlags``, or ``CAGE_PROPERTIES``; others are ignored.

        Raises:
            TypeError: The flags are no integer.
            ValueError: Another solver has cut a body.
        """
        if not isinstance(flags, int | np.integer):
            raise TypeError(f"flags must be newton.ModelFlags, got {flags!r}")
        if flags & self.CAGE_PROPERTIES:
            for body in self._simulated:
                live_edits.take_over(body)

    def set_material(self, body: int | str, material: Material) -> None:
        """Change Young's modulus, Poisson's ratio, density and damping of a body, between any two steps.

        ``model.particle_mass`` and the masses of pieces follow. States stay as they are, and stay good.

        Args:
            body: Index or label of the body.
            material: The material, of the constitutive model that the body was added with.

        Raises:
            TypeError: It is no material.
            ValueError: There is no such body, the model is another one, or the body was edited through another solver.
        """
        live_edits.set_material(self._simulated[self._row(body)], material)

    def set_fixed(self, body: int | str, fixed: np.ndarray | Sequence[int] | None) -> None:
        """Change which cage vertices of a body are fixed; all others are released.

        A vertex that becomes fixed stays where a state has it, or follows its target; see :meth:`step`.

        Args:
            body: Index or label of the body.
            fixed: Indices of cage vertices, or a mask over all that there are now; None releases all.

        Raises:
            TypeError: It is neither.
            ValueError: There is no such body or vertex, or the body was edited through another solver.
        """
        live_edits.set_fixed(self._simulated[self._row(body)], fixed)

    def _all_worlds(self) -> wp.array:
        """A mask over all worlds, made once."""
        if getattr(self, "_every_world", None) is None:
            self._every_world = wp.ones(self.model.world_count + 1, dtype=wp.bool, device=self.model.device)
        return self._every_world


def refuse_gradients(model: newton.Model) -> None:
    """Refuse a model whose states are to carry gradients: those through this solver would be zero.

    Args:
        model: The model.

    Raises:
        ValueError: It was finalized with ``requires_grad=True``.
    """
    if model.requires_grad:
        raise ValueError(
            "SolverCageCut is not differentiable, gradients through its steps would be zero: "
            "use builder.finalize(requires_grad=False)"
        )


def refuse_state_gradients(state: newton.State) -> None:
    """Refuse a state that is to carry gradients.

    Args:
        state: The state.

    Raises:
        ValueError: It does.
    """
    if state.particle_q.requires_grad:
        raise ValueError(
            "SolverCageCut is not differentiable, gradients through its steps would be zero: "
            "use model.state(requires_grad=False)"
        )
