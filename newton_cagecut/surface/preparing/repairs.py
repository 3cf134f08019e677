# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What was done to a mesh so that it can be cut, in words."""

from __future__ import annotations

import numpy as np


class Repairs:
    """Sentences about repairs, with the numbers of what they were made to."""

    def __init__(self) -> None:
        self.notes: list[str] = []
        """The sentences."""

    def add(self, which: np.ndarray, kind: str, one: str, several: str) -> None:
        """Note a repair, if there was any.

        Args:
            which: Numbers of what was repaired, shape (count,), or (count, 2) of edges.
            kind: What it is, "triangle" or "edge".
            one: What is said of one.
            several: What is said of several.
        """
        if not len(which):
            return
        number = which[0] if which.ndim == 1 else tuple(which[0].tolist())
        text = f"{kind} {number} {one}" if len(which) == 1 else f"{len(which)} {kind}s {several}, the first {number}"
        self.notes.append(text)
