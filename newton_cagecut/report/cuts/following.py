# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""One cut followed step by step: which walks bounds flag, and which really change.

A walk that meets a cut goes on from there with smaller spheres, so it lands elsewhere: a walk has changed where its
landing has.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...cage import Cage
from ...harmonic import HarmonicCoordinates
from ...section import Blade
from ..paper.cutting import STEP, edits


@dataclass
class Followed:
    """Walks flagged and walks changed by one cut.

    Attributes:
        flagged: Share of the walks that were flagged, of each step.
        changed: Share of the walks whose landing changed, of each step.
        touched: For each walk whether some step changed it, shape ``(walk_count,)``.
    """

    flagged: list[float]
    changed: list[float]
    touched: np.ndarray

    @property
    def in_vain(self) -> float:
        """Flagged walks that did not change, for each one that did; infinite if none did."""
        changed = sum(self.changed)
        return sum(self.flagged) / changed - 1.0 if changed else np.inf


def follow(
    cage: Cage,
    points: np.ndarray,
    blade: Blade,
    walks: int,
    *,
    step: float = STEP,
    on_step: Callable[[], object] | None = None,
    **options,
) -> Followed:
    """Cut a cage by one blade and count walks.

    Args:
        cage: The cage.
        points: Points in it [m], shape ``(n, dimension)``.
        blade: The blade.
        walks: Walks a point.
        step: Advance of the blade, as a share of the cut's length.
        on_step: Called after each step.
        options: Further options of the coordinates.
    """
    coordinates = HarmonicCoordinates(cage, points, walks, **options)
    before = landings_of(coordinates)
    found = Followed([], [], np.zeros(len(before), dtype=bool))
    for edit in edits(cage, [blade], step):
        found.flagged.append(coordinates.update(edit).rewalked / len(before))
        after = landings_of(coordinates)
        changed = (before != after).any(axis=1)
        found.changed.append(float(changed.mean()))
        found.touched |= changed
        before = after
        if on_step:
            on_step()
    return found


def landings_of(coordinates: HarmonicCoordinates) -> np.ndarray:
    """Return where each walk landed, with the wall's side, as bits, shape ``(walk_count, n)``.

    Args:
        coordinates: Coordinates that keep their walks.
    """
    landings = coordinates.landings
    return np.column_stack([np.ascontiguousarray(landings["point"]).view(np.int32), landings["key"]])
