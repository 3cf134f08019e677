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

    def add(self, which: np.ndarray, one: str, several: str) -> None:
        """Note a repair, if there was any.

        Args:
            which: Numbers of what was repaired, shape (count,), or (count, 2) of edges.
            one: What is said of one, with its number at ``{}``.
            several: What is said of several, with their count at ``{}``.
        """
        if len(which):
            number = which[0] if which.ndim == 1 else tuple(which[0].tolist())
            text = one.format(number)
            self.notes.append(text if len(which) == 1 else f"{several.format(len(which))}; the first: {text}")
