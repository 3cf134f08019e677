# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What an advance of a cut did to a body."""

from __future__ import annotations

from dataclasses import dataclass

from ...harmonic import UpdateStats


@dataclass(frozen=True, kw_only=True)
class CutReport:
    """One advance of a cut.

    Args:
        depth: Depth of the cut from where the blade first touched [m].
        complete: Whether nothing is left to cut.
        components: Pieces that the cage is in.
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
    components: int
    separated: bool
    vertices_created: int
    points_created: int
    stats: UpdateStats
    seconds: dict[str, float]
    energy_before: float
    energy_after: float

    @property
    def energy_injected(self) -> float:
        """Energy that the change of shape functions added or took [J]."""
        return self.energy_after - self.energy_before

    @property
    def total_seconds(self) -> float:
        """Time of all parts [s]."""
        return sum(self.seconds.values())
