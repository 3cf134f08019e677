# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cuts in small steps, as section 7 of the paper makes them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ...cage import Cage, CageEdit, Cut
from ...section import Blade

STEP = 0.03  # of a cut's length, as in section 7 of the paper


def edits(cage: Cage, blades: Sequence[Blade], step: float = STEP) -> Iterator[CageEdit]:
    """Cut a cage by one blade after the other, each through the whole cage.

    Args:
        cage: The cage before the cuts.
        blades: The blades.
        step: Advance of a blade from one edit to the next, as a share of its cut's length.
    """
    for blade in blades:
        cut = Cut(cage, blade)
        for k in range(1, step_count(step) + 1):
            yield cut.advance(to=cut.length * min(k * step, 1.0))
        cage = cut.cage


def step_count(step: float = STEP) -> int:
    """Return the number of steps of one cut."""
    return math.ceil(1.0 / step - 1e-9)
