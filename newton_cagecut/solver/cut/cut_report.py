# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What an advance of a cut did to a body."""

from __future__ import annotations

import time
from dataclasses import dataclass

from ...harmonic import UpdateStats


@dataclass(frozen=True, kw_only=True)
class CutReport:
    """One advance of a cut.

    Args:
        depth: Depth of the cut from where the blade first touched [m].
        complete: Whether nothing is left to cut.
        piece_count: Pieces that the body is in.
        separated: Whether a piece came off in this step.
        vertices_created: Cage vertices that are new.
        points_created: Surface points that are new.
        stats: What the update of the weights did, and its times.
        seconds: Time of each part [s]: "topology", "surface", "coordinates", "transfer".
        energy_before: Elastic and kinetic energy before the step [J].
        energy_after: The same after it [J].
    """

    depth: float
    complete: bool
    piece_count: int
    separated: bool
    vertices_created: int
    points_created: int
    stats: UpdateStats
    seconds: dict[str, float]
    energy_before: float
    energy_after: float

    @property
    def components(self) -> int:
        """Earlier name of ``piece_count``; a cage's components are its connected sets of faces, cavities included."""
        return self.piece_count

    @property
    def energy_injected(self) -> float:
        """Energy that the change of shape functions added or took [J]."""
        return self.energy_after - self.energy_before

    @property
    def total_seconds(self) -> float:
        """Time of all parts [s]."""
        return sum(self.seconds.values())


class Clock:
    """Times of the parts of an advance."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        """Time of each part so far [s]."""
        self._last = time.perf_counter()

    def lap(self, part: str) -> None:
        """Add the time since the last lap to a part.

        Args:
            part: Name of the part.
        """
        now = time.perf_counter()
        self.seconds[part] = self.seconds.get(part, 0.0) + now - self._last
        self._last = now
