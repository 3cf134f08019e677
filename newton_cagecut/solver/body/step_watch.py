# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How the steps of a solver's bodies went: counted on the device, looked at when a later call may."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import warp as wp

from ...elastic import STEP_COUNTS, ReducedSystem


class StepWatch:
    """Reads the records of bodies' steps, and warns once of each body whose solves miss the tolerance or are refused.

    Args:
        labels: Names of the bodies.
        systems: Their systems; None of a body without elasticity.
        device: Where they are.
    """

    def __init__(self, labels: Sequence[str], systems: Sequence[ReducedSystem | None], device: wp.Device) -> None:
        self.device = device
        self._bodies = [(label, system) for label, system in zip(labels, systems, strict=True) if system is not None]
        self._labels = tuple(labels)
        shape = (len(self._bodies), len(STEP_COUNTS))
        self._seen = wp.zeros(shape, dtype=int, device="cpu", pinned=device.is_cuda)
        self._seen_counts = self._seen.numpy()  # a view, of host memory on every device
        self._rows = [self._seen[row] for row in range(len(self._bodies))]
        self._warned: set[tuple[str, str]] = set()

    @property
    def systems(self) -> list[ReducedSystem]:
        """The systems whose steps are counted."""
        return [system for _, system in self._bodies]

    def note(self) -> None:
        """Hand the counts on to the host, when the device gets there; launches copies only."""
        for row, (_, system) in zip(self._rows, self._bodies, strict=True):
            wp.copy(row, system.record.counts)

    def warn(self) -> None:
        """Warn of what earlier steps have left, unless that is said already; nothing is waited for."""
        columns = {name: self._seen_counts[:, STEP_COUNTS.index(name)] for name in ("refused", "missed")}
        if not any(column.any() for column in columns.values()):
            return
        for row, (label, _) in enumerate(self._bodies):
            for name, text in _TEXTS.items():
                if columns[name][row] and (label, name) not in self._warned:
                    self._warned.add((label, name))
                    warnings.warn(f"{label}: {text} See solver.statistics().", RuntimeWarning, stacklevel=4)

    def statistics(self) -> list[dict[str, object]]:
        """One record a body, in the order of the bodies; read on the host."""
        found = {label: system.step_statistics() for label, system in self._bodies}
        return [{"body": label, **found.get(label, {})} for label in self._labels]

    def clear(self) -> None:
        """Start counting anew."""
        for _, system in self._bodies:
            system.record.counts.zero_()
            system.record.residuals.zero_()
        wp.synchronize_device(self.device)
        self._seen_counts[:] = np.int32(0)
        self._warned.clear()


_TEXTS = {
    "refused": "a step could not be made, and the body was left where it was.",
    "missed": "a linear solve ended before it reached the tolerance; raise max_iterations or the tolerance.",
}
