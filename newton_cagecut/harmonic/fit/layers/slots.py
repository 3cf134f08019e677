# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Ranges of numbers that are lent to owners and given back."""

from __future__ import annotations

from collections.abc import Hashable

_SPARE = 8
"""Room is made for one in so many more, so that it need not be made for every new owner."""


class Slots:
    """Ranges of the numbers from 0 to ``capacity``, which grows as it must."""

    def __init__(self) -> None:
        self.capacity = 0
        self._taken: dict[Hashable, tuple[int, int]] = {}

    def first(self, owner: Hashable) -> int:
        """Where the range of an owner starts."""
        return self._taken[owner][0]

    def keep(self, owners: set) -> None:
        """Take back the ranges of all others."""
        self._taken = {owner: taken for owner, taken in self._taken.items() if owner in owners}

    def take(self, owner: Hashable, count: int) -> int:
        """Where the range of an owner starts, who has one already or is lent one now.

        Args:
            owner: The owner.
            count: Length of the range.
        """
        if owner not in self._taken:
            self._taken[owner] = (self._gap(count), count)
        return self._taken[owner][0]

    def _gap(self, count: int) -> int:
        end = 0
        for first, length in sorted(self._taken.values()):
            if first - end >= count:
                return end
            end = first + length
        if end + count > self.capacity:
            self.capacity = end + count + (end + count) // _SPARE if self.capacity else end + count
        return end
