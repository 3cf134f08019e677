# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What an update did, and how long each part took."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import warp as wp


@dataclass
class UpdateStats:
    """Counts and times of one update or recompute.

    Args:
        walk_count: Walks that there are.
        checked: Walks whose bounds were tested against the new walls.
        rewalked: Walks that were walked again.
        on_face: Walks whose landing was evaluated again on changed faces.
        resumed: Walks that went on from their landings, where a face has moved outward.
        resolved_points: Points whose weights were resolved again.
        capped: Walks, of all, that the cap on steps stopped.
        lowest_weight: Least weight of all points; 0 unless some are negative.
        seconds: Time of each part [s]: "walls", "check", "rewalk", "resume", "on_face", "fit", "resolve", and
            "new_points" of points that an update has set besides.
    """

    walk_count: int
    checked: int = 0
    rewalked: int = 0
    on_face: int = 0
    resumed: int = 0
    resolved_points: int = 0
    capped: int = 0
    lowest_weight: float = 0.0
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def reused(self) -> int:
        """Walks that were kept as they were."""
        return self.walk_count - self.rewalked - self.on_face - self.resumed

    @property
    def total_seconds(self) -> float:
        """Time of all parts [s]."""
        return sum(self.seconds.values())

    @contextmanager
    def time(self, part: str, device: wp.context.Device) -> Iterator[None]:
        """Add the time that a block takes on a device to a part."""
        start = time.perf_counter()
        yield
        wp.synchronize_device(device)
        self.seconds[part] = self.seconds.get(part, 0.0) + time.perf_counter() - start
